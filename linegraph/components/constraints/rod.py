"""The rod: a massless rigid link with a ball at either end."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.constraints.base import Constraint, ReactionRow
from linegraph.ir.program import Quantity
from linegraph.spatial.vector import ZERO, dot, scale, subtract

if TYPE_CHECKING:
    from linegraph.components.constraints.base import Instant


@dataclass(frozen=True)
class Rod(Constraint):
    """Two points keep their distance: ``|d| - length = 0``; the multiplier is the rod's force, > 0 in push.

    d runs from the tail to the head; the force (N) acts on the head along d, and opposite on the tail.
    The same as a massless body between two balls, in one row instead of three. A length that is a function
    of time is an actuator's stroke or a hoist's rope. The length must not be 0, where d has no direction.

    Attributes:
        length: m; a number, an expression of parameters and t, or "input".

    Example:
        >>> Rod("strut", ("ground.eye", "arm.pin"), length=0.4).equations()[0][0].unit
        'N'
    """

    length: Any = 0
    kind = "rod"
    timed = ("length",)
    needs = (("length",),)

    def prescribed(self) -> tuple[tuple[Any, Quantity], ...]:
        """The length (m), which may be a function of time."""
        return ((self.length, Quantity(f"{self.name}_length", "m", f"length of rod {self.name}")),)

    def equations(self) -> tuple[tuple[Quantity, bool], ...]:
        """The force along the rod (N), with an equation of position."""
        about = f"force of rod {self.name} on its head, along the line from tail to head"
        return ((Quantity(f"{self.name}_force", "N", about), True),)

    def rows(self, at: Instant) -> tuple[ReactionRow, ...]:
        """A unit force along the line from tail to head, in ground axes."""
        line = subtract(at.head.origin, at.tail.origin)
        distance = at.algebra.sqrt(dot(line, line))
        (length,) = at.drive
        x, dx = length or (0, 0)
        return (ReactionRow(distance - x, scale(1 / distance, line), ZERO, dx),)
