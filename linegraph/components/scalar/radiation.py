"""Heat radiation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import THERMAL
from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Radiation(OnePort):
    """Radiation of heat between absolute temperatures: ``Y = coefficient (T_tail^4 - T_head^4)``.

    Attributes:
        coefficient: emissivity times 5.670374419e-8 W/(m^2 K^4) times area (W/K^4).

    Example:
        >>> Radiation("shine", ("sink", "sky"), coefficient=1e-9).kind
        'radiation'
    """

    coefficient: Any = None
    kind = "radiation"
    domain_name = THERMAL.name
    required = ("coefficient",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Stefan and Boltzmann's law."""
        tail, head = (at.potential(self.domain_name, vertex) for vertex in self.between)
        hot, cold = tail * tail, head * head
        return (at.Y[0] - at.value(self.coefficient) * (hot * hot - cold * cold),)
