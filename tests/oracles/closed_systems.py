"""Seeded random mechanisms with closed loops, and an oracle of their dynamics that knows no tree.

A system is a plain list of bodies and joints like those of `random_trees`, except that joints may
close loops. It is drawn by placing the frames of all joints in ground first, each pair so that
the joint is satisfied, and the bodies' own frames anywhere after that: whatever is drawn can be
assembled. Beside the kinds of `random_trees` there are

===========  =====================================  ==================  ========================
kind         motion                                 coordinates         velocities
===========  =====================================  ==================  ========================
cylindrical  R = Rot(axis, q1), d = axis q2         angle, distance     rates
universal    R = Rot(axis, q1) Rot(second, q2)      two angles          rates
spherical    R of the quaternion, d = 0             quaternion          spin, in head axes
===========  =====================================  ==================  ========================

with R and d as told there.

The oracle describes each body by the velocity of its mass centre and its angular velocity, both in
ground axes: x (6n,). A joint leaves its head the relative twists S y, so the rows of its constraint
are C^T (relative twist) with C the orthogonal complement of S, and the wrench it transmits is C
lambda beside its own effort. Nothing is chosen: no tree, no cut, no independent coordinates.

The third part, `Chart`, only translates: a state of some spanning tree into motions of bodies.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray
from oracles.newton_euler import aligned, rotation_of_quaternion, skew, turned
from scipy.linalg import null_space
from systems import random_trees as trees
from systems.random_trees import GROUND, Body, random_rotation

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

Array = NDArray[np.float64]

COORDINATES = {
    "fixed": (),
    "revolute": ("",),
    "prismatic": ("",),
    "cylindrical": ("_angle", "_displacement"),
    "universal": ("_angle1", "_angle2"),
    "planar": ("_x", "_y", "_angle"),
    "spherical": ("_qx", "_qy", "_qz", "_qw"),
    "free": ("_x", "_y", "_z", "_qx", "_qy", "_qz", "_qw"),
}
VELOCITIES = COORDINATES | {
    "planar": ("_vx", "_vy", "_wz"),
    "spherical": ("_wx", "_wy", "_wz"),
    "free": ("_vx", "_vy", "_vz", "_wx", "_wy", "_wz"),
}
"""What linegraph appends to a joint's name."""

WRENCH = ("_fx", "_fy", "_fz", "_tx", "_ty", "_tz")

RANK = 1e-7
"""Singular values of the constraints below this part of the largest count as zero."""

SPREAD = 80.0
"""Largest over smallest singular value of the constraints of a system as drawn."""

ATTEMPTS = 500


@dataclass(frozen=True, eq=False)
class Joint(trees.Joint):
    """A joint, possibly with a second axis, possibly driven.

    Attributes:
        second: (3,) second axis of a universal joint, in head frame axes.
        effort: Whether it has an effort along each of its velocities.
    """

    second: Array = field(default_factory=lambda: np.array([0.0, 1.0, 0.0]))
    effort: bool = False

    @property
    def freedoms(self) -> int:
        """The number of its velocities."""
        return len(VELOCITIES[self.kind])

    @property
    def coordinate_names(self) -> list[str]:
        """Its coordinates as linegraph calls them."""
        return [self.name + ending for ending in COORDINATES[self.kind]]

    @property
    def velocity_names(self) -> list[str]:
        """Its velocities, and its efforts, as linegraph calls them."""
        return [self.name + ending for ending in VELOCITIES[self.kind]]


class Pose(NamedTuple):
    """A frame in ground: rotation (3, 3), ground axes <- frame axes, and origin (3,)."""

    rotation: Array
    origin: Array


@dataclass(frozen=True, eq=False)
class System:
    """Bodies and joints that hold together.

    Attributes:
        family: What kind of mechanism this is, for messages.
        bodies: Bodies in any order, which is that of x.
        joints: Joints in any order, which is that of efforts.
        gravity: (3,) acceleration of gravity, in ground axes.
        assembled: Poses of the bodies, and of ground, that satisfy all joints.
    """

    family: str
    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    gravity: Array
    assembled: Mapping[str, Pose] = field(default_factory=dict)

    @property
    def places(self) -> dict[str, slice]:
        """Place in x of each body."""
        return {body.name: slice(6 * k, 6 * k + 6) for k, body in enumerate(self.bodies)}

    @property
    def effort_names(self) -> list[str]:
        """The efforts in order."""
        return [name for joint in self.joints if joint.effort for name in joint.velocity_names]

    def efforts_of(self, u: Array) -> dict[str, Array]:
        """The efforts of each joint, zeros where it has none."""
        given = dict(zip(self.effort_names, u, strict=True))
        return {
            joint.name: np.array([given.get(name, 0.0) for name in joint.velocity_names])
            for joint in self.joints
        }


def cross(a: Array, b: Array) -> Array:
    """The product a x b, in a fraction of the time numpy takes for one pair."""
    product: Array = skew(a) @ b
    return product


# ---- what a joint allows ----


