"""The source of temperature."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import THERMAL
from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class TemperatureSource(OnePort):
    """A source: ``X = temperature``, tail over head.

    Attributes:
        temperature: K: a number, an input, an expression of t or of any variable.

    Example:
        >>> TemperatureSource("source", ("a", "ground"), temperature=1.0).kind
        'temperature_source'
    """

    temperature: Any = None
    kind = "temperature_source"
    domain_name = THERMAL.name
    required = ("temperature",)
    source = True

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """As given."""
        return (at.X[0] - at.value(self.temperature),)
