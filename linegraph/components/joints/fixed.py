"""The fixed joint: a weld."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.joints.base import NO_SHIFT, NO_TURN, Joint, Restriction
from linegraph.spatial.motion import Motion
from linegraph.spatial.rotation import Rotation
from linegraph.spatial.vector import ZERO, Matrix, Vector

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.ir.program import Quantity


@dataclass(frozen=True)
class Fixed(Joint):
    """Head and tail frames coincide: the two bodies are one.

    R = 1, d = 0, w = 0, u = 0; it has no coordinates, and as a chord six reactions.

    Example:
        >>> Fixed("bolt", ("arm.tip", "tool")).positions()
        ()
    """

    kind = "fixed"
    freedoms = 0

    def positions(self) -> tuple[Quantity, ...]:
        """Empty: it has no coordinates."""
        return ()

    def velocities(self) -> tuple[Quantity, ...]:
        """Empty: it has no velocities."""
        return ()

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """No rotation, no displacement and no columns."""
        return Motion(Rotation(), ZERO, (), ())

    def restricted(self, algebra: Algebra) -> tuple[Restriction, ...]:
        """Three forces and three torques: no shift and no turn."""
        return (*NO_SHIFT, *NO_TURN)

    def measured(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[Scalar, ...]:
        """Empty: it has no coordinates to measure."""
        return ()
