"""Dynamics of rigid-body trees from the Newton-Euler equations of each body, in ground axes.

The functions take a `random_trees.Tree` and a state: coordinates q (nq,) and velocities
v (nv,), as that module describes them. Everything is derived from the Jacobians of the bodies
and the accelerations left when the derivative of v is zero (the bias accelerations). The aim
is to be plainly right, not fast. Generalised forces are dual to v: their power is tau . v.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Iterator

    from systems.random_trees import Body, Joint, Tree

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Motion:
    """Motion of a frame relative to ground, in ground axes.

    Attributes:
        rotation: (3, 3) rotation, ground axes <- frame axes.
        origin: (3,) origin of the frame.
        linear: (3, nv) Jacobian of the velocity of the origin.
        angular: (3, nv) Jacobian of the angular velocity.
        linear_bias: (3,) acceleration of the origin where v' = 0.
        angular_bias: (3,) angular acceleration where v' = 0.
    """

    rotation: Array
    origin: Array
    linear: Array
    angular: Array
    linear_bias: Array
    angular_bias: Array


@dataclass(frozen=True, eq=False)
class Relative:
    """Motion of the head frame of a joint relative to its tail frame, as seen from the latter.

    Attributes:
        rotation: (3, 3) rotation, tail axes <- head axes.
        arm: (3,) head origin from tail origin.
        linear: (3, nv) Jacobian of the relative velocity of the head origin.
        angular: (3, nv) Jacobian of the relative angular velocity.
    """

    rotation: Array
    arm: Array
    linear: Array
    angular: Array


@dataclass(frozen=True, eq=False)
class Link:
    """A body with the joint that connects it towards ground.

    Attributes:
        joint: The joint.
        near: Name of its end nearer ground, a body or "ground".
        far: Name of the body.
        outward: Whether the far end is the head of the joint.
    """

    joint: Joint
    near: str
    far: str
    outward: bool


def mass_matrix(tree: Tree, q: Array, v: Array) -> Array:
    """Mass matrix (nv, nv)."""
    total = np.zeros((tree.nv, tree.nv))
    for body, center in mass_centers(tree, q, v):
        inertia = _inertia(body, center)
        total += body.mass * center.linear.T @ center.linear
        total += center.angular.T @ inertia @ center.angular
    return total


def bias(tree: Tree, q: Array, v: Array) -> Array:
    """Generalised forces (nv,) that keep v' = 0: velocity products and gravity."""
    total = np.zeros(tree.nv)
    for body, center in mass_centers(tree, q, v):
        inertia, spin = _inertia(body, center), center.angular @ v
        force = body.mass * (center.linear_bias - tree.gravity)
        moment = inertia @ center.angular_bias + np.cross(spin, inertia @ spin)
        total += center.linear.T @ force + center.angular.T @ moment
    return total


def inverse_dynamics(tree: Tree, q: Array, v: Array, a: Array) -> Array:
    """Generalised forces (nv,) for v' = a, from the balance of forces on each subtree.

    The wrench that a joint transmits is what the bodies beyond it need; the generalised force
    is the part of that wrench along the motion of the joint.
    """
    links, motions = outward_links(tree), body_motions(tree, q, v)
    needed = {name: np.zeros((2, 3)) for name in motions}
    for body, center in mass_centers(tree, q, v):
        needed[body.name] += _needed_wrench(body, center, v, a, tree.gravity)
    total = np.zeros(tree.nv)
    for link in reversed(links):
        needed[link.near] += needed[link.far]
        total += _along_joint(tree, link, motions, q, needed[link.far])
    return total


def reactions(tree: Tree, q: Array, v: Array, a: Array) -> dict[str, Array]:
    """What each joint exerts on its head, (2, 3): force, and torque about the head frame's origin, there.

    Everything that the bodies beyond a joint need passes through it.
    """
    links, motions = outward_links(tree), body_motions(tree, q, v)
    needed = {name: np.zeros((2, 3)) for name in motions}
    for body, center in mass_centers(tree, q, v):
        needed[body.name] += _needed_wrench(body, center, v, a, tree.gravity)
    found = {}
    for link in reversed(links):
        needed[link.near] += needed[link.far]
        joint, sign = link.joint, 1.0 if link.outward else -1.0
        frame = carried(motions[joint.head], v, joint.head_at, joint.head_rotation)
        force, moment = sign * needed[link.far]
        torque = moment - np.cross(frame.origin, force)
        found[joint.name] = np.array([force, torque]) @ frame.rotation
    return found


