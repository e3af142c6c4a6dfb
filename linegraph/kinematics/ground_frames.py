"""Links and their terminals as ground sees them: the circuit equations of position, velocity, acceleration.

Chords, force elements and the inverse scheme compare points of different links, so everything here is
resolved in ground axes and taken from the origin of ground. What no result needs is never computed: over
the DAG it is dead code.
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
    """A frame in motion, in ground axes.

    Attributes:
        rotation: its components to those of ground.
        origin: from the origin of ground.
        angular, linear: its angular velocity and the velocity of its origin.
        spin, pull: its angular acceleration and the acceleration of its origin.
    """

    rotation: Matrix
    origin: Vector
    angular: Vector
    linear: Vector
    spin: Vector
    pull: Vector

    def at(self, place: Vector, axes: Matrix = IDENTITY_MATRIX) -> GroundFrame:
        """A frame fixed in this one."""
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
    """Every link's working frame; with no v̇ given, accelerations are those at v̇ = 0."""
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
        # the relative velocity turns with the near link, and with the far one as its components are
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
    """The frame of a place on a link."""
    link = found[seat.link] if seat.link >= 0 else GROUND_FRAME
    return link.at(seat.at, seat.rotation)


class Pair(NamedTuple):
    """A force and a torque about a point that something exerts on one link, and back on another."""

    force: Vector
    torque: Vector
    point: Vector
    head: int
    tail: int


def along_velocities(
    state: TreeState, found: Sequence[GroundFrame], pair: Pair
) -> Iterator[tuple[Freedom, Scalar]]:
    """What a force and a torque between two links do along each velocity: a column of Hᵀ, projected.

    Both are carried inward; where the two ways meet they cancel, but for torques that have ended in the
    inertia edge of a link that turns against ground.
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
    """A force and a torque about a link's origin along its joint's velocities."""
    motion, rotation = state.arms[link].motion, frame.rotation
    for a, freedom in enumerate(state.tree.links[link].velocities):
        s, u = times(rotation, motion.angular[a]), times(rotation, motion.linear[a])
        yield freedom, freedom.ratio * (dot(s, torque) + dot(u, force))


def _meeting(state: TreeState, head: int, tail: int) -> tuple[int, bool]:
    """The link where the ways of two links to ground meet, and whether a level link lies before it."""
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
    """Head from tail: rotation, and displacement in the tail's axes."""
    inward = vector.transpose(tail.rotation)
    return product(inward, head.rotation), times(inward, subtract(head.origin, tail.origin))


def relative_motion(tail: GroundFrame, head: GroundFrame) -> tuple[Vector, Vector]:
    """Velocity of the head's origin as seen from the tail, and relative angular velocity."""
    carried = cross(tail.angular, subtract(head.origin, tail.origin))
    u = subtract(subtract(head.linear, tail.linear), carried)
    return u, subtract(head.angular, tail.angular)