def relative_pose(joint: Joint, q: Array) -> tuple[Array, Array]:
    """Rotation (3, 3), tail <- head, and head origin (3,) in tail axes; q of the joint alone."""
    if joint.kind == "revolute":
        return turned(joint.axis, q[0]), np.zeros(3)
    if joint.kind == "prismatic":
        return np.eye(3), joint.axis * q[0]
    if joint.kind == "cylindrical":
        return turned(joint.axis, q[0]), joint.axis * q[1]
    if joint.kind == "universal":
        return turned(joint.axis, q[0]) @ turned(joint.second, q[1]), np.zeros(3)
    if joint.kind == "planar":
        return turned(joint.axis, q[2]), aligned(joint.axis)[:, :2] @ q[:2]
    if joint.kind == "spherical":
        return rotation_of_quaternion(q), np.zeros(3)
    if joint.kind == "free":
        return rotation_of_quaternion(q[3:]), q[:3]
    return np.eye(3), np.zeros(3)


def free_twists(joint: Joint, tail: Array, head: Array) -> Array:
    """Relative twist (6, f) of the head per unit of each velocity, in ground axes.

    The first three rows are the velocity of the head origin against the tail, the last three the
    relative angular velocity. `tail` and `head` (3, 3) turn frame axes into ground axes.
    """
    axis, none = (tail @ joint.axis)[:, None], np.zeros((3, 3))
    turn, slide = np.vstack([none[:, :1], axis]), np.vstack([axis, none[:, :1]])
    if joint.kind == "revolute":
        return turn
    if joint.kind == "prismatic":
        return slide
    if joint.kind == "cylindrical":
        return np.hstack([turn, slide])
    if joint.kind == "universal":
        second = np.vstack([none[:, :1], (head @ joint.second)[:, None]])
        return np.hstack([turn, second])
    if joint.kind == "planar":
        plane = head @ aligned(joint.axis)[:, :2]
        return np.hstack([np.vstack([plane, none[:, :2]]), turn])
    if joint.kind == "spherical":
        return np.vstack([none, head])
    if joint.kind == "free":
        return np.vstack([np.hstack([head, none]), np.hstack([none, head])])
    return np.zeros((6, 0))


def drift(joint: Joint, twists: Array, y: Array, tail_spin: Array, head_spin: Array) -> Array:
    """Derivative (6,) of the relative twist where the velocities y stay: the twists turn.

    Those of planar, spherical and free joints turn with the head, the second one of a universal
    joint too, all others with the tail.
    """
    spins = [tail_spin] * joint.freedoms
    if joint.kind in ("planar", "spherical", "free"):
        spins = [head_spin] * joint.freedoms
    if joint.kind == "universal":
        spins = [tail_spin, head_spin]
    total = np.zeros(6)
    for spin, twist, rate in zip(spins, twists.T, y, strict=True):
        total += rate * np.concatenate([cross(spin, twist[:3]), cross(spin, twist[3:])])
    return total


def gap(joint: Joint, tail: Pose, head: Pose) -> Array:
    """What is zero where the joint is satisfied by these poses of its frames, and smooth around."""
    rotation = tail.rotation.T @ head.rotation
    d = tail.rotation.T @ (head.origin - tail.origin)
    across = d - joint.axis * (joint.axis @ d)
    tilt = rotation @ joint.axis - joint.axis
    twist = (rotation - np.eye(3)).ravel()
    crossing = joint.axis @ rotation @ joint.second - joint.axis @ joint.second
    gaps: dict[str, tuple[Array, ...]] = {
        "fixed": (d, twist),
        "revolute": (d, tilt),
        "prismatic": (across, twist),
        "cylindrical": (across, tilt),
        "universal": (d, np.array([crossing])),
        "planar": (np.array([joint.axis @ d]), tilt),
        "spherical": (d,),
        "free": (),
    }
    return np.concatenate([np.zeros(0), *gaps[joint.kind]])


def rates_of(joint: Joint, q: Array, v: Array) -> Array:
    """Derivative of the coordinates of one joint."""
    if joint.kind == "planar":
        plane = turned(np.array([0.0, 0.0, 1.0]), q[2])[:2, :2]
        return np.append(plane @ v[:2], v[2])
    if joint.kind == "spherical":
        vector, scalar = q[:3], q[3]
        return np.append(scalar * v + cross(vector, v), -vector @ v) / 2
    if joint.kind == "free":
        ball = replace(joint, kind="spherical")
        return np.append(rotation_of_quaternion(q[3:]) @ v[:3], rates_of(ball, q[3:], v[3:]))
    return v


# ---- motions of bodies and of frames fixed on them ----


@dataclass(frozen=True, eq=False)
class Motion:
    """Motion of a frame in ground, in ground axes.

    Attributes:
        rotation: (3, 3) rotation, ground axes <- frame axes.
        origin: (3,) origin of the frame.
        velocity, acceleration: (3,) of the origin.
        spin, spin_rate: (3,) angular velocity and angular acceleration.
    """

    rotation: Array
    origin: Array
    velocity: Array
    spin: Array
    acceleration: Array
    spin_rate: Array


def at_rest(pose: Pose) -> Motion:
    """A frame that does not move."""
    return Motion(pose.rotation, pose.origin, *np.zeros((4, 3)))


def carried(motion: Motion, at: Array, rotation: Array) -> Motion:
    """Motion of a frame fixed in another at the place `at` (3,), its axes turned by `rotation`."""
    arm = motion.rotation @ at
    sweep = cross(motion.spin, arm)
    return Motion(
        motion.rotation @ rotation,
        motion.origin + arm,
        motion.velocity + sweep,
        motion.spin,
        motion.acceleration + cross(motion.spin_rate, arm) + cross(motion.spin, sweep),
        motion.spin_rate,
    )


