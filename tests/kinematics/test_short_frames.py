"""Working frames moved until equations are short: the motion and the masses stay what they were."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.chains import LIMB, LIMB_STATE, Part, link_poses, mass_matrix, modelled, poses, walked
from support.rigid_motion import pose, rows, turned

from linegraph.dynamics.mass_matrix import mass_matrix as derived_mass_matrix
from linegraph.dynamics.orthogonality import inverse_dynamics
from linegraph.errors import ModelError
from linegraph.kinematics.expansion import expanded
from linegraph.kinematics.frame_trees import require_frame, seat_of, tipped
from linegraph.kinematics.ground_frames import frames
from linegraph.kinematics.tree_state import TreeState
from linegraph.kinematics.working_frames import shortened
from linegraph.spatial.placement import Placement
from linegraph.spatial.rotation import Turn

if TYPE_CHECKING:
    import linegraph as lg
    from linegraph.kinematics.links import KinematicTree, Seat

Q, V = LIMB_STATE
EXACT = 1e-14
TILT = turned((1, -1, 2), 0.8)

LONG = tuple(
    Part(
        "revolute", near=((0.3, 0, 0.05 * k), (0, 0, 1), 0.0), parent=k - 1, center=(0.15, 0.02, 0)
    )
    for k in range(6)
)
"""Six parallel hinges."""

OBLIQUE = (
    Part("revolute", near=((0, 0, 0.4), (0, 0, 1), 0.0)),
    Part("revolute", near=((0.2, 0.3, 0.1), (1, 2, 0.5), 0.9), parent=0),
    Part("revolute", near=((0.1, 0, 0.5), (0, 1, 0.2), -0.6), parent=1),
)

CROSS = (
    Part("revolute", (0, 3, 4), ((0.1, 0.2, 0), (1, 0, 0), 0.3)),
    Part(
        "universal",
        ((1, 0, 0), (0, 1, 0)),
        ((0.3, -0.1, 0.2), (0, 1, 0), 0.7),
        ((0.1, 0.2, -0.1), (1, 0, 1), -0.4),
        forward=False,
        parent=0,
    ),
    Part("revolute", (2, -1, 2), ((0.2, 0.5, -0.3), (0, 0, 1), 0.6), parent=1),
)
"""A universal joint against its edge: the axes of its last part are not those of the joint."""

CHAINS = {"cross": CROSS, "limb": LIMB, "long": LONG, "oblique": OBLIQUE}


def drawn(name: str) -> tuple[Any, Any]:
    rng = np.random.default_rng(5)
    n = {"limb": 7, "long": 6, "oblique": 3, "cross": 4}[name]
    return rng.uniform(-1, 1, n), rng.uniform(-1, 1, n)


def own_turned(state: TreeState, i: int) -> Any:
    """A link's own axes in ground: its working axes may be still."""
    found = frames(state)[i]
    turn: Any = np.array(state.arms[i].turn.matrix())
    return pose(np.array(found.rotation) @ turn, np.array(found.origin))


@pytest.mark.parametrize("name", CHAINS)
def test_short_frames_stand_where_their_poses_in_the_walks_frames_say(name: str) -> None:
    parts, (q, v) = CHAINS[name], drawn(name)
    tree = walked(modelled(parts))
    short = shortened(tree)
    state = TreeState(short.tree, q, v)
    for own, place, shift in zip(
        link_poses(tree, poses(parts, q)), short.places, short.poses, strict=True
    ):
        expected = own @ pose(np.array(shift.rotation, float), np.array(shift.at, float))
        np.testing.assert_allclose(own_turned(state, place), expected, atol=EXACT)


@pytest.mark.parametrize("name", CHAINS)
def test_the_mass_matrix_is_that_of_the_bodies_in_short_frames_too(name: str) -> None:
    parts, (q, v) = CHAINS[name], drawn(name)
    tree = walked(modelled(parts))
    for short in (shortened(tree).tree, expanded(tree).tree):
        found = derived_mass_matrix(TreeState(short, q, v))
        np.testing.assert_allclose(found, mass_matrix(parts, q), atol=EXACT)


