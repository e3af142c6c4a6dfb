"""Links: what is folded into them, what a parent carries for them, and what the tree says of them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.chains import (
    LIMB,
    LIMB_STATE,
    PLANE,
    Part,
    link_poses,
    mass_matrix,
    modelled,
    poses,
    walked,
)
from support.rigid_motion import TINY, axial, of_quaternion, tensor

import linegraph as lg
from linegraph.dynamics.mass_matrix import mass_matrix as derived_mass_matrix
from linegraph.kinematics.links import links_in_plane, parallel, upright
from linegraph.kinematics.state_layout import Place
from linegraph.kinematics.tree_state import TreeState
from linegraph.spatial.rotation import Relabel, Rotation, Turn

Q, V = LIMB_STATE


def welded() -> lg.Model:
    """A plate hinged to ground with a block welded on it, and a body welded to ground."""
    model = lg.Model("welded")
    plate = model.body("plate", mass=2.0, mass_center=(0.5, 0, 0), inertia=(0, 0, 0))
    block = model.body("block", mass=1.0, mass_center=(0.1, 0, 0), inertia=(0, 0, 0.2))
    wall = model.body("wall", mass=5.0)
    model.revolute("hinge", between=("ground", plate))
    model.fixed("weld", between=(plate.frame("tip", at=(1, 0, 0)), block))
    model.fixed("nail", between=(model.ground.frame("there", at=(0, 3, 0)), wall))
    return model


def test_welded_bodies_are_one_link_with_the_sum_of_their_moments() -> None:
    tree = walked(welded())
    (link,) = tree.links
    assert link.name == "plate, block"
    assert link.caption == "hinge -> plate, block"
    # m x: 2 0.5 + 1 (1 + 0.1); m x^2: 2 0.25 + 1.21, of the block 0.2 beside it
    assert link.moments.mass == 3.0
    np.testing.assert_allclose(link.moments.first, (2.1, 0, 0), atol=1e-15)
    assert link.moments.inertia[5] == pytest.approx(0.5 + 1.21 + 0.2, abs=1e-15)
    assert tree.bodies["block"][0] == tree.bodies["plate"][0] == 0
    assert tree.bodies["block"][1].at == (1, 0, 0)
    assert tree.bodies["wall"] == (-1, ((0, 3, 0), ((1, 0, 0), (0, 1, 0), (0, 0, 1))))


def test_a_weld_by_a_turned_frame_of_the_far_body_turns_that_body_back() -> None:
    model = welded()
    lamp = model.body("lamp", mass=1.0, mass_center=(0, 0.4, 0))
    foot = lamp.frame("foot", at=(0.1, 0, 0), axis=(0, 0, 1), angle=math.pi / 2)
    model.fixed("screw", between=("plate.tip", foot))
    tree = walked(model)
    link, own = tree.bodies["lamp"]
    assert link == 0
    # the foot's x is the lamp's y: the plate's x is the lamp's y, and the plate's -y its x
    assert own.rotation == ((0, 1, 0), (-1, 0, 0), (0, 0, 1))
    np.testing.assert_allclose(own.at, (1, 0.1, 0), atol=4e-16)
    # 2.1 of plate and block, and the lamp's centre at (1, 0.1) + (0.4, 0)
    np.testing.assert_allclose(tree.links[0].moments.first, (3.5, 0.1, 0), atol=1e-15)


def test_a_links_own_frame_has_its_joint_at_the_origin_and_the_axis_as_z() -> None:
    tree = walked(modelled(LIMB))
    for k, (part, at) in enumerate(zip(LIMB, link_poses(tree, poses(LIMB, Q)), strict=True)):
        if part.kind == "universal":
            continue
        # moving the joint alone leaves its axis where it was: z of the link
        moved = Q.copy()
        moved[[0, 1, 2, 4, 6][k]] += 0.9
        other = link_poses(tree, poses(LIMB, moved))[k]
        np.testing.assert_allclose(other[:3, 2], at[:3, 2], atol=4e-16)
        shift = other[:3, 3] - at[:3, 3]
        np.testing.assert_allclose(np.cross(shift, at[:3, 2]), 0, atol=4e-16)


def test_moments_of_links_are_those_of_bodies_about_the_joint() -> None:
    tree = walked(modelled(LIMB))
    at = poses(LIMB, Q)
    assert [tree.bodies[f"b{k}"][0] for k in range(len(LIMB))] == list(range(len(LIMB)))
    for part, body, seen, link in zip(LIMB, at, link_poses(tree, at), tree.links, strict=True):
        moments = link.moments
        inward = np.linalg.inv(seen) @ body
        c, R = (inward @ [*part.center, 1])[:3], inward[:3, :3]
        np.testing.assert_allclose(moments.first, part.mass * c, atol=4e-16)
        J = R @ np.diag(part.inertia) @ R.T
        J = J + part.mass * ((c @ c) * np.eye(3) - np.outer(c, c))
        np.testing.assert_allclose(tensor(moments.inertia), J, atol=1e-15)


def test_a_tree_with_masses_handed_on_has_the_same_mass_matrix() -> None:
    tree = walked(modelled(LIMB))
    less = tree.regrouped()
    found = derived_mass_matrix(TreeState(less, Q, V))
    np.testing.assert_allclose(found, mass_matrix(LIMB, Q), atol=4e-15)
    # the first hinge's mass stands on ground, and what lies on its axis with it
    first = less.links[0].moments
    assert first.mass == 0
    assert first.first[2] == 0
    assert tree.links[0].moments.mass == 1.0


def test_links_on_hinges_about_one_direction_stay_in_a_plane() -> None:
    tree = walked(modelled(PLANE))
    assert links_in_plane(tree.links) == [True, True, True]
    tilted = (PLANE[0], PLANE[1]._replace(axis=(0, 0, -1)), PLANE[2]._replace(axis=(0, 1, 0)))
    tree = walked(modelled(tilted))
    assert links_in_plane(tree.links) == [True, True, False]
    assert [parallel(link) for link in tree.links] == [True, True, False]
    slide = (
        Part("prismatic", (1, 0, 0)),
        Part("revolute", (0, 1, 1), parent=0),
        Part("prismatic", parent=1),
    )
    tree = walked(modelled(slide))
    # a slide does not turn and a hinge on it turns about one direction; what slides on that does not count
    assert links_in_plane(tree.links) == [False, True, False]
    driven = replace(tree.links[1], place=Place(drive=(1,)))  # type: ignore[arg-type]
    assert links_in_plane((tree.links[0], driven)) == [False, False]


def test_upright_is_the_direction_of_z_either_way_round() -> None:
    link = walked(modelled(PLANE)).links[0]
    for rotation, expected in (
        (Rotation((Turn(2, 0.6, 0.8),)), True),
        (Rotation((Relabel((0, 1, 2), (1, -1, -1)),)), True),
        (Rotation((Turn(0, 0.6, 0.8),)), False),
    ):
        assert upright(replace(link, rotation=rotation)) is expected


def balls() -> lg.Model:
    model = lg.Model("balls")
    a = model.body("a", mass=1.0, mass_center=(0.1, 0, 0), inertia=(1, 1, 1))
    b = model.body("b", mass=1.0, inertia=(1, 1, 1))
    model.free("float", between=("ground", a))
    model.spherical("ball", between=(a, b))
    return model


def test_quaternions_are_found_in_q_and_given_length_1() -> None:
    tree = walked(balls())
    assert tree.quaternions == [(3, 4, 5, 6), (7, 8, 9, 10)]
    q = [1.0, 2.0, 3.0, 0.0, 3.0, 0.0, 4.0, 0.0, 0.0, 0.0, -2.0]
    tree.normalise(q)
    np.testing.assert_allclose(q, [1, 2, 3, 0, 0.6, 0, 0.8, 0, 0, 0, -1], atol=1e-16)


def test_a_ball_turns_with_its_velocity_in_the_heads_axes() -> None:
    q = [0.0] * 3 + [0.1, -0.7, 0.1, 0.7] + [0.5, 0.5, -0.5, 0.5]
    v = [0.3, -0.4, 0.2, 0.5, 0.7, -0.1, 0.9, -0.6, 0.8]
    rates = np.array(TreeState(walked(balls()), q, v).coordinate_rates)
    for part, own in ((slice(3, 7), v[3:6]), (slice(7, 11), v[6:9])):
        ahead = of_quaternion(np.array(q)[part] + 1j * TINY * rates[part])
        np.testing.assert_allclose(axial(ahead.real.T @ ahead.imag / TINY), own, atol=4e-16)
        assert abs(np.array(q)[part] @ rates[part]) < 1e-16  # the length stays


def test_the_tree_counts_outward_and_knows_what_it_shares() -> None:
    tree = walked(modelled(LIMB))
    assert tree.outward == list(range(7))
    assert not tree.coupled
    assert not tree.levelled
    assert not tree.closed
    model = modelled(PLANE)
    model.couple("j2", to="j0", ratio=-2.0, offset=0.5)
    tree = walked(model)
    assert tree.coupled
    assert [q.name for q in tree.positions] == ["j0", "j1"]
    model = lg.Model("backwards")
    b = model.body("b", mass=1.0)
    a = model.body("a", mass=1.0)
    model.revolute("outer", between=(a, b))
    model.revolute("inner", between=("ground", a))
    tree = walked(model)
    # coordinates stand in declared order, links from ground outward
    assert [q.name for q in tree.positions] == ["outer", "inner"]
    assert tree.outward == [1, 0]


def test_a_chord_closes_a_loop_and_an_unforced_one_does_not() -> None:
    model = modelled(PLANE)
    model.rod("strut", between=("ground", "b2"), length=0.6)
    tree = walked(model)
    assert tree.closed
    (closure,) = tree.closures
    assert (closure.tail.link, closure.head.link) == (-1, 2)
    free = modelled(PLANE)
    free.free("six", between=("ground", "b2"))
    tree = walked(free)
    # six freedoms forbid nothing
    assert [c.component.name for c in tree.closures] == ["six"]
    assert tree.closures[0].restrictions == ()
    assert not tree.closed


def test_coupled_joints_move_as_their_ratio_says() -> None:
    model = modelled(PLANE)
    model.couple("j2", to="j0", ratio=-2.0, offset=0.5)
    state = TreeState(walked(model), [0.3, -0.4], [1.0, 2.0])
    own: Any = np.array([0.3, -0.4, -2 * 0.3 + 0.5])
    assert state.arms[2].rates == (-2.0,)
    turns = np.eye(3)
    for arm in state.arms:
        turns = turns @ np.array(arm.rotation.matrix())
    np.testing.assert_allclose(turns, poses(PLANE, own)[2][:3, :3], atol=4e-16)
    assert state.coordinate_rates == [1.0, 2.0]
