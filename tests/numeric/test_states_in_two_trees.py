"""One state in two trees, and the numeric reference of a single pendulum."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.chains import LIMB, LIMB_STATE, PLANE, modelled, poses
from support.linkages import closed, four_bar, gap
from support.rigid_motion import TINY, axial, moving, of_quaternion, rows, turned

import linegraph as lg
from linegraph.algebra.protocol import Floats
from linegraph.components.joints import Cylindrical, Free, Spherical
from linegraph.numeric.between_trees import body_frames, coordinates_at, quaternion_of, transfer
from linegraph.numeric.derived import Derived
from linegraph.pipeline import derived

if TYPE_CHECKING:
    from linegraph.numeric.reference import Numeric


def numeric(model: lg.Model) -> Numeric:
    return derived(model, Derived).numeric()


@pytest.mark.parametrize("seed", range(8))
def test_quaternions_of_rotations_turn_as_these_do(seed: int) -> None:
    q = np.random.default_rng(seed).normal(size=4)
    # near half a turn, where w is small, another entry is the largest
    q[3] *= 1 if seed < 4 else 1e-3
    q /= np.linalg.norm(q) * (1 if q[3] >= 0 else -1)
    np.testing.assert_allclose(quaternion_of(rows(of_quaternion(q))), q, atol=1e-15)


def test_half_turns_have_quaternions_with_w_zero() -> None:
    for axis in np.eye(3):
        half = rows(2 * np.outer(axis, axis) - np.eye(3))
        assert np.abs(quaternion_of(half)).tolist() == [*axis, 0]


def test_body_frames_are_those_of_the_bodies_not_of_joints() -> None:
    q, v = LIMB_STATE
    found = body_frames(numeric(modelled(LIMB)), q, v)
    assert np.array(found["ground"].rotation).tolist() == np.eye(3).tolist()
    for k in range(5):
        expected = moving(lambda t, k=k: poses(LIMB, q + v * t)[k])  # type: ignore[misc]
        for mine, other in zip(found[f"b{k}"][:4], expected[:4], strict=True):
            np.testing.assert_allclose(mine, other, atol=4e-15)


def test_joint_angles_become_places_of_mass_centres_and_back() -> None:
    q, v = LIMB_STATE
    joints = numeric(modelled(LIMB))
    absolute = modelled(LIMB)
    absolute.formulation(coordinates="absolute")
    whole = numeric(absolute)
    p, u = transfer(joints, q, v, whole)
    for k, part in enumerate(LIMB):
        center = [*part.center, 1]
        at = poses(LIMB, q)[k]
        np.testing.assert_allclose(p[7 * k : 7 * k + 3], (at @ center)[:3], atol=4e-15)
        turn = of_quaternion(np.array(p[7 * k + 3 : 7 * k + 7]))
        np.testing.assert_allclose(turn, at[:3, :3], atol=4e-15)
        # a free body's velocities are those of its mass centre and its angular ones, in its own axes
        ahead = poses(LIMB, q + 1j * TINY * v)[k]
        w = axial(at[:3, :3].T @ ahead[:3, :3].imag / TINY)
        rate = at[:3, :3].T @ (ahead @ center)[:3].imag / TINY
        np.testing.assert_allclose(u[6 * k : 6 * k + 6], [*rate, *w], atol=1e-14)
    back = transfer(whole, p, u, joints)
    np.testing.assert_allclose(back[0], q, atol=1e-14)
    np.testing.assert_allclose(back[1], v, atol=1e-13)


def test_angles_from_ground_are_sums_of_joint_angles() -> None:
    model = modelled(PLANE)
    joints = numeric(model)
    model.formulation(coordinates="absolute-angle")
    ground = numeric(model)
    own, rates = [0.3, -0.5, 0.9], [1.0, -2.0, 0.5]
    q, v = transfer(joints, own, rates, ground)
    np.testing.assert_allclose(q, np.cumsum(own), atol=1e-15)
    np.testing.assert_allclose(v, np.cumsum(rates), atol=1e-15)
    back = transfer(ground, q, v, joints)
    np.testing.assert_allclose(back, [own, rates], atol=1e-15)


def test_a_loop_cut_elsewhere_has_the_other_pins_angle_and_keeps_full_turns() -> None:
    a, b, d = closed(0.7)
    model = four_bar()
    first = numeric(model)
    model.formulation(tree=("a", "b", "c"))
    second = numeric(model)
    q, _ = transfer(first, [a + 2 * math.pi, b, d], [0.0] * 3, second)
    # a is in both trees and keeps its full turn; c is the rocker's direction less the coupler's
    names = [x.name for x in second.tree.positions]
    found = dict(zip(names, q, strict=True))
    assert found["a"] == a + 2 * math.pi
    assert found["b"] == b
    assert math.cos(found["c"] - (d - a - b)) == pytest.approx(1, abs=1e-14)
    assert abs(found["c"]) <= math.pi


def test_coordinates_are_measured_of_a_relative_place() -> None:
    turn = rows(turned((0, 0, 1), 0.6))
    assert coordinates_at(Floats(), Cylindrical("j", ("a", "b")), turn, (0, 0, 0.3)) == [
        pytest.approx(0.6),
        0.3,
    ]
    q = [0, 0, math.sin(0.3), math.cos(0.3)]
    assert coordinates_at(Floats(), Spherical("j", ("a", "b")), turn, (0, 0, 0)) == pytest.approx(q)
    found = coordinates_at(Floats(), Free("j", ("a", "b")), turn, (1, 2, 3))
    assert found == pytest.approx([1, 2, 3, *q])


# the reference


def pendulum() -> lg.Model:
    model = lg.Model("pendulum", gravity=(0, -10, 0))
    mass, length = model.parameter("m", 2.0), model.parameter("l", 0.5)
    bob = model.body("bob", mass=mass, mass_center=(0, -length, 0))
    model.revolute("hinge", between=("ground", bob))
    return model


def test_a_point_on_a_thread_has_the_pendulums_equation_and_energy() -> None:
    found = numeric(pendulum())
    assert found.mass_matrix([0.3]) == [[pytest.approx(2 * 0.25)]]
    assert found.bias([0.3], [4.0]) == [pytest.approx(2 * 10 * 0.5 * math.sin(0.3))]
    assert found.inverse_dynamics([0.3], [4.0], [3.0]) == [pytest.approx(1.5 + 10 * math.sin(0.3))]
    kinetic, potential = found.energy([0.3], [4.0])
    assert kinetic == pytest.approx(2 * (0.5 * 4) ** 2 / 2)
    assert potential == pytest.approx(-2 * 10 * 0.5 * math.cos(0.3))
    assert found.coordinate_rates([0.3], [4.0]) == [4.0]
    assert found.exchange([0.3], [4.0]) is None


def test_other_values_take_the_place_of_the_models_own() -> None:
    d = derived(pendulum(), Derived)
    assert d.numeric({"l": 2.0}).mass_matrix([0.0]) == [[pytest.approx(8.0)]]
    assert d.numeric({"m": 1.0, "l": 1.0}).resolve("m + 2*l") == 3.0


def test_a_value_that_is_missing_and_inputs_too_few_are_refused() -> None:
    model = pendulum()
    model.parameter("unknown")
    d = derived(model, Derived)
    with pytest.raises(lg.ModelError, match="has no value") as told:
        d.numeric()
    assert told.value.thing == 'parameter "unknown"'
    assert d.numeric({"unknown": 1.0}).t == 0.0
    with pytest.raises(lg.ModelError, match="1 inputs are needed, got 2"):
        derived(pendulum(), Derived).numeric(u=[1.0, 2.0])


def test_what_divides_by_a_singular_mass_matrix_is_refused_and_else_let_pass() -> None:
    derived(pendulum(), Derived).require_inverse("rhs")
    model = pendulum()
    model.revolute("loose", between=("bob", model.body("nothing")))
    with pytest.raises(lg.ModelError, match="moves no inertia of its own") as told:
        derived(model, Derived).require_inverse("rhs")
    assert told.value.thing == 'joint "loose"'
    assert "rhs divides by it" in told.value.problem


def test_at_another_time_what_is_prescribed_has_moved_on() -> None:
    model = four_bar()
    flag = model.body("flag", mass=1.0, inertia=(1, 1, 1))
    model.revolute("driven", between=("ground", flag), motion="3*t")
    found = derived(model, Derived).numeric(t=1.0)
    assert found.tree.layout.drives["driven"][0].x == 3.0
    later = found.at_time(2.0)
    assert (later.t, later.tree.layout.drives["driven"][0].x) == (2.0, 6.0)


def test_constraints_over_floats_are_those_of_the_gap() -> None:
    found = numeric(four_bar())
    q, v = np.array([0.7, -0.4, 1.1]), np.array([0.9, -1.3, 0.6])
    np.testing.assert_allclose(found.constraints(q)[:2], gap(q), atol=1e-15)
    J: Any = np.array(found.constraint_jacobian(q))
    np.testing.assert_allclose(J[:2] @ v, gap(q + 1j * TINY * v).imag / TINY, atol=1e-15)
    np.testing.assert_allclose(found.constraint_rates(q, v), J @ v, atol=1e-15)
