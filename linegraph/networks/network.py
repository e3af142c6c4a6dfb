"""The derived network, as the rest of the program uses it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from linegraph.algebra.differentiation import TermSizes, substitution
from linegraph.algebra.residues import CONSTANT, Residues
from linegraph.errors import ModelError
from linegraph.networks.static import EASE, LOOP

if TYPE_CHECKING:
    from linegraph.algebra.differentiation import Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Component
    from linegraph.components.scalar.branches import Branch
    from linegraph.graph.forest import Topology
    from linegraph.ir.dag import Dag
    from linegraph.ir.program import Quantity
    from linegraph.networks.law_records import Laws

INPUTS = ("u", "du", "ddu")
RATE, SHAFT_RATE = "dz", "dw"
"""Symbols of the rates of states, by their index, and of the accelerations of ports in mechanics."""


@dataclass(frozen=True)
class State:
    """A state of a network: its quantity, and the symbol that it has in the laws."""

    quantity: Quantity
    key: Symbol


@dataclass(frozen=True)
class Network:
    """The equations ``𝓜 ż = f`` of a network, with all its edges.

    Attributes:
        laws: its terminal equations, with the DAG of all scalars.
        branches: its edges.
        topologies: the chosen tree of each subspace.
        states: z, in the order of the components.
        mass: 𝓜 by (row, column), states first, then ports in 3-D mechanics; zero entries are left out.
        force: f by row; for a port in mechanics the force or torque with which it drives.
        variables: (X, Y) of every edge; they may contain the rates of states.
        loop: residuals of the algebraic loop; its unknowns are symbols.
        pivots: divisors that must not vanish.
        dependent: stores that are no states, with those that determine them.
        rates: inputs whose derivative is needed, with its order.
        remarks: for readers of the model.
        energy, heat: stored (J) and dissipated (W) by each component.
        heats: subspaces in which through times across is not a power.
        loop_names: names of the unknowns of the algebraic loop.
        eased: residuals of the loop with resistances at its laws, the symbols `EASE`, which Newton's method
            lets vanish where it does not succeed without.
    """

    laws: Laws
    branches: tuple[Branch, ...]
    topologies: tuple[Topology, ...]
    states: tuple[State, ...]
    mass: dict[tuple[int, int], Scalar]
    force: tuple[Scalar, ...]
    variables: dict[str, tuple[Scalar, Scalar]]
    loop: tuple[Scalar, ...]
    pivots: tuple[Scalar, ...]
    dependent: dict[str, tuple[str, ...]]
    rates: dict[str, int]
    remarks: tuple[str, ...]
    energy: dict[str, Scalar] = field(default_factory=dict)
    heat: dict[str, Scalar] = field(default_factory=dict)
    heats: frozenset[str] = frozenset()
    loop_names: tuple[str, ...] = ()
    eased: tuple[Scalar, ...] = ()

    @property
    def dag(self) -> Dag:
        """The DAG of all its scalars."""
        return self.laws.dag

    @cached_property
    def ports(self) -> tuple[Branch, ...]:
        """The ports in 3-D mechanics."""
        return tuple(branch for branch in self.branches if branch.port.spatial)

    @cached_property
    def symmetric(self) -> bool:
        """Whether 𝓜 is symmetric. Controlled sources, which may generate power, can make it unsymmetric."""
        residues = Residues()
        return all(
            residues(entry) == residues(self.mass.get((j, i), 0))
            for (i, j), entry in self.mass.items()
        )

    def owner(self, state: State) -> Component:
        """The component to which a state belongs."""
        place = str(state.key[1])
        names = (place, place.rpartition(".")[0])
        return next(
            branch.component
            for branch in self.branches
            if branch.name == names[0] or branch.component.name == names[1]
        )

    @cached_property
    def places(self) -> dict[Symbol, int]:
        """The index of each state, by its symbol."""
        return {state.key: k for k, state in enumerate(self.states)}

    @cached_property
    def loop_jacobian(self) -> list[list[Scalar]]:
        """The derivatives of the loop's residuals with respect to its unknowns."""
        size = range(len(self.loop))
        return [[self.laws.calculus.derivative(r, (LOOP, k)) for k in size] for r in self.loop]

    @cached_property
    def eased_jacobian(self) -> list[list[Scalar]]:
        """The derivatives of the loop's residuals with resistances, with respect to its unknowns."""
        size = range(len(self.loop))
        return [[self.laws.calculus.derivative(r, (LOOP, k)) for k in size] for r in self.eased]

    @cached_property
    def loop_needs(self) -> frozenset[Symbol]:
        """The symbols on which the algebraic loop depends, without its unknowns."""
        slopes = (slope for row in self.eased_jacobian for slope in row)
        supports = (self.laws.calculus.support(x) for x in (*self.eased, *slopes, *self.loop_sizes))
        return frozenset(s for support in supports for s in support if s[0] not in (LOOP, EASE))

    @cached_property
    def loop_sizes(self) -> list[Scalar]:
        """The size of the terms of each residual: at a solution it is zero up to the rounding of these.

        Terms without unknowns are constant during the search: their size is their own value, however steeply
        they depend on the time or an input.
        """
        return [TermSizes(self.laws.calculus, (LOOP,))(r) for r in self.loop]

    @cached_property
    def force_slopes(self) -> list[list[Scalar]]:
        """The derivatives of f, by row, with respect to the unknowns of the algebraic loop."""
        size = range(len(self.loop))
        return [[self.laws.calculus.derivative(f, (LOOP, k)) for k in size] for f in self.force]

    @cached_property
    def variable_sizes(self) -> dict[str, tuple[Scalar, Scalar]]:
        """The size of the terms of X and of Y, for every edge."""
        sizes = TermSizes(self.laws.calculus)
        return {name: (sizes(x), sizes(y)) for name, (x, y) in self.variables.items()}

    @cached_property
    def parts(self) -> dict[str, tuple[Scalar, ...]]:
        """By row, f with all inputs zero ("resting"), what inputs add to it ("driven"), and both ("all").

        Where inputs are in an algebraic loop, or are divided by, the two cannot be separated, and all of f
        counts as resting.
        """
        calculus, dag = self.laws.calculus, self.dag
        support = {s for row in self.loop for s in calculus.support(row)}
        inputs = {s for row in self.force for s in calculus.support(row) if s[0] in INPUTS}
        if any(symbol[0] in INPUTS for symbol in support):
            return {"resting": self.force, "driven": (0,) * len(self.force), "all": self.force}
        try:
            resting = tuple(substitution(dag, dict.fromkeys(inputs, 0)).all(self.force))
        except (ArithmeticError, ModelError):
            # an input in a denominator cannot be set to zero
            return {"resting": self.force, "driven": (0,) * len(self.force), "all": self.force}
        pairs = zip(self.force, resting, strict=True)
        driven = tuple(self._added(row, rest) for row, rest in pairs)
        return {"resting": resting, "driven": driven, "all": self.force}

    @cached_property
    def part_sizes(self) -> dict[str, tuple[Scalar, ...]]:
        """The size of the terms of each row of `parts`."""
        sizes = TermSizes(self.laws.calculus)
        return {what: tuple(sizes(x) for x in rows) for what, rows in self.parts.items()}

    @cached_property
    def affine(self) -> bool:
        """Whether f is affine in the inputs, so that their contribution needs no difference of two values."""
        calculus = self.laws.calculus
        return not any(
            symbol[0] in INPUTS and any(s[0] in INPUTS for s in calculus.support(slope))
            for row in self.force
            for symbol, slope in calculus.gradient(row).items()
        )

    def require_linear(self) -> None:
        """Refuse a network whose rates are not linear in its states and inputs.

        Raises:
            ModelError: names a state whose rate is not linear.
        """
        calculus = self.laws.calculus
        variables = {*self.places} | {
            s for row in self.force for s in calculus.support(row) if s[0] in (*INPUTS, "x", "w")
        }
        for (i, _), entry in self.mass.items():
            if calculus.support(entry) & variables:
                raise self._curved(i)
        for i, row in enumerate(self.force):
            slopes = calculus.gradient(row)
            if any(symbol[0] == LOOP for symbol in slopes) or any(
                calculus.support(slope) & variables
                for symbol, slope in slopes.items()
                if symbol in variables
            ):
                raise self._curved(i)

    def _curved(self, row: int) -> ModelError:
        name = self.states[row].quantity.name if row < len(self.states) else "an edge in mechanics"
        problem = "its rate is not linear in states and inputs: there is no state space"
        return ModelError(f'"{name}"', problem)

    def _added(self, row: Scalar, resting: Scalar) -> Scalar:
        """The contribution of inputs to a row: their slopes times them, if these are free of inputs."""
        slopes = {
            symbol: slope
            for symbol, slope in sorted(self.laws.calculus.gradient(row).items(), key=_symbol_first)
            if symbol[0] in INPUTS
        }
        if any(
            s[0] in INPUTS for slope in slopes.values() for s in self.laws.calculus.support(slope)
        ):
            return row - resting
        total: Scalar = 0
        for symbol, slope in slopes.items():
            total = total + slope * self.dag.symbol(*symbol)
        return total

    def rate(self, x: Scalar) -> Scalar:
        """The total time derivative of a scalar of states, displacements, inputs and the time."""
        total: Scalar = 0
        follows = {"x": "w", "w": SHAFT_RATE, "u": "du", "du": "ddu"}
        residues = Residues()
        for (kind, place), slope in self.laws.calculus.gradient(x).items():
            if not residues(slope):
                continue  # it cancels
            rate: Scalar = 1
            if (kind, place) in self.places:
                rate = self.dag.symbol(RATE, self.places[(kind, place)])
            elif kind == "name":
                rate = self.dag.symbol("name", f"der({place})")
            elif kind in follows:
                rate = self.dag.symbol(follows[kind], place)
            elif kind in ("p", CONSTANT):
                continue
            total = total + slope * rate
        return total

    @cached_property
    def gains(self) -> dict[str, Scalar]:
        """For each component the power that it stores and dissipates less the power that it takes in: zero.

        Left out are sources, stores of unknown energy, stores that the time, inputs or other components
        change, and thermal components, whose through times across is not a power.
        """
        found: dict[str, Scalar] = {}
        for component in dict.fromkeys(branch.component for branch in self.branches):
            own = [b for b in self.branches if b.component is component]
            hot = any(b.port.domain in self.heats for b in own)
            if component.source or hot or component.name in self.unknown:
                continue
            if self._foreign(component):
                continue
            taken = self.rate(self.energy[component.name]) + self.heat[component.name]
            for branch in own:
                x, y = self.variables[branch.name]
                taken = taken - x * y
            found[component.name] = taken
        return found

    def _foreign(self, component: Component) -> bool:
        """Whether the energy of a component depends on variables of others."""
        own = {branch.name for branch in self.branches if branch.component is component}
        return any(
            kind not in ("p", CONSTANT)
            and place not in own
            and not str(place).startswith(f"{component.name}.")
            for kind, place in self.laws.calculus.support(self.laws.energy[component.name])
        )

    @cached_property
    def unknown(self) -> frozenset[str]:
        """The components of unknown energy: elements with a state, and stores that no rule integrates."""
        kinds = {branch.component for branch in self.branches}
        lawless = {c.name for c in kinds if getattr(c, "rate", None) is not None}
        return frozenset(lawless | self.laws.unknown)

    @cached_property
    def powerful(self) -> frozenset[str]:
        """The components whose ports are in subspaces where through times across is a power."""
        return frozenset(
            branch.component.name
            for branch in self.branches
            if branch.port.domain not in self.heats
        )

    @cached_property
    def domains(self) -> tuple[str, ...]:
        """The names of its scalar subspaces."""
        return tuple(topology.projection.domain for topology in self.topologies)


def _symbol_first(item: tuple[Symbol, Scalar]) -> str:
    """A sort key for slopes, so that the order of terms does not depend on how they were found."""
    return repr(item[0])
