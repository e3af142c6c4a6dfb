"""Heat convection."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import THERMAL
from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Convection(OnePort):
    """Convection of heat: ``Y = coefficient area X``.

    Attributes:
        coefficient: W/(m^2 K); it may depend on any variable, such as a speed.
        area: of the surface (m^2).

    Example:
        >>> Convection("fins", ("sink", "air"), coefficient=25.0, area=0.02).kind
        'convection'
    """

    coefficient: Any = None
    area: Any = 1
    kind = "convection"
    domain_name = THERMAL.name
    required = ("coefficient",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Newton's law of cooling."""
        return (at.Y[0] - at.value(self.coefficient) * at.value(self.area) * at.X[0],)
