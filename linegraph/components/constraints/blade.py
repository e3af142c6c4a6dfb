"""The blade: a knife edge or a skate, which does not move sideways."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.constraints.base import Constraint, ReactionRow
from linegraph.ir.program import Quantity
from linegraph.spatial.vector import ZERO, Vector, times

if TYPE_CHECKING:
    from linegraph.components.constraints.base import Instant


@dataclass(frozen=True)
class Blade(Constraint):
    """The head's origin has no velocity along a direction of the head: ``axis . u = 0``.

    u is the velocity of the head's origin as seen from the tail, `axis` a unit vector fixed in the head. The
    multiplier is the force along the axis on the head (N). The constraint is nonholonomic: it restricts
    velocities and has no equation of position.

    Attributes:
        axis: the direction, across the edge, in the head's axes.

    Example:
        >>> Blade("skate", ("ground", "sled.runner"), axis=(0, 1, 0)).equations()[0][1]
        False
    """

    axis: Vector = (0, 1, 0)
    kind = "blade"

    def equations(self) -> tuple[tuple[Quantity, bool], ...]:
        """The force across the edge (N), without an equation of position."""
        return ((Quantity(f"{self.name}_across", "N", f"force across blade {self.name}"), False),)

    def rows(self, at: Instant) -> tuple[ReactionRow, ...]:
        """A unit force along the axis, resolved in ground axes, at the head's origin."""
        x, y, z = self.axis
        across = times(at.head.rotation, (at.resolve(x), at.resolve(y), at.resolve(z)))
        return (ReactionRow(None, across, ZERO),)
