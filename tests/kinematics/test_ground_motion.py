"""Places, velocities and accelerations of bodies against differentiated products of poses."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.chains import (
    GRAVITY,
    LIMB,
    LIMB_STATE,
    PLANE,
    jacobian,
    link_poses,
    modelled,
    poses,
    walked,
)
from support.rigid_motion import TINY, axial, moving, of_quaternion, pose, turned, undone

import linegraph as lg
from linegraph.kinematics.accelerations import crossed_with, crossing, seen_near, spins
from linegraph.kinematics.ground_frames import (
    GROUND_FRAME,
    Pair,
    along_velocities,
    frames,
    relative_motion,
    seated,
    seen,
)
from linegraph.kinematics.links import Seat
from linegraph.kinematics.tree_state import TreeState
from linegraph.kinematics.twists import (
    Outlook,
    accelerations,
    columns,
    matrix,
    position,
    velocities,
)
from linegraph.kinematics.working_frames import shortened

Q, V = LIMB_STATE
A = np.array([0.5, -1.2, 0.9, 0.2, -0.6, 1.4, 0.3])
EXACT = 4e-15
OF_DIFFERENCES = 3e-9  # of second derivatives: h**2 with h = 1e-5, and rounding / h
TREE = walked(modelled(LIMB))
STATE = TreeState(TREE, Q, V)


def close(found: Any, expected: Any, within: float = EXACT) -> None:
    np.testing.assert_allclose(np.array(found, float), np.array(expected, float), atol=within)


def link_motion(i: int, a: Any = None) -> Any:
    """How a link's working frame moves, by differentiating where it is."""
    a = 0 * V if a is None else a

    def path(t: Any) -> Any:
        return link_poses(TREE, poses(LIMB, Q + V * t + a * t * t / 2))[i]

    return moving(path)


@pytest.mark.parametrize("i", range(len(LIMB)))
@pytest.mark.parametrize("a", [None, A], ids=["steady", "accelerated"])
def test_frames_of_links_move_as_products_of_poses_do(i: int, a: Any) -> None:
    found = frames(STATE, a)[i]
    expected = link_motion(i, a)
    close(found.rotation, expected.rotation)
    close(found.origin, expected.place)
    close(found.angular, expected.angular)
    close(found.linear, expected.linear)
    close(found.spin, expected.spin, OF_DIFFERENCES)
    close(found.pull, expected.pull, OF_DIFFERENCES)


@pytest.mark.parametrize("i", range(len(LIMB)))
@pytest.mark.parametrize("a", [None, A], ids=["steady", "accelerated"])
def test_spins_are_the_same_motion_in_the_links_axes_with_gravity(i: int, a: Any) -> None:
    found = spins(STATE, a)[i]
    expected = link_motion(i, a)
    back = expected.rotation.T
    close(found.velocity, back @ expected.angular)
    close(found.angular, back @ expected.spin, OF_DIFFERENCES)
    close(found.linear, back @ (expected.pull - np.array(GRAVITY)), OF_DIFFERENCES)


@pytest.mark.parametrize("i", range(len(LIMB)))
def test_a_joint_crossed_in_the_near_links_axes_gives_the_same_vectors(i: int) -> None:
    arm, near = STATE.arms[i], (0.3, -0.4, 0.5)
    here = crossing(arm, near)
    there = crossed_with(arm, seen_near(arm), near)
    for mine, other in zip(here, there, strict=True):
        close(arm.rotation.out(mine), other)
    w, back = np.array(near), np.array(arm.rotation.matrix()).T
    close(here.velocity, back @ w + np.array(here.turning))


def test_a_place_on_a_body_moves_with_it() -> None:
    place, axes = (0.3, -0.1, 0.7), ((0, -1, 0), (1, 0, 0), (0, 0, 1))
    link, seat = TREE.bodies["b4"]
    body = seated(frames(STATE), Seat(link, seat.at, seat.rotation))
    found = body.at(place, axes)
    fixed = np.eye(4)
    fixed[:3, :3], fixed[:3, 3] = axes, place
    expected = moving(lambda t: poses(LIMB, Q + V * t)[4] @ fixed)
    for mine, other in zip(found, expected, strict=True):
        close(mine, other, OF_DIFFERENCES)
    assert seated([], Seat(-1, place, axes))[:2] == (axes, place)


