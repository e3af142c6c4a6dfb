"""The revolute joint: one rotation about an axis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.joints.base import (
    NO_SHIFT,
    NO_TURN_ACROSS_Z,
    Joint,
    Restriction,
    angle_about_z,
)
from linegraph.components.joints.look import ABOUT, Look
from linegraph.ir.program import Quantity
from linegraph.spatial.inertia import Moments
from linegraph.spatial.motion import Motion
from linegraph.spatial.rotation import Rotation, Turn, z_onto
from linegraph.spatial.vector import ZERO, Matrix, Vector

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar


@dataclass(frozen=True)
class Revolute(Joint):
    """A hinge: the head turns about `axis` by the angle q (rad), right-handed; v = q̇ (rad/s).

    Relative motion in aligned axes: R = a turn about z by q, d = 0, w = z v, u = 0. The effort is the torque
    about the axis on the head (N m).

    Example:
        >>> Revolute("elbow", ("arm.tip", "forearm"), axis=(0, 1, 0)).velocities()[0].unit
        'rad/s'
    """

    kind = "revolute"
    look = Look("revolute", shifted=True, long=True, plane=ABOUT)
    freedoms = 1
    turns = True
    slides = (2,)

    def positions(self) -> tuple[Quantity, ...]:
        """The angle, called after the joint (rad)."""
        return (Quantity(self.name, "rad", f"angle of revolute joint {self.name}"),)

    def velocities(self) -> tuple[Quantity, ...]:
        """The rate of the angle (rad/s)."""
        return (Quantity(self.name, "rad/s", f"rate of revolute joint {self.name}"),)

    def alignment(self) -> Matrix:
        """The smallest rotation that takes z to the axis."""
        return z_onto(self.axis)

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """A turn about z by q, without displacement. The column z is constant, so there is no bias."""
        turn = Turn(2, algebra.cos(q[0]), algebra.sin(q[0]))
        return Motion(Rotation((turn,)), ZERO, ((0, 0, 1),), (ZERO,))

    def regroup(self, head: Moments) -> tuple[Moments, Moments]:
        """Hand over the moments of mass that could as well be on the axis.

        The mass as a point on the axis, its first moment along the axis and its spread along it look the same
        from the tail body at every angle [Gautier and Khalil 1990].
        """
        x, y, z = head.first
        *others, zz = head.second
        kept = Moments(0, (x, y, 0), (*others, 0), (None, None, head.about[2]))
        return kept, Moments(head.mass, (0, 0, z), (0, 0, 0, 0, 0, zz))

    def restricted(self, algebra: Algebra) -> tuple[Restriction, ...]:
        """Three forces, and torques about x and y: no shift, no turn but about z."""
        return (*NO_SHIFT, *NO_TURN_ACROSS_Z)

    def measured(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[Scalar, ...]:
        """The angle about z (rad), between -pi and pi."""
        return (angle_about_z(algebra, rotation),)
