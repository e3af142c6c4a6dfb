"""The hydraulic cylinder."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import HYDRAULIC
from linegraph.components.scalar.base import Transducer

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Cylinder(Transducer):
    """A chamber of a hydraulic cylinder: ``Y = area w``, and it pushes with ``area X``.

    w is the rate of its length (m/s): of the distance of two points, or of the coordinate of a prismatic
    joint. X is the pressure in the chamber (Pa), Y the flow into it at the tail (m^3/s). No power is lost:
    ``X Y = (area X) w``. The other chamber of a double-acting cylinder is another one with its area negative.

    Attributes:
        area: of the piston (m^2).

    Example:
        >>> Cylinder("boom", ("p1", "tank"), points=("chassis.pin", "boom.pin"), area=5e-3).kind
        'cylinder'
    """

    area: Any = None
    kind = "cylinder"
    domain_name = HYDRAULIC.name
    required = ("area",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """``Y - area w`` (m^3/s), and the mechanical through variable plus the thrust ``area X`` (N)."""
        area = at.value(self.area)
        return at.Y[0] - area * at.X[1], at.Y[1] + area * at.X[0]
