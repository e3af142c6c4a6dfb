"""The worked example of identification: parameters within their intervals, torques to the sensors' noise."""

from __future__ import annotations

import importlib.util
import sys
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

FOLDER = Path(__file__).parents[2] / "examples" / "identification"


@cache
def example() -> Any:
    """The script as a module."""
    specification = importlib.util.spec_from_file_location("identify", FOLDER / "identify.py")
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    sys.modules["identify"] = module
    specification.loader.exec_module(module)
    return module


@cache
def estimate() -> Any:
    return example().identify(example().arm(), seed=2, tries=60)


def test_every_base_parameter_lies_in_its_interval() -> None:
    found = estimate()
    assert len(found.names) == 22
    assert np.abs(found.errors).max() < example().SIGMAS
    # the intervals are neither too wide nor too narrow
    assert 0.5 < np.sqrt((found.errors**2).mean()) < 1.5
    values = dict(zip(found.names, zip(found.true, found.deviation, strict=True), strict=True))
    for name in ("column.Izz", "upper.mx", "upper.Iyy", "lower.mx", "elbow.armature"):
        true, deviation = values[name]
        assert deviation < 0.01 * true
    assert values["elbow.friction"][0] == 2.0
    assert values["elbow.armature"][0] == pytest.approx(80**2 * 8e-5)


def test_another_motion_is_predicted_to_the_noise_of_the_sensors() -> None:
    found, module = estimate(), example()
    sensors = module.NOISE_TAU / np.sqrt(module.PERIODS)
    for residual in found.noise:
        assert np.abs(residual / sensors - 1).max() < 0.05
    _, tau, predicted = found.torques
    assert (np.ptp(predicted, axis=0) > 20 * sensors).all()
    assert (tau - predicted).std(0) == pytest.approx(found.noise[1])


def test_the_motion_excites_better_than_one_at_random() -> None:
    first, chosen = estimate().conditions
    assert chosen < first / 2


def test_without_friction_in_the_model_the_residual_tells() -> None:
    """What is checked above can fail: columns of friction left out, and the noise is exceeded."""
    module = example()
    system = module.Arm(module.arm())
    rng = np.random.default_rng(2)
    motion, _, _ = module.exciting(system, rng, 3)
    q, v, a = motion.at(np.arange(0, module.PERIOD, 0.02))
    rows = system.rows((q, v, a))
    tau = rows @ system.true + rng.normal(size=q.shape)
    _, _, whole = module.least_squares(rows, tau)
    poor = [k for k, place in enumerate(system.base.independent) if not _rubs(system, place)]
    _, _, residual = module.least_squares(rows[..., poor], tau)
    assert whole.max() < 1.2
    assert residual.min() > 2


def _rubs(system: Any, place: int) -> bool:
    return system.base.names[place].endswith((".friction", ".damping"))


def test_its_report_and_its_picture(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    text = example().report(estimate())
    assert "elbow.armature" in text
    assert "another motion" in text
    example().plot(estimate(), tmp_path / "found.png")
    assert (tmp_path / "found.png").read_bytes().startswith(b"\x89PNG")
    readme = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert "identification.png" in readme
    assert (FOLDER / "identification.png").exists()
