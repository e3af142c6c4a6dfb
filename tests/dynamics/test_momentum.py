"""Centre of mass and momentum: sums over single bodies, and what free flight keeps."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from oracles import newton_euler as oracle
from support.chains import LIMB, LIMB_STATE, PLANE, Part, jacobian, modelled, poses, walked
from support.drawn_trees import KINDS, drawn
from support.near import near
from support.rigid_motion import STEP

import linegraph as lg
from linegraph.dynamics.momentum import (
    center,
    center_columns,
    center_velocity,
    momenta,
    momentum_columns,
    momentum_rate,
    scaled,
    shared,
)
from linegraph.kinematics.tree_state import TreeState
from linegraph.kinematics.twists import Column, Outlook, matrix, total
from linegraph.spatial.vector import ZERO

MIXED = (
    *PLANE[:2],
    Part("prismatic", (1, 2, 0), near=((0.4, 0.1, 0), (0, 0, 1), 0.0), parent=1, mass=0.5),
)
"""Two hinges about z, whose angles may be taken against ground, and a slide on the last link."""

CASES: dict[str, tuple[tuple[Part, ...], Any, Any, Any, str]] = {
    "joint": (LIMB, *LIMB_STATE, np.eye(7), "joint"),
    "level": (
        PLANE,
        np.array([0.4, -0.7, 1.2]),
        np.array([0.9, 0.5, -1.4]),
        np.array([[1, 0, 0], [-1, 1, 0], [0, -1, 1]]),
        "absolute-angle",
    ),
    "mixed": (
        MIXED,
        np.array([0.4, -0.7, 1.2]),
        np.array([0.9, 0.5, -1.4]),
        np.array([[1, 0, 0], [-1, 1, 0], [0, 0, 1]]),
        "absolute-angle",
    ),
}
"""Bodies, a state, the joints' own coordinates by those of the state, and what these are called."""


def outlook(model: lg.Model, q: Any, v: Any, **known: Any) -> Outlook:
    return Outlook(TreeState(walked(model, **known), q, v))


def case(name: str, shift: float = 0.0) -> tuple[Outlook, Outlook, Any]:
    """The links of a case, the same in shares of the mass, and the state; after some time at this rate."""
    parts, q, v, _, coordinates = CASES[name]
    model = modelled(parts)
    model.formulation(coordinates=coordinates)
    view = outlook(model, q + shift * v, v)
    mass = sum(part.mass for part in parts)
    shares = Outlook(TreeState(shared(view.tree, mass), q + shift * v, v))
    return view, shares, mass


def by_bodies(name: str) -> tuple[Any, Any]:
    """The centre of mass, and the matrix of momentum about it: each body's own, added."""
    parts, q, _, turns, _ = CASES[name]
    at = poses(parts, turns @ q)
    places = [(pose @ [*part.center, 1])[:3] for pose, part in zip(at, parts, strict=True)]
    c = np.average(places, axis=0, weights=[part.mass for part in parts])
    found = np.zeros((6, len(q)))
    for k, (part, place) in enumerate(zip(parts, places, strict=True)):
        J, R = jacobian(parts, turns @ q, k, part.center) @ turns, at[k][:3, :3]
        found[:3] += part.mass * J[:3]
        found[3:] += np.cross(place - c, part.mass * J[:3], axisb=0, axisc=0)
        found[3:] += R @ np.diag(part.inertia) @ R.T @ J[3:]
    return c, found


@pytest.mark.parametrize("name", CASES)
def test_the_centre_of_mass_is_the_mean_of_the_bodies(name: str) -> None:
    view, shares, mass = case(name)
    c, _ = by_bodies(name)
    near(np.array(center(view, ZERO)) / mass, c)
    near(center(shares, ZERO), c)
    at_rest = (0.3, -0.1, 0.2)
    near(np.subtract(center(view, at_rest), center(view, ZERO)), at_rest)


@pytest.mark.parametrize("name", CASES)
def test_its_velocity_is_the_momentum_by_the_mass(name: str) -> None:
    view, shares, mass = case(name)
    v = CASES[name][2]
    _, A = by_bodies(name)
    near(center_velocity(shares), A[:3] @ v / mass)
    near(matrix(center_columns(shares), len(v))[:3], A[:3] / mass)
    near(matrix(center_columns(view), len(v))[:3], A[:3])
    assert not np.any(matrix(center_columns(view), len(v))[3:])
    near(total(center_columns(shares))[0], A[:3] @ v / mass)


@pytest.mark.parametrize("name", CASES)
def test_momentum_is_that_of_the_bodies_both_ways(name: str) -> None:
    view, _, _ = case(name)
    v = CASES[name][2]
    c, A = by_bodies(name)
    near(matrix(momentum_columns(view, tuple(c)), len(v)), A)
    by_columns, by_links = momenta(view, tuple(c))
    near(np.concatenate(by_columns), A @ v)
    near(np.concatenate(by_links), A @ v)