def test_a_planar_arm_of_three_hinges_loses_its_shifts_along_the_axes() -> None:
    tree = walked(modelled(LONG[:3]))
    assert [link.at[2] for link in tree.links] == [0, 0.05, 0.1]
    short = shortened(tree).tree
    # the arm to ground costs nothing: it alone may keep its shift
    assert [link.at[2] for link in short.links[1:]] == [0, 0]
    assert [link.at[0] for link in short.links] == [0.3, 0.3, 0.3]


def test_from_five_hinges_in_a_plane_on_all_axes_stay_still() -> None:
    for count, still in ((4, False), (5, True), (6, True)):
        tree = walked(modelled(LONG[:count]))
        links = shortened(tree).tree.links
        assert all(link.in_plane for link in links)
        assert all(link.still is still for link in links[:-1])


def test_an_oblique_child_is_reached_by_single_turns() -> None:
    tree = walked(modelled(OBLIQUE))
    short = shortened(tree).tree
    for link in short.links[1:]:
        assert all(isinstance(f, Turn) for f in link.rotation.factors)
    # the turned angles of the joints make up for it
    assert any(f.offset for link in short.links for f in link.place.positions)
    assert not any(f.offset for link in tree.links for f in link.place.positions)


def test_wrenches_on_the_walks_links_do_the_same_on_the_shortened_ones() -> None:
    tree = walked(modelled(LIMB))
    short = shortened(tree)
    wrenches: Any = [((1.0, k, -2.0), (0.3 * k, 0.5, -1.0)) for k in range(len(tree.links))]
    state = TreeState(short.tree, Q, V)
    own = link_poses(tree, poses(LIMB, Q))
    moved = short.rehoused(wrenches, state.arms)
    for (f, n), at, place in zip(wrenches, own, short.places, strict=True):
        frame = frames(state)[place]
        force, torque = (np.array(frame.rotation) @ np.array(x) for x in moved[place])
        expected = at[:3, :3] @ np.array(f)
        np.testing.assert_allclose(force, expected, atol=EXACT)
        lever = at[:3, 3] - np.array(frame.origin)
        about = at[:3, :3] @ np.array(n) + np.cross(lever, expected)
        np.testing.assert_allclose(torque, about, atol=EXACT)
    inner = set(range(len(short.tree.links))) - set(short.places)
    assert inner
    assert all(moved[i] == ((0, 0, 0), (0, 0, 0)) for i in inner)


def test_a_universal_joint_becomes_two_hinges_with_the_body_on_the_last() -> None:
    tree = walked(modelled(LIMB))
    apart = expanded(tree)
    links = apart.tree.links
    assert [link.name for link in links] == ["b0", "b1", "inside j2", "b2", "b3", "b4"]
    # a cylindrical joint turns about the axis that it slides along: it stays whole
    assert [link.joint.freedoms for link in links] == [1, 1, 1, 1, 2, 1]
    assert [[f.index for f in link.velocities] for link in links] == [
        [0],
        [1],
        [2],
        [3],
        [4, 5],
        [6],
    ]
    assert apart.last == (0, 1, 3, 4, 5)
    assert [link.parent for link in links] == [-1, 0, 1, 2, 1, 4]
    assert [link.moments.mass for link in links] == [1.0, 0.7, 0, 0.5, 1.0, 1.5]
    state = TreeState(apart.tree, Q, V)
    for own, last, turn in zip(
        link_poses(tree, poses(LIMB, Q)), apart.last, apart.turns, strict=True
    ):
        expected = own @ pose(np.array(turn.matrix(), float))
        np.testing.assert_allclose(own_turned(state, last), expected, atol=EXACT)


def framed() -> lg.Model:
    model = modelled(LIMB)
    for name, at in (("b2", (0.1, 0.2, 0.3)), ("b4", (-0.2, 0, 0.4))):
        model.add_frame(name, "tip", Placement(at, rows(TILT)))
    return model


def tips(q: Any) -> list[Any]:
    at = poses(LIMB, q)
    return [at[2] @ pose(TILT, (0.1, 0.2, 0.3)), at[4] @ pose(TILT, (-0.2, 0, 0.4))]


