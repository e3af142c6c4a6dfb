"""Reaction directions of joints and constraints as rows: one formula each, over any algebra."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.components.constraints.base import Constraint, Instant, Pose, ReactionRow
from linegraph.components.joints.base import Along, Restriction, Square, Thread, Unturned, Upright
from linegraph.kinematics.ground_frames import seen
from linegraph.spatial.rotation import IDENTITY_MATRIX, product
from linegraph.spatial.vector import ZERO, cross, dot, negate, scale, subtract, times, transpose

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.joints import Joint
    from linegraph.kinematics.links import Closure


def where(restriction: Restriction, joint: Joint) -> str:
    """A reaction direction in words, in the tail's axes if it is numeric; appended to descriptions.

    Args:
        restriction: the direction.
        joint: its alignment gives the joint's axes in the tail's.
    """
    if isinstance(restriction, Along):
        axis = restriction.direction
    elif isinstance(restriction, Upright | Unturned):
        axis = IDENTITY_MATRIX[restriction.axis]
    elif isinstance(restriction, Thread):
        return " along its thread"
    else:
        return " about the common normal of its axes"
    direction = times(joint.alignment(), axis)
    if not all(isinstance(x, (int, float)) for x in direction):
        return ""
    return f" along ({', '.join(f'{float(x):.4g}' for x in direction)}) of its tail frame"


def rows_of(closure: Closure, at: Instant) -> tuple[ReactionRow, ...]:
    """All rows of a chord at an instant, over any algebra.

    Args:
        closure: the joint or constraint.
        at: poses of tail and head in ground axes, prescribed values, and the algebra.

    Returns:
        One row per constraint: residual of position, unit force and torque on the head about its
            origin, and prescribed rate.
    """
    component = closure.component
    if isinstance(component, Constraint):
        return component.rows(at)
    found = [
        _row(restriction, at.algebra, at.tail, at.head) for restriction in closure.restrictions
    ]
    if any(x is not None for x in at.drive):
        found += _driven(component, at)
    return tuple(found)


def _row(restriction: Restriction, algebra: Algebra, tail: Pose, head: Pose) -> ReactionRow:
    """The row of one reaction direction, for given poses of tail and head."""
    line = subtract(head.origin, tail.origin)
    if isinstance(restriction, Along):
        direction = times(tail.rotation, restriction.direction)
        return ReactionRow(dot(direction, line), direction, ZERO)
    if isinstance(restriction, Square):
        a, b = times(tail.rotation, restriction.tail), times(head.rotation, restriction.head)
        position = (dot(a, b) - restriction.cosine) / restriction.sine
        return ReactionRow(position, ZERO, scale(1 / restriction.sine, cross(b, a)))
    if isinstance(restriction, Upright):
        return _upright(restriction.axis, tail, head)
    if isinstance(restriction, Unturned):
        return _unturned(restriction.axis, tail, head)
    assert isinstance(restriction, Thread)
    return _thread(restriction.advance, algebra, tail, head)


def _upright(axis: int, tail: Pose, head: Pose) -> ReactionRow:
    """The head's z must be parallel to the tail's and of the same sense."""
    x, y, z = transpose(tail.rotation)
    leaning = transpose(head.rotation)[2]
    # 2 sin / (1 + cos) = 2 tan(angle / 2): slope 1 at zero and, unlike the sine, no root at half a turn
    lean = -dot(y, leaning) if axis == 0 else dot(x, leaning)
    return ReactionRow(2 * lean / (1 + dot(z, leaning)), ZERO, (x, y)[axis])


def _unturned(axis: int, tail: Pose, head: Pose) -> ReactionRow:
    """No relative rotation: component of the rotation vector of length 2 tan(angle / 2)."""
    a, b = transpose(tail.rotation), transpose(head.rotation)
    j, k = (axis + 1) % 3, (axis + 2) % 3
    # 1 + trace = 2 (1 + cos): as in `_upright`, the sine alone would also vanish at half a turn
    cosines = 1 + (dot(a[0], b[0]) + dot(a[1], b[1]) + dot(a[2], b[2]))
    return ReactionRow(2 * (dot(a[k], b[j]) - dot(a[j], b[k])) / cosines, ZERO, a[axis])


def _thread(advance: Scalar, algebra: Algebra, tail: Pose, head: Pose) -> ReactionRow:
    """A screw; any number of full turns is allowed."""
    axis = times(tail.rotation, (0, 0, 1))
    shift = dot(axis, subtract(head.origin, tail.origin))
    torque = negate(scale(advance, axis))
    turned = product(transpose(tail.rotation), head.rotation)
    angle = algebra.function("atan2", turned[1][0], turned[0][0])
    return ReactionRow(advance * _wrapped(algebra, shift / advance - angle), axis, torque)


def _wrapped(algebra: Algebra, angle: Scalar) -> Scalar:
    """An angle without its full turns."""
    return algebra.function("atan2", algebra.sin(angle), algebra.cos(angle))


def _driven(joint: Joint, at: Instant) -> list[ReactionRow]:
    """Rows that prescribe a chord's own coordinates; full turns of angles do not count."""
    rotation, displacement = seen(at.tail, at.head)
    measured = joint.measured(at.algebra, rotation, displacement)
    duals = joint.duals(at.algebra, rotation, displacement)
    found = []
    for x, (m, f), given, quantity in zip(
        measured, duals, at.drive, joint.positions(), strict=True
    ):
        if given is not None:
            behind = x - given.x
            position = _wrapped(at.algebra, behind) if quantity.unit == "rad" else behind
            force, torque = times(at.head.rotation, f), times(at.head.rotation, m)
            found.append(ReactionRow(position, force, torque, given.dx))
    return found
