"""The pipe with laminar flow."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import HYDRAULIC
from linegraph.components.scalar.base import Dissipator

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Pipe(Dissipator):
    """A pipe with laminar flow: ``X = resistance Y``; its inertia is an `inertance` in series.

    Attributes:
        resistance: Pa s/m^3.

    Example:
        >>> Pipe("line", ("pump", "tank"), resistance=1e9).kind
        'pipe'
    """

    resistance: Any = None
    kind = "pipe"
    domain_name = HYDRAULIC.name
    required = ("resistance",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Hagen and Poiseuille's law."""
        return (at.X[0] - at.value(self.resistance) * at.Y[0],)