def seats_of(tree: KinematicTree, *names: str) -> list[Seat]:
    return [seat_of(tree, name) for name in names]


@pytest.mark.parametrize("masses", [True, False])
def test_the_tip_of_a_frame_tree_is_the_frame(masses: bool) -> None:
    tree = walked(framed())
    found = tipped(tree, seats_of(tree, "b2.tip", "b4.tip"), masses=masses)
    state = TreeState(found.tree, Q, V)
    for tip, expected in zip(found.tips, tips(Q), strict=True):
        np.testing.assert_allclose(own_turned(state, tip), expected, atol=EXACT)


def test_where_axes_are_not_asked_for_the_origins_are_right() -> None:
    tree = walked(framed())
    found = tipped(tree, seats_of(tree, "b2.tip", "b4.tip"), masses=False, turning=False)
    state = TreeState(found.tree, Q, V)
    for tip, expected in zip(found.tips, tips(Q), strict=True):
        np.testing.assert_allclose(own_turned(state, tip)[:3, 3], expected[:3, 3], atol=EXACT)


def test_only_links_on_the_way_are_kept_where_masses_are_not_asked_for() -> None:
    tree = walked(framed())
    found = tipped(tree, seats_of(tree, "b0"), masses=False)
    # the first hinge, and the frame on it
    assert len(found.tree.links) == 2
    assert all(link.moments.mass == 0 for link in found.tree.links)
    assert (found.mass, found.at_rest) == (0, (0, 0, 0))


def test_links_and_what_rests_have_the_first_moment_of_all_bodies() -> None:
    tree = walked(framed())
    found = tipped(tree, seats_of(tree, "b4.tip"), masses=True)
    assert found.mass == pytest.approx(sum(part.mass for part in LIMB), abs=1e-15)
    state = TreeState(found.tree, Q, V)
    total = np.array(found.at_rest, float)
    for arm, frame in zip(state.arms, frames(state), strict=True):
        total += np.array(frame.rotation) @ np.array(arm.moments.first, float)
        total += arm.moments.mass * np.array(frame.origin)
    expected = sum(
        part.mass * (at @ [*part.center, 1])[:3]
        for part, at in zip(LIMB, poses(LIMB, Q), strict=True)
    )
    np.testing.assert_allclose(total, expected, atol=EXACT)


def test_a_mass_centre_and_a_frame_of_ground_have_seats() -> None:
    tree = walked(framed())
    link, at, rotation = seat_of(tree, "b1.mass_center")
    assert link == 1
    (_, own) = tree.bodies["b1"]
    expected = pose(np.array(own.rotation), np.array(own.at)) @ [*LIMB[1].center, 1]
    np.testing.assert_allclose(at, expected[:3], atol=4e-16)
    np.testing.assert_allclose(rotation, own.rotation, atol=4e-16)
    there = seat_of(tree, "ground.f0near")
    assert there.link == -1
    np.testing.assert_allclose(there.at, LIMB[0].near[0], atol=4e-16)


@pytest.mark.parametrize("name", ["b9", "b1.nothing", "ground", "nobody.mass_center"])
def test_a_frame_that_is_none_is_refused(name: str) -> None:
    with pytest.raises(ModelError, match="is no body and no frame of one"):
        require_frame(modelled(LIMB).system(), name)


def test_frames_of_bodies_are_accepted() -> None:
    for name in ("b1", "b1.f1far", "b1.mass_center"):
        require_frame(modelled(LIMB).system(), name)


def test_bodies_on_ground_angles_keep_the_frames_of_the_walk() -> None:
    model = modelled(LONG)
    model.formulation(coordinates="absolute-angle")
    tree = walked(model)
    short = shortened(tree)
    assert short.places == tuple(range(6))
    assert all(p.at == (0, 0, 0) for p in short.poses)
    q, v = (np.cumsum(x) for x in drawn("long"))
    first, second = (inverse_dynamics(TreeState(t, q, v)) for t in (tree, short.tree))
    np.testing.assert_allclose(first, second, atol=1e-13 * math.hypot(*first))
