"""The accumulator: volume by pressure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linegraph.components.domains import HYDRAULIC
from linegraph.components.scalar.stores import AcrossStore

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Own, Terminals


@dataclass(frozen=True)
class Accumulator(AcrossStore):
    """An accumulator, or a chamber's compressibility: ``Y = d/dt (capacity X)``, or by volume or co-energy.

    Attributes:
        capacity: m^3/Pa; of a chamber its volume over the bulk modulus; or
        volume: the volume taken in (m^3) as a function of its pressure x; or
        coenergy: its co-energy (J) as a function of x.

    Example:
        >>> Accumulator("line", ("line", "ground"), capacity=1e-12).kind
        'accumulator'
    """

    capacity: Any = None
    volume: Any = None
    coenergy: Any = None
    kind = "accumulator"
    domain_name = HYDRAULIC.name
    charge_field = "volume"
    own: ClassVar[Own] = {"volume": ("x",), "coenergy": ("x",)}
    needs = (("capacity", "volume", "coenergy"),)

    def constant(self, at: Terminals) -> Scalar:
        """The capacity."""
        return at.value(self.capacity)
