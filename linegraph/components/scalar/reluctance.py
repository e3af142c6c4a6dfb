"""The reluctance: flux by magnetomotive force."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linegraph.components.domains import MAGNETIC
from linegraph.components.scalar.stores import AcrossStore

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Own, Terminals


@dataclass(frozen=True)
class Reluctance(AcrossStore):
    """A magnetic path: ``Y = d/dt (X / reluctance)``, Y the rate of its flux; or by its flux or co-energy.

    Attributes:
        reluctance: A/Wb; or
        flux: its flux (V s) as a function of its magnetomotive force x; or
        coenergy: its co-energy (J) as a function of x.

    Example:
        >>> Reluctance("gap", ("pole", "ground"), reluctance=1e6).kind
        'reluctance'
    """

    reluctance: Any = None
    flux: Any = None
    coenergy: Any = None
    kind = "reluctance"
    domain_name = MAGNETIC.name
    charge_field = "flux"
    own: ClassVar[Own] = {"flux": ("x",), "coenergy": ("x",)}
    needs = (("reluctance", "flux", "coenergy"),)

    def constant(self, at: Terminals) -> Scalar:
        """Flux by magnetomotive force."""
        return 1 / at.value(self.reluctance)
