"""The pipe with laminar flow."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.base import Dissipator
from linegraph.domains import HYDRAULIC

if TYPE_CHECKING:
    from linegraph.components.base import Terminals
    from linegraph.vector import Scalar


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
