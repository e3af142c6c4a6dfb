"""The prismatic joint: one translation along an axis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.joints.base import NO_SHIFT_ACROSS_Z, NO_TURN, Joint, Restriction
from linegraph.components.joints.look import ALONG, Look
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

    Relative motion in aligned axes: R = 1, d = z q, w = 0, u = z v. The effort is the force along the axis on
    the head (N).

    Example:
        >>> Prismatic("slide", ("ground", "cart"), axis=(1, 0, 0)).positions()[0].unit
        'm'
    """

    kind = "prismatic"
    look = Look(
        "prismatic", apart=True, shifted=True, actuated=True, guided=True, long=True, plane=ALONG
    )
    freedoms = 1
    slides = (0, 1, 2)

    def positions(self) -> tuple[Quantity, ...]:
        """The displacement, called after the joint (m)."""
        return (Quantity(self.name, "m", f"displacement of prismatic joint {self.name}"),)

    def velocities(self) -> tuple[Quantity, ...]:
        """The rate of the displacement (m/s)."""
        return (Quantity(self.name, "m/s", f"rate of prismatic joint {self.name}"),)

    def alignment(self) -> Matrix:
        """The smallest rotation that takes z to the axis."""
        return z_onto(self.axis)

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """A shift along z by q, without turning. The column z is constant, so there is no bias."""
        return Motion(Rotation(), (0, 0, q[0]), (ZERO,), ((0, 0, 1),))

    def regroup(self, head: Moments) -> tuple[Moments, Moments]:
        """Hand over the second moments, about the head's origin: head and tail turn alike."""
        kept = Moments(head.mass, head.first, (0, 0, 0, 0, 0, 0))
        return kept, Moments(0, ZERO, head.second, head.about)

    def restricted(self, algebra: Algebra) -> tuple[Restriction, ...]:
        """Forces along x and y, and three torques: no shift but along z, no turn."""
        return (*NO_SHIFT_ACROSS_Z, *NO_TURN)

    def measured(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[Scalar, ...]:
        """The shift along z (m)."""
        return (displacement[2],)
