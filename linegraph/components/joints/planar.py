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

    Example:
        >>> [c.name for c in Planar("table", ("ground", "puck")).velocities()]
        ['table_vx', 'table_vy', 'table_wz']
    """

    kind = "planar"
    freedoms = 3
    slides = (2,)

    def positions(self) -> tuple[Quantity, ...]:
        """x, y and the angle."""
        where = f"of planar joint {self.name}, in the tail frame"
        return (
            Quantity(f"{self.name}_x", "m", f"position x {where}"),
            Quantity(f"{self.name}_y", "m", f"position y {where}"),
            Quantity(f"{self.name}_angle", "rad", f"angle of planar joint {self.name}"),
        )

    def velocities(self) -> tuple[Quantity, ...]:
        """The velocity in head axes and the angular rate."""
        where = f"of planar joint {self.name}, in head axes"
        return (
            Quantity(f"{self.name}_vx", "m/s", f"velocity x {where}"),
            Quantity(f"{self.name}_vy", "m/s", f"velocity y {where}"),
            Quantity(f"{self.name}_wz", "rad/s", f"angular rate of planar joint {self.name}"),
        )

    def alignment(self) -> Matrix:
        """Z onto the normal."""
        return z_onto(self.axis)

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """A shift in x and y, then a turn about z."""
        turn = Turn(2, algebra.cos(q[2]), algebra.sin(q[2]))
        linear = ((1, 0, 0), (0, 1, 0), ZERO)
        return Motion(Rotation((turn,)), (q[0], q[1], 0), (ZERO, ZERO, (0, 0, 1)), linear)

    def rates(
        self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]
    ) -> tuple[Scalar, ...]:
        """Turn the velocity from head to tail axes."""
        c, s = algebra.cos(q[2]), algebra.sin(q[2])
        return (c * v[0] - s * v[1], s * v[0] + c * v[1], v[2])

    def adjoint(self, v: tuple[Scalar, ...]) -> tuple[tuple[Scalar, ...], ...]:
        """That of motions in the plane."""
        x, y, turn = v
        return ((0, -turn, y), (turn, 0, -x), (0, 0, 0))

    def regroup(self, head: Moments) -> tuple[Moments, Moments]:
        """Hand over the part of the inertia that looks the same at every angle about the normal."""
        return round_apart(head)

    def restricted(self, algebra: Algebra) -> tuple[Restriction, ...]:
        """No shift along the normal, no turn but about it."""
        return (NO_SHIFT[2], *NO_TURN_ACROSS_Z)

    def measured(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[Scalar, ...]:
        """The place in the plane and the angle about z."""
        return (displacement[0], displacement[1], angle_about_z(algebra, rotation))