def forward_dynamics(tree: Tree, q: Array, v: Array, tau: Array) -> Array:
    """Accelerations v' (nv,) under the generalised forces tau (nv,)."""
    a = np.linalg.solve(mass_matrix(tree, q, v), tau - bias(tree, q, v))
    return a.astype(np.float64)


def kinetic_energy(tree: Tree, q: Array, v: Array) -> float:
    """Kinetic energy."""
    total = 0.0
    for body, center in mass_centers(tree, q, v):
        velocity, spin = center.linear @ v, center.angular @ v
        twice = body.mass * velocity @ velocity + spin @ _inertia(body, center) @ spin
        total += float(twice) / 2
    return total


def potential_energy(tree: Tree, q: Array) -> float:
    """Energy of gravity, zero for mass centres at the origin of ground."""
    centers = mass_centers(tree, q, np.zeros(tree.nv))
    return float(-sum(body.mass * tree.gravity @ center.origin for body, center in centers))


def coordinate_rates(tree: Tree, q: Array, v: Array) -> Array:
    """Derivative of the coordinates (nq,)."""
    places = zip(tree.coordinate_slices.values(), tree.velocity_slices.values(), strict=True)
    rates = [
        _joint_rates(joint, q[at_q], v[at_v])
        for joint, (at_q, at_v) in zip(tree.active, places, strict=True)
    ]
    return np.concatenate([np.zeros(0), *rates])


def power_balance(tree: Tree, q: Array, v: Array, a: Array, step: float = 1e-3) -> float:
    """Rate of energy less power of the forces, on the path where v' = a; zero but for errors.

    The rate is a central difference of fourth order over steps of time `step`.
    """
    times = step * np.array([-2.0, -1.0, 1.0, 2.0])
    states = [advance(tree, q, v, a, time) for time in times]
    energy = [kinetic_energy(tree, x, y) + potential_energy(tree, x) for x, y in states]
    rate = np.array([1.0, -8.0, 8.0, -1.0]) @ energy / (12 * step)
    return float(rate - inverse_dynamics(tree, q, v, a) @ v)


def advance(tree: Tree, q: Array, v: Array, a: Array, time: float) -> tuple[Array, Array]:
    """State after `time` on the path where v' = a is constant, by one Runge-Kutta step."""
    middle, final = v + time / 2 * a, v + time * a
    k1 = coordinate_rates(tree, q, v)
    k2 = coordinate_rates(tree, q + time / 2 * k1, middle)
    k3 = coordinate_rates(tree, q + time / 2 * k2, middle)
    k4 = coordinate_rates(tree, q + time * k3, final)
    return q + time / 6 * (k1 + 2 * k2 + 2 * k3 + k4), final


def outward_links(tree: Tree) -> list[Link]:
    """The joints, directed away from ground, each after all those between it and ground."""
    links: list[Link] = []
    reached, waiting = {"ground"}, list(tree.joints)
    while waiting:
        found = [_directed(joint, reached) for joint in waiting if _touches(joint, reached)]
        if not found:
            raise ValueError("some bodies are not connected to ground")
        links += found
        reached |= {link.far for link in found}
        waiting = [joint for joint in waiting if not {joint.tail, joint.head} <= reached]
    return links


def body_motions(tree: Tree, q: Array, v: Array) -> dict[str, Motion]:
    """Motion of the body frames, and of ground, by name."""
    motions = {"ground": _at_rest(tree.nv)}
    for link in outward_links(tree):
        joint, relative = link.joint, relative_motion(tree, link.joint, q)
        tail, head = (joint.tail_at, joint.tail_rotation), (joint.head_at, joint.head_rotation)
        near, far = (tail, head) if link.outward else (head, tail)
        near_frame = carried(motions[link.near], v, *near)
        far_frame = _across(near_frame, relative, v, link.outward)
        motions[link.far] = carried(far_frame, v, -far[1].T @ far[0], far[1].T)
    return motions


def mass_centers(tree: Tree, q: Array, v: Array) -> Iterator[tuple[Body, Motion]]:
    """Each body with the motion of its mass centre, in the axes of the body."""
    motions = body_motions(tree, q, v)
    for body in tree.bodies:
        yield body, carried(motions[body.name], v, body.mass_center, np.eye(3))


def relative_motion(tree: Tree, joint: Joint, q: Array) -> Relative:
    """Motion in a joint, in tail axes, under the coordinates (nq,) of the tree."""
    rotation, arm = _pose(joint, _joint_coordinates(tree, joint, q))
    linear, angular = _directions(joint, rotation)
    selection = _selection(tree, joint)
    return Relative(rotation, arm, linear @ selection, angular @ selection)


