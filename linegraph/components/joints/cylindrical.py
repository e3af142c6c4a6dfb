"""The cylindrical joint: rotation about an axis and translation along it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.joints.base import (
    NO_SHIFT_ACROSS_Z,
    NO_TURN_ACROSS_Z,
    Joint,
    Restriction,
    angle_about_z,
)
from linegraph.components.joints.look import Look
from linegraph.ir.program import Quantity
from linegraph.spatial.inertia import Moments, round_apart
from linegraph.spatial.motion import Motion
from linegraph.spatial.rotation import Rotation, Turn, z_onto
from linegraph.spatial.vector import ZERO, Matrix, Vector

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar


@dataclass(frozen=True)
class Cylindrical(Joint):
    """A shaft in a sleeve: the head turns about `axis` and slides along it, independently.

    q = (angle (rad), displacement (m)), v their rates (rad/s, m/s). Relative motion in aligned axes: R = a
    turn about z by q1, d = z q2, w = z v1, u = z v2. The efforts are a torque about the axis (N m) and a
    force along it (N), on the head.

    Example:
        >>> [c.unit for c in Cylindrical("sleeve", ("housing", "shaft")).velocities()]
        ['rad/s', 'm/s']
    """

    kind = "cylindrical"
    look = Look("cylindrical", apart=True, shifted=True, actuated=True, long=True)
    freedoms = 2
    slides = (2,)

    def positions(self) -> tuple[Quantity, ...]:
        """The angle (rad), then the displacement (m)."""
        what = f"of cylindrical joint {self.name}"
        return (
            Quantity(f"{self.name}_angle", "rad", f"angle {what}"),
            Quantity(f"{self.name}_displacement", "m", f"displacement {what}"),
        )

    def velocities(self) -> tuple[Quantity, ...]:
        """The rate of the angle (rad/s), then that of the displacement (m/s)."""
        what = f"of cylindrical joint {self.name}"
        return (
            Quantity(f"{self.name}_angle", "rad/s", f"angular rate {what}"),
            Quantity(f"{self.name}_displacement", "m/s", f"sliding rate {what}"),
        )

    def alignment(self) -> Matrix:
        """The smallest rotation that takes z to the axis."""
        return z_onto(self.axis)

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """A turn about z and a shift along it, which commute. The columns are constant: no bias."""
        turn = Turn(2, algebra.cos(q[0]), algebra.sin(q[0]))
        z = (0, 0, 1)
        return Motion(Rotation((turn,)), (0, 0, q[1]), (z, ZERO), (ZERO, z))

    def regroup(self, head: Moments) -> tuple[Moments, Moments]:
        """Hand over the part of the inertia that looks the same at every angle about the axis.

        Mass and first moment stay: their places in the tail body change with the displacement.
        """
        return round_apart(head)

    def restricted(self, algebra: Algebra) -> tuple[Restriction, ...]:
        """Forces and torques along and about x and y: no shift but along z, no turn but about it."""
        return (*NO_SHIFT_ACROSS_Z, *NO_TURN_ACROSS_Z)

    def measured(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[Scalar, ...]:
        """The angle about z (rad), between -pi and pi, and the shift along z (m)."""
        return (angle_about_z(algebra, rotation), displacement[2])
