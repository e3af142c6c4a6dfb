"""Reaction directions: their forces and torques are the derivatives of their equations of position."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from support.rigid_motion import TINY, axial, rows, turned

from linegraph.algebra.protocol import Floats
from linegraph.components.constraints.base import Instant, Pose, Prescribed
from linegraph.components.joints import Prismatic, Revolute
from linegraph.components.joints.base import Along, Square, Thread, Unturned, Upright
from linegraph.dynamics.reaction_rows import rows_of, where
from linegraph.kinematics.links import Closure, Seat
from linegraph.spatial.vector import ZERO

GROUND = Seat(-1, ZERO, rows(np.eye(3)))
TAIL = turned((1, 2, -1), 0.8)
PLACE = np.array([0.3, -0.2, 0.5])


def row(restriction: Any, turn: Any, shift: Any, drive: Any = (), joint: Any = None) -> Any:
    """The row where the head is turned and shifted against the tail, in the tail's axes."""
    joint = joint or Revolute("j", ("a", "b"))
    closure = Closure(joint, GROUND, GROUND, drive, () if restriction is None else (restriction,))
    head = Pose(rows(TAIL @ turn), tuple((PLACE + TAIL @ np.array(shift)).tolist()))
    tail = Pose(rows(TAIL), tuple(PLACE.tolist()))
    (found,) = rows_of(closure, Instant(Floats(), float, tail, head, drive))
    return found


def differentiated(restriction: Any, turn: Any, shift: Any, h: float = 1e-6) -> tuple[Any, Any]:
    """What the equation's rate makes of each relative velocity of the head, in ground axes: force, torque."""
    found = []
    for k in range(6):
        move = np.zeros(6)
        move[k] = h
        sides = []
        for sign in (1, -1):
            u, w = sign * move[:3], sign * move[3:]
            # the head's origin moves with u, and the head turns about it with w, both in ground axes
            there = np.array(shift) + TAIL.T @ u
            ahead = TAIL.T @ (turned(w, h) if w.any() and sign > 0 else np.eye(3)) @ TAIL @ turn
            if w.any() and sign < 0:
                ahead = TAIL.T @ turned(-w, -h) @ TAIL @ turn
            sides.append(float(row(restriction, ahead, there).position))
        found.append((sides[0] - sides[1]) / (2 * h))
    return found[:3], found[3:]


OFF = (turned((1, -1, 0.5), 0.6), (0.2, 0.4, -0.1))
ABOUT_Z = (turned((0, 0, 1), 0.6), (0.2, 0.4, -0.1))
COINCIDENT = (np.eye(3), (0.2, 0.4, -0.1))
SINE = math.sin(1.1)

CASES = {
    "along": (Along((0.6, 0, 0.8)), *OFF),
    "square": (Square((1, 0, 0), (0, 1, 0), 0.0, 1.0), *OFF),
    "at an angle": (Square((1, 0, 0), (0, 0.6, 0.8), math.cos(1.1), SINE), *OFF),
    "upright x": (Upright(0), *ABOUT_Z),
    "upright y": (Upright(1), *ABOUT_Z),
    "unturned x": (Unturned(0), *COINCIDENT),
    "unturned y": (Unturned(1), *COINCIDENT),
    "unturned z": (Unturned(2), *COINCIDENT),
    "thread": (Thread(0.05), *ABOUT_Z),
}


@pytest.mark.parametrize("name", CASES)
def test_force_and_torque_are_what_the_equations_rate_makes_of_the_motion(name: str) -> None:
    """Torques of upright and unturned ones where these hold: elsewhere they say which way to turn back."""
    found = row(*CASES[name])
    force, torque = differentiated(*CASES[name])
    np.testing.assert_allclose(found.force, force, atol=1e-9)
    np.testing.assert_allclose(found.torque, torque, atol=1e-9)
    assert found.rate == 0


