"""The source of current."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class CurrentSource(OnePort):
    """A source: ``Y = current``, through it from tail to head.

    Attributes:
        current: A: a number, an input, an expression of t or of any variable.

    Example:
        >>> CurrentSource("source", ("a", "ground"), current=1.0).kind
        'current_source'
    """

    current: Any = None
    kind = "current_source"
    domain_name = ELECTRICAL.name
    required = ("current",)
    source = True

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """As given."""
        return (at.Y[0] - at.value(self.current),)
