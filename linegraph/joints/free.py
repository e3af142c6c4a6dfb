"""The free joint: no restriction at all, six velocities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.joints.base import Joint, Motion
from linegraph.program import Quantity
from linegraph.rotation import IDENTITY_MATRIX, Full, Rotation, from_quaternion
from linegraph.vector import ZERO, Scalar

if TYPE_CHECKING:
    from linegraph.algebra import Algebra


@dataclass(frozen=True)
class Free(Joint):
    """Six freedoms between tail and head: a floating base.

    q = (position in the tail frame (m), unit quaternion x, y, z, w); v = (velocity of the head's origin
    (m/s), angular velocity (rad/s)), both in head axes. It carries no effort.

    Example:
        >>> Free("root", ("ground", "trunk")).rest()
        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    """

    effort: bool = False
    kind = "free"
    freedoms = 6

    def positions(self) -> tuple[Quantity, ...]:
        """Position and quaternion."""
        place = [
            Quantity(f"{self.name}_{c}", "m", f"position {c} of {self.name}, in the tail frame")
            for c in "xyz"
        ]
        turn = [
            Quantity(f"{self.name}_q{c}", "1", f"quaternion {c} of {self.name}") for c in "xyzw"
        ]
        return tuple(place + turn)

    def velocities(self) -> tuple[Quantity, ...]:
        """Velocity and angular velocity in head axes."""
        linear = [
            Quantity(f"{self.name}_v{c}", "m/s", f"velocity {c} of {self.name}, in head axes")
            for c in "xyz"
        ]
        angular = [
            Quantity(
                f"{self.name}_w{c}", "rad/s", f"angular velocity {c} of {self.name}, in head axes"
            )
            for c in "xyz"
        ]
        return tuple(linear + angular)

    def rest(self) -> tuple[float, ...]:
        """Origin and identity quaternion."""
        return (0.0,) * 6 + (1.0,)

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """Shift and turn by the quaternion; the velocities are the components themselves."""
        rotation = Rotation((Full(from_quaternion(q[3], q[4], q[5], q[6])),))
        none = (ZERO, ZERO, ZERO)
        return Motion(rotation, (q[0], q[1], q[2]), none + IDENTITY_MATRIX, IDENTITY_MATRIX + none)

    def rates(
        self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]
    ) -> tuple[Scalar, ...]:
        """Position rate R v; quaternion rate ``q̇ = 1/2 q (ω, 0)``."""
        linear = Full(from_quaternion(q[3], q[4], q[5], q[6])).out((v[0], v[1], v[2]))
        x, y, z, w = q[3:]
        a, b, c = (rate / 2 for rate in v[3:])
        return (
            *linear,
            w * a + y * c - z * b,
            w * b + z * a - x * c,
            w * c + x * b - y * a,
            -(x * a + y * b + z * c),
        )
