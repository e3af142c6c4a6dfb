"""The helical joint: a screw, rotation and translation in a fixed ratio."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

from linegraph.components.joints.base import (
    NO_SHIFT_ACROSS_Z,
    NO_TURN_ACROSS_Z,
    Joint,
    Restriction,
    Thread,
    angle_about_z,
)
from linegraph.components.joints.look import Look
from linegraph.components.validation import finite
from linegraph.errors import ModelError
from linegraph.ir.program import Quantity
from linegraph.spatial.inertia import Moments, round_apart
from linegraph.spatial.motion import Motion
from linegraph.spatial.rotation import Rotation, Turn, z_onto
from linegraph.spatial.vector import ZERO

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.spatial.vector import Matrix, Vector


@dataclass(frozen=True)
class Helical(Joint):
    """A screw: the head turns about `axis` by the angle q (rad) and advances along it by lead * q / 2 pi.

    v = q̇ (rad/s); the effort is a torque about the axis. Relative motion in aligned axes, with p = lead / 2
    pi (m/rad): R = a turn about z by q, d = z p q, w = z v, u = z p v.

    Attributes:
        lead: advance in a full turn (m), positive for a right-handed screw; may be a parameter.

    Example:
        >>> Helical("spindle", ("bed", "nut"), axis=(1, 0, 0), lead=0.005).positions()[0].unit
        'rad'
    """

    lead: Any = None
    kind = "helical"
    look = Look("helical", apart=True, shifted=True, actuated=True, long=True)
    freedoms = 1
    slides = (2,)

    def __post_init__(self) -> None:
        """Refuse a screw without a lead, or with one that is not finite, with a `ModelError`."""
        who = f'joint "{self.name}"'
        if self.lead is None:
            raise ModelError(who, "has no lead; give lead=..., the advance in a full turn (m)")
        finite((self.lead,), who)

    @property
    def _advance(self) -> Scalar:
        """Shift for a turn by 1 rad."""
        return self.lead * (1 / math.tau)

    def positions(self) -> tuple[Quantity, ...]:
        """The angle, called after the joint (rad)."""
        return (Quantity(self.name, "rad", f"angle of helical joint {self.name}"),)

    def velocities(self) -> tuple[Quantity, ...]:
        """The rate of the angle (rad/s)."""
        return (Quantity(self.name, "rad/s", f"rate of helical joint {self.name}"),)

    def resolved(self, resolve: Callable[[Any], Scalar]) -> Self:
        """The same screw with its lead as a scalar (m)."""
        return self._with(lead=resolve(self.lead))

    def alignment(self) -> Matrix:
        """The smallest rotation that takes z to the axis."""
        return z_onto(self.axis)

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """A turn about z by q, and lead / 2 pi times that as a shift along z. There is no bias."""
        turn = Turn(2, algebra.cos(q[0]), algebra.sin(q[0]))
        shift = (0, 0, self._advance * q[0])
        return Motion(Rotation((turn,)), shift, ((0, 0, 1),), ((0, 0, self._advance),))

    def regroup(self, head: Moments) -> tuple[Moments, Moments]:
        """Hand over the part of the inertia that looks the same at every angle about the axis.

        The mass stays although one velocity carries both motions: m and the inertia m (lead / 2 pi)^2 it
        causes about the axis could be traded, but not its momentum along the axis when the tail moves.
        """
        return round_apart(head)

    def restricted(self, algebra: Algebra) -> tuple[Restriction, ...]:
        """Forces and torques along and about x and y, and a force along z with the torque of the thread."""
        return (*NO_SHIFT_ACROSS_Z, *NO_TURN_ACROSS_Z, Thread(self._advance))

    def measured(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[Scalar, ...]:
        """The angle about z (rad), between -pi and pi; the advance of further turns is not looked at."""
        return (angle_about_z(algebra, rotation),)

    def duals(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[tuple[Vector, Vector], ...]:
        """A torque about z alone: the angle is measured by the turn, not by the advance."""
        return (((0, 0, 1), ZERO),)
