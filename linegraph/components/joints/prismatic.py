"""The prismatic joint: one translation along an axis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.joints.base import NO_SHIFT_ACROSS_Z, NO_TURN, Joint, Restriction
from linegraph.ir.program import Quantity
from linegraph.spatial.inertia import Moments
from linegraph.spatial.motion import Motion
from linegraph.spatial.rotation import Rotation, z_onto
from linegraph.spatial.vector import ZERO, Matrix, Vector

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar


@dataclass(frozen=True)
class Prismatic(Joint):
    """A slider: the head moves along `axis` by q (m) without turning; v = q̇ (m/s).

    Example:
        >>> Prismatic("slide", ("ground", "cart"), axis=(1, 0, 0)).positions()[0].unit
        'm'
    """

    kind = "prismatic"
    freedoms = 1
    slides = (0, 1, 2)

    def positions(self) -> tuple[Quantity, ...]:
        """The displacement."""
        return (Quantity(self.name, "m", f"displacement of prismatic joint {self.name}"),)

    def velocities(self) -> tuple[Quantity, ...]:
        """Its rate."""
        return (Quantity(self.name, "m/s", f"rate of prismatic joint {self.name}"),)

    def alignment(self) -> Matrix:
        """Z onto the axis."""
        return z_onto(self.axis)

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """A shift along z."""
        return Motion(Rotation(), (0, 0, q[0]), (ZERO,), ((0, 0, 1),))

    def regroup(self, head: Moments) -> tuple[Moments, Moments]:
        """Hand over the second moments: head and tail turn alike."""
        kept = Moments(head.mass, head.first, (0, 0, 0, 0, 0, 0))
        return kept, Moments(0, ZERO, head.second, head.about)

    def restricted(self, algebra: Algebra) -> tuple[Restriction, ...]:
        """No shift but along the axis, no turn."""
        return (*NO_SHIFT_ACROSS_Z, *NO_TURN)

    def measured(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[Scalar, ...]:
        """The shift along z."""
        return (displacement[2],)
