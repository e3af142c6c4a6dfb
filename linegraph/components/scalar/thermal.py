"""The components of thermal networks.

X is the temperature of the tail less that of the head (K), Y the heat flow from tail to head (W). Ground is
0 K, so that the potential of a vertex is its absolute temperature. ``X Y`` is no power: heat is in the graph,
but not in the power audit.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import THERMAL
from linegraph.components.scalar.base import OnePort
from linegraph.components.scalar.stores import AcrossStore
from linegraph.components.scalar.twins import Twins
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class HeatCapacity(AcrossStore):
    """A heat capacity: ``Y = d/dt (capacity X)``. One of its ends is ground, 0 K.

    The first law for a body of uniform temperature X without work: the heat that flows in warms it.

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
        """Heat for a kelvin: the capacity (J/K)."""
        return at.value(self.capacity)


@dataclass(frozen=True)
class Conduction(OnePort):
    """Conduction of heat: ``Y = conductance X``.

    Fourier's law for a wall; its conductance is conductivity times area over thickness. Heat flows towards
    the lower temperature.

    Attributes:
        conductance: W/K.

    Example:
        >>> Conduction("mica", ("die", "sink"), conductance=2.0).kind
        'conduction'
    """

    conductance: Any = None
    kind = "conduction"
    domain_name = THERMAL.name
    required = ("conductance",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Residual of Fourier's law: the heat flow less that of the conductance (W)."""
        return (at.Y[0] - at.value(self.conductance) * at.X[0],)


@dataclass(frozen=True)
class Convection(OnePort):
    """Convection of heat: ``Y = coefficient area X``.

    Newton's law of cooling, from a surface (tail) to a fluid (head); heat flows towards the lower
    temperature.

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
        """Residual of Newton's law of cooling: the heat flow less that of the surface (W)."""
        return (at.Y[0] - at.value(self.coefficient) * at.value(self.area) * at.X[0],)


@dataclass(frozen=True)
class Radiation(OnePort):
    """Radiation of heat between absolute temperatures: ``Y = coefficient (T_tail^4 - T_head^4)``.

    The law of Stefan and Boltzmann for a small grey body in large surroundings. It needs the two
    temperatures from 0 K, not their difference X alone. The constant is ``2 pi^5 k^4 / (15 h^3 c^2)``, with
    the values that the SI fixes for k, h and c.

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
        """Residual of Stefan and Boltzmann's law: the heat flow less the net radiation (W)."""
        tail, head = (at.potential(self.domain_name, vertex) for vertex in self.between)
        hot, cold = tail * tail, head * head
        return (at.Y[0] - at.value(self.coefficient) * (hot * hot - cold * cold),)


@dataclass(frozen=True)
class Losses(OnePort):
    """A source of heat: all that the named components and force elements dissipate.

    ``Y = sum of their dissipation`` (W), from tail to head, so the head is where it gets warm. Resistors,
    motors, diodes, dampers and friction, in networks and in 3-D joints. The coupling is one-way.

    Attributes:
        of: their names.

    Example:
        >>> Losses("copper", ("ground", "winding"), of=("R1", "motor")).kind
        'losses'
    """

    of: tuple[str, ...] = ()
    kind = "losses"
    domain_name = THERMAL.name

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Residual: the heat flow less the sum of the dissipated powers (W)."""
        total: Scalar = 0
        for name in self.of:
            total = total + at.taken(name)
        return (at.Y[0] - total,)

    def require_fields(self) -> None:
        """Refuse losses of nothing.

        Raises:
            ModelError: `of` names nothing.
        """
        if not self.of:
            raise ModelError(f'{self.kind} "{self.name}"', "of: name what loses power")


_types = Twins(THERMAL, __name__)

TemperatureSource = _types.across_source("temperature_source", "temperature")
HeatSource = _types.through_source("heat_source", "heat")
