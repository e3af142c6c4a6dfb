"""The source of pressure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import HYDRAULIC
from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class PressureSource(OnePort):
    """A source: ``X = pressure``, tail over head.

    Attributes:
        pressure: Pa: a number, an input, an expression of t or of any variable.

    Example:
        >>> PressureSource("source", ("a", "ground"), pressure=1.0).kind
        'pressure_source'
    """

    pressure: Any = None
    kind = "pressure_source"
    domain_name = HYDRAULIC.name
    required = ("pressure",)
    source = True

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """As given."""
        return (at.X[0] - at.value(self.pressure),)