def centers(system: System, motions: Mapping[str, Motion]) -> list[Motion]:
    """Motion of the mass centre of each body."""
    return [carried(motions[b.name], b.mass_center, np.eye(3)) for b in system.bodies]


def velocities(system: System, motions: Mapping[str, Motion]) -> Array:
    """The velocities x (6n,) of the oracle."""
    return np.concatenate([np.append(c.velocity, c.spin) for c in centers(system, motions)])


def accelerations(system: System, motions: Mapping[str, Motion]) -> Array:
    """Their derivatives (6n,)."""
    found = [np.append(c.acceleration, c.spin_rate) for c in centers(system, motions)]
    return np.concatenate(found)


def moving(system: System, poses: Mapping[str, Pose], x: Array) -> dict[str, Motion]:
    """The bodies in these poses with the velocities x; accelerations are left at zero."""
    motions = {GROUND: at_rest(Pose(np.eye(3), np.zeros(3)))}
    for body in system.bodies:
        velocity, spin = x[system.places[body.name]].reshape(2, 3)
        rotation, origin = poses[body.name]
        velocity = velocity - cross(spin, rotation @ body.mass_center)
        motions[body.name] = replace(at_rest(Pose(rotation, origin)), velocity=velocity, spin=spin)
    return motions


def frames(joint: Joint, motions: Mapping[str, Motion]) -> tuple[Motion, Motion]:
    """Motions of the joint's tail frame and head frame, each carried by its own body."""
    tail = carried(motions[joint.tail], joint.tail_at, joint.tail_rotation)
    head = carried(motions[joint.head], joint.head_at, joint.head_rotation)
    return tail, head


def gaps(system: System, motions: Mapping[str, Motion]) -> Array:
    """The gaps of all joints, one after the other."""
    found = [np.zeros(0)]
    for joint in system.joints:
        tail, head = frames(joint, motions)
        ends = Pose(tail.rotation, tail.origin), Pose(head.rotation, head.origin)
        found.append(gap(joint, *ends))
    return np.concatenate(found)


# ---- the oracle ----


@dataclass(frozen=True, eq=False)
class Rows:
    """The constraints of one joint on x: `matrix` x = 0, `matrix` x' = `right`.

    Attributes:
        twists: (6, f) free relative twists.
        complement: (6, 6 - f) directions of reactions, orthonormal.
        relative: (6, 6n) relative twist at the head origin from x.
        matrix: (6 - f, 6n) rows.
        right: (6 - f,) right-hand side.
        rates: (f,) velocities of the joint.
        turn: (3, 3) ground axes <- head axes.
    """

    twists: Array
    complement: Array
    relative: Array
    matrix: Array
    right: Array
    rates: Array
    turn: Array


@dataclass(frozen=True, eq=False)
class Solution:
    """What the oracle finds at a state.

    Attributes:
        acceleration: (6n,) derivative of x.
        wrenches: For each joint the force and the torque about the head origin (6,) that it exerts
            on its head, in head axes; of all that there may be, the smallest multipliers.
        doubts: For each joint how much each entry of the wrench may vary (6,): zero where unique.
        constraints: (rows, 6n) the matrix.
        rank: Its rank.
        residual: How far the constraints contradict each other: zero at a consistent state.
        condition: Condition number of the matrix whose inverse gives the multipliers.
        margin: Ratio of the smallest singular value that counts to the largest that does not.
    """

    acceleration: Array
    wrenches: dict[str, Array]
    doubts: dict[str, Array]
    constraints: Array
    rank: int
    residual: float
    condition: float
    margin: float

    @property
    def mobility(self) -> int:
        """Freedoms of the mechanism."""
        return self.constraints.shape[1] - self.rank

    @property
    def redundancy(self) -> int:
        """Rows that follow from others."""
        return self.constraints.shape[0] - self.rank


def rows_of(system: System, joint: Joint, motions: Mapping[str, Motion]) -> Rows:
    """The constraint of one joint, at the level of velocities and of accelerations.

    The relative twist t = (v_h - v_t - w_t x (o_h - o_t), w_h - w_t) is S y, hence t' = S y' + S' y;
    the complement of S leaves C^T t' = C^T S' y, and t' = H x' + H' x.
    """
    tail, head = frames(joint, motions)
    twists = free_twists(joint, tail.rotation, head.rotation)
    complement = null_space(twists.T) if joint.freedoms else np.eye(6)
    relative, bias = np.zeros((6, 6 * len(system.bodies))), np.zeros(6)
    x = np.zeros(relative.shape[1])
    for end, sign in ((joint.head, 1), (joint.tail, -1)):
        if end == GROUND:
            continue
        body = next(body for body in system.bodies if body.name == end)
        center = carried(motions[end], body.mass_center, np.eye(3))
        arm = head.origin - center.origin
        # the arm of the head's body turns with it; that of the tail's body ends where the head is
        change = cross(center.spin, arm) if sign > 0 else head.velocity - center.velocity
        bias[:3] += sign * cross(center.spin, change)
        place = system.places[end]
        relative[:, place] += sign * np.block(
            [[np.eye(3), -skew(arm)], [np.zeros((3, 3)), np.eye(3)]]
        )
        x[place] = np.append(center.velocity, center.spin)
    y = np.linalg.lstsq(twists, relative @ x, rcond=None)[0] if joint.freedoms else np.zeros(0)
    turning = drift(joint, twists, y, tail.spin, head.spin)
    right = complement.T @ (turning - bias)
    return Rows(twists, complement, relative, complement.T @ relative, right, y, head.rotation)


