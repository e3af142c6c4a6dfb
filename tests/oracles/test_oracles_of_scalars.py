"""The scalars of the oracles: dual numbers, lanes with complex steps, mimic joints as a file says them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from oracles.mixed_reference import FUNCTIONS as OF_LANES
from oracles.mixed_reference import STEP, Lane, Lanes, lanes, rate
from oracles.mixed_tableau import FUNCTIONS, Dual

X = 0.7
ARITHMETIC = {
    "polynomial": (lambda x: 3 * x**3 - x + 2, 9 * X**2 - 1),
    "quotient": (lambda x: (1 - x) / (2 + x), -3 / (2 + X) ** 2),
    "reciprocal": (lambda x: 5 / x, -5 / X**2),
    "difference": (lambda x: 4 - x * x, -2 * X),
}


@pytest.mark.parametrize("name", ARITHMETIC)
def test_dual_numbers_have_slopes(name: str) -> None:
    function, slope = ARITHMETIC[name]
    found = function(Dual(X, 1.0))
    assert found.a == pytest.approx(function(X), rel=1e-15)
    assert found.b == pytest.approx(slope, rel=1e-14)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_of_dual_numbers_have_slopes(name: str) -> None:
    found = FUNCTIONS[name](Dual(X, 1.0))
    around = [FUNCTIONS[name](X + h) for h in (-1e-5, 1e-5)]
    assert found.a == FUNCTIONS[name](X)
    assert found.b == pytest.approx((around[1] - around[0]) / 2e-5, rel=1e-9)


SMOOTH = [name for name in OF_LANES if name not in ("abs", "sign", "min", "max", "atan2")]


@pytest.mark.parametrize("name", SMOOTH)
def test_a_complex_step_in_a_lane_is_a_derivative(name: str) -> None:
    found = Lanes().function(name, Lane(np.array([X, 0.2]) + 1j * STEP))
    around = [OF_LANES[name](np.array([X, 0.2]) + h) for h in (-1e-5, 1e-5)]
    assert rate(found.x) == pytest.approx((around[1] - around[0]) / 2e-5, rel=1e-8)


def test_an_angle_of_lanes_turns_with_both_coordinates() -> None:
    """D atan2(y, x) = (x dy - y dx) / (x^2 + y^2)."""
    y, x = np.array([0.3, -0.4]), np.array([-0.2, -0.9])
    found = Lanes().function("atan2", Lane(y + 2j * STEP), Lane(x + 1j * STEP)).x
    assert found.real == pytest.approx([math.atan2(*pair) for pair in zip(y, x, strict=True)])
    assert rate(found) == pytest.approx((2 * x - y) / (x * x + y * y), rel=1e-14)


def test_lanes_calculate_with_numbers_on_either_side() -> None:
    a, b = lanes(np.array([[1.0, 2.0], [3.0, 5.0]]))
    assert (2 * a - b / 4 + (1 - a) * (6 / b) - 0.5).x.tolist() == [
        2 * 1 - 2 / 4 + 0 - 0.5,
        2 * 3 - 5 / 4 + (1 - 3) * (6 / 5) - 0.5,
    ]


def test_mimic_joints_are_read_with_their_defaults() -> None:
    peers = pytest.importorskip("oracles.pinocchio_models")
    text = """<robot name="r"><joint name="a"/><joint name="b"><mimic joint="a"/></joint>
        <joint name="c"><mimic joint="a" multiplier="-2" offset="0.5"/></joint></robot>"""
    assert peers.followers(text) == {
        "b": peers.Follower("a", 1.0, 0.0),
        "c": peers.Follower("a", -2.0, 0.5),
    }
