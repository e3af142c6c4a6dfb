"""The source of force in 1-D translation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import TRANSLATION_1D
from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class ForceSource(OnePort):
    """A source: ``Y = force``, through it from tail to head.

    Attributes:
        force: N: a number, an input, an expression of t or of any variable.

    Example:
        >>> ForceSource("source", ("a", "ground"), force=1.0).kind
        'force_source'
    """

    force: Any = None
    kind = "force_source"
    domain_name = TRANSLATION_1D.name
    required = ("force",)
    source = True

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """As given."""
        return (at.Y[0] - at.value(self.force),)
