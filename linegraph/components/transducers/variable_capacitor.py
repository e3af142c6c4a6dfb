"""Capacitors whose capacitance depends on where a plate is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import ACROSS, STATIC, OwnState, Transducer

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Own, Terminals


@dataclass(frozen=True)
class VariableCapacitor(Transducer):
    """A condenser microphone, comb drive or plate: ``Y = d/dt ∂W'/∂v``, and it pushes with ``∂W'/∂x``.

    v is its voltage X (V), x the displacement of its mechanical port (m); a positive force (N) makes x grow.
    It is the slope of the *co-energy* W' at a given voltage, or ``-∂W/∂x`` of the energy W at a given charge
    [Woodson and Melcher 1968, sec. 3.1.2]. Where W is given, the charge q is a state: ``v = ∂W/∂q`` and
    ``dq/dt = Y``.

    Attributes:
        capacitance: C(x), an expression of the displacement x: ``W' = C(x) v² / 2``; or
        coenergy: W', an expression of the voltage v and of x; or
        energy: W, an expression of the charge q and of x; q then is the state.

    Example:
        >>> VariableCapacitor("plate", ("a", "ground"), joint="slide", energy="q**2*x/(2*eps*A)").kept()
        ('', '')
    """

    capacitance: Any = None
    coenergy: Any = None
    energy: Any = None
    kind = "variable_capacitor"
    domain_name = ELECTRICAL.name
    own: ClassVar[Own] = {"capacitance": ("x",), "coenergy": ("v", "x"), "energy": ("q", "x")}
    needs = (("capacitance", "coenergy", "energy"),)

    def kept(self) -> tuple[str, ...]:
        """Its voltage, unless its energy is given; nothing in mechanics."""
        return STATIC if self.energy is not None else ACROSS, STATIC

    def states(self) -> tuple[OwnState, ...]:
        """The charge q (A s), if its energy is given."""
        return (OwnState("q", "q", "A*s", "charge"),) if self.energy is not None else ()

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Nothing beside the current, and the mechanical Y without the force of the co-energy (N).

        Of an energy, two residuals: voltage less ``∂W/∂q`` (V), and Y less ``∂W/∂x`` (N).
        """
        if self.energy is None:
            return 0, at.Y[1]
        stored, q = self.own_energy(at), at.states["q"]
        return at.X[0] - at.derivative(stored, q), at.Y[1] - at.derivative(stored, at.x)

    def kept_coenergy(self, at: Terminals) -> Scalar:
        """W'(v, x) (J): ``C(x) v² / 2``, or as given; 0 where the energy is given instead."""
        v = at.X[0]
        if self.energy is not None:
            return 0
        if self.coenergy is not None:
            return at.value(self.coenergy, v=v, x=at.x)
        return at.value(self.capacitance, x=at.x) * (v * v / 2)

    def rates(self, at: Terminals) -> tuple[Scalar, ...]:
        """``dq/dt = Y`` (A), if the charge is a state."""
        return () if self.energy is None else (at.Y[0],)

    def own_energy(self, at: Terminals) -> Scalar:
        """W(q, x) (J), if the energy is given; else 0."""
        if self.energy is None:
            return 0
        return at.value(self.energy, q=at.states["q"], x=at.x)

    @property
    def displaced(self) -> bool:
        """True: the force is a slope over the displacement."""
        return True