def solve(system: System, motions: Mapping[str, Motion], efforts: Mapping[str, Array]) -> Solution:
    """Accelerations and reactions from the equations of all bodies and all joints at once.

    M x' = F + G^T l and G x' = g give, with W = M^(-1/2), A = G W = U D V^T restricted to its rank,
    W^(-1) x' = W F + V D^(-1) U^T (g - G W W F) and l = U D^(-2) U^T (g - G W W F).
    """
    joints = {joint.name: rows_of(system, joint, motions) for joint in system.joints}
    half = _root(system, motions)
    force = _forces(system, motions)
    applied = {name: _effort_wrench(rows, efforts[name]) for name, rows in joints.items()}
    for name, rows in joints.items():
        force += rows.relative.T @ applied[name]
    matrix = np.vstack([rows.matrix for rows in joints.values()])
    right = np.concatenate([rows.right for rows in joints.values()])
    scaled = matrix @ half
    left, values, across = np.linalg.svd(scaled, full_matrices=len(scaled) > len(half))
    rank = int(np.sum(values > RANK * values[0])) if len(values) else 0
    used, dependent = left[:, :rank], left[:, rank:]
    missing = right - matrix @ (half @ (half.T @ force))
    along = (used.T @ missing) / values[:rank]
    acceleration = half @ (half.T @ force + across[:rank].T @ along)
    multipliers = used @ (along / values[:rank])
    wrenches, doubts, start = {}, {}, 0
    for name, rows in joints.items():
        share = slice(start, start := start + len(rows.right))
        turn = np.kron(np.eye(2), rows.turn.T)
        wrenches[name] = turn @ (rows.complement @ multipliers[share] + applied[name])
        doubts[name] = np.linalg.norm(turn @ rows.complement @ dependent[share], axis=1)
    smallest = values[rank - 1] if rank else 1.0
    return Solution(
        acceleration,
        wrenches,
        doubts,
        matrix,
        rank,
        float(np.linalg.norm(dependent.T @ missing)),
        float((values[0] / smallest) ** 2) if rank else 1.0,
        float(smallest / max(np.max(values[rank:], initial=0.0), 1e-300)),
    )


def energy(system: System, motions: Mapping[str, Motion]) -> float:
    """Kinetic energy and that of gravity."""
    total = 0.0
    for body, center in zip(system.bodies, centers(system, motions), strict=True):
        spin = center.rotation.T @ center.spin
        total += body.mass * (center.velocity @ center.velocity / 2)
        total += spin @ body.inertia @ spin / 2 - body.mass * system.gravity @ center.origin
    return float(total)


def shifted(
    system: System, motions: Mapping[str, Motion], rates: Array, time: float
) -> dict[str, Motion]:
    """The bodies after a short time with constant accelerations: exact to the second order."""
    found = {GROUND: motions[GROUND]}
    for body, center in zip(system.bodies, centers(system, motions), strict=True):
        acceleration, spin_rate = rates[system.places[body.name]].reshape(2, 3)
        angle = center.spin * time + spin_rate * time**2 / 2
        size = float(np.linalg.norm(angle))
        rotation = turned(angle / size, size) @ center.rotation if size else center.rotation
        origin = center.origin + center.velocity * time + acceleration * time**2 / 2
        there = Motion(
            rotation,
            origin,
            center.velocity + acceleration * time,
            center.spin + spin_rate * time,
            *np.zeros((2, 3)),
        )
        found[body.name] = carried(there, -body.mass_center, np.eye(3))
    return found


def _root(system: System, motions: Mapping[str, Motion]) -> Array:
    """W (6n, 6n) with W W^T the inverse of the mass matrix."""
    root = np.zeros((6 * len(system.bodies),) * 2)
    for body in system.bodies:
        place, rotation = system.places[body.name], motions[body.name].rotation
        start = place.start
        root[start : start + 3, start : start + 3] = np.eye(3) / np.sqrt(body.mass)
        moments, axes = np.linalg.eigh(body.inertia)
        root[start + 3 : place.stop, start + 3 : place.stop] = rotation @ axes / np.sqrt(moments)
    return root


def _forces(system: System, motions: Mapping[str, Motion]) -> Array:
    """F (6n,): weights and gyroscopic torques."""
    found = []
    for body in system.bodies:
        motion = motions[body.name]
        inertia = motion.rotation @ body.inertia @ motion.rotation.T
        found += [body.mass * system.gravity, -cross(motion.spin, inertia @ motion.spin)]
    return np.concatenate(found)


def _effort_wrench(rows: Rows, effort: Array) -> Array:
    """A wrench (6,) on the head whose power along each free twist is that of the effort."""
    wrench: Array = np.linalg.pinv(rows.twists).T @ effort if len(effort) else np.zeros(6)
    return wrench


# ---- from the states of a spanning tree to motions of bodies ----


