"""The source of flux rate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import MAGNETIC
from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class FluxSource(OnePort):
    """A source: ``Y = rate``, through it from tail to head.

    Attributes:
        rate: V: a number, an input, an expression of t or of any variable.

    Example:
        >>> FluxSource("source", ("a", "ground"), rate=1.0).kind
        'flux_source'
    """

    rate: Any = None
    kind = "flux_source"
    domain_name = MAGNETIC.name
    required = ("rate",)
    source = True

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """As given."""
        return (at.Y[0] - at.value(self.rate),)
