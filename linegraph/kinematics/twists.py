"""Pose, Jacobian, velocity and acceleration at v̇ = 0 of a link's frame relative to ground.

The velocity of a frame is that of its origin together with its angular velocity, both in ground axes.
By the circuit equations it is the sum of the contributions of the joints on the way:

    ω = Σ s_i v_i        u = Σ (u_i + s_i x d_i) v_i

with s_i and u_i the joint's unit angular and linear velocity in ground axes, and d_i the vector from
its origin to the frame's. The d_i are summed from the frame inward and are never differences of two
positions, which would lose digits far from ground. A link whose orientation is measured from ground
interrupts the chain: joints before it move its origin, but do not turn it.

The same velocity can be carried from link to link, in the links' own axes or in those of ground. Which
way takes the fewest operations depends on the joints and on the other results, so all are offered, and
`programs.kinematics` counts.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from linegraph.algebra.protocol import set_label
from linegraph.kinematics.accelerations import spins
from linegraph.kinematics.ground_frames import GroundFrame, frames
from linegraph.spatial import vector
from linegraph.spatial.rotation import IDENTITY_MATRIX
from linegraph.spatial.vector import ZERO, Matrix, Vector, add, cross, times

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.state_layout import Freedom
    from linegraph.kinematics.tree_state import TreeState

Twist = tuple[Vector, Vector]
"""Linear, then angular velocity or acceleration of a frame's origin, mostly in ground axes."""


class Column(NamedTuple):
    """The effect of a unit of one velocity on two vectors: a column of a Jacobian of six rows.

    Attributes:
        freedom: the entry of v; None if the motion is prescribed.
        rate: its value (rad/s, m/s).
        first, second: effect on the first and on the second vector, e.g. on linear and angular
            velocity.
    """

    freedom: Freedom | None
    rate: Scalar
    first: Vector
    second: Vector


class Outlook:
    """All links of a tree at a state relative to ground, over any algebra; computed on demand.

    Args:
        state: the tree at (q, v).
    """

    def __init__(self, state: TreeState) -> None:
        """Keep the state; frames and velocities are computed when they are first needed."""
        self.state = state
        self.tree = state.tree
        self.algebra = state.algebra
        self.arms = state.arms

    @cached_property
    def frames(self) -> list[GroundFrame]:
        """The working frame of every link in ground axes, with accelerations at v̇ = 0."""
        return frames(self.state)

    @cached_property
    def accelerations(self) -> list[Twist]:
        """Linear and angular acceleration of every link at v̇ = 0, in its own axes and without gravity."""
        return [(spin.linear, spin.angular) for spin in spins(self.state, gravity=ZERO)]

    @cached_property
    def velocities(self) -> list[Twist]:
        """Linear and angular velocity of every link, of its origin and in its own axes."""
        found: list[Twist] = []
        for link, arm in zip(self.tree.links, self.arms, strict=True):
            set_label(self.algebra, f"velocity, {link.caption}")
            linear, angular = found[link.parent] if link.parent >= 0 else (ZERO, ZERO)
            linear = arm.rotation.into(add(linear, cross(angular, arm.at)))
            linear = add(linear, vector.combine(arm.rates, arm.motion.linear))
            turned = ZERO if arm.level else arm.rotation.into(angular)
            angular = add(turned, vector.combine(arm.rates, arm.motion.angular))
            found.append((linear, angular))
        return found

    def rotation(self, i: int) -> Matrix:
        """Rotation from a link's working axes to those of ground; -1 is ground."""
        return self.frames[i].rotation if i >= 0 else IDENTITY_MATRIX

    def arm(self, i: int) -> Vector:
        """Vector from the origin of a link's parent to the link's own, in ground axes (m)."""
        return times(self.rotation(self.tree.links[i].parent), self.arms[i].at)

    def way(self, tip: int) -> Iterator[int]:
        """The links from a tip to ground, tip first."""
        while tip >= 0:
            yield tip
            tip = self.tree.links[tip].parent

    def moved(self, i: int) -> Iterator[tuple[Freedom | None, Scalar, Vector, Vector]]:
        """For each velocity of a joint: freedom, rate, unit linear and angular velocity in ground axes."""
        link, arm = self.tree.links[i], self.arms[i]
        freedoms = link.velocities or (None,) * len(arm.rates)
        motion = zip(freedoms, arm.rates, arm.motion.linear, arm.motion.angular, strict=True)
        for freedom, rate, u, s in motion:
            yield freedom, rate, times(self.rotation(i), u), times(self.rotation(i), s)

    def out(self, tip: int, x: Vector) -> Vector:
        """A vector turned from a link's axes to those of ground, one link at a time.

        Args:
            tip: the link.
            x: the vector, in the link's working axes.
        """
        for i in self.way(tip):
            x = self.arms[i].rotation.out(x)
        return x


def position(view: Outlook, tip: int) -> Vector:
    """Position of a link's origin, from that of ground and in ground axes (m).

    Args:
        view: the links relative to ground.
        tip: the link.
    """
    total = ZERO
    for i in view.way(tip):
        set_label(view.algebra, f"place, {view.tree.links[i].caption}")
        total = add(total, view.arm(i))
    return total


