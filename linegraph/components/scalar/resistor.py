"""The resistor: a voltage in proportion to the current."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import Dissipator

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Resistor(Dissipator):
    """A resistor: ``X = resistance Y``.

    Attributes:
        resistance: ohm; it may depend on any variable, such as a temperature ``across(winding)``.

    Example:
        >>> Resistor("R1", ("in", "out"), resistance=100.0).kind
        'resistor'
    """

    resistance: Any = None
    kind = "resistor"
    domain_name = ELECTRICAL.name
    required = ("resistance",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Ohm's law."""
        return (at.X[0] - at.value(self.resistance) * at.Y[0],)
