"""The inductor: flux linkage by current."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.stores import ThroughStore

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Own, Terminals


@dataclass(frozen=True)
class Inductor(ThroughStore):
    """An inductor: ``X = d/dt (inductance Y)``, or by its flux linkage or co-energy.

    Attributes:
        inductance: H; or
        flux: its flux linkage (V s) as a function of its current y; or
        coenergy: its co-energy (J) as a function of y.

    Example:
        >>> Inductor("L1", ("a", "b"), inductance=1e-3).kind
        'inductor'
    """

    inductance: Any = None
    flux: Any = None
    coenergy: Any = None
    kind = "inductor"
    domain_name = ELECTRICAL.name
    charge_field = "flux"
    own: ClassVar[Own] = {"flux": ("y",), "coenergy": ("y",)}
    needs = (("inductance", "flux", "coenergy"),)

    def constant(self, at: Terminals) -> Scalar:
        """The inductance."""
        return at.value(self.inductance)
