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

    Attributes:
        axis: the direction, across the edge, in the head's axes.

    Example:
        >>> Blade("skate", ("ground", "sled.runner"), axis=(0, 1, 0)).equations()[0][1]
        False
    """

    axis: Vector = (0, 1, 0)
    kind = "blade"

    def equations(self) -> tuple[tuple[Quantity, bool], ...]:
        """The force across it."""
        return ((Quantity(f"{self.name}_across", "N", f"force across blade {self.name}"), False),)

    def rows(self, at: Instant) -> tuple[ReactionRow, ...]:
        """A force along the direction."""
        x, y, z = self.axis
        across = times(at.head.rotation, (at.resolve(x), at.resolve(y), at.resolve(z)))
        return (ReactionRow(None, across, ZERO),)
