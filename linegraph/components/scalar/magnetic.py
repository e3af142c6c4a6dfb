"""The components of magnetic circuits.

X is the magnetomotive force from tail to head (A), Y the *rate* of the flux through the component from tail
to head (V), so that ``X Y`` is a power (W). A magnetic path then stores energy as a capacitor does, and a
winding is a gyrator [Hamill 1994]; with the flux itself for the through variable a path would look like a
resistor that dissipates nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linegraph.components.domains import MAGNETIC
from linegraph.components.scalar.stores import AcrossStore
from linegraph.components.scalar.twins import Twins

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Own, Terminals


@dataclass(frozen=True)
class Reluctance(AcrossStore):
    """A magnetic path: ``Y = d/dt (X / reluctance)``, Y the rate of its flux; or by its flux or co-energy.

    In general ``Y = dΦ/dt`` with the flux ``Φ = ∂W'/∂X`` (V s). It keeps its magnetomotive force and stores
    ``Φ X - W'`` (J). Of a path of length l, permeability mu and area A the reluctance is ``l / (mu A)``.

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
        """Flux for an ampere of magnetomotive force: ``1 / reluctance`` (Wb/A)."""
        return 1 / at.value(self.reluctance)


_types = Twins(MAGNETIC, __name__)

MmfSource = _types.across_source("mmf_source", "mmf")
FluxSource = _types.through_source("flux_source", "rate")