def test_relative_motion_is_that_of_one_frame_in_the_other() -> None:
    found = frames(STATE)
    tail, head = found[2], found[4]

    def relative(t: Any) -> Any:
        at = link_poses(TREE, poses(LIMB, Q + V * t))
        inward = np.linalg.inv(at[2])
        return inward @ at[4]

    expected = moving(relative)
    rotation, displacement = seen(tail, head)
    close(rotation, expected.rotation)
    close(displacement, expected.place)
    out = np.array(tail.rotation)
    u, w = relative_motion(tail, head)
    close(u, out @ expected.linear)
    close(w, out @ expected.angular)


@pytest.mark.parametrize(("head", "tail"), [(4, -1), (-1, 2), (4, 2), (2, 4), (1, 4)])
def test_a_force_between_two_links_does_along_velocities_what_its_power_says(
    head: int, tail: int
) -> None:
    force, torque, point = (1.0, -2.0, 0.5), (0.3, 0.7, -1.1), (0.2, 0.4, -0.3)
    moving_frames = frames(STATE)
    pair = Pair(force, torque, point, head, tail)
    found = np.zeros(len(V))
    for freedom, entry in along_velocities(STATE, moving_frames, pair):
        found[freedom.index] += entry
    expected = np.zeros(len(V))
    for link, sign in ((head, 1), (tail, -1)):
        if link >= 0:
            at = poses(LIMB, Q)[link]
            own = np.linalg.inv(at) @ np.array([*point, 1])
            J = jacobian(LIMB, Q, link, own[:3])
            expected += sign * (np.array(force) @ J[:3] + np.array(torque) @ J[3:])
    close(found, expected, 2e-15)


@pytest.mark.parametrize("i", range(len(LIMB)))
def test_the_jacobian_of_a_link_is_the_derivative_of_its_pose(i: int) -> None:
    view = Outlook(STATE)
    link, own = TREE.bodies[f"b{i}"]
    assert link == i
    back = -np.array(own.rotation).T @ np.array(own.at)
    close(matrix(columns(view, i), len(V)), jacobian(LIMB, Q, i, back))
    close(position(view, i), link_poses(TREE, poses(LIMB, Q))[i][:3, 3])


@pytest.mark.parametrize("i", range(len(LIMB)))
def test_every_way_to_a_velocity_or_an_acceleration_ends_at_the_same(i: int) -> None:
    view = Outlook(STATE)
    expected = link_motion(i)
    ways = velocities(view, i)
    assert len(ways) == 4
    for linear, angular in ways:
        close(linear, expected.linear)
        close(angular, expected.angular)
    ways = accelerations(view, i)
    assert len(ways) == 4
    for linear, angular in ways:
        close(linear, expected.pull, OF_DIFFERENCES)
        close(angular, expected.spin, OF_DIFFERENCES)


def test_angles_measured_from_ground_are_sums_of_the_hinges_angles() -> None:
    model = modelled(PLANE)
    model.formulation(coordinates="absolute-angle")
    tree = walked(model)
    assert tree.levelled
    own, rates, second = (
        np.array(x) for x in ([0.4, -0.9, 0.5], [0.7, 0.3, -1.2], [0.2, 0.9, -0.4])
    )
    q, v, a = (np.cumsum(x) for x in (own, rates, second))
    state = TreeState(tree, q, v)
    view = Outlook(state)
    for i in range(3):

        def path(t: Any, i: int = i) -> Any:
            return link_poses(tree, poses(PLANE, own + rates * t + second * t * t / 2))[i]

        expected = moving(path)
        found = frames(state, a)[i]
        for mine, other in zip(found, expected, strict=True):
            close(mine, other, OF_DIFFERENCES)
        for linear, angular in velocities(view, i):
            close(linear, expected.linear)
            close(angular, expected.angular)
        spin = spins(state, a)[i]
        close(spin.angular, expected.rotation.T @ expected.spin, OF_DIFFERENCES)
        # a column is what the angle of one link against ground does to the last one's place
        J = np.array(matrix(columns(view, i), 3))
        close(J @ v, [*expected.linear, *expected.angular])