def test_a_force_along_a_direction_measures_the_shift_there() -> None:
    assert row(Along((0.6, 0, 0.8)), *OFF).position == pytest.approx(0.6 * 0.2 - 0.8 * 0.1)


def test_directions_at_an_angle_are_compared_with_its_cosine() -> None:
    restriction = Square((1, 0, 0), (1, 0, 0), math.cos(1.1), SINE)
    found = row(restriction, turned((0, 0, 1), 0.4), ZERO)
    assert found.position == pytest.approx((math.cos(0.4) - math.cos(1.1)) / SINE)
    assert row(restriction, turned((0, 0, 1), 1.1), ZERO).position == pytest.approx(0, abs=1e-15)


@pytest.mark.parametrize("lean", [0.1, 2.0, 3.1])
def test_a_lean_about_x_counts_by_twice_the_tangent_of_its_half(lean: float) -> None:
    turn = turned((1, 0, 0), lean) @ turned((0, 0, 1), 0.9)
    assert row(Upright(0), turn, ZERO).position == pytest.approx(2 * math.tan(lean / 2))
    assert row(Upright(1), turn, ZERO).position == pytest.approx(0, abs=1e-12)
    turn = turned((0, 1, 0), lean)
    assert row(Upright(1), turn, ZERO).position == pytest.approx(2 * math.tan(lean / 2))


@pytest.mark.parametrize("angle", [0.1, -2.0, 3.1])
def test_no_turn_is_measured_along_the_axis_of_the_one_turn(angle: float) -> None:
    axis = np.array([2, -1, 2]) / 3
    for k in range(3):
        found = row(Unturned(k), turned(axis, angle), ZERO)
        assert found.position == pytest.approx(2 * math.tan(angle / 2) * axis[k])


def test_a_thread_may_have_made_full_turns() -> None:
    turn = turned((0, 0, 1), 0.6)
    for turns in (0, 1, -3):
        shift = 0.05 * (0.6 + 2 * math.pi * turns)
        assert row(Thread(0.05), turn, (0, 0, shift)).position == pytest.approx(0, abs=1e-15)
    assert row(Thread(0.05), turn, (0, 0, 0.05 * 0.9)).position == pytest.approx(0.05 * 0.3)


def test_a_driven_chord_has_a_row_that_does_not_count_full_turns() -> None:
    turn = turned((0, 0, 1), 0.6)
    given = Prescribed(0.4 + 2 * math.pi, -1.5)
    found = row(None, turn, ZERO, (given,))
    assert found.position == pytest.approx(0.2)
    assert found.rate == -1.5
    np.testing.assert_allclose(found.torque, TAIL[:, 2], atol=1e-15)
    assert found.force == pytest.approx((0, 0, 0))
    slide = Prismatic("s", ("a", "b"))
    found = row(None, np.eye(3), (0, 0, 9.0), (Prescribed(2.0, 0.3),), slide)
    assert found.position == pytest.approx(7.0)
    np.testing.assert_allclose(found.force, TAIL[:, 2], atol=1e-15)


def test_a_direction_is_told_in_the_axes_of_the_tails_frame() -> None:
    hinge = Revolute("j", ("a", "b"), axis=(1, 0, 0))
    # z onto x is a quarter turn about y: the joint's x is -z of the frame
    assert where(Along((1, 0, 0)), hinge) == " along (0, 0, -1) of its tail frame"
    assert where(Upright(1), hinge) == " along (0, 1, 0) of its tail frame"
    assert where(Thread(0.1), hinge) == " along its thread"
    assert where(Square((1, 0, 0), (0, 1, 0), 0, 1), hinge).endswith("normal of its axes")


def test_turned_heads_are_turned_as_meant() -> None:
    """The differences above turn the head about ground's axes."""
    w = np.array([0.0, 1.0, 0.0])
    ahead = turned(w, 1j * TINY) @ TAIL
    np.testing.assert_allclose(axial(ahead.imag / TINY @ TAIL.T), w, atol=1e-15)
