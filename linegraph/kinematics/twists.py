"""How a link's frame stands and moves, seen from ground: pose, Jacobian, velocity, acceleration at v̇ = 0.

The velocity of a frame is that of its origin and its angular velocity, both in ground axes. By the circuit
equations it is the sum of what the joints on the way add:

    w = sum_i s_i v_i        u = sum_i (u_i + s_i x d_i) v_i

with s_i and u_i the joint's angular and linear motion in ground axes, and d_i from its origin to the
frame's. The d_i are summed from the frame inward, so that no two places are ever subtracted. A link that
turns against ground cuts the way: joints before it move its origin, but do not turn it.

The same velocity can be carried along link by link, in the links' own axes or in those of ground. Which way
is the shortest depends on the joints and on what else is asked for, so all are offered and the caller counts.
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
"""Of the origin and angular, in this order, in ground axes: velocities or accelerations."""


class Column(NamedTuple):
    """What a unit of one of a joint's velocities does.

    Attributes:
        freedom: where it comes from in the state; None where the motion is prescribed.
        rate: its value.
        first, second: what it makes of the two vectors that are asked for.
    """

    freedom: Freedom | None
    rate: Scalar
    first: Vector
    second: Vector


class Outlook:
    """All links of a tree at a state, as seen from ground, over any algebra.

    Args:
        state: the links and where they are.
    """

    def __init__(self, state: TreeState) -> None:
        """Nothing is calculated before it is asked for."""
        self.state = state
        self.tree = state.tree
        self.algebra = state.algebra
        self.arms = state.arms

    @cached_property
    def frames(self) -> list[GroundFrame]:
        """Every link's frame in ground axes, accelerations at v̇ = 0."""
        return frames(self.state)

    @cached_property
    def accelerations(self) -> list[Twist]:
        """Of every link the acceleration at v̇ = 0 in its own axes: linear, angular."""
        return [(spin.linear, spin.angular) for spin in spins(self.state, gravity=ZERO)]

    @cached_property
    def velocities(self) -> list[Twist]:
        """Of every link the velocity in its own axes: linear, angular."""
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
        """A link's components to those of ground; -1 is ground."""
        return self.frames[i].rotation if i >= 0 else IDENTITY_MATRIX

    def arm(self, i: int) -> Vector:
        """From the origin of a link's parent to its own."""
        return times(self.rotation(self.tree.links[i].parent), self.arms[i].at)

    def way(self, tip: int) -> Iterator[int]:
        """The links from a tip to ground."""
        while tip >= 0:
            yield tip
            tip = self.tree.links[tip].parent

    def moved(self, i: int) -> Iterator[tuple[Freedom | None, Scalar, Vector, Vector]]:
        """Of each velocity of a joint its freedom, its rate, and linear and angular motion in ground axes."""
        link, arm = self.tree.links[i], self.arms[i]
        freedoms = link.velocities or (None,) * len(arm.rates)
        motion = zip(freedoms, arm.rates, arm.motion.linear, arm.motion.angular, strict=True)
        for freedom, rate, u, s in motion:
            yield freedom, rate, times(self.rotation(i), u), times(self.rotation(i), s)

    def out(self, tip: int, x: Vector) -> Vector:
        """A vector in a link's axes in those of ground, carried from link to link."""
        for i in self.way(tip):
            x = self.arms[i].rotation.out(x)
        return x


def position(view: Outlook, tip: int) -> Vector:
    """Where a frame's origin is, from that of ground."""
    total = ZERO
    for i in view.way(tip):
        set_label(view.algebra, f"place, {view.tree.links[i].caption}")
        total = add(total, view.arm(i))
    return total


def columns(view: Outlook, tip: int) -> list[Column]:
    """What every joint on the way to a frame adds to its velocity, from the root outward."""
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
    """The links from a frame to ground, and from each one's origin the place that its turning moves."""
    lever = ZERO
    for i in view.way(tip):
        yield i, lever
        set_label(view.algebra, f"place, {view.tree.links[i].caption}")
        lever = add(ZERO if view.arms[i].level else lever, view.arm(i))


def matrix(found: Iterable[Column], size: int) -> list[list[Scalar]]:
    """Columns as a matrix (6 x size); joints that share a velocity share a column."""
    rows: list[list[Scalar]] = [[0] * size for _ in range(6)]
    for column in found:
        if column.freedom is None:
            continue
        k, ratio = column.freedom.index, column.freedom.ratio
        for row, entry in zip(rows, (*column.first, *column.second), strict=True):
            row[k] = row[k] + ratio * entry
    return rows


def total(found: Iterable[Column]) -> Twist:
    """The sum of columns times rates, what is prescribed included."""
    first = second = ZERO
    for column in found:
        first = add(first, vector.scale(column.rate, column.first))
        second = add(second, vector.scale(column.rate, column.second))
    return first, second


def velocities(view: Outlook, tip: int) -> list[Twist]:
    """Ways to a frame's velocity: by columns, along in ground axes, along in the links' own axes."""
    frame = view.frames[tip]
    return [
        total(columns(view, tip)),
        (frame.linear, frame.angular),
        *_seen(view, tip, view.velocities[tip]),
    ]


def accelerations(view: Outlook, tip: int) -> list[Twist]:
    """Ways to a frame's acceleration at v̇ = 0: in ground axes, in the links' own, from the columns."""
    frame = view.frames[tip]
    found = [(frame.pull, frame.spin), *_seen(view, tip, view.accelerations[tip])]
    return found if view.tree.levelled else [*found, _by_products(view, tip)]


def _by_products(view: Outlook, tip: int) -> Twist:
    """A frame's acceleration at v̇ = 0 from what each joint adds to its velocity.

    With w_i and σ_i what joint i adds to the velocity and to the angular velocity, and ω_i the sum of σ up to
    it, these are the sums over all joints of

        (ω_i + ω_(i-1)) x w_i        ω_(i-1) x σ_i

    and of what the joints' own motions make of constant v, and what is prescribed.
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
    """A pair of vectors in a link's axes in those of ground: from link to link, or by its rotation."""
    set_label(view.algebra, f"to ground axes, {view.tree.links[tip].caption}")
    rotation = view.rotation(tip)
    first, second = own
    return [
        (view.out(tip, first), view.out(tip, second)),
        (times(rotation, first), times(rotation, second)),
    ]