@dataclass(frozen=True, eq=False)
class Chart:
    """The coordinates of some spanning tree.

    Attributes:
        system: The mechanism.
        links: Its branches, each after those between it and ground, and whether it points outward.
        q, v: Places of the coordinates and of the velocities of each branch.
    """

    system: System
    links: tuple[tuple[Joint, bool], ...]
    q: dict[str, list[int]]
    v: dict[str, list[int]]

    @property
    def nv(self) -> int:
        """The number of velocities."""
        return sum(map(len, self.v.values()))

    def motions(self, q: Array, v: Array, a: Array) -> dict[str, Motion]:
        """Motion of the body frames, and of ground, where v' = a."""
        motions = {GROUND: at_rest(Pose(np.eye(3), np.zeros(3)))}
        for joint, outward in self.links:
            places = self.v[joint.name]
            tail, head = (joint.tail_at, joint.tail_rotation), (joint.head_at, joint.head_rotation)
            near, far = (tail, head) if outward else (head, tail)
            ends = (joint.tail, joint.head) if outward else (joint.head, joint.tail)
            frame = carried(motions[ends[0]], *near)
            frame = _across(joint, frame, q[self.q[joint.name]], v[places], a[places], outward)
            motions[ends[1]] = carried(frame, -far[1].T @ far[0], far[1].T)
        return motions

    def jacobian(self, q: Array) -> Array:
        """Matrix (6n, nv) from the velocities of the tree to x."""
        none = np.zeros(self.nv)
        columns = [velocities(self.system, self.motions(q, unit, none)) for unit in np.eye(self.nv)]
        return np.array(columns).reshape(self.nv, -1).T

    def rates(self, q: Array, v: Array) -> Array:
        """Derivative of the coordinates."""
        found = np.zeros(len(q))
        for joint, _ in self.links:
            at = self.q[joint.name]
            found[at] = rates_of(joint, q[at], v[self.v[joint.name]])
        return found

    def advance(self, q: Array, v: Array, a: Array, time: float) -> tuple[Array, Array]:
        """State after `time` on the path where v' = a is constant, by one Runge-Kutta step."""
        middle, final = v + time / 2 * a, v + time * a
        k1 = self.rates(q, v)
        k2 = self.rates(q + time / 2 * k1, middle)
        k3 = self.rates(q + time / 2 * k2, middle)
        k4 = self.rates(q + time * k3, final)
        return self.normalised(q + time / 6 * (k1 + 2 * k2 + 2 * k3 + k4)), final

    def normalised(self, q: Array) -> Array:
        """The coordinates with quaternions of length 1."""
        q = q.copy()
        for joint, _ in self.links:
            if joint.kind in ("spherical", "free"):
                at = self.q[joint.name][-4:]
                q[at] /= np.linalg.norm(q[at])
        return q


def chart(system: System, q_names: Sequence[str], v_names: Sequence[str]) -> Chart:
    """The chart of the tree whose coordinates have these names.

    Fixed joints have none: they are taken where the others leave bodies apart.

    Raises:
        ValueError: The names do not describe a spanning tree of the system.
    """
    named = [j for j in system.joints if j.freedoms and set(j.coordinate_names) <= set(q_names)]
    fixed = [j for j in system.joints if j.kind == "fixed"]
    branches = _spanning(system, [*named, *fixed])
    if not set(named) <= set(branches):
        raise ValueError("the coordinates are those of joints that close a loop")
    if len(branches) < len(system.bodies):
        raise ValueError("the coordinates leave some body apart")
    q, v = ({name: k for k, name in enumerate(names)} for names in (q_names, v_names))
    return Chart(
        system,
        _outward(branches),
        {joint.name: [q[name] for name in joint.coordinate_names] for joint in branches},
        {joint.name: [v[name] for name in joint.velocity_names] for joint in branches},
    )


def random_branches(system: System, rng: np.random.Generator) -> tuple[str, ...]:
    """The names of the joints of some spanning tree; free joints are always among them."""
    order = [system.joints[k] for k in rng.permutation(len(system.joints))]
    order.sort(key=lambda joint: joint.kind != "free")
    return tuple(joint.name for joint in _spanning(system, order))


def _spanning(system: System, joints: Sequence[Joint]) -> list[Joint]:
    """Those of the joints that close no loop with earlier ones."""
    group = {name: name for name in (GROUND, *(body.name for body in system.bodies))}
    branches = []
    for joint in joints:
        near, far = group[joint.tail], group[joint.head]
        if near != far:
            branches.append(joint)
            group = {name: near if there == far else there for name, there in group.items()}
    return branches


def _outward(branches: Sequence[Joint]) -> tuple[tuple[Joint, bool], ...]:
    """The joints of a tree directed away from ground, each after those between it and ground."""
    links: list[tuple[Joint, bool]] = []
    reached, waiting = {GROUND}, list(branches)
    while waiting:
        joint = next(j for j in waiting if {j.tail, j.head} & reached)
        links.append((joint, joint.tail in reached))
        reached |= {joint.tail, joint.head}
        waiting.remove(joint)
    return tuple(links)


def _across(joint: Joint, near: Motion, q: Array, v: Array, a: Array, outward: bool) -> Motion:
    """Motion of the far frame of a joint from that of its near frame.

    The head is the tail moved by the relative pose: o_h = o_t + d, v_h = v_t + w_t x d + u and
    v_h' = v_t' + w_t' x d + w_t x (v_h - v_t) + u', with (u, w) = S v the relative twist.
    """
    rotation, d = relative_pose(joint, q)
    tail = near.rotation if outward else near.rotation @ rotation.T
    head = tail @ rotation
    arm, twists = tail @ d, free_twists(joint, tail, head)
    twist = twists @ v
    tail_spin = near.spin if outward else near.spin - twist[3:]
    rate = twists @ a + drift(joint, twists, v, tail_spin, tail_spin + twist[3:])
    tail_spin_rate = near.spin_rate if outward else near.spin_rate - rate[3:]
    step = cross(tail_spin, arm) + twist[:3]
    change = cross(tail_spin_rate, arm) + cross(tail_spin, step) + rate[:3]
    sign = 1 if outward else -1
    return Motion(
        head if outward else tail,
        near.origin + sign * arm,
        near.velocity + sign * step,
        near.spin + sign * twist[3:],
        near.acceleration + sign * change,
        near.spin_rate + sign * rate[3:],
    )


