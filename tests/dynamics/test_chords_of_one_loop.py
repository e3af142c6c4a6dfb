"""The rows that chords add, beside plane geometry differentiated by complex steps."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.chains import walked
from support.linkages import (
    BASE,
    COUPLER,
    CRANK,
    ROCKER,
    closed,
    four_bar,
    gap,
)
from support.rigid_motion import STEP, TINY

import linegraph as lg
from linegraph.dynamics.chords import Chords, equations
from linegraph.dynamics.circuit_lengths import of_rows, pure, sizes
from linegraph.kinematics.tree_state import TreeState

Q = np.array([0.7, -0.4, 1.1])  # the loop stands open: rows are right there, too
V = np.array([0.9, -1.3, 0.6])


def chords(model: lg.Model, q: Any, v: Any, **arguments: Any) -> Chords:
    return Chords(TreeState(walked(model, **arguments), q, v))


def test_a_hinge_that_closes_a_loop_has_three_forces_and_two_torques() -> None:
    found = equations(walked(four_bar()))
    assert [e.multiplier.name for e in found] == ["c_f1", "c_f2", "c_f3", "c_t1", "c_t2"]
    assert [e.multiplier.unit for e in found] == ["N"] * 3 + ["N*m"] * 2
    assert [(e.component, e.place, e.holonomic) for e in found] == [
        ("c", k, True) for k in range(5)
    ]


def test_positions_are_the_gap_in_the_axes_of_the_tail() -> None:
    found = chords(four_bar(), Q, V).position()
    np.testing.assert_allclose(found, [*gap(Q), 0, 0, 0], atol=1e-15)


def test_j_is_the_derivative_of_the_gap_and_gamma_of_its_rate() -> None:
    found = chords(four_bar(), Q, V)
    J = [gap(Q + 1j * TINY * e).imag / TINY for e in np.eye(3)]
    np.testing.assert_allclose(found.jacobian()[:2], np.array(J).T, atol=1e-15)
    np.testing.assert_allclose(found.jacobian()[2:], 0, atol=0)
    np.testing.assert_allclose(found.rates()[:2], gap(Q + 1j * TINY * V).imag / TINY, atol=1e-15)

    def rate(t: float) -> Any:
        return gap(Q + (t + 1j * TINY) * V).imag / TINY

    # J v̇ = γ: with v̇ = 0 the rate changes by -γ
    change = (rate(STEP) - rate(-STEP)) / (2 * STEP)
    np.testing.assert_allclose(found.bias()[:2], -change, atol=1e-9)
    np.testing.assert_allclose(found.bias()[2:], 0, atol=1e-15)


@pytest.mark.parametrize("sign", [1, -1])
def test_where_the_law_of_cosines_closes_the_loop_nothing_remains(sign: int) -> None:
    q = closed(0.7, sign)
    found = chords(four_bar(), q, V)
    np.testing.assert_allclose(found.position(), 0, atol=4e-16)
    rotation, displacement = found.seen("c")
    np.testing.assert_allclose(displacement, 0, atol=4e-16)
    (angle,) = found.coordinates(found.state.tree.closures[0])[0]
    assert angle == pytest.approx(q[2] - q[0] - q[1], abs=1e-15)
    assert rotation[1][0] == pytest.approx(np.sin(angle), abs=1e-15)


def test_the_chords_own_angle_and_rate_are_what_laws_may_name() -> None:
    found = chords(four_bar(), Q, V)
    (closure,) = found.state.tree.closures
    named = found.named(closure)
    assert set(named) == {"c", "der(c)"}
    assert named["c"] == pytest.approx(Q[2] - Q[0] - Q[1], abs=1e-15)
    assert named["der(c)"] == pytest.approx(V[2] - V[0] - V[1], abs=1e-15)


def test_an_effort_in_the_chord_acts_along_what_its_angle_depends_on() -> None:
    found = chords(four_bar(), Q, V)
    (closure,) = found.state.tree.closures
    force = np.zeros(3)
    for freedom, entry in found.along(found.effort(closure, [2.5])):
        force[freedom.index] += entry
    np.testing.assert_allclose(force, [-2.5, -2.5, 2.5], atol=1e-15)


def strut(length: Any) -> lg.Model:
    """A door hinged at the origin with a rod from its edge at 0.5 m to an eye on ground."""
    model = lg.Model("strut")
    door = model.body("door", mass=1.0, inertia=(1, 1, 1))
    model.revolute("hinge", between=("ground", door))
    eye = model.ground.frame("eye", at=(0.2, -0.7, 0.3))
    model.rod("rod", between=(eye, door.frame("edge", at=(0.5, 0, 0))), length=length)
    return model


def distance(q: Any) -> Any:
    x, y, z = 0.5 * np.cos(q) - 0.2, 0.5 * np.sin(q) + 0.7, -0.3
    return np.sqrt(x * x + y * y + z * z)


def test_a_rod_with_a_stroke_has_what_its_length_prescribes() -> None:
    q, v, t = 0.4, 1.3, 0.5
    found = chords(strut("0.6 + 0.1*t**2"), [q], [v], t=t)
    slope = distance(q + 1j * TINY).imag / TINY
    assert found.position() == [pytest.approx(distance(q) - 0.6 - 0.1 * t**2, abs=1e-15)]
    assert found.jacobian() == [[pytest.approx(slope, abs=1e-15)]]
    assert found.rates() == [pytest.approx(slope * v - 0.2 * t, abs=1e-15)]

    def gap_rate(at: float) -> float:
        return distance(q + v * at + 1j * TINY * v).imag / TINY - 0.2 * (t + at)

    change = (gap_rate(STEP) - gap_rate(-STEP)) / (2 * STEP)
    assert found.bias() == [pytest.approx(-change, abs=1e-9)]


def measured(model: lg.Model) -> Any:
    return sizes(walked(model))


def test_the_length_of_a_circuit_is_the_sum_of_its_arms() -> None:
    found = measured(four_bar())
    total = CRANK + COUPLER + ROCKER + BASE
    assert found.constraints == [pytest.approx(total)] * 3 + [1, 1]
    assert found.velocities == [1, 1, 1]


def test_a_rod_adds_its_own_length_to_its_circuit() -> None:
    # 0.5 on the door; the eye at (0.2, 0.7, 0.3) from the hinge, each component by itself; 0.6 of the rod
    assert measured(strut(0.6)).constraints == [pytest.approx(0.5 + 1.2 + 0.6)]


def two_doors(shared: bool) -> lg.Model:
    """Two doors with a stay each, of 2 m and 20 m of circuit; on one slide, or each on ground."""
    model = lg.Model("doors")
    car = model.body("car", mass=1.0, inertia=(1, 1, 1))
    model.prismatic("slide", between=("ground", car), axis=(1, 0, 0))
    for k, size in enumerate((0.5, 5.0)):
        on = car if shared else model.ground
        door = model.body(f"door{k}", mass=1.0, inertia=(1, 1, 1))
        model.revolute(f"hinge{k}", between=(on, door))
        eye = model.ground.frame(f"eye{k}", at=(size, 0, 0))
        edge = door.frame("edge", at=(0, size, 0))
        model.rod(f"rod{k}", between=(eye, edge), length=2 * size)
    return model


def test_loops_that_share_a_velocity_share_the_greatest_length() -> None:
    apart, together = measured(two_doors(False)), measured(two_doors(True))
    assert apart.constraints == [pytest.approx(2.0), pytest.approx(20.0)]
    assert together.constraints == [pytest.approx(20.0)] * 2
    # the slide is measured by its loops' length where it lies in them, else by what masses reach: sqrt(3)
    assert together.velocities == [pytest.approx(20.0), 1, 1]
    assert apart.velocities == [pytest.approx(np.sqrt(3)), 1, 1]


def test_joints_in_one_place_are_measured_by_how_far_the_masses_reach() -> None:
    model = lg.Model("wrist")
    parts = [model.body(f"b{k}", mass=4.0, mass_center=(0.3, 0, 0)) for k in range(2)]
    model.revolute("first", between=("ground", parts[0]), axis=(1, 0, 0))
    model.revolute("second", between=(parts[0], parts[1]), axis=(0, 1, 0))
    model.revolute("third", between=(parts[1], "ground"), axis=(0, 0, 1))
    found = measured(model)
    # 0.3 to the mass, and sqrt((Jx + Jy + Jz) / m) = sqrt(2) 0.3 of its spread about the joint
    assert found.constraints[:3] == [pytest.approx(0.3 + np.sqrt(2) * 0.3)] * 3


def test_rows_in_pure_numbers_have_entries_of_size_one_at_most() -> None:
    found = measured(four_bar())
    J = np.array(chords(four_bar(), Q, V).jacobian())
    clean = pure(J, found)
    total = CRANK + COUPLER + ROCKER + BASE
    np.testing.assert_allclose(clean[:2], J[:2] / total, atol=1e-16)
    assert np.abs(clean).max() < 1
    # without a size, as of relations, a row is divided by its own greatest entry; of zeros by 1
    unknown = found._replace(constraints=[0, 0, 0, 0, 0], velocities=[1, 2, 1])
    rows = np.array([[1.0, -4.0, 2.0], [0, 0, 0], [3, 0, 0], [0, 0, 5], [0, 1, 0]])
    np.testing.assert_array_equal(of_rows(rows, unknown), [8, 1, 3, 5, 2])
