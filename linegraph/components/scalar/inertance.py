"""The inertance of a liquid column."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import HYDRAULIC
from linegraph.components.scalar.stores import ThroughStore

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Inertance(ThroughStore):
    """The inertia of a liquid column: ``X = d/dt (inertance Y)``.

    Attributes:
        inertance: density times length over area (kg/m^4).

    Example:
        >>> Inertance("pipe", ("pump", "tank"), inertance=1e7).kind
        'inertance'
    """

    inertance: Any = None
    kind = "inertance"
    domain_name = HYDRAULIC.name
    required = ("inertance",)

    def constant(self, at: Terminals) -> Scalar:
        """The inertance."""
        return at.value(self.inertance)
