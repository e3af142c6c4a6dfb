"""The planar joint: two translations in a plane and the rotation about its normal."""

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
from linegraph.spatial.inertia import Moments, round_apart
from linegraph.spatial.motion import Motion
from linegraph.spatial.rotation import Rotation, Turn, z_onto
from linegraph.spatial.vector import ZERO, Matrix, Vector

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar


@dataclass(frozen=True)
class Planar(Joint):
    """The head slides in the plane normal to `axis` and turns about that normal.

    q = (x, y, angle): position in the tail frame (m, m) and angle (rad). v = (vx, vy, wz): velocity of
    the head's origin in the *head's* x and y (m/s) and angular rate (rad/s). With another normal than z,
    x and y are the tail's x and y after the smallest rotation that takes z to the normal.

    Relative motion in aligned axes: R = a turn about z by the angle, d = (x, y, 0), w = z wz, u = (vx, vy,
    0). Velocities in head axes keep M constant for a body that moves alone; in return q̇ = N(q) v turns them
    into tail axes. The efforts are forces along the head's x and y on the head (N) and a torque about z (N
    m).

    Example:
        >>> [c.name for c in Planar("table", ("ground", "puck")).velocities()]
        ['table_vx', 'table_vy', 'table_wz']
    """

    kind = "planar"
    look = Look("planar", apart=True, long=True, plane=ABOUT)
    freedoms = 3
    slides = (2,)

    def positions(self) -> tuple[Quantity, ...]:
        """Position x and y in the tail frame (m), then the angle (rad)."""
        where = f"of planar joint {self.name}, in the tail frame"
        return (
            Quantity(f"{self.name}_x", "m", f"position x {where}"),
            Quantity(f"{self.name}_y", "m", f"position y {where}"),
            Quantity(f"{self.name}_angle", "rad", f"angle of planar joint {self.name}"),
        )

    def velocities(self) -> tuple[Quantity, ...]:
        """Velocity of the head's origin along the head's x and y (m/s), then the angular rate (rad/s)."""
        where = f"of planar joint {self.name}, in head axes"
        return (
            Quantity(f"{self.name}_vx", "m/s", f"velocity x {where}"),
            Quantity(f"{self.name}_vy", "m/s", f"velocity y {where}"),
            Quantity(f"{self.name}_wz", "rad/s", f"angular rate of planar joint {self.name}"),
        )

    def alignment(self) -> Matrix:
        """The smallest rotation that takes z to the normal."""
        return z_onto(self.axis)

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """A shift in x and y, then a turn about z. The columns are constant in head axes: no bias."""
        turn = Turn(2, algebra.cos(q[2]), algebra.sin(q[2]))
        linear = ((1, 0, 0), (0, 1, 0), ZERO)
        return Motion(Rotation((turn,)), (q[0], q[1], 0), (ZERO, ZERO, (0, 0, 1)), linear)

    def rates(
        self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]
    ) -> tuple[Scalar, ...]:
        """``ẋ = c vx - s vy``, ``ẏ = s vx + c vy``, and the angular rate; c, s of the angle."""
        c, s = algebra.cos(q[2]), algebra.sin(q[2])
        return (c * v[0] - s * v[1], s * v[0] + c * v[1], v[2])

    def adjoint(self, v: tuple[Scalar, ...]) -> tuple[tuple[Scalar, ...], ...]:
        """The adjoint of motions in the plane, SE(2), in the order (vx, vy, wz)."""
        x, y, turn = v
        return ((0, -turn, y), (turn, 0, -x), (0, 0, 0))

    def regroup(self, head: Moments) -> tuple[Moments, Moments]:
        """Hand over the part of the inertia that looks the same at every angle about the normal."""
        return round_apart(head)

    def restricted(self, algebra: Algebra) -> tuple[Restriction, ...]:
        """A force along z, and torques about x and y: no shift along the normal, no turn but about it."""
        return (NO_SHIFT[2], *NO_TURN_ACROSS_Z)

    def measured(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[Scalar, ...]:
        """The place in the plane (m) and the angle about z (rad), between -pi and pi."""
        return (displacement[0], displacement[1], angle_about_z(algebra, rotation))
