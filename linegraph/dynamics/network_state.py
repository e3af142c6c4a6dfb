"""A network at a state: its equations over any algebra, with what mechanics tells it and takes from it.

The network is derived once, over symbols of its own; here these get their values: its states from v, the
rates and displacements of its edges in mechanics from the tree, parameters, inputs and the time from the
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
"""What of the forces is meant: with all inputs zero, what inputs add to that, both, or nothing."""


@dataclass(frozen=True)
class EdgeMotion:
    """How an edge in 3-D mechanics moves.

    Attributes:
        x, w: displacement and rate.
        row: its rate by velocity: ``w = Σ row v`` and what is prescribed.
        bias: its acceleration at v̇ = 0; None where no formula gives it.
    """

    x: Scalar
    w: Scalar
    row: tuple[tuple[int, Scalar], ...]
    bias: Scalar | None = 0


@dataclass
class Exchange:
    """A network at a state.

    Attributes:
        network: what was derived.
        state: the links and where they are; the network's states are among v.
        names: what else of the model laws may name.
        motion: of an edge in mechanics, by its name.
        acceleration: v̇, where it is known.
    """

    network: Network
    state: TreeState
    names: Mapping[str, Scalar]
    motion: Callable[[str], EdgeMotion]
    acceleration: Sequence[Scalar] | None = None
    _motions: dict[str, EdgeMotion] = field(default_factory=dict)

    @property
    def first(self) -> int:
        """Where the network's states begin in v."""
        return self.state.tree.layout.mechanical

    def motion_of(self, port: str) -> EdgeMotion:
        """How an edge in mechanics moves, found once."""
        if port not in self._motions:
            self._motions[port] = self.motion(port)
        return self._motions[port]

    # -- the equations of motion

    def force(self, row: int, what: str) -> Scalar:
        """F of a row: a state's, or what an edge in mechanics drives with, at v̇ = 0."""
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
        """What an edge in mechanics accelerates with at v̇ = 0."""
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
        """What the network adds to the mass matrix: row, column, entry; rows and columns may repeat."""
        for (i, j), entry in self.network.mass.items():
            value = self.still(entry)
            for row, left in self.projected(i):
                for column, right in self.projected(j):
                    yield row, column, left * right * value

    def projected(self, place: int) -> tuple[tuple[int, Scalar], ...]:
        """Where a row or column of the network stands in the whole."""
        count = len(self.network.states)
        if place < count:
            return ((self.first + place, 1),)
        return self.motion_of(self.network.ports[place - count].name).row

    def coordinate_of(self, port: int) -> tuple[tuple[int, Scalar], ...]:
        """The same of an edge in mechanics."""
        return self.projected(len(self.network.states) + port)

    # -- every variable

    def across(self, edge: str) -> Scalar:
        """X of an edge."""
        return self._moving(self.network.variables[edge][0])

    def through(self, edge: str) -> Scalar:
        """Y of an edge."""
        return self._moving(self.network.variables[edge][1])

    def size(self, edge: str, place: int) -> Scalar:
        """How large the terms are that X (0) or Y (1) of an edge is the sum of."""
        return self._moving(self.network.variable_sizes[edge][place])

    def heat(self, component: str) -> Scalar:
        """The power that a component turns into heat."""
        return self._moving(self.network.heat[component])

    def gains(self) -> dict[str, Scalar]:
        """Of each component what it stores and turns into heat, less what it takes in: zero."""
        return {name: self._moving(x) for name, x in self.network.gains.items()}

    def energy(self) -> Scalar:
        """What the network's stores hold."""
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
        """``across(R1)`` and ``through(R1)`` of every edge, evaluated as they are looked up."""
        return _Variables(self)

    # -- symbols

    @cached_property
    def still(self) -> Replay:
        """Scalars at v̇ = 0."""
        return Replay(self.state.algebra, lambda symbol: self._value(symbol, None))

    @cached_property
    def _moving(self) -> Replay:
        """Scalars with the rates they have, if these are known."""
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
        """What is zero in the algebraic loop."""
        return [self.still(residue) for residue in self.network.loop]

    @cached_property
    def solved(self) -> list[float]:
        """The unknowns of the algebraic loop, in floats."""
        return solved(self.network, lambda symbol: float(self._value(symbol, None)))


class _Variables(dict[str, Any]):
    """Looks edges up when they are named."""

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
