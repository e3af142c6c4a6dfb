"""Plane mechanisms of one freedom, on a pendulum and a sliding block."""

from __future__ import annotations

import math

import pytest
from mpmath import mp
from oracles.one_freedom import Body, Pin, acceleration, course, moving, reactions

MASS, LENGTH, INERTIA, GRAVITY = 2.0, 0.7, 0.3, 9.81

PENDULUM = Body(MASS, INERTIA, lambda s: (LENGTH * mp.sin(s), -LENGTH * mp.cos(s), s))
"""It hangs below the origin for s = 0."""


def test_a_course_has_the_derivatives_of_its_function() -> None:
    found = course(lambda s: mp.sin(2 * s), 0.4)
    assert found == pytest.approx((math.sin(0.8), 2 * math.cos(0.8), -4 * math.sin(0.8)))
    assert found.rate(3.0) == pytest.approx(6 * math.cos(0.8))
    assert found.acceleration(3.0, 5.0) == pytest.approx(
        -36 * math.sin(0.8) + 10 * math.cos(0.8), rel=1e-14
    )


def test_a_pendulum_swings_as_its_equation_says() -> None:
    s, torque = 0.8, 1.5
    expected = (torque - MASS * GRAVITY * LENGTH * math.sin(s)) / (INERTIA + MASS * LENGTH**2)
    found = acceleration([PENDULUM], s, 3.0, GRAVITY, torque)
    assert found == pytest.approx(expected, rel=1e-14)


def test_a_block_on_a_parabola_feels_the_curvature() -> None:
    """Y = x^2 / 2: (1 + x^2) x'' + x x'^2 + g x = 0."""
    block = Body(MASS, INERTIA, lambda s: (s, s**2 / 2, 0 * s))
    x, w = 0.6, 2.0
    expected = -(x * w * w + GRAVITY * x) / (1 + x * x)
    assert acceleration([block], x, w, GRAVITY, 0.0) == pytest.approx(expected, rel=1e-14)


def test_the_pin_of_a_hanging_pendulum_carries_weight_and_pull() -> None:
    """Upward m (g + l w^2), and no torque about the pin."""
    w = 3.0
    a = acceleration([PENDULUM], 0.0, w, GRAVITY, 0.0)
    body = moving(PENDULUM, 0.0, w, a, (0.0, -MASS * GRAVITY, 0.0))
    found = reactions({"rod": body}, {"pin": Pin(None, "rod", (0.0, 0.0), (0, 1, 2))})["pin"]
    assert found == pytest.approx([0.0, MASS * (GRAVITY + LENGTH * w * w), 0.0], abs=1e-12)


def test_what_a_pin_exerts_on_its_tail_is_turned_round() -> None:
    """Two blocks at rest hang below each other: the upper pin carries both."""
    upper = Body(1.0, 0.1, lambda s: (0 * s, -1 + 0 * s, 0 * s))
    lower = Body(3.0, 0.1, lambda s: (0 * s, -2 + 0 * s, 0 * s))
    bodies = {
        name: moving(body, 0.0, 0.0, 0.0, (0.0, -body.mass * GRAVITY, 0.0))
        for name, body in (("upper", upper), ("lower", lower))
    }
    every = (0, 1, 2)
    pins = {
        "top": Pin(None, "upper", (0.0, -0.5), every),
        "middle": Pin("upper", "lower", (0.0, -1.5), every),
    }
    found = reactions(bodies, pins)
    assert found["middle"] == pytest.approx([0, 3.0 * GRAVITY, 0], abs=1e-12)
    assert found["top"] == pytest.approx([0, 4.0 * GRAVITY, 0], abs=1e-12)
