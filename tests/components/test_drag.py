"""The drag of a fluid, by hand on a body that flies and spins, in every route and language."""

from __future__ import annotations

import math
import subprocess
import sys
from typing import TYPE_CHECKING

import numpy as np
import pytest

import linegraph as lg
from linegraph.emission.emit import render
from linegraph.readers import modelfile
from linegraph.report import report

if TYPE_CHECKING:
    from pathlib import Path

TEXT = """
name = "ball"
[parameters]
k = 0.02
[inputs]
gust = { unit = "m/s" }
[body.ball]
mass = 0.5
inertia = [0.01, 0.02, 0.03]
frame.tip = { at = [0.1, -0.2, 0.3] }
[free.fly]
between = ["ground", "ball"]
[drag.air]
at = "ball.tip"
coefficient = "k"
wind = ["gust", 0, 0.5]
[drag.still]
at = "ball"
coefficient = 0.01
"""

MASS, INERTIA, TIP = 0.5, np.array([0.01, 0.02, 0.03]), np.array([0.1, -0.2, 0.3])


def ball() -> lg.Model:
    """The model of `TEXT` by the builder."""
    model = lg.Model("ball")
    k = model.parameter("k", 0.02)
    gust = model.input("gust", unit="m/s")
    body = model.body("ball", mass=MASS, inertia=tuple(INERTIA))
    model.free("fly", between=("ground", body))
    model.drag("air", body.frame("tip", at=tuple(TIP)), coefficient=k, wind=(gust, 0, 0.5))
    model.drag("still", body, coefficient=0.01)
    return model


def rotation(quaternion: np.ndarray) -> np.ndarray:
    """From body axes to ground axes, of (x, y, z, w)."""
    x, y, z, w = quaternion
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * skew + 2 * skew @ skew


def by_hand(q: np.ndarray, v: np.ndarray, gust: float) -> np.ndarray:
    """Newton and Euler with both drags, in body axes."""
    R = rotation(q[3:])
    velocity, omega = R @ v[:3], v[3:]
    force, torque = MASS * np.array([0, 0, -9.81]), np.zeros(3)
    for k, at, wind in ((0.02, TIP, [gust, 0, 0.5]), (0.01, np.zeros(3), [0, 0, 0])):
        relative = velocity + R @ np.cross(omega, at) - wind
        drag = -k * np.linalg.norm(relative) * relative
        force, torque = force + drag, torque + np.cross(at, R.T @ drag)
    linear = R.T @ force / MASS - np.cross(omega, v[:3])
    angular = (torque - np.cross(omega, INERTIA * omega)) / INERTIA
    return np.concatenate([linear, angular])


def drawn(seed: int) -> tuple[np.ndarray, np.ndarray, float]:
    """q, v and the gust."""
    rng = np.random.default_rng(seed)
    turn = rng.normal(size=4)
    q = np.concatenate([rng.normal(size=3), turn / np.linalg.norm(turn)])
    return q, 5 * rng.normal(size=6), float(4 * rng.normal())


@pytest.mark.parametrize("seed", range(20))
def test_a_spinning_ball_is_slowed_where_its_tip_meets_the_air(seed: int) -> None:
    q, v, gust = drawn(seed)
    a = lg.derive(ball()).function("forward_dynamics")(q, v, [gust])
    expected = by_hand(q, v, gust)
    assert np.allclose(a, expected, rtol=0, atol=1e-12 * (1 + np.abs(expected).max()))


def test_falling_it_reaches_the_speed_of_the_textbook() -> None:
    """With v1^2 = m g / k, v = v1 tanh(g t / v1): at the speed v1 nothing accelerates."""
    model = lg.Model("stone")
    stone = model.body("stone", mass=2.0)
    model.prismatic("fall", between=("ground", stone), axis=(0, 0, -1), effort=False)
    model.drag("air", stone, coefficient=0.3)
    f = lg.derive(model).function("forward_dynamics")
    final = math.sqrt(2.0 * 9.81 / 0.3)
    for t in (0.0, 0.3, 1.0, 4.0, 40.0):
        v = final * math.tanh(9.81 * t / final)
        assert f([0.0], [v], []) == pytest.approx(
            [9.81 / math.cosh(9.81 * t / final) ** 2], abs=1e-13
        )


def test_inputs_make_it_part_of_the_forces() -> None:
    d = lg.derive(ball())
    q, v, gust = drawn(3)
    driven, still = d.numeric(u=[gust]), d.numeric(u=[0.0])
    assert driven.bias(list(q), list(v)) == still.bias(list(q), list(v))
    assert driven.forces(list(q), list(v)) != still.forces(list(q), list(v))


def test_it_only_takes_energy_from_what_moves_relative_to_the_fluid() -> None:
    d = lg.derive(ball())
    power = d.function("power")
    for seed in range(10):
        q, v, gust = drawn(seed)
        P, sums = power(q, v, [gust])
        of = dict(zip(power.module.POWER_NAMES, np.ravel(P), strict=True))
        assert of["still.translation"] < 0
        assert np.abs(sums).max() < 1e-11 * np.abs(P).max()


def test_at_rest_it_has_no_slope() -> None:
    """d(|u| u)/du is 0 at u = 0: emitted, it is 0 and not 0 over 0."""
    model = lg.Model("ball")
    body = model.body("ball", mass=MASS, inertia=tuple(INERTIA))
    model.free("fly", between=("ground", body))
    model.drag("air", body.frame("tip", at=tuple(TIP)), coefficient=3.0)
    A = lg.derive(model).function("linearize")([0, 0, 0, 0, 0, 0, 1], [0] * 6, [])
    assert np.all(np.isfinite(A))
    assert np.all(np.asarray(A)[6:, 6:] == 0)


def test_file_and_builder_say_the_same() -> None:
    read = modelfile.parse(TEXT.encode(), "ball.toml")
    assert render(read, languages=["c"])["ball.c"] == render(ball(), languages=["c"])["ball.c"]


def test_golden_vectors_hold_in_both_languages(tmp_path: Path) -> None:
    files = render(ball(), tests=True, functions=("linearize", "power", "regressor"))
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    command = ["gcc", "-std=c99", "-O1", "ball_test.c", "ball.c", "-lm", "-o", "held"]
    subprocess.run(command, cwd=tmp_path, check=True)
    subprocess.run(["./held"], cwd=tmp_path, check=True)
    subprocess.run([sys.executable, "test_ball.py"], cwd=tmp_path, check=True)


def test_the_report_writes_its_law() -> None:
    text = report(lg.derive(ball()), level="none")
    root = "√(v_still_x² + v_still_y² + v_still_z²)"
    assert f"f_still = (−0.01·v_still_x·{root}, −0.01·v_still_y·{root}" in text


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("coefficient = 0.01", "wind = [0, 0, 0]"), "coefficient"),
        (('wind = ["gust", 0, 0.5]', "wind = [0, 0]"), "wind"),
        (('at = "ball"\n', 'at = "bal"\n'), "bal"),
        (("coefficient = 0.01", 'coefficient = "c"'), "c"),
    ],
)
def test_mistakes_are_told_with_their_line(change: tuple[str, str], said: str) -> None:
    assert change[0] in TEXT
    with pytest.raises(lg.LinegraphError, match=rf"ball.toml:\d+: \[drag\..*{said}"):
        modelfile.parse(TEXT.replace(*change).encode(), "ball.toml")