def carried(motion: Motion, v: Array, at: Array, rotation: Array) -> Motion:
    """Motion of a second frame fixed on the body of a first.

    Args:
        motion: Motion of the first frame.
        v: (nv,) velocities.
        at: (3,) origin of the second frame, in the first.
        rotation: (3, 3) rotation, first frame axes <- second frame axes.
    """
    arm, spin = motion.rotation @ at, motion.angular @ v
    return Motion(
        motion.rotation @ rotation,
        motion.origin + arm,
        motion.linear - skew(arm) @ motion.angular,
        motion.angular,
        motion.linear_bias + _swept(arm, spin, motion.angular_bias),
        motion.angular_bias,
    )


def skew(x: Array) -> Array:
    """Matrix (3, 3) of the product x cross ..."""
    return np.array([[0.0, -x[2], x[1]], [x[2], 0.0, -x[0]], [-x[1], x[0], 0.0]])


def turned(axis: Array, angle: float) -> Array:
    """Rotation matrix (3, 3) by an angle about a unit axis (3,)."""
    cross = skew(axis)
    rotation: Array = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return rotation


def aligned(axis: Array) -> Array:
    """Smallest rotation (3, 3) from z to a unit axis (3,); about x when that is -z."""
    if axis[2] == -1.0:
        return np.diag([1.0, -1.0, -1.0])
    cross = skew(np.cross([0.0, 0.0, 1.0], axis))
    rotation: Array = np.eye(3) + cross + cross @ cross / (1 + axis[2])
    return rotation


def rotation_of_quaternion(quaternion: Array) -> Array:
    """Rotation matrix (3, 3) of a unit quaternion (4,) in the order x, y, z, w."""
    cross = skew(quaternion[:3])
    rotation: Array = np.eye(3) + 2 * quaternion[3] * cross + 2 * cross @ cross
    return rotation


def _at_rest(nv: int) -> Motion:
    """Motion of ground."""
    still = np.zeros((3, nv))
    return Motion(np.eye(3), np.zeros(3), still, still, np.zeros(3), np.zeros(3))


def _swept(arm: Array, spin: Array, angular_acceleration: Array) -> Array:
    """Acceleration (3,) of the end of an arm that turns about its start."""
    return np.cross(angular_acceleration, arm) + np.cross(spin, np.cross(spin, arm))


def _inertia(body: Body, center: Motion) -> Array:
    """Inertia (3, 3) about the mass centre, in ground axes."""
    return center.rotation @ body.inertia @ center.rotation.T


def _touches(joint: Joint, reached: set[str]) -> bool:
    """Whether one end of the joint has been reached from ground."""
    return joint.tail in reached or joint.head in reached


def _directed(joint: Joint, reached: set[str]) -> Link:
    """The joint directed away from its end that has been reached."""
    if joint.tail in reached:
        return Link(joint, joint.tail, joint.head, True)
    return Link(joint, joint.head, joint.tail, False)


def _joint_coordinates(tree: Tree, joint: Joint, q: Array) -> Array:
    """Coordinates of one joint, from the law of its coupling if it has one."""
    for coupling in tree.couplings:
        if coupling.joint == joint.name:
            return coupling.ratio * q[tree.coordinate_slices[coupling.master]] + coupling.offset
    return q[tree.coordinate_slices.get(joint.name, slice(0))]


def _selection(tree: Tree, joint: Joint) -> Array:
    """Matrix (n, nv) from the velocities of the tree to the n of one joint."""
    for coupling in tree.couplings:
        if coupling.joint == joint.name:
            return coupling.ratio * np.eye(tree.nv)[tree.velocity_slices[coupling.master]]
    return np.eye(tree.nv)[tree.velocity_slices.get(joint.name, slice(0))]


def _pose(joint: Joint, q: Array) -> tuple[Array, Array]:
    """Rotation (3, 3), tail <- head, and head origin (3,) in tail axes; q of the joint alone."""
    if joint.kind == "revolute":
        return turned(joint.axis, q[0]), np.zeros(3)
    if joint.kind == "prismatic":
        return np.eye(3), joint.axis * q[0]
    if joint.kind == "planar":
        return turned(joint.axis, q[2]), aligned(joint.axis)[:, :2] @ q[:2]
    if joint.kind == "free":
        return rotation_of_quaternion(q[3:]), q[:3]
    return np.eye(3), np.zeros(3)