# ---- random systems ----


class Step(NamedTuple):
    """A joint to be placed: its kind, a point it goes through, and its first axis, in ground."""

    kind: str
    at: Array
    axis: Array


class Sketch:
    """A system being drawn: joints whose frames stand in ground, between bodies still without axes.

    Attributes:
        rng: Source of all randomness.
        root: What stands still, or floats.
        bodies: Names of the bodies.
        joints: Joints whose frames are given in ground instead of in their bodies.
    """

    def __init__(self, rng: np.random.Generator, floating: bool) -> None:
        """Start with ground, and with a floating body if the mechanism is to hang on one."""
        self.rng = rng
        self.root = GROUND
        self.bodies: list[str] = []
        self.joints: list[Joint] = []
        if floating:
            self.root = self.new_body()
            self.connect(Step("free", rng.normal(size=3), direction(rng)), GROUND, self.root)

    def new_body(self) -> str:
        """Add a body."""
        self.bodies.append(f"b{len(self.bodies) + 1}")
        return self.bodies[-1]

    def connect(self, step: Step, one: str, other: str) -> None:
        """Place a joint at random coordinates, with its head on either body."""
        tail, head = (one, other) if self.rng.random() < 0.5 else (other, one)
        plain = self.rng.random() < 0.5
        rotation = random_rotation(self.rng)
        if plain:
            rotation = rotation @ aligned(rotation.T @ step.axis)
        axis = np.array([0.0, 0.0, 1.0]) if plain else rotation.T @ step.axis
        name = f"j{len(self.joints) + 1}"
        effort = step.kind not in ("fixed", "free") and self.rng.random() < 0.5
        second = self.second_axis(axis)
        joint = Joint(
            name, step.kind, tail, head, step.at, rotation, step.at, rotation, axis, second, effort
        )
        turn, shift = relative_pose(joint, self.coordinates(step.kind))
        at, there = step.at + rotation @ shift, rotation @ turn
        self.joints.append(replace(joint, head_at=at, head_rotation=there))

    def second_axis(self, axis: Array) -> Array:
        """An axis not nearly parallel to the first, half of the time normal to it."""
        while True:
            second = direction(self.rng)
            if self.rng.random() < 0.5:
                second = aligned(axis) @ np.array([1.0, 0.0, 0.0])
            if abs(axis @ second) < 0.8:
                return second

    def coordinates(self, kind: str) -> Array:
        """Coordinates of a joint of this kind: moderate distances, any angle."""
        angle = self.rng.uniform(-np.pi, np.pi, size=2)
        distance = self.rng.normal(scale=0.4, size=3)
        quaternion = self.rng.normal(size=4)
        quaternion /= np.linalg.norm(quaternion)
        drawn = {
            "revolute": angle[:1],
            "prismatic": distance[:1],
            "cylindrical": np.array([angle[0], distance[0]]),
            "universal": angle,
            "planar": np.append(distance[:2], angle[0]),
            "spherical": quaternion,
            "free": np.append(distance, quaternion),
        }
        return drawn.get(kind, np.zeros(0))

    def chain(self, one: str, other: str, steps: Sequence[Step]) -> list[str]:
        """Connect two bodies by joints in a row, with new bodies in between."""
        new = [self.new_body() for _ in steps[1:]]
        for step, near, far in zip(steps, [one, *new], [*new, other], strict=True):
            self.connect(step, near, far)
        return new

    def two_bodies(self) -> tuple[str, str]:
        """Two different bodies, one of which may be what the mechanism stands on."""
        nodes = [self.root, *(name for name in self.bodies if name != self.root)]
        one, other = self.rng.choice(nodes, size=2, replace=False)
        return str(one), str(other)

    def hang_trees(self) -> None:
        """Add a few bodies that close no loop."""
        kinds = ("fixed", "revolute", "prismatic", "universal", "spherical", "planar")
        for _ in range(self.rng.integers(1, 4)):
            carrier = self.two_bodies()[0]
            kind = str(self.rng.choice(kinds))
            step = Step(kind, self.rng.normal(size=3), direction(self.rng))
            self.connect(step, carrier, self.new_body())

    def finished(self, family: str) -> System:
        """Draw the bodies, and give the frames of the joints in their axes."""
        poses = {name: self.body_pose(name) for name in self.bodies}
        poses[GROUND] = Pose(np.eye(3), np.zeros(3))
        joints = [_in_bodies(joint, poses) for joint in self.joints]
        bodies = [_body(self.rng, name) for name in self.bodies]
        return System(
            family,
            tuple(bodies[k] for k in self.rng.permutation(len(bodies))),
            tuple(joints[k] for k in self.rng.permutation(len(joints))),
            9.81 * direction(self.rng),
            poses,
        )

    def body_pose(self, name: str) -> Pose:
        """Any pose near those of the body's joints, one time in three that of one of them."""
        heads = [Pose(j.head_rotation, j.head_at) for j in self.joints if j.head == name]
        tails = [Pose(j.tail_rotation, j.tail_at) for j in self.joints if j.tail == name]
        poses = heads + tails
        chosen = poses[int(self.rng.integers(len(poses)))]
        if self.rng.random() < 1 / 3:
            return chosen
        shift = self.rng.normal(scale=0.3, size=3)
        return Pose(random_rotation(self.rng), chosen.origin + shift)


