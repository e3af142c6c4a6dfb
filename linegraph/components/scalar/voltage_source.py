"""The source of voltage."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class VoltageSource(OnePort):
    """A source: ``X = voltage``, tail over head.

    Attributes:
        voltage: V: a number, an input, an expression of t or of any variable.

    Example:
        >>> VoltageSource("source", ("a", "ground"), voltage=1.0).kind
        'voltage_source'
    """

    voltage: Any = None
    kind = "voltage_source"
    domain_name = ELECTRICAL.name
    required = ("voltage",)
    source = True

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """As given."""
        return (at.X[0] - at.value(self.voltage),)
