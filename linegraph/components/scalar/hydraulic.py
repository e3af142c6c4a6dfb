"""The components of hydraulic networks.

X is the pressure at the tail less that at the head (Pa), Y the volume flow from tail to head (m^3/s); ``X Y``
is the power that the component takes in (W).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linegraph.components.domains import HYDRAULIC
from linegraph.components.scalar.base import Dissipator
from linegraph.components.scalar.stores import AcrossStore, ThroughStore
from linegraph.components.scalar.twins import Twins

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Own, Terminals


@dataclass(frozen=True)
class Tank(AcrossStore):
    """An open tank: ``Y = d/dt (area / (density gravity) X)``. One end is ground, the pressure outside.

    X is the hydrostatic pressure ``density gravity level`` at the bottom, so that the volume in it is
    ``area level``. It stores ``area X² / (2 density gravity)`` (J), the potential energy of the liquid above
    its bottom.

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
        """Volume for a unit of pressure at the bottom: ``area / (density gravity)`` (m^3/Pa)."""
        return at.value(self.area) / (at.value(self.density) * at.value(self.gravity))


@dataclass(frozen=True)
class Accumulator(AcrossStore):
    """An accumulator, or a chamber's compressibility: ``Y = d/dt (capacity X)``, or by volume or co-energy.

    In general ``Y = dV/dt`` with the volume ``V = ∂W'/∂X`` (m^3) that it has taken in at the tail. It keeps
    its pressure and stores ``V X - W'`` (J).

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
        """Volume for a unit of pressure: the capacity (m^3/Pa)."""
        return at.value(self.capacity)


@dataclass(frozen=True)
class Inertance(ThroughStore):
    """The inertia of a liquid column: ``X = d/dt (inertance Y)``.

    Newton's second law of a plug of liquid in a pipe: the drop of pressure accelerates it from tail to head.
    It keeps its flow and stores the kinetic energy ``inertance Y² / 2`` (J).

    Attributes:
        inertance: density times length over area (kg/m^4).

    Example:
        >>> Inertance("pipe", ("pump", "tank"), inertance=1e7).kind
        'inertance'
    """

    inertance: Any = None
    kind = "inertance"
    domain_name = HYDRAULIC.name
    required = ("inertance",)

    def constant(self, at: Terminals) -> Scalar:
        """Pressure momentum (Pa s) for a unit of flow: the inertance (kg/m^4)."""
        return at.value(self.inertance)


@dataclass(frozen=True)
class Pipe(Dissipator):
    """A pipe with laminar flow: ``X = resistance Y``; its inertia is an `inertance` in series.

    The law of Hagen and Poiseuille; of a round pipe of length l and radius r the resistance is
    ``8 viscosity l / (pi r^4)``, with the dynamic viscosity in Pa s. It turns ``resistance Y²`` (W) into
    heat.

    Attributes:
        resistance: Pa s/m^3.

    Example:
        >>> Pipe("line", ("pump", "tank"), resistance=1e9).kind
        'pipe'
    """

    resistance: Any = None
    kind = "pipe"
    domain_name = HYDRAULIC.name
    required = ("resistance",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Residual: the drop of pressure less that of laminar flow (Pa)."""
        return (at.X[0] - at.value(self.resistance) * at.Y[0],)


@dataclass(frozen=True)
class Orifice(Dissipator):
    """A sharp-edged orifice: ``Y = coefficient sign(X) sqrt(|X|)``, rounded where |X| is below `width`.

    Torricelli's law, turbulent flow towards the lower pressure: of an orifice of area A with the discharge
    coefficient c, `coefficient` is ``c A sqrt(2 / density)``. The root alone has an infinite slope at X = 0,
    where Newton's method and integrators fail, so the law here is linear in X for |X| well below `width`, as
    laminar flow is.

    Attributes:
        coefficient: flow for a pressure drop of one (m^3/s/sqrt(Pa)).
        width: where the root is rounded: Y = coefficient X / (X^2 + width^2)^(1/4) (Pa).

    Example:
        >>> Orifice("jet", ("tank", "ground"), coefficient=1e-6).kind
        'orifice'
    """

    coefficient: Any = None
    width: Any = 1.0
    kind = "orifice"
    domain_name = HYDRAULIC.name
    required = ("coefficient",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Residual: the flow less that of the rounded root (m^3/s)."""
        return (at.Y[0] - at.value(self.coefficient) * _rounded_root(at, self.width),)


@dataclass(frozen=True)
class Valve(Dissipator):
    """A valve: ``Y = coefficient opening sign(X) sqrt(|X|)``, rounded where |X| is below `width`.

    An orifice whose area is in proportion to `opening`; see `Orifice` for the coefficient and the rounding.
    An opening below 0 counts as 0, so an input that swings through zero shuts the valve and does not turn
    the flow around.

    Attributes:
        coefficient: flow for a pressure drop of one when fully open (m^3/s/sqrt(Pa)).
        opening: from 0, shut, to 1; mostly an expression of an input.
        width: where the root is rounded (Pa).

    Example:
        >>> Valve("spool", ("pump", "cylinder"), coefficient=1e-6, opening="spool").kind
        'valve'
    """

    coefficient: Any = None
    opening: Any = 1
    width: Any = 1.0
    kind = "valve"
    domain_name = HYDRAULIC.name
    required = ("coefficient",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Residual: the flow less that of the open part of the orifice (m^3/s)."""
        root = _rounded_root(at, self.width)
        opening = at.value(self.opening)
        if not isinstance(opening, (int, float)) or opening < 0:
            opening = at.function("max", opening, 0)
        return (at.Y[0] - at.value(self.coefficient) * opening * root,)


def _rounded_root(at: Terminals, width: Any) -> Scalar:
    """``X / (X² + width²)^(1/4)``, which is ``sign(X) sqrt(|X|)`` far from zero (sqrt(Pa))."""
    limit = at.value(width)
    root = at.function("sqrt", at.function("sqrt", at.X[0] * at.X[0] + limit * limit))
    return at.X[0] / root


_types = Twins(HYDRAULIC, __name__)

PressureSource = _types.across_source("pressure_source", "pressure")
FlowSource = _types.through_source("flow_source", "flow")
