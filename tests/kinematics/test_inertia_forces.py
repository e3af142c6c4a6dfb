"""What a moving link asks for, against a cloud of accelerated point masses."""

from __future__ import annotations

from typing import Any

import numpy as np
from support.chains import LIMB, LIMB_STATE, modelled, walked
from support.rigid_motion import UPPER

from linegraph.kinematics.accelerations import (
    Spin,
    accelerated,
    d_alembert,
    inertia_forces,
    resting,
    spins,
    together,
)
from linegraph.kinematics.tree_state import TreeState
from linegraph.spatial.inertia import Moments

RNG = np.random.default_rng(11)
MASSES = RNG.uniform(0.2, 1.0, size=6)
PLACES = RNG.normal(size=(6, 3))
SPIN = Spin((0.7, -1.1, 0.4), (2.0, 0.3, -0.8), (0.1, -0.5, 9.8))
EXACT = 2e-14  # of numbers of size 10


def acceleration(spin: Spin, r: Any) -> Any:
    w, e, a = (np.array(x) for x in spin)
    return a + np.cross(e, r) + np.cross(w, np.cross(w, r))


def packed(points: Any, masses: Any) -> Any:
    second = (masses[:, None] * points).T @ points
    return tuple(float(second[i, j]) for i, j in UPPER)


def test_points_of_a_link_are_accelerated_by_turning_and_spinning() -> None:
    for r in PLACES:
        expected = acceleration(SPIN, r) - np.array(SPIN.linear)
        np.testing.assert_allclose(accelerated(SPIN, tuple(r)), expected, atol=EXACT)


def test_force_and_torque_are_sums_over_point_masses() -> None:
    forces = [m * acceleration(SPIN, r) for m, r in zip(MASSES, PLACES, strict=True)]
    moments = Moments(
        float(MASSES.sum()),
        tuple((MASSES @ PLACES).tolist()),  # type: ignore[arg-type]
        packed(PLACES, MASSES),
    )
    force, torque = d_alembert(moments, SPIN)
    np.testing.assert_allclose(force, sum(forces), atol=EXACT)
    expected = sum(np.cross(r, f) for r, f in zip(PLACES, forces, strict=True))
    np.testing.assert_allclose(torque, expected, atol=EXACT)


def test_masses_on_one_axis_take_the_shorter_formula_to_the_same_torque() -> None:
    for axis in np.eye(3):
        points = np.outer(np.arange(1.0, 4.0), axis)
        masses = np.array([0.5, 1.0, 0.2])
        moments = Moments(1.7, tuple((masses @ points).tolist()), packed(points, masses))  # type: ignore[arg-type]
        _, torque = d_alembert(moments, SPIN)
        expected = sum(
            m * np.cross(r, acceleration(SPIN, r)) for m, r in zip(masses, points, strict=True)
        )
        np.testing.assert_allclose(torque, expected, atol=EXACT)


def test_wrenches_add_part_by_part() -> None:
    assert together(((1, 2, 3), (4, 5, 6)), ((10, 0, 0), (0, 0, 7))) == ((11, 2, 3), (4, 5, 13))


def test_ground_rests_but_for_the_weight() -> None:
    assert resting(walked(modelled(LIMB)).gravity) == Spin((0, 0, 0), (0, 0, 0), (-0.3, 0.2, 9.81))


def test_every_links_wrench_comes_from_its_own_moments_and_motion() -> None:
    state = TreeState(walked(modelled(LIMB)), *LIMB_STATE)
    a = tuple(0.1 * k for k in range(7))
    found = inertia_forces(state, a)
    for link, spin, (force, torque) in zip(state.tree.links, spins(state, a), found, strict=True):
        m, (b, S) = link.moments.mass, (np.array(link.moments.first), link.moments.second)
        J = np.array(
            [[S[3] + S[5], -S[1], -S[2]], [-S[1], S[0] + S[5], -S[4]], [-S[2], -S[4], S[0] + S[3]]]
        )
        w, e, a0 = (np.array(x) for x in spin)
        newton = m * a0 + np.cross(e, b) + np.cross(w, np.cross(w, b))
        euler = J @ e + np.cross(w, J @ w) + np.cross(b, a0)
        np.testing.assert_allclose(force, newton, atol=EXACT)
        np.testing.assert_allclose(torque, euler, atol=EXACT)
