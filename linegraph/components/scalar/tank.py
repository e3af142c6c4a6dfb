"""The open tank."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import HYDRAULIC
from linegraph.components.scalar.stores import AcrossStore

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Tank(AcrossStore):
    """An open tank: ``Y = d/dt (area / (density gravity) X)``. One end is ground, the pressure outside.

    Attributes:
        area: of the surface (m^2)
        density: of the liquid (kg/m^3)
        gravity: m/s^2.

    Example:
        >>> Tank("basin", ("basin", "ground"), area=2.0).kind
        'tank'
    """

    area: Any = None
    density: Any = 1000
    gravity: Any = 9.81
    kind = "tank"
    domain_name = HYDRAULIC.name
    grounded = True
    required = ("area",)

    def constant(self, at: Terminals) -> Scalar:
        """Volume by pressure at the bottom."""
        return at.value(self.area) / (at.value(self.density) * at.value(self.gravity))