@pytest.mark.parametrize("name", CASES)
def test_its_rate_without_accelerations_is_that_along_the_motion(name: str) -> None:
    def momentum(t: float) -> Any:
        view, _, mass = case(name, t)
        c = np.array(center(view, ZERO)) / mass
        return np.concatenate(momenta(view, tuple(c))[1])

    view, _, _ = case(name)
    rate = (momentum(STEP) - momentum(-STEP)) / (2 * STEP)
    near(np.concatenate(momentum_rate(view, tuple(by_bodies(name)[0]))), rate, 1e-9)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("kinds", KINDS)
def test_momentum_changes_by_what_ground_and_weight_exert(kinds: str, seed: int) -> None:
    """A v' + A'v is the weight and the reactions of all joints on ground, with their moments about c."""
    here = drawn(seed, kinds)
    spec, q, v, a = here.spec, here.q, here.v, here.a
    view = Outlook(here.over_floats())
    mass = sum(body.mass for body in spec.bodies)
    c = np.array(center(view, ZERO)) / mass
    A = np.array(matrix(momentum_columns(view, tuple(c)), spec.nv), float)
    found = A @ a + np.concatenate(momentum_rate(view, tuple(c)))
    expected = np.concatenate([mass * spec.gravity, np.zeros(3)])
    motions = oracle.body_motions(spec, q, v)
    exerted = oracle.reactions(spec, q, v, a)
    for joint in spec.joints:
        if "ground" not in (joint.tail, joint.head):
            continue
        head = oracle.carried(motions[joint.head], v, joint.head_at, joint.head_rotation)
        force, torque = exerted[joint.name] @ head.rotation.T
        sign = -1 if joint.head == "ground" else 1
        expected += sign * np.concatenate([force, torque + np.cross(head.origin - c, force)])
    near(found, expected, 1e-12)


def test_free_flight_keeps_the_angular_momentum() -> None:
    """Two bodies with a slide between them: the weight is the only force."""
    model = lg.Model("flight", gravity=(0, 0, -9.81))
    hub = model.body("hub", mass=2.0, mass_center=(0.1, 0, 0), inertia=(0.2, 0.3, 0.4))
    tip = model.body("tip", mass=0.5, inertia=(0.01, 0.02, 0.02))
    model.free("pose", between=("ground", hub))
    model.prismatic("boom", between=(hub, tip), axis=(0, 1, 1))
    q = [0.3, -0.2, 0.1, 0.5, -0.5, 0.5, 0.5, 0.7]
    v = [0.4, 0.1, -0.6, 1.2, 0.3, -0.9, 0.8]
    numeric = lg.derive(model).numeric()
    a = np.linalg.solve(numeric.mass_matrix(q), -np.array(numeric.bias(q, v)))
    view = outlook(model, q, v)
    c = np.array(center(view, ZERO)) / 2.5
    A = np.array(matrix(momentum_columns(view, tuple(c)), 7), float)
    rate = A @ a + np.concatenate(momentum_rate(view, tuple(c)))
    near(rate, [0, 0, -9.81 * 2.5, 0, 0, 0])


def test_prescribed_motion_has_a_column_that_no_velocity_is_at() -> None:
    """A turntable at a given rate with a slide on it: momentum m (r', r w), about its own centre none."""
    m, r, out, w = 0.8, 0.6, 0.3, 1.4
    model = lg.Model("table")
    table = model.body("table")
    rider = model.body("rider", mass=m)
    model.revolute("spin", between=("ground", table), motion=f"{w}*t")
    model.prismatic("slide", between=(table, rider), axis=(1, 0, 0))
    view = outlook(model, [r], [out], t=0.0)
    (turning, sliding) = momentum_columns(view, (r, 0, 0))
    assert turning.freedom is None
    assert turning.rate == pytest.approx(w)
    near(turning.first, [0, m * r, 0])
    near(sliding.first, [m, 0, 0])
    for way in momenta(view, (r, 0, 0)):
        near(np.concatenate(way), [m * out, m * r * w, 0, 0, 0, 0])
    near(
        np.concatenate(momentum_rate(view, (r, 0, 0))), [-m * r * w**2, 2 * m * out * w, 0, 0, 0, 0]
    )
    found = matrix(momentum_columns(view, (r, 0, 0)), 1)
    near(np.ravel(found), [m, 0, 0, 0, 0, 0])


def test_momentum_about_another_point_has_the_moment_of_its_push() -> None:
    view, _, _ = case("joint")
    c, A = by_bodies("joint")
    v, other = CASES["joint"][2], np.array([0.7, -0.3, 0.5])
    push, turn = np.split(A @ v, 2)
    for way in momenta(view, tuple(other)):
        near(np.concatenate(way), [*push, *(turn + np.cross(c - other, push))])


def test_scaled_columns_divide_their_first_vector() -> None:
    found = scaled([Column(None, 2.0, (1, -3, 8), (5, 6, 7))], 4)
    assert found == [Column(None, 2.0, (0.25, -0.75, 2), (5, 6, 7))]