def _directions(joint: Joint, rotation: Array) -> tuple[Array, Array]:
    """Linear and angular velocity (3, n) per unit of each velocity of the joint, in tail axes."""
    axis, still = joint.axis[:, None], np.zeros((3, 3))
    if joint.kind == "revolute":
        return still[:, :1], axis
    if joint.kind == "prismatic":
        return axis, still[:, :1]
    if joint.kind == "planar":
        plane = rotation @ aligned(joint.axis)[:, :2]
        return np.hstack([plane, still[:, :1]]), np.hstack([still[:, :2], axis])
    if joint.kind == "free":
        return np.hstack([rotation, still]), np.hstack([still, rotation])
    return still[:, :0], still[:, :0]


def _in_ground(relative: Relative, turn: Array) -> Relative:
    """The relative motion in ground axes; `turn` (3, 3) is ground axes <- tail axes."""
    arm, linear, angular = turn @ relative.arm, turn @ relative.linear, turn @ relative.angular
    return Relative(relative.rotation, arm, linear, angular)


def _across(near: Motion, relative: Relative, v: Array, outward: bool) -> Motion:
    """Motion of the far frame of a joint, from that of its near frame.

    Where the joint points outward the near frame is the tail and the relative motion is
    added; else the near frame is the head and it is subtracted. Seen from the tail frame the
    relative velocity of every kind of joint is constant in head axes where v' = 0, so that its
    derivative is the relative angular velocity cross the relative velocity.
    """
    sign = 1 if outward else -1
    tail_rotation = near.rotation if outward else near.rotation @ relative.rotation.T
    step = _in_ground(relative, tail_rotation)
    slide, turn = step.linear @ v, step.angular @ v
    tail_angular = near.angular if outward else near.angular - step.angular
    spin = tail_angular @ v
    angular_bias = np.cross(spin, turn)
    tail_bias = near.angular_bias if outward else near.angular_bias - angular_bias
    coriolis = 2 * np.cross(spin, slide) + np.cross(turn, slide)
    return Motion(
        tail_rotation @ relative.rotation if outward else tail_rotation,
        near.origin + sign * step.arm,
        near.linear + sign * (step.linear - skew(step.arm) @ tail_angular),
        near.angular + sign * step.angular,
        near.linear_bias + sign * (_swept(step.arm, spin, tail_bias) + coriolis),
        near.angular_bias + sign * angular_bias,
    )


def _needed_wrench(body: Body, center: Motion, v: Array, a: Array, gravity: Array) -> Array:
    """Force and moment about the ground origin, (2, 3), beside gravity, for v' = a."""
    inertia, spin = _inertia(body, center), center.angular @ v
    acceleration = center.linear @ a + center.linear_bias
    angular_acceleration = center.angular @ a + center.angular_bias
    force = body.mass * (acceleration - gravity)
    moment = inertia @ angular_acceleration + np.cross(spin, inertia @ spin)
    return np.array([force, moment + np.cross(center.origin, force)])


def _along_joint(
    tree: Tree, link: Link, motions: dict[str, Motion], q: Array, wrench: Array
) -> Array:
    """Generalised forces (nv,) of the wrench on the far body of a joint.

    The wrench (2, 3) is a force and its moment about the ground origin. The wrench on the head
    is that on the far body, reversed where this is the tail; its power is taken at the head
    origin, whose velocity relative to the tail the joint describes.
    """
    joint = link.joint
    tail, head = motions[joint.tail], motions[joint.head]
    step = _in_ground(relative_motion(tree, joint, q), tail.rotation @ joint.tail_rotation)
    force, moment = wrench if link.outward else -wrench
    moment = moment - np.cross(head.origin + head.rotation @ joint.head_at, force)
    along: Array = step.linear.T @ force + step.angular.T @ moment
    return along


def _joint_rates(joint: Joint, q: Array, v: Array) -> Array:
    """Derivative of the coordinates of one joint, from its own coordinates and velocities."""
    if joint.kind == "planar":
        cosine, sine = np.cos(q[2]), np.sin(q[2])
        return np.array([cosine * v[0] - sine * v[1], sine * v[0] + cosine * v[1], v[2]])
    if joint.kind == "free":
        linear = rotation_of_quaternion(q[3:]) @ v[:3]
        return np.concatenate([linear, _quaternion_rate(q[3:], v[3:])])
    return v


def _quaternion_rate(quaternion: Array, spin: Array) -> Array:
    """Half the product of the quaternion (x, y, z, w) and (spin, 0); spin in head axes."""
    vector, scalar = quaternion[:3], quaternion[3]
    product = scalar * spin + np.cross(vector, spin)
    return np.append(product, -vector @ spin) / 2
