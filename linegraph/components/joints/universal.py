"""The universal joint: rotations about two crossing axes, one fixed in the tail and one in the head."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

from linegraph.components.joints.base import NO_SHIFT, Joint, Restriction, Square
from linegraph.components.joints.composition import (
    common_axes,
    direction,
    hinges,
    parallel,
    reciprocal,
    seen,
    turns,
)
from linegraph.components.joints.look import Look
from linegraph.errors import ModelError
from linegraph.ir.program import Quantity
from linegraph.spatial.inertia import Moments, point_apart
from linegraph.spatial.vector import ZERO, cross, dot, scale, subtract, times, transpose

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.spatial.motion import Motion
    from linegraph.spatial.rotation import Rotation
    from linegraph.spatial.vector import Matrix, Vector


@dataclass(frozen=True)
class Universal(Joint):
    """A cardan (Hooke) joint: the head turns about an axis that itself turns about one of the tail.

    q = (angle1, angle2) (rad), v their rates (rad/s). The first axis is fixed in the tail frame, the second
    in the head frame; both are given in the frames at q = 0, where these coincide. With a1, a2
    the axes, R = turn(a1, q1) turn(a2, q2), d = 0, ``w = turn(a2, q2)^T a1 v1 + a2 v2`` in head axes. The
    efforts are torques about the two axes (N m).

    Attributes:
        axes: the two directions; they need not be normal to each other but must not be parallel.

    Example:
        >>> cross = Universal("cross", ("shaft.end", "shaft2"), axes=((1, 0, 0), (0, 1, 0)))
        >>> [c.name for c in cross.positions()]
        ['cross_angle1', 'cross_angle2']
    """

    axes: tuple[Vector, Vector] = ((1, 0, 0), (0, 1, 0))
    kind = "universal"
    look = Look("universal", directed=False)
    freedoms = 2

    def __post_init__(self) -> None:
        """Refuse axes that are not two, have no length, or are parallel, with a `ModelError`."""
        who = f'joint "{self.name}"'
        if len(self.axes) != 2:
            raise ModelError(who, f"two axes are needed, got {len(self.axes)}")
        if parallel(*self._directions):
            raise ModelError(who, "the axes are parallel; give two different directions")

    @cached_property
    def _directions(self) -> tuple[Vector, Vector]:
        """The axes scaled to length 1."""
        first, second = (direction(axis, f'joint "{self.name}"') for axis in self.axes)
        return first, second

    def positions(self) -> tuple[Quantity, ...]:
        """The angle about each axis (rad)."""
        return tuple(
            Quantity(f"{self.name}_angle{k}", "rad", f"angle {k} of universal joint {self.name}")
            for k in (1, 2)
        )

    def velocities(self) -> tuple[Quantity, ...]:
        """The rate of each angle (rad/s)."""
        return tuple(
            Quantity(f"{self.name}_angle{k}", "rad/s", f"rate {k} of universal joint {self.name}")
            for k in (1, 2)
        )

    def resolved(self, resolve: Callable[[Any], Scalar]) -> Self:
        """The same joint with its axes as scalars."""
        return self._with(_directions=tuple(tuple(map(resolve, a)) for a in self._directions))

    def alignment(self) -> Matrix:
        """Z onto the second axis, the first in the plane of x and z; x, y and z if both are of these."""
        return common_axes(self._directions)

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """A turn about the first axis, then one about the second.

        The first column turns relative to the head with the second angle, which gives the bias ``w1 x w2``.
        """
        axes = self.alignment()
        return turns(algebra, [seen(axis, axes) for axis in self._directions], q, v)

    def sequence(self) -> tuple[tuple[Joint, Rotation], ...]:
        """Two hinges, about the first and the second axis."""
        axes = self.alignment()
        return hinges(self, [seen(axis, axes) for axis in self._directions])

    def regroup(self, head: Moments) -> tuple[Moments, Moments]:
        """Hand over the mass as a point: the joint's centre belongs to both bodies.

        Nothing more: the second axis, about which a hinge would, moves relative to the tail.
        """
        return point_apart(head)

    def restricted(self, algebra: Algebra) -> tuple[Restriction, ...]:
        """Three forces, and a torque about the common normal: the axes keep the angle between them."""
        axes = self.alignment()
        first, second = (seen(axis, axes) for axis in self._directions)
        normal = cross(first, second)
        sine = algebra.sqrt(dot(normal, normal))
        return (*NO_SHIFT, Square(first, second, dot(first, second), sine))

    def measured(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[Scalar, ...]:
        """The angles (rad), between -pi and pi.

        The first is that of the second axis about the first, as the tail sees it; the second that of the
        first axis about the second, as the head sees it, reversed.
        """
        axes = self.alignment()
        first, second = (seen(axis, axes) for axis in self._directions)
        moved, back = times(rotation, second), times(transpose(rotation), first)
        angle = _angle_between(algebra, second, moved, first)
        return (angle, _angle_between(algebra, back, first, second))

    def duals(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[tuple[Vector, Vector], ...]:
        """Torques that do work along one angle only: the reciprocal basis of the two axes in their plane."""
        q = self.measured(algebra, rotation, displacement)
        columns = self.motion(algebra, q, (0, 0)).angular
        return tuple((s, ZERO) for s in reciprocal(columns))


def _angle_between(algebra: Algebra, a: Vector, b: Vector, axis: Vector) -> Scalar:
    """The angle from `a` to `b` as seen along a unit vector."""
    flat = subtract(a, scale(dot(axis, a), axis))
    return algebra.function("atan2", dot(axis, cross(flat, b)), dot(flat, b))
