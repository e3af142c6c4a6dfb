"""Links and terminals relative to ground: circuit equations of position, velocity and acceleration.

Chords, force elements and the inverse scheme compare points of different links, so everything here is
resolved in ground axes and measured from the origin of ground. Quantities that no result needs cost
nothing: over the DAG they are dead code.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.algebra.protocol import set_label
from linegraph.kinematics.state_layout import own_rates
from linegraph.spatial import vector
from linegraph.spatial.rotation import IDENTITY_MATRIX, product
from linegraph.spatial.vector import ZERO, Matrix, Vector, add, cross, dot, subtract, times

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.components.constraints.base import Pose
    from linegraph.kinematics.links import Seat
    from linegraph.kinematics.state_layout import Freedom
    from linegraph.kinematics.tree_state import TreeState


class GroundFrame(NamedTuple):
    """A moving frame: pose, velocity and acceleration relative to ground, all in ground axes.

    Attributes:
        rotation: from its components to those of ground (3 x 3).
        origin: from the origin of ground (m).
        angular, linear: its angular velocity (rad/s) and the velocity of its origin (m/s).
        spin, pull: its angular acceleration (rad/s²) and the acceleration of its origin (m/s²), both
            kinematic: gravity is not included.
    """

    rotation: Matrix
    origin: Vector
    angular: Vector
    linear: Vector
    spin: Vector
    pull: Vector

    def at(self, place: Vector, axes: Matrix = IDENTITY_MATRIX) -> GroundFrame:
        """A frame that is fixed in this one.

        Args:
            place: its origin, in the axes of this frame (m).
            axes: from its components to those of this frame.
        """
        arm = times(self.rotation, place)
        sweep = cross(self.angular, arm)
        bend = add(cross(self.spin, arm), cross(self.angular, sweep))
        rotation = self.rotation if axes == IDENTITY_MATRIX else product(self.rotation, axes)
        return GroundFrame(
            rotation,
            add(self.origin, arm),
            self.angular,
            add(self.linear, sweep),
            self.spin,
            add(self.pull, bend),
        )


GROUND_FRAME = GroundFrame(IDENTITY_MATRIX, ZERO, ZERO, ZERO, ZERO, ZERO)


def frames(state: TreeState, acceleration: Iterable[Scalar] | None = None) -> list[GroundFrame]:
    """The working frame of every link, with its motion.

    Args:
        state: the tree at (q, v).
        acceleration: v̇ (rad/s², m/s²); if None, accelerations are those at v̇ = 0.
    """
    a = None if acceleration is None else tuple(acceleration)
    found: list[GroundFrame] = []
    for link, arm in zip(state.tree.links, state.arms, strict=True):
        set_label(state.algebra, f"place in ground, {link.caption}")
        near = found[link.parent] if link.parent >= 0 else GROUND_FRAME
        turning = GROUND_FRAME if arm.level else near
        x, y, z = (arm.rotation.into(row) for row in near.rotation)
        rotation = (x, y, z)
        if link.in_space:
            rotation = arm.motion.rotation.matrix()
        angular = times(rotation, vector.combine(arm.rates, arm.motion.angular))
        linear = times(rotation, vector.combine(arm.rates, arm.motion.linear))
        spin, pull = arm.motion.angular_bias, arm.motion.linear_bias
        own = arm.prescribed
        if a is not None and link.velocities:
            own = own_rates(link.place, a)
        if own:
            spin = add(spin, vector.combine(own, arm.motion.angular))
            pull = add(pull, vector.combine(own, arm.motion.linear))
        spin, pull = times(rotation, spin), times(rotation, pull)
        carried = near.at(arm.at)
        whole = add(turning.angular, angular)
        # Coriolis: u turns with the near link, and its components, given in far axes, with the far link
        coriolis = cross(add(near.angular, whole), linear)
        found.append(
            GroundFrame(
                rotation,
                carried.origin,
                whole,
                add(carried.linear, linear),
                add(turning.spin, add(cross(turning.angular, angular), spin)),
                add(carried.pull, add(coriolis, pull)),
            )
        )
    return found


def seated(found: Sequence[GroundFrame], seat: Seat) -> GroundFrame:
    """The frame at a constant place on a link.

    Args:
        found: the working frames of all links, as `frames` returns them.
        seat: the link, -1 for ground, and the place on it.
    """
    link = found[seat.link] if seat.link >= 0 else GROUND_FRAME
    return link.at(seat.at, seat.rotation)


class Pair(NamedTuple):
    """A force and a torque on one link, with their reaction on another.

    Attributes:
        force: on the head, in ground axes (N); the tail gets the opposite.
        torque: on the head, about `point` (N m); the tail gets the opposite, about the same point.
        point: from the origin of ground (m).
        head: the link that is acted on; -1 for ground.
        tail: the link that the reaction acts on; -1 for ground.
    """

    force: Vector
    torque: Vector
    point: Vector
    head: int
    tail: int


def along_velocities(
    state: TreeState, found: Sequence[GroundFrame], pair: Pair
) -> Iterator[tuple[Freedom, Scalar]]:
    """Generalised forces of a pair of opposite wrenches: Hᵀ restricted to two links, projected.

    Both wrenches are carried inward, and cancel from the link at which the two ways meet. Torques on a
    link whose orientation is measured from ground end there, in its inertia edge, so they do not cancel
    and are carried on.

    Args:
        state: the tree at (q, v).
        found: the working frames of all links in ground axes.
        pair: the two wrenches.

    Returns:
        (freedom, generalised force) for each velocity that is met; one velocity may occur several
            times.
    """
    tree, arms = state.tree, state.arms
    meeting, level = _meeting(state, pair.head, pair.tail)
    rest = ZERO
    for start, sign in ((pair.head, 1), (pair.tail, -1)):
        force = pair.force if sign > 0 else vector.negate(pair.force)
        torque = pair.torque if sign > 0 else vector.negate(pair.torque)
        point, link = pair.point, start
        while link != meeting:
            frame = found[link]
            about = add(torque, cross(subtract(point, frame.origin), force))
            yield from _projected(state, found[link], link, about, force)
            if arms[link].level:
                torque, point = ZERO, frame.origin
            link = tree.links[link].parent
        if level and link >= 0:
            rest = add(rest, add(torque, cross(subtract(point, found[link].origin), force)))
    link = meeting
    while level and link >= 0:
        yield from _projected(state, found[link], link, rest, ZERO)
        rest = ZERO if arms[link].level else rest
        link = tree.links[link].parent


def _projected(
    state: TreeState, frame: GroundFrame, link: int, torque: Vector, force: Vector
) -> Iterator[tuple[Freedom, Scalar]]:
    """Generalised forces along one joint's velocities of a wrench about its link's origin, in ground axes."""
    motion, rotation = state.arms[link].motion, frame.rotation
    for a, freedom in enumerate(state.tree.links[link].velocities):
        s, u = times(rotation, motion.angular[a]), times(rotation, motion.linear[a])
        yield freedom, freedom.ratio * (dot(s, torque) + dot(u, force))


def _meeting(state: TreeState, head: int, tail: int) -> tuple[int, bool]:
    """The link at which the ways of two links to ground meet, and whether a level link lies on either."""
    tree, arms = state.tree, state.arms
    inward = []
    link = head
    while link >= 0:
        inward.append(link)
        link = tree.links[link].parent
    link = tail
    level = False
    while link >= 0 and link not in inward:
        level = level or arms[link].level
        link = tree.links[link].parent
    for other in inward[: inward.index(link)] if link in inward else inward:
        level = level or arms[other].level
    return link, level


def seen(tail: Pose | GroundFrame, head: Pose | GroundFrame) -> tuple[Matrix, Vector]:
    """Pose of the head relative to the tail: the rotation, and the displacement in the tail's axes (m).

    Args:
        tail: rotation and origin in ground axes.
        head: the same.

    Returns:
        The rotation from head components to tail components, and the vector from tail origin to head
            origin.
    """
    inward = vector.transpose(tail.rotation)
    return product(inward, head.rotation), times(inward, subtract(head.origin, tail.origin))


def relative_motion(tail: GroundFrame, head: GroundFrame) -> tuple[Vector, Vector]:
    """Velocity of the head relative to the tail, in ground axes.

    Args:
        tail: the frame in which the motion is observed.
        head: the frame that moves.

    Returns:
        Velocity of the head's origin as observed in the tail frame (m/s), and relative angular velocity
            (rad/s).
    """
    carried = cross(tail.angular, subtract(head.origin, tail.origin))
    u = subtract(subtract(head.linear, tail.linear), carried)
    return u, subtract(head.angular, tail.angular)
