"""The heat capacity."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import THERMAL
from linegraph.components.scalar.stores import AcrossStore

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class HeatCapacity(AcrossStore):
    """A heat capacity: ``Y = d/dt (capacity X)``. One of its ends is ground, 0 K.

    Attributes:
        capacity: J/K.

    Example:
        >>> HeatCapacity("winding", ("winding", "ground"), capacity=40.0).kind
        'heat_capacity'
    """

    capacity: Any = None
    kind = "heat_capacity"
    domain_name = THERMAL.name
    grounded = True
    required = ("capacity",)

    def constant(self, at: Terminals) -> Scalar:
        """The capacity."""
        return at.value(self.capacity)
