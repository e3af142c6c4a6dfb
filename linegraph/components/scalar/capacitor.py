"""The capacitor: charge by voltage."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.stores import AcrossStore

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Own, Terminals


@dataclass(frozen=True)
class Capacitor(AcrossStore):
    """A capacitor: ``Y = d/dt (capacitance X)``, or by its charge or co-energy.

    Attributes:
        capacitance: F; or
        charge: its charge (A s) as a function of its voltage x; or
        coenergy: its co-energy (J) as a function of x.

    Example:
        >>> Capacitor("C1", ("a", "ground"), capacitance=1e-6).kind
        'capacitor'
    """

    capacitance: Any = None
    charge: Any = None
    coenergy: Any = None
    kind = "capacitor"
    domain_name = ELECTRICAL.name
    charge_field = "charge"
    own: ClassVar[Own] = {"charge": ("x",), "coenergy": ("x",)}
    needs = (("capacitance", "charge", "coenergy"),)

    def constant(self, at: Terminals) -> Scalar:
        """The capacitance."""
        return at.value(self.capacitance)
