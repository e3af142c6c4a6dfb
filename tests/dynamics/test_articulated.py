"""Articulated inertias: 6 x 6 matrices, a block on a slope by hand, and M^-1 of an oracle."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from oracles import newton_euler as oracle
from support.chains import LIMB, LIMB_STATE, mass_matrix, modelled, walked
from support.drawn_trees import KINDS, drawn
from support.near import near
from support.rigid_motion import UPPER, cross_matrix, tensor, turned

import linegraph as lg
from linegraph.dynamics.applied_forces import Applied
from linegraph.dynamics.articulated import Articulated, Freed, forward_dynamics, rigid
from linegraph.dynamics.composite_bias import bias_beside_mass
from linegraph.kinematics.tree_state import TreeState
from linegraph.spatial.inertia import Moments
from linegraph.spatial.rotation import Full, Rotation
from linegraph.spatial.vector import ZERO

RNG = np.random.default_rng(5)
PLACES = RNG.normal(size=(6, 3))
MASSES = RNG.uniform(0.3, 1.0, size=6)
SECOND = np.einsum("k,ki,kj", MASSES, PLACES, PLACES)
CLOUD = Moments(
    float(MASSES.sum()),
    tuple((MASSES @ PLACES).tolist()),  # type: ignore[arg-type]
    tuple(float(SECOND[i, j]) for i, j in UPPER),  # type: ignore[arg-type]
)


def whole(found: Articulated) -> Any:
    """The 6 x 6 matrix of (α, a) to (n, f)."""
    b = np.array(found.b, float)
    return np.block([[tensor(found.a), b], [b.T, tensor(found.c)]])


def of_points(places: Any) -> Any:
    """The same of point masses: each goes with a + α x r, and its force has the moment r x f."""
    total = np.zeros((6, 6))
    for m, r in zip(MASSES, places, strict=True):
        moved = np.hstack([-cross_matrix(r), np.eye(3)])
        total += m * moved.T @ moved
    return total


def yielding() -> Articulated:
    """A map without the symmetries of a rigid body: one freedom of the cloud gives way."""
    return rigid(CLOUD).without(freed(rigid(CLOUD), (0.6, -0.3, 0.2), (0.1, 0.5, -0.4)))


def freed(body: Articulated, s: Any, u: Any, along: Any = None) -> Freed:
    n, f = body.apply(s, u)
    return Freed((n, f), 1 / (np.dot(s, n) + np.dot(u, f)), 0, along)


def test_a_rigid_body_is_the_sum_of_its_points() -> None:
    near(whole(rigid(CLOUD)), of_points(PLACES))


def test_a_map_gives_torque_and_force_in_this_order() -> None:
    given = RNG.normal(size=6)
    torque, force = yielding().apply(tuple(given[:3]), tuple(given[3:]))
    near([*torque, *force], whole(yielding()) @ given)


def test_a_body_seen_from_outside_is_the_sum_of_its_points_there() -> None:
    turn, at = turned((1, 2, -1), 0.8), np.array([0.4, -0.7, 0.3])
    rotation = Rotation((Full(tuple(map(tuple, turn.tolist()))),))  # type: ignore[arg-type]
    seen = rigid(CLOUD).turned(rotation).shifted(tuple(at))
    near(whole(seen), of_points(PLACES @ turn.T + at))


def test_any_map_is_shifted_and_turned_as_its_matrix() -> None:
    """With V the motion of an inner origin for that of the outer one: V^T A V."""
    turn, at = turned((0.3, -1, 2), -1.3), np.array([-0.2, 0.5, 0.6])
    rotation = Rotation((Full(tuple(map(tuple, turn.tolist()))),))  # type: ignore[arg-type]
    lever = np.block([[np.eye(3), np.zeros((3, 3))], [-cross_matrix(at), np.eye(3)]])
    both = np.kron(np.eye(2), turn)
    own = whole(yielding())
    near(whole(yielding().turned(rotation)), both @ own @ both.T)
    near(whole(yielding().shifted(tuple(at))), lever.T @ own @ lever)


def test_bodies_on_one_link_add() -> None:
    near(
        whole(yielding().joined(rigid(CLOUD))),
        whole(yielding()) + of_points(PLACES),
    )


def test_along_a_freedom_that_gives_way_nothing_resists() -> None:
    s, u = np.array([0.6, -0.3, 0.2]), np.array([0.1, 0.5, -0.4])
    rest = whole(yielding())
    near(rest @ [*s, *u], np.zeros(6))
    # what is left is the least that any motion of the freedom makes of the kinetic energy
    own, free = of_points(PLACES), np.array([*s, *u])
    for given in np.eye(6):
        at_best = given - free * (free @ own @ given) / (free @ own @ free)
        assert given @ rest @ given == pytest.approx(at_best @ own @ at_best, abs=1e-13)


@pytest.mark.parametrize("place", range(6))
def test_zeros_along_coordinate_axes_are_no_sums(place: int) -> None:
    """For some masses x (1 / x) is not 1, and the differences would not vanish."""
    axis = np.eye(6)[place]
    along = (place, None) if place < 3 else (None, place - 3)
    s, u = tuple(axis[:3].tolist()), tuple(axis[3:].tolist())
    for share in np.linspace(0.5, 2, 60).tolist():
        body = rigid(
            Moments(
                share * CLOUD.mass,
                tuple(share * x for x in CLOUD.first),  # type: ignore[arg-type]
                tuple(share * x for x in CLOUD.second),  # type: ignore[arg-type]
            )
        )
        rest = whole(body.without(freed(body, s, u, along)))
        assert not rest[place].any()
        assert not rest[:, place].any()
        near(rest, whole(body.without(freed(body, s, u))))


# chains


def block_on_a_slope() -> lg.Model:
    """A block that slides down a slope of 0.5 rad, and a bar that swings from it about z."""
    model = lg.Model("block", gravity=(0, -9.81, 0))
    block = model.body("block", mass=3.0)
    bar = model.body("bar", mass=1.2, mass_center=(0, -0.4, 0), inertia={"zz": 0.05})
    model.prismatic("slope", between=("ground", block), axis=(np.cos(0.5), -np.sin(0.5), 0))
    model.revolute("swing", between=(block, bar))
    return model


def accelerations(
    model: lg.Model, q: Any, v: Any, efforts: Any, armatures: Any = None
) -> tuple[Any, Any]:
    return forward_dynamics(TreeState(walked(model), q, v), efforts, armatures)


def test_a_block_on_a_slope_with_a_swinging_bar() -> None:
    m1, m2, c, inertia, g, slope = 3.0, 1.2, 0.4, 0.05, 9.81, 0.5
    angle, rate, push, torque = 0.8, 1.7, 4.0, 0.6
    found, pivots = accelerations(block_on_a_slope(), [0.1, angle], [-0.4, rate], [push, torque])
    lean = angle + slope  # of the bar to the normal of the slope
    M = np.array([[m1 + m2, m2 * c * np.cos(lean)], [m2 * c * np.cos(lean), inertia + m2 * c**2]])
    h = [
        -m2 * c * rate**2 * np.sin(lean) - (m1 + m2) * g * np.sin(slope),
        m2 * g * c * np.sin(angle),
    ]
    near(found, np.linalg.solve(M, np.array([push, torque]) - h))
    # eliminated from the tip: that of the hinge first, then what the block still moves
    near(pivots, [M[0, 0] - M[0, 1] ** 2 / M[1, 1], M[1, 1]])


def test_a_rotor_behind_a_gear_adds_to_its_own_pivot_and_to_nothing_else() -> None:
    q, v = LIMB_STATE
    efforts = np.linspace(2, -1, 7)
    armatures = {1: 0.4, 4: 0.07, 6: 0.2}
    found, pivots = accelerations(modelled(LIMB), q, v, efforts, armatures)
    M = mass_matrix(LIMB, q)
    at_rest = [0] * 7
    for k, extra in armatures.items():
        M[k, k] += extra
    still, _ = accelerations(modelled(LIMB), q, v, at_rest, armatures)
    near(np.array(found) - still, np.linalg.solve(M, efforts), 1e-12)
    assert np.prod(pivots) == pytest.approx(np.linalg.det(M), rel=1e-12)


def test_oblique_joints_accelerate_as_mass_matrix_and_bias_say() -> None:
    q, v = LIMB_STATE
    state = TreeState(walked(modelled(LIMB)), q, v)
    idle = Applied([(ZERO, ZERO)] * len(state.tree.links), [0] * 7)
    h = bias_beside_mass(state, idle)
    efforts = np.linspace(2, -1, 7)
    found, _ = accelerations(modelled(LIMB), q, v, efforts)
    near(found, np.linalg.solve(mass_matrix(LIMB, q), efforts - h), 1e-12)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kinds", KINDS)
def test_random_trees_accelerate_as_newton_and_euler_say(kinds: str, seed: int) -> None:
    here = drawn(seed, kinds, couplings=False)
    efforts = 3 * here.a
    M = oracle.mass_matrix(here.spec, here.q, here.v)
    expected = oracle.forward_dynamics(here.spec, here.q, here.v, efforts)
    # rounding grows by the condition of M, lengths and angles in units of their own
    scale = 1 / np.sqrt(np.diag(M))
    tolerance = 1e-14 * np.linalg.cond(M * np.outer(scale, scale)) + 1e-13
    found, pivots = forward_dynamics(here.over_floats(), efforts.tolist())
    near(found, expected, tolerance)
    assert np.prod(pivots) == pytest.approx(np.linalg.det(M), rel=tolerance)
    # over nodes products with zero are left out, and so are sums that vanish
    over_nodes = here.over_dag(lambda state: forward_dynamics(state, efforts.tolist()).unknowns)
    near(over_nodes, expected, tolerance)