def columns(view: Outlook, tip: int) -> list[Column]:
    """The Jacobian of a link's origin as columns: one per velocity on the way, root first.

    Args:
        view: the links relative to ground.
        tip: the link.

    Returns:
        Columns whose first vector is linear, whose second angular; both in ground axes.
    """
    found: list[Column] = []
    turning = True
    for i, lever in _levers(view, tip):
        set_label(view.algebra, f"Jacobian, {view.tree.links[i].caption}")
        own = [
            Column(freedom, rate, add(u, cross(s, lever)), s if turning else ZERO)
            for freedom, rate, u, s in view.moved(i)
        ]
        found = own + found
        turning = turning and not view.arms[i].level
    return found


def _levers(view: Outlook, tip: int) -> Iterator[tuple[int, Vector]]:
    """The links from a tip to ground, each with the vector from its origin to the point that it turns."""
    lever = ZERO
    for i in view.way(tip):
        yield i, lever
        set_label(view.algebra, f"place, {view.tree.links[i].caption}")
        lever = add(ZERO if view.arms[i].level else lever, view.arm(i))


def matrix(found: Iterable[Column], size: int) -> list[list[Scalar]]:
    """Columns as a matrix (6 x size); joints that share a velocity share a column.

    Args:
        found: the columns; those of prescribed motions are left out.
        size: the number of velocities.
    """
    rows: list[list[Scalar]] = [[0] * size for _ in range(6)]
    for column in found:
        if column.freedom is None:
            continue
        k, ratio = column.freedom.index, column.freedom.ratio
        for row, entry in zip(rows, (*column.first, *column.second), strict=True):
            row[k] = row[k] + ratio * entry
    return rows


def total(found: Iterable[Column]) -> Twist:
    """The sum of columns times their rates, prescribed motions included."""
    first = second = ZERO
    for column in found:
        first = add(first, vector.scale(column.rate, column.first))
        second = add(second, vector.scale(column.rate, column.second))
    return first, second


def velocities(view: Outlook, tip: int) -> list[Twist]:
    """Alternative formulas for a frame's velocity (m/s, rad/s), all in ground axes and all equal.

    Args:
        view: the links relative to ground.
        tip: the link whose working frame is meant.

    Returns:
        Linear and angular velocity: from the columns, along the chain in ground axes, and along it in
            the links' own axes, turned to ground in two ways.
    """
    frame = view.frames[tip]
    return [
        total(columns(view, tip)),
        (frame.linear, frame.angular),
        *_seen(view, tip, view.velocities[tip]),
    ]


def accelerations(view: Outlook, tip: int) -> list[Twist]:
    """Alternative formulas for a frame's acceleration at v̇ = 0 (m/s², rad/s²), in ground axes.

    Args:
        view: the links relative to ground.
        tip: the link whose working frame is meant.

    Returns:
        Linear and angular acceleration, without gravity: along the chain in ground axes, in the links'
            own axes, and from products of the columns.
    """
    frame = view.frames[tip]
    found = [(frame.pull, frame.spin), *_seen(view, tip, view.accelerations[tip])]
    return found if view.tree.levelled else [*found, _by_products(view, tip)]


def _by_products(view: Outlook, tip: int) -> Twist:
    """A frame's acceleration at v̇ = 0 from the contributions of each joint to its velocity.

    With w_i and σ_i the contributions of joint i to linear and angular velocity, and ω_i the sum of all
    σ up to joint i, it is the sum over all joints of

        (ω_i + ω_(i-1)) x w_i        ω_(i-1) x σ_i

    plus the joints' own accelerations at constant v, and prescribed accelerations.
    """
    linear = angular = turned = ZERO
    for i, lever in reversed(list(_levers(view, tip))):
        link, arm = view.tree.links[i], view.arms[i]
        set_label(view.algebra, f"products of velocities, {link.caption}")
        push = spin = ZERO
        before = turned
        for _, rate, u, s in view.moved(i):
            own = vector.scale(rate, s)
            turned, spin = add(turned, own), add(spin, own)
            push = add(push, vector.scale(rate, add(u, cross(s, lever))))
        bias, pull = arm.motion.angular_bias, arm.motion.linear_bias
        if arm.prescribed:
            bias = add(bias, vector.combine(arm.prescribed, arm.motion.angular))
            pull = add(pull, vector.combine(arm.prescribed, arm.motion.linear))
        bias, pull = (times(view.rotation(i), x) for x in (bias, pull))
        angular = add(angular, add(cross(before, spin), bias))
        linear = add(linear, add(cross(add(turned, before), push), add(pull, cross(bias, lever))))
    return linear, angular


def _seen(view: Outlook, tip: int, own: Twist) -> list[Twist]:
    """A pair of vectors turned from a link's axes to those of ground: link by link, or by its rotation."""
    set_label(view.algebra, f"to ground axes, {view.tree.links[tip].caption}")
    rotation = view.rotation(tip)
    first, second = own
    return [
        (view.out(tip, first), view.out(tip, second)),
        (times(rotation, first), times(rotation, second)),
    ]
