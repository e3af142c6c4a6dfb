"""The components of electrical networks.

X is the voltage of the tail less that of the head (V), Y the current through the component from tail to head
(A); ``X Y`` is the power that it takes in (W).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import THROUGH, Component, Dissipator, Pair, Port
from linegraph.components.scalar.stores import AcrossStore, ThroughStore
from linegraph.components.scalar.twins import Twins
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Own, Terminals


@dataclass(frozen=True)
class Resistor(Dissipator):
    """A resistor: ``X = resistance Y``.

    Ohm's law; it turns ``resistance Y²`` (W) into heat. A resistance of 0 is a short circuit.

    Attributes:
        resistance: ohm; it may depend on any variable, such as a temperature ``across(winding)``.

    Example:
        >>> Resistor("R1", ("in", "out"), resistance=100.0).kind
        'resistor'
    """

    resistance: Any = None
    kind = "resistor"
    domain_name = ELECTRICAL.name
    required = ("resistance",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Residual of Ohm's law: the voltage less that of the resistance (V)."""
        return (at.X[0] - at.value(self.resistance) * at.Y[0],)


@dataclass(frozen=True)
class Conductance(Dissipator):
    """A conductance: ``Y = conductance X``.

    Ohm's law solved for the current; it turns ``conductance X²`` (W) into heat. Unlike a resistor it may be
    an open circuit, and unlike a resistor no short circuit.

    Attributes:
        conductance: S; it may be 0, an open switch.

    Example:
        >>> Conductance("leak", ("plate", "ground"), conductance=1e-9).kind
        'conductance'
    """

    conductance: Any = None
    kind = "conductance"
    domain_name = ELECTRICAL.name
    required = ("conductance",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Residual of Ohm's law: the current less that of the conductance (A)."""
        return (at.Y[0] - at.value(self.conductance) * at.X[0],)


@dataclass(frozen=True)
class Capacitor(AcrossStore):
    """A capacitor: ``Y = d/dt (capacitance X)``, or by its charge or co-energy.

    In general ``Y = dQ/dt`` with the charge ``Q = ∂W'/∂X`` (A s) on the plate at the tail. It keeps its
    voltage and stores ``Q X - W'`` (J), which is ``capacitance X² / 2`` if it is linear.

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
        """Charge for a volt: the capacitance (F)."""
        return at.value(self.capacitance)


@dataclass(frozen=True)
class Inductor(ThroughStore):
    """An inductor: ``X = d/dt (inductance Y)``, or by its flux linkage or co-energy.

    Faraday's law ``X = dΛ/dt`` with the flux linkage ``Λ = ∂W'/∂Y`` (V s). It keeps its current and stores
    ``Λ Y - W'`` (J), which is ``inductance Y² / 2`` if it is linear.

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
        """Flux linkage for an ampere: the inductance (H)."""
        return at.value(self.inductance)


@dataclass(frozen=True)
class CoupledInductors(Component):
    """Inductors that share their flux: ``X = d/dt (inductance Y)`` with a symmetric matrix.

    Its edges are "winding1", "winding2", ... X is the column of their voltages, Y that of their currents; a
    positive mutual inductance is that of windings whose tails are the dotted ends. It keeps all currents and
    stores ``Y^T inductance Y / 2`` (J), which is positive only if the matrix is positive definite.

    Attributes:
        windings: the vertices of each, (tail, head).
        inductance: the matrix, row by row (H): self-inductances on the diagonal, mutual ones beside it.

    Example:
        >>> pair = (("a", "ground"), ("b", "ground"))
        >>> CoupledInductors("T", pair, inductance=((2.0, 0.9), (0.9, 0.5))).kept()
        ('through', 'through')
    """

    windings: tuple[Pair, ...]
    inductance: tuple[tuple[Any, ...], ...] = ()
    kind = "coupled_inductors"

    def ports(self) -> tuple[Port, ...]:
        """An electrical edge for each winding, in order."""
        return tuple(
            Port(f"winding{k + 1}", ELECTRICAL.name, ends) for k, ends in enumerate(self.windings)
        )

    def kept(self) -> tuple[str, ...]:
        """The current of every winding."""
        return (THROUGH,) * len(self.windings)

    def kept_coenergy(self, at: Terminals) -> Scalar:
        """``W' = Y^T inductance Y / 2`` (J), each mutual inductance counted once."""
        rows = [[at.value(entry) for entry in row] for row in self.inductance]
        total: Scalar = 0
        for i, row in enumerate(rows):
            total = total + row[i] * (at.Y[i] * at.Y[i] / 2)
            for j in range(i):
                total = total + row[j] * (at.Y[i] * at.Y[j])
        return total

    def require_fields(self) -> None:
        """Refuse fewer than two windings and a matrix that does not fit them.

        Raises:
            ModelError: fewer than two windings, a matrix of another size, or one that is not symmetric as it
                is written.
        """
        n, who = len(self.windings), f'{self.kind} "{self.name}"'
        if n < 2:
            raise ModelError(who, "windings: at least two are needed, each [tail, head]")
        if len(self.inductance) != n or any(len(row) != n for row in self.inductance):
            raise ModelError(who, f"inductance: a {n} x {n} matrix is needed for {n} windings")
        rows = self.inductance
        if any(str(rows[i][j]) != str(rows[j][i]) for i in range(n) for j in range(i)):
            raise ModelError(who, "inductance: the matrix is not symmetric")


@dataclass(frozen=True)
class Diode(Dissipator):
    """A diode: ``Y = saturation (exp(X / voltage) - 1)``.

    The law of the ideal junction [Shockley 1949]: it conducts from tail to head, where X > 0, and lets no
    more than `saturation` through backwards. Neither breakdown, nor series resistance, nor the charge of the
    junction is part of it; add those as components of their own.

    Attributes:
        saturation: the current it lets through backwards (A).
        voltage: thermal voltage times ideality (V).

    Example:
        >>> Diode("D1", ("in", "out"), saturation=1e-12).kind
        'diode'
    """

    saturation: Any = 1e-14
    voltage: Any = 0.02585
    kind = "diode"
    domain_name = ELECTRICAL.name

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Residual of Shockley's law: the current less that of the junction (A)."""
        grown = at.function("exp", at.X[0] / at.value(self.voltage))
        return (at.Y[0] - at.value(self.saturation) * (grown - 1),)


@dataclass(frozen=True)
class OpAmp(Component):
    """An ideal operational amplifier, a nullor: at its input X = Y = 0, at its output anything.

    Its edges are "input" and "output". Infinite gain in negative feedback: the network around it sets the
    voltage and the current of the output so that no voltage is left at the input. Both laws are about the
    input, none about the output, so the power it delivers comes from outside.

    Attributes:
        between: its inputs (plus, minus).
        output: the vertices of its output, mostly (out, ground).

    Example:
        >>> OpAmp("stage", ("ground", "minus"), ("out", "ground")).kind
        'opamp'
    """

    between: Pair
    output: Pair
    kind = "opamp"
    source = True

    def ports(self) -> tuple[Port, ...]:
        """The electrical edges "input" and "output"."""
        domain = ELECTRICAL.name
        return Port("input", domain, self.between), Port("output", domain, self.output)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Voltage (V) and current (A) of the input, both zero."""
        return at.X[0], at.Y[0]


_types = Twins(ELECTRICAL, __name__)

VoltageSource = _types.across_source("voltage_source", "voltage")
CurrentSource = _types.through_source("current_source", "current")