def random_system(seed: int) -> System:
    """The system of this number; twenty in a row are of all families.

    Raises:
        ValueError: No system drawn was regular.
    """
    rng = np.random.default_rng([seed, 20260727])
    family, draw = FAMILIES[seed % len(FAMILIES)]
    for _ in range(ATTEMPTS):
        sketch = Sketch(rng, rng.random() < 0.08)
        draw(sketch, seed // len(FAMILIES))
        if rng.random() < 0.3:
            sketch.hang_trees()
        system = sketch.finished(family)
        if _is_regular(system):
            return system
    raise ValueError(f"no regular system of the family {family}")


def direction(rng: np.random.Generator) -> Array:
    """A (3,) unit vector, uniform on the sphere."""
    vector = rng.normal(size=3)
    return np.asarray(vector / np.linalg.norm(vector), dtype=float)


def _in_bodies(joint: Joint, poses: Mapping[str, Pose]) -> Joint:
    """The joint with its frames, given in ground, in the axes of its bodies."""
    tail, head = poses[joint.tail], poses[joint.head]
    return replace(
        joint,
        tail_at=tail.rotation.T @ (joint.tail_at - tail.origin),
        tail_rotation=tail.rotation.T @ joint.tail_rotation,
        head_at=head.rotation.T @ (joint.head_at - head.origin),
        head_rotation=head.rotation.T @ joint.head_rotation,
    )


def _body(rng: np.random.Generator, name: str) -> Body:
    """A body with the inertia of a cloud of points, hence a valid one."""
    mass = rng.uniform(0.5, 3.0)
    points = rng.normal(scale=0.4, size=(6, 3))
    points -= points.mean(axis=0)
    moments = mass / 6 * points.T @ points
    inertia = np.trace(moments) * np.eye(3) - moments
    return Body(name, mass, rng.normal(scale=0.3, size=3), inertia)


def _is_regular(system: System) -> bool:
    """Whether it moves, and far from a configuration where it could move in another way."""
    still = moving(system, system.assembled, np.zeros(6 * len(system.bodies)))
    matrix = np.vstack([rows_of(system, joint, still).matrix for joint in system.joints])
    values = np.linalg.svd(matrix @ _root(system, still), compute_uv=False)
    rank = int(np.sum(values > RANK * values[0]))
    spread = values[0] / values[rank - 1]
    return rank < matrix.shape[1] and bool(spread < SPREAD)


def _polygon(rng: np.random.Generator, normal: Array, count: int) -> list[Array]:
    """Points around a bent polygon normal to `normal`, each off its plane by some distance."""
    axes = aligned(normal) @ turned(np.array([0.0, 0.0, 1.0]), rng.uniform(-np.pi, np.pi))
    angles = 2 * np.pi * np.arange(count) / count + rng.uniform(-0.3, 0.3, size=count)
    radii = rng.uniform(0.4, 1.2, size=count)
    flat = np.array([radii * np.cos(angles), radii * np.sin(angles), rng.normal(size=count) / 2])
    center = rng.normal(scale=0.5, size=3)
    return [center + axes @ point for point in flat.T]


def _planar_steps(
    rng: np.random.Generator, normal: Array, count: int, sliders: int, loose: bool
) -> list[Step]:
    """Joints of a chain that moves in a plane.

    Where `loose`, one hinge becomes a ball and one a universal or a cylindrical joint: the loop
    stays in its plane without being told so twice.
    """
    points = _polygon(rng, normal, count)
    places = [int(k) for k in rng.permutation(count)]
    kinds = dict.fromkeys(places[:sliders], "prismatic")
    if loose:
        kinds[places[sliders]] = "spherical"
        kinds[places[sliders + 1]] = str(rng.choice(["universal", "cylindrical"]))
    steps = []
    for k, at in enumerate(points):
        kind = kinds.get(k, "revolute")
        axis = rng.choice([-1.0, 1.0]) * normal
        if kind == "prismatic":
            axis = aligned(normal) @ np.append(direction_in_plane(rng), 0.0)
        steps.append(Step(kind, at, axis))
    return steps


def direction_in_plane(rng: np.random.Generator) -> Array:
    """A (2,) unit vector."""
    angle = rng.uniform(-np.pi, np.pi)
    return np.array([np.cos(angle), np.sin(angle)])


SPATIAL = (
    *("revolute",) * 8,
    *("universal",) * 4,
    *("spherical",) * 4,
    *("cylindrical",) * 3,
    *("prismatic",) * 2,
    *("planar", "fixed"),
)


def _spatial_steps(rng: np.random.Generator, count: int, least: int, most: int) -> list[Step]:
    """Joints of a chain in space, with so many freedoms in all."""
    while True:
        kinds = [str(kind) for kind in rng.choice(SPATIAL, size=count)]
        if least <= sum(len(VELOCITIES[kind]) for kind in kinds) <= most:
            return [Step(kind, rng.normal(scale=0.7, size=3), direction(rng)) for kind in kinds]


def _planar(loose: bool, sliders: int = 0, chains: int = 0) -> Callable[[Sketch, int], None]:
    """Planar bars about a random direction: a loop of four to eight, and further chains."""

    def draw(sketch: Sketch, turn: int) -> None:
        rng, normal = sketch.rng, direction(sketch.rng)
        count = 4 + turn % 2 if chains else 4 + turn % 5
        slides = min(sliders, 1 + turn % 2, count - 2 * loose - 1)
        steps = _planar_steps(rng, normal, count, slides, loose)
        sketch.chain(sketch.root, sketch.root, steps)
        for _ in range(1 + turn % 2 if chains else 0):
            added = _planar_steps(rng, normal, 3 + int(rng.random() < 0.3), 0, loose)
            sketch.chain(*sketch.two_bodies(), added)

    return draw


def _spatial(chains: int) -> Callable[[Sketch, int], None]:
    """A loop in space, and further chains between its bodies."""

    def draw(sketch: Sketch, turn: int) -> None:
        rng = sketch.rng
        steps = _spatial_steps(rng, int(rng.integers(3, 7)), 7, 9)
        sketch.chain(sketch.root, sketch.root, steps)
        for _ in range(chains):
            added = _spatial_steps(rng, int(rng.integers(2, 5)), 6, 8)
            sketch.chain(*sketch.two_bodies(), added)

    return draw


def _mixed(sketch: Sketch, turn: int) -> None:
    """A planar loop of hinges, twice over constrained, that carries a loop in space."""
    _planar(loose=False)(sketch, turn % 2)
    sketch.chain(*sketch.two_bodies(), _spatial_steps(sketch.rng, 3, 6, 8))


def _special(sketch: Sketch, turn: int) -> None:
    """Mechanisms that move although a count of their joints says otherwise."""
    (_parallelogram, _bennett, _bricard, _sarrus, _spherical_bars)[turn % 5](sketch)


def _parallelogram(sketch: Sketch) -> None:
    """Three equal parallel bars that carry a coupler."""
    rng, normal = sketch.rng, direction(sketch.rng)
    bar = aligned(normal) @ np.append(direction_in_plane(rng), 0.0)
    coupler = sketch.new_body()
    for at in _polygon(rng, normal, 3):
        steps = [Step("revolute", at, normal), Step("revolute", at + bar, normal)]
        sketch.chain(sketch.root, coupler, steps)


def _hinges(sketch: Sketch, lines: Sequence[tuple[Array, Array]]) -> None:
    """A loop of hinges about lines, each a point and a direction."""
    steps = [Step("revolute", at, axis) for at, axis in lines]
    sketch.chain(sketch.root, sketch.root, steps)


def _bennett(sketch: Sketch) -> None:
    """Bennett's four hinges: opposite links alike, twists in the ratio of lengths, no offsets."""
    rng = sketch.rng
    alpha, beta, length, angle = rng.uniform([0.6, 1.6, 0.5, 0.8], [1.2, 2.4, 1.0, 2.2])
    other = length * np.sin(beta) / np.sin(alpha)
    ratio = np.sin((beta + alpha) / 2) / np.sin((beta - alpha) / 2)
    follower = 2 * np.arctan(ratio / np.tan(angle / 2))
    turns = (angle, follower, -angle, -follower)
    x, z = np.eye(3)[0], np.eye(3)[2]
    rotation, at = random_rotation(rng), rng.normal(scale=0.5, size=3)
    lines = []
    for turn, (reach, twist) in zip(turns, [(length, alpha), (other, beta)] * 2, strict=True):
        lines.append((at, rotation @ z))
        rotation = rotation @ turned(z, turn)
        at = at + rotation @ x * reach
        rotation = rotation @ turned(x, twist)
    assert np.allclose(at, lines[0][0])
    _hinges(sketch, lines)


def _bricard(sketch: Sketch) -> None:
    """Bricard's six hinges: three about any lines, three about these after half a turn."""
    rng = sketch.rng
    axis, center = direction(rng), rng.normal(scale=0.3, size=3)
    half = 2 * np.outer(axis, axis) - np.eye(3)
    lines = [(rng.normal(scale=0.7, size=3), direction(rng)) for _ in range(3)]
    lines += [(center + half @ (at - center), half @ along) for at, along in lines]
    _hinges(sketch, lines)


def _sarrus(sketch: Sketch) -> None:
    """Sarrus's six hinges: three about parallel lines, three about others; the link slides."""
    rng = sketch.rng
    lines = []
    for normal in (direction(rng), direction(rng)):
        lines += [(at, normal) for at in _polygon(rng, normal, 3)]
    _hinges(sketch, lines)


def _spherical_bars(sketch: Sketch) -> None:
    """Hinges about lines through one point."""
    rng = sketch.rng
    center = rng.normal(scale=0.5, size=3)
    axes = [direction(rng) for _ in range(int(rng.integers(4, 6)))]
    _hinges(sketch, [(center + rng.normal() * axis, axis) for axis in axes])


FAMILIES: tuple[tuple[str, Callable[[Sketch, int], None]], ...] = (
    *(("planar bars", _planar(loose=True)),) * 4,
    *(("planar bars with sliders", _planar(loose=True, sliders=2)),) * 2,
    *(("spatial loop", _spatial(0)),) * 5,
    *(("two spatial loops", _spatial(1)),) * 2,
    *(("three spatial loops", _spatial(2)),) * 2,
    *(("planar loops", _planar(loose=True, chains=2)),) * 2,
    ("planar bars, all hinges", _planar(loose=False)),
    ("planar and spatial loop", _mixed),
    ("special", _special),
)
"""Twenty families, some of them repeated; the last three are redundant."""
