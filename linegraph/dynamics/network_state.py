"""A scalar network at a state: its equations over any algebra, coupled to mechanics.

A network is derived once, over symbols of its own. Here the symbols get values: its states from v,
displacements and rates of its edges in mechanics from the tree, parameters, inputs and time from the
model.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.algebra.differentiation import Replay
from linegraph.algebra.formula import variable_of
from linegraph.algebra.protocol import Floats
from linegraph.algebra.residues import CONSTANT
from linegraph.components.scalar.base import ACROSS
from linegraph.errors import ModelError
from linegraph.networks.network import RATE, SHAFT_RATE
from linegraph.networks.newton import solved
from linegraph.networks.static import EASE, LOOP

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.tree_state import TreeState
    from linegraph.networks import Network

RESTING, DRIVEN, ALL, NONE = "resting", "driven", "all", "none"
"""Parts of a network's forces: with all inputs zero, the addition by inputs, both, or nothing."""


@dataclass(frozen=True)
class EdgeMotion:
    """Motion of an edge of a network in 3-D mechanics.

    Attributes:
        x, w: displacement (rad or m) and rate (rad/s or m/s).
        row: coefficients of the rate by velocity: ``w = Σ row v``, plus prescribed motion.
        bias: acceleration at v̇ = 0; None if there is no formula for it.
    """

    x: Scalar
    w: Scalar
    row: tuple[tuple[int, Scalar], ...]
    bias: Scalar | None = 0