def test_driven_joints_add_what_their_motions_prescribe() -> None:
    """The first and last hinges and the slide follow functions of t, in short frames as well."""
    model = driven_limb()
    tree = walked(model, t=0.7)
    free = [2, 3, 4, 5]

    def coordinates(t: Any) -> Any:
        """The whole state around the time 0.7: driven coordinates as given, others at constant rates."""
        at, now = Q + V * t, 0.7 + t
        return np.array([0.4 * now**3, 0.2 * np.sin(3 * now), *at[2:6], now**2 / 2])

    short = shortened(tree)
    bodies = poses(LIMB, Q)
    for given in (tree, short.tree):
        view = Outlook(TreeState(given, Q[free], V[free]))
        for k, link in enumerate(link_poses(tree, bodies)):
            tip, inner = k, np.eye(4)
            if given is short.tree:
                tip, at = short.places[k], short.poses[k]
                inner = pose(np.array(at.rotation), np.array(at.at))
            fixed = undone(bodies[k]) @ link @ inner
            expected = moving(lambda t, k=k, fixed=fixed: poses(LIMB, coordinates(t))[k] @ fixed)  # type: ignore[misc]
            close(position(view, tip), expected.place, 1e-14)
            for linear, angular in velocities(view, tip):
                close(linear, expected.linear, 1e-14)
                close(angular, expected.angular, 1e-14)
            for linear, angular in accelerations(view, tip):
                close(linear, expected.pull, OF_DIFFERENCES)
                close(angular, expected.spin, OF_DIFFERENCES)


def driven_limb() -> lg.Model:
    model = modelled(LIMB)
    for name, motion in (("j0", "0.4*t**3"), ("j1", "0.2*sin(3*t)"), ("j4", "t**2/2")):
        model._joints[name] = replace(model._joints[name], drive=motion)
    return model


def test_an_orientation_in_space_is_seen_from_the_parent_as_its_hinge_turns() -> None:
    parts = (PLANE[0], PLANE[1]._replace(axis=(1, 0, 0)), PLANE[2])
    model = modelled(parts)
    model.formulation(coordinates="absolute-angle")
    tree = walked(model)
    own, rates = np.array([0.4, -0.9, 0.5]), np.array([0.7, 0.3, -1.2])
    q, v = [own[0]], [rates[0]]
    ahead = poses(parts, own + 1j * TINY * rates)
    half = np.array([[0, 0, np.sin(x / 2), np.cos(x / 2)] for x in own])
    half[1] = half[1][[2, 1, 0, 3]]  # about x
    quaternion = half[0]
    for k in (1, 2):
        a, b = quaternion, half[k]
        vector = a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])
        quaternion = np.array([*vector, a[3] * b[3] - a[:3] @ b[:3]])
        turn = ahead[k][:3, :3]
        np.testing.assert_allclose(of_quaternion(quaternion), turn.real, atol=1e-15)
        q += quaternion.tolist()
        v += axial(turn.real.T @ turn.imag / TINY).tolist()
    state = TreeState(tree, q, v)
    found = frames(state)
    before = np.eye(3)
    for i in range(3):
        expected = moving(lambda t, i=i: link_poses(tree, poses(parts, own + rates * t))[i])  # type: ignore[misc]
        close(state.arms[i].rotation.matrix(), before.T @ expected.rotation)
        close(found[i].rotation, expected.rotation)
        close(found[i].origin, expected.place)
        close(found[i].linear, expected.linear)
        close(found[i].angular, expected.angular)
        before = expected.rotation


def test_a_free_body_on_a_turntable_has_all_terms_of_coriolis() -> None:
    """At constant velocities in its own axes a free body's velocity turns with it."""
    model = lg.Model("turntable", gravity=(0, 0, 0))
    table, ball = (model.body(x, mass=1.0, inertia=(1, 1, 1)) for x in ("table", "ball"))
    model.revolute("hinge", between=("ground", table))
    model.free("flight", between=(table, ball))
    angle, rate, d = 0.4, 1.3, np.array([0.5, -0.2, 0.7])
    turn = np.array([0.1, -0.5, 0.5, 0.7])
    u, w = np.array([0.3, 0.8, -0.6]), np.array([-0.9, 0.4, 1.1])
    state = TreeState(walked(model), [angle, *d, *turn], [rate, *u, *w])
    found = frames(state)[1]
    H, R = turned((0, 0, 1), angle), of_quaternion(turn)
    c = np.array([0, 0, rate])
    velocity, bend = R @ u, R @ np.cross(w, u)
    pull = H @ (bend + 2 * np.cross(c, velocity) + np.cross(c, np.cross(c, d)))
    spin = H @ np.cross(c, R @ w)
    close(found.linear, H @ (velocity + np.cross(c, d)))
    close(found.angular, H @ (c + R @ w))
    close(found.pull, pull)
    close(found.spin, spin)
    back = (H @ R).T
    own = spins(state)[1]
    close(own.linear, back @ pull)
    close(own.angular, back @ spin)


def test_ground_is_a_frame_at_rest() -> None:
    assert GROUND_FRAME.at((1, 2, 3)) == GROUND_FRAME._replace(origin=(1, 2, 3))
