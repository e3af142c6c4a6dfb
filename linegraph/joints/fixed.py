"""The fixed joint: a weld."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.joints.base import Joint, Motion
from linegraph.rotation import Rotation
from linegraph.vector import ZERO, Scalar

if TYPE_CHECKING:
    from linegraph.algebra import Algebra
    from linegraph.program import Quantity


@dataclass(frozen=True)
class Fixed(Joint):
    """Head and tail frames coincide: the two bodies are one.

    Example:
        >>> Fixed("bolt", ("arm.tip", "tool")).positions()
        ()
    """

    kind = "fixed"
    freedoms = 0

    def positions(self) -> tuple[Quantity, ...]:
        """None."""
        return ()

    def velocities(self) -> tuple[Quantity, ...]:
        """None."""
        return ()

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """No motion."""
        return Motion(Rotation(), ZERO, (), ())
