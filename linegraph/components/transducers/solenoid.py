"""Coils whose inductance depends on where an armature is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import STATIC, THROUGH, OwnState, Transducer

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Own, Terminals


@dataclass(frozen=True)
class Solenoid(Transducer):
    """A solenoid or electromagnet: ``X = resistance Y + d/dt ∂W'/∂i``, and it pushes with ``∂W'/∂x``.

    i is its current Y (A), x the displacement of its mechanical port (m); a positive force (N) makes x grow.
    It is the slope of the *co-energy* W' at a given current, or ``-∂W/∂x`` of the energy W at a given flux
    linkage [Woodson and Melcher 1968, sec. 3.1.2]. Where W is given, the flux linkage psi is a state:
    ``i = ∂W/∂psi`` and ``dpsi/dt = X - resistance i``.

    Attributes:
        inductance: L(x), an expression of the displacement x: ``W' = L(x) i² / 2``; or
        coenergy: W', an expression of the current i and of x; or
        energy: W, an expression of the flux linkage psi and of x; psi then is the state.
        resistance: ohm; 0 if left out.

    Example:
        >>> Solenoid("magnet", ("plus", "ground"), joint="slide", inductance="L0 + L1/(1 + x/d)").kept()
        ('through', '')
    """

    inductance: Any = None
    coenergy: Any = None
    energy: Any = None
    resistance: Any = 0
    kind = "solenoid"
    domain_name = ELECTRICAL.name
    own: ClassVar[Own] = {"inductance": ("x",), "coenergy": ("i", "x"), "energy": ("psi", "x")}
    needs = (("inductance", "coenergy", "energy"),)

    def kept(self) -> tuple[str, ...]:
        """Its current, unless its energy is given; nothing in mechanics."""
        return STATIC if self.energy is not None else THROUGH, STATIC

    def states(self) -> tuple[OwnState, ...]:
        """The flux linkage psi (V s), if its energy is given."""
        flux = OwnState("psi", "psi", "V*s", "flux linkage")
        return (flux,) if self.energy is not None else ()

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Voltage of the resistance (V), and the mechanical Y without the force of the co-energy (N).

        Of an energy, two residuals: current less ``∂W/∂psi`` (A), and Y less ``∂W/∂x`` (N).
        """
        if self.energy is None:
            return at.value(self.resistance) * at.Y[0], at.Y[1]
        stored, psi = self.own_energy(at), at.states["psi"]
        return at.Y[0] - at.derivative(stored, psi), at.Y[1] - at.derivative(stored, at.x)

    def kept_coenergy(self, at: Terminals) -> Scalar:
        """W'(i, x) (J): ``L(x) i² / 2``, or as given; 0 where the energy is given instead."""
        i = at.Y[0]
        if self.energy is not None:
            return 0
        if self.coenergy is not None:
            return at.value(self.coenergy, i=i, x=at.x)
        return at.value(self.inductance, x=at.x) * (i * i / 2)

    def rates(self, at: Terminals) -> tuple[Scalar, ...]:
        """Faraday's law: ``dpsi/dt = X - resistance Y`` (V), if psi is a state."""
        if self.energy is None:
            return ()
        return (at.X[0] - at.value(self.resistance) * at.Y[0],)

    def own_energy(self, at: Terminals) -> Scalar:
        """W(psi, x) (J), if the energy is given; else 0."""
        if self.energy is None:
            return 0
        return at.value(self.energy, psi=at.states["psi"], x=at.x)

    def dissipation(self, at: Terminals) -> Scalar:
        """Heat of the winding: ``resistance Y²`` (W)."""
        return at.value(self.resistance) * (at.Y[0] * at.Y[0])

    @property
    def displaced(self) -> bool:
        """True: the force is a slope over the displacement."""
        return True


@dataclass(frozen=True)
class ReluctanceMachine(Solenoid):
    """A solenoid that turns: x is the angle of its joint or shaft.

    ``X = resistance Y + d/dt ∂W'/∂i``, and it drives with the torque ``∂W'/∂x`` (N m), x in rad.

    Example:
        >>> ReluctanceMachine("motor", ("a", "ground"), joint="axle", inductance="L0 + L2*cos(2*x)").turns
        True
    """

    kind = "reluctance_machine"
    turns = True
