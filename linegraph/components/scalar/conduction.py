"""Heat conduction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import THERMAL
from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Conduction(OnePort):
    """Conduction of heat: ``Y = conductance X``.

    Attributes:
        conductance: W/K.

    Example:
        >>> Conduction("mica", ("die", "sink"), conductance=2.0).kind
        'conduction'
    """

    conductance: Any = None
    kind = "conduction"
    domain_name = THERMAL.name
    required = ("conductance",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Fourier's law."""
        return (at.Y[0] - at.value(self.conductance) * at.X[0],)