@dataclass
class Exchange:
    """A network at a state, coupled to mechanics.

    Attributes:
        network: the derived network.
        state: the tree at (q, v); the network's states are among v.
        names: other names that laws may use, with their scalars.
        motion: returns the motion of an edge in mechanics, by its name.
        acceleration: v̇, if it is known.
    """

    network: Network
    state: TreeState
    names: Mapping[str, Scalar]
    motion: Callable[[str], EdgeMotion]
    acceleration: Sequence[Scalar] | None = None
    _motions: dict[str, EdgeMotion] = field(default_factory=dict)

    @property
    def first(self) -> int:
        """Index of the network's first state in v."""
        return self.state.tree.layout.mechanical

    def motion_of(self, port: str) -> EdgeMotion:
        """The motion of an edge in mechanics, computed once."""
        if port not in self._motions:
            self._motions[port] = self.motion(port)
        return self._motions[port]

    # -- the equations of motion

    def force(self, row: int, what: str) -> Scalar:
        """Right-hand side F of one row of the network at v̇ = 0.

        Args:
            row: a state of the network, or after these an edge in mechanics, whose driving force F is.
            what: `RESTING`, `DRIVEN`, `ALL` or `NONE`.

        Raises:
            ModelError: an edge in mechanics has no formula for its acceleration.
        """
        if what == NONE:
            return 0
        found = self.still(self.network.parts[what][row])
        if what != DRIVEN:
            for k, port in enumerate(self.network.ports):
                entry = self.network.mass.get((row, len(self.network.states) + k))
                if entry is not None:
                    found = found - self.still(entry) * self._bias(port.name)
        return found

    def _bias(self, port: str) -> Scalar:
        """Acceleration of an edge in mechanics at v̇ = 0."""
        bias = self.motion_of(port).bias
        if bias is None:
            problem = (
                "reflects inertia to a joint whose own coordinate is no coordinate of the system; put it in "
                "a joint that is a branch: name that in [formulation] tree, or keep joint coordinates there"
            )
            component = next(p.component for p in self.network.ports if p.name == port)
            raise ModelError(f'{component.kind} "{component.name}"', problem)
        return bias

    def inertia(self) -> Iterator[tuple[int, int, Scalar]]:
        """Entries that the network adds to the mass matrix: row, column, value; places may repeat."""
        for (i, j), entry in self.network.mass.items():
            value = self.still(entry)
            for row, left in self.projected(i):
                for column, right in self.projected(j):
                    yield row, column, left * right * value

    def projected(self, place: int) -> tuple[tuple[int, Scalar], ...]:
        """The velocities, with factors, that a row or column of the network belongs to."""
        count = len(self.network.states)
        if place < count:
            return ((self.first + place, 1),)
        return self.motion_of(self.network.ports[place - count].name).row

    def coordinate_of(self, port: int) -> tuple[tuple[int, Scalar], ...]:
        """The velocities, with factors, that an edge in mechanics belongs to."""
        return self.projected(len(self.network.states) + port)

    # -- every variable

    def across(self, edge: str) -> Scalar:
        """Across variable X of an edge."""
        return self._moving(self.network.variables[edge][0])

    def through(self, edge: str) -> Scalar:
        """Through variable Y of an edge."""
        return self._moving(self.network.variables[edge][1])

    def size(self, edge: str, place: int) -> Scalar:
        """Size of the terms whose sum is a variable of an edge: the scale of its rounding.

        Args:
            edge: name of the edge.
            place: 0 for the across, 1 for the through variable.
        """
        return self._moving(self.network.variable_sizes[edge][place])

    def heat(self, component: str) -> Scalar:
        """The power that a component turns into heat (W)."""
        return self._moving(self.network.heat[component])

    def gains(self) -> dict[str, Scalar]:
        """The energy balance of each component, stored plus heat less taken in (W): zero."""
        return {name: self._moving(x) for name, x in self.network.gains.items()}

    def energy(self) -> Scalar:
        """The energy in the network's stores (J)."""
        total: Scalar = 0
        for name, stored in self.network.energy.items():
            if name not in self.network.powerful:
                continue
            try:
                total = total + self._moving(stored)
            except ModelError as error:
                kind = next(
                    b.component.kind for b in self.network.branches if b.component.name == name
                )
                raise ModelError(f'{kind} "{name}"', f"its energy: {error.problem}") from None
        return total

    def variables(self) -> dict[str, Scalar]:
        """Variables ``across(R1)`` and ``through(R1)`` of every edge, evaluated on look-up."""
        return _Variables(self)

    # -- symbols

    @cached_property
    def still(self) -> Replay:
        """Replay of the network's scalars at v̇ = 0."""
        return Replay(self.state.algebra, lambda symbol: self._value(symbol, None))

    @cached_property
    def _moving(self) -> Replay:
        """Replay of the network's scalars with their rates, if these are known."""
        return Replay(self.state.algebra, lambda symbol: self._value(symbol, self.acceleration))

    def _value(self, symbol: Symbol, acceleration: Sequence[Scalar] | None) -> Scalar:
        kind, place = symbol
        if symbol in self.network.places:
            return self.state.v[self.first + self.network.places[symbol]]
        if kind in (RATE, SHAFT_RATE):
            if acceleration is None:
                problem = "depends on rates, which are known only once the equations are solved"
                raise ModelError("", problem)
            return self._rate(kind, place, acceleration)
        if kind == "x":
            return self.motion_of(place).x
        if kind == "w":
            return self.motion_of(place).w
        if kind == "p":
            return self.state.tree.parameters[place]
        if kind == CONSTANT:
            return float(Fraction(place))
        if kind == "t":
            return self.state.algebra.symbol("t")
        if kind in ("u", "du", "ddu"):
            return self.state.tree.layout.input_rates[(kind, place)]
        if kind == LOOP:
            return self._loop(place)
        if kind == EASE:
            return self.state.algebra.symbol(kind, place)
        if place not in self.names:
            raise ModelError("", f"{place} is not known here")
        return self.names[place]

    def _rate(self, kind: str, place: Any, acceleration: Sequence[Scalar]) -> Scalar:
        if kind == RATE:
            return acceleration[self.first + place]
        total = self._bias(place)
        for index, slope in self.motion_of(place).row:
            total = total + slope * acceleration[index]
        return total

    def _loop(self, place: int) -> Scalar:
        if isinstance(self.state.algebra, Floats):
            return self.solved[place]
        return self.state.algebra.symbol("loop", place)

    def algebraic_loop(self) -> list[Scalar]:
        """Residuals of the algebraic loop: zero at its solution."""
        return [self.still(residue) for residue in self.network.loop]

    @cached_property
    def solved(self) -> list[float]:
        """The unknowns of the algebraic loop, solved in floats."""
        return solved(self.network, lambda symbol: float(self._value(symbol, None)))


class _Variables(dict[str, Any]):
    """Variables of edges, evaluated on look-up."""

    def __init__(self, exchange: Exchange) -> None:
        super().__init__()
        self._exchange = exchange

    def _edge(self, name: object) -> tuple[str, str] | None:
        kind, edge, part = variable_of(str(name)) or ("", "", "")
        known = kind in ("across", "through") and not part
        return (kind, edge) if known and edge in self._exchange.network.variables else None

    def __contains__(self, name: object) -> bool:
        return self._edge(name) is not None

    def __getitem__(self, name: str) -> Scalar:
        found = self._edge(name)
        if found is None:
            raise KeyError(name)
        kind, edge = found
        return self._exchange.across(edge) if kind == ACROSS else self._exchange.through(edge)
