"""The source of heat."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import THERMAL
from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class HeatSource(OnePort):
    """A source: ``Y = heat``, through it from tail to head.

    Attributes:
        heat: W: a number, an input, an expression of t or of any variable.

    Example:
        >>> HeatSource("source", ("a", "ground"), heat=1.0).kind
        'heat_source'
    """

    heat: Any = None
    kind = "heat_source"
    domain_name = THERMAL.name
    required = ("heat",)
    source = True

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """As given."""
        return (at.Y[0] - at.value(self.heat),)
