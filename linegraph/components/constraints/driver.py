"""The driver: a point in prescribed motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.constraints.base import Constraint, ReactionRow
from linegraph.ir.program import Quantity
from linegraph.spatial.rotation import IDENTITY_MATRIX
from linegraph.spatial.vector import ZERO, dot, subtract, times

if TYPE_CHECKING:
    from linegraph.components.constraints.base import Instant


@dataclass(frozen=True)
class Driver(Constraint):
    """The head's origin moves as prescribed, seen from the tail: ``d . e - x(t) = 0`` for each axis e given.

    d runs from the tail's origin to the head's, e is an axis of the tail. The multipliers are the forces that
    it takes, along these axes on the head (N). A driver of a joint's own coordinate is the joint's `motion`.

    Attributes:
        x, y, z: place in the tail's axes (m): an expression of parameters and t, or "input"; an axis
            left out is free.

    Example:
        >>> [row.name for row, _ in Driver("lead", ("ground", "hand.tip"), x="0.1*sin(t)").equations()]
        ['lead_fx']
    """

    x: Any = None
    y: Any = None
    z: Any = None
    kind = "driver"
    timed = ("x", "y", "z")
    needs = (("x", "y", "z"),)

    def prescribed(self) -> tuple[tuple[Any, Quantity], ...]:
        """The places x, y and z (m), each given or None."""
        return tuple(
            (value, Quantity(f"{self.name}_{c}", "m", f"place {c} of driver {self.name}"))
            for c, value in zip("xyz", (self.x, self.y, self.z), strict=True)
        )

    def equations(self) -> tuple[tuple[Quantity, bool], ...]:
        """A force along each axis that is given (N), with an equation of position."""
        return tuple(
            (
                Quantity(
                    f"{self.name}_f{c}", "N", f"force {c} of driver {self.name}, in the tail's axes"
                ),
                True,
            )
            for c, value in zip("xyz", (self.x, self.y, self.z), strict=True)
            if value is not None
        )

    def rows(self, at: Instant) -> tuple[ReactionRow, ...]:
        """A unit force along each given axis of the tail, resolved in ground axes."""
        line = subtract(at.head.origin, at.tail.origin)
        found = []
        for axis, given in zip(IDENTITY_MATRIX, at.drive, strict=True):
            if given is not None:
                direction = times(at.tail.rotation, axis)
                found.append(ReactionRow(dot(direction, line) - given.x, direction, ZERO, given.dx))
        return tuple(found)
