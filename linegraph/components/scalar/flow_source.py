"""The source of flow."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import HYDRAULIC
from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class FlowSource(OnePort):
    """A source: ``Y = flow``, through it from tail to head.

    Attributes:
        flow: m^3/s: a number, an input, an expression of t or of any variable.

    Example:
        >>> FlowSource("source", ("a", "ground"), flow=1.0).kind
        'flow_source'
    """

    flow: Any = None
    kind = "flow_source"
    domain_name = HYDRAULIC.name
    required = ("flow",)
    source = True

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """As given."""
        return (at.Y[0] - at.value(self.flow),)
