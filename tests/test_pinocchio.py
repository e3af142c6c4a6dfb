"""Emitted C and Python against Pinocchio on real robots, fixed and floating: 50 states each.

A few robots by default; ``--all-robots`` takes every URDF of the example-robot-data wheel and prints a
table. A robot with a joint that moves no inertia is refused by linegraph; that joint is then locked on
both sides, so that the rest of the robot is compared.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
import pytest
from compiled import Compiled
from emitted import load

from linegraph import ModelError, derive, urdf
from linegraph.emission import render

pytest.importorskip("pinocchio")
import pinocchio_models as peers

if TYPE_CHECKING:
    from pathlib import Path

    from linegraph import Model

STATES = 50
TOLERANCE = 1e-10  # relative to the largest expected entry
FEW = (
    "double_pendulum_continuous",
    "panda",
    "ur5_robot",
    "solo12",
    "anymal-kinova",
    "simple_humanoid",
    "tiago_dual",
    "talos_reduced",
)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    files = peers.urdf_files()
    if not metafunc.config.getoption("--all-robots"):
        files = [file for file in files if file.stem in FEW]
    names = [f"{file.parent.parent.name}-{file.stem}" for file in files]
    metafunc.parametrize("file", files, ids=names)
    metafunc.parametrize("base", ["fixed", "floating"])


def readable(file: Path, base: str) -> tuple[Model, dict[str, float]]:
    """The model, with the joints locked that move no inertia."""
    held: dict[str, float] = {}
    for _ in range(60):
        model = urdf.read(file, base=base)
        for name in held:
            model.lock(name)
        try:
            derive(model)
        except ModelError as error:
            joint = re.search(r'joint "([^"]+)"', str(error))
            if joint is None or "singular" not in str(error):
                pytest.skip(f"refused: {error}")
            held[joint.group(1)] = 0.0
        else:
            return model, held
    raise AssertionError(f"{file.name}: no regular mass matrix")


def relative(found: np.ndarray, expected: np.ndarray) -> float:
    return float(np.max(np.abs(found - expected)) / (np.max(np.abs(expected)) or 1.0))


def test_agrees_with_pinocchio(
    file: Path, base: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if file.stat().st_size < 1000:
        pytest.skip("a git link, not a robot")
    model, held = readable(file, base)
    text = file.read_text()
    pair = peers.Bridge(
        model, peers.load_text(text, floating=base == "floating"), peers.followers(text), held
    )
    files = render(model, name="robot", folded=True)
    compiled = Compiled(files, "robot", tmp_path, flags=("-O1",))
    module = load(files, "robot", tmp_path)
    n = module.NV
    actuated = [module.V_NAMES.index(name) for name in module.U_NAMES]
    assert list(module.Q_NAMES) == pair.q_names
    worst = dict.fromkeys(("M", "h", "inverse", "forward"), 0.0)
    rng = np.random.default_rng(0)
    for _ in range(STATES):
        q, v = pair.random_state(rng)
        a, u = rng.normal(size=n), rng.normal(size=module.NU)
        tau = np.zeros(n)
        tau[actuated] = u
        M, h = pair.mass_matrix(q), pair.bias(q, v)
        for found_M, found_h, inverse, forward in (
            (
                *compiled.call("equations", q, v, out=[(n, n), (n,)]),
                compiled.call("inverse_dynamics", q, v, a, out=[(n,)]),
                compiled.call("forward_dynamics", q, v, u, out=[(n,)]),
            ),
            (
                *module.equations(q, v),
                module.inverse_dynamics(q, v, a),
                module.forward_dynamics(q, v, u),
            ),
        ):
            worst["M"] = max(worst["M"], relative(found_M, M))
            worst["h"] = max(worst["h"], relative(found_h, h))
            expected = pair.inverse_dynamics(q, v, a)
            worst["inverse"] = max(worst["inverse"], relative(inverse, expected))
            expected = np.linalg.solve(M, tau - h)
            worst["forward"] = max(worst["forward"], relative(forward, expected))
    with capsys.disabled():
        row = "  ".join(f"{key} {value:.0e}" for key, value in worst.items())
        locked = f"  locked: {len(held)}" if held else ""
        print(f"\n{file.stem:32s} {base:8s} nv {n:3d}  {row}{locked}", end="")
    assert max(worst.values()) < TOLERANCE
