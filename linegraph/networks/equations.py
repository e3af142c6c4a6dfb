"""The equations ``𝓜 ż = f`` of a network over its states, with the forces that it exerts on mechanics.

Each store whose variable is a state gives a row, ``d/dt charge + rest = other variable``. Stores that depend
on them add to 𝓜 by the same equations, as masses do in the paper's congruence: their other variable is the
rate of a charge that the states determine. Where 𝓜 is still singular, its null combinations are constraints
among the states, which are solved and differentiated until it is regular.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.algebra.differentiation import Replay, substitution
from linegraph.algebra.residues import Residues
from linegraph.components.domains import DOMAINS
from linegraph.components.scalar.branches import dangling, edges_of, projections
from linegraph.errors import ModelError
from linegraph.ir.program import Quantity
from linegraph.networks.laws import laws_of
from linegraph.networks.network import RATE, SHAFT_RATE, Network, State
from linegraph.networks.rates import Rates
from linegraph.networks.reduction import Reduction
from linegraph.networks.selection import select
from linegraph.networks.static import DUAL, Solver, pruned, substituting

INTERFACES = ("rotational_interface", "translational_interface")

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.domains import Domain
    from linegraph.components.scalar.branches import Branch
    from linegraph.model.system import System
    from linegraph.networks.law_records import Laws, StoreLaw
    from linegraph.networks.selection import Selection
    from linegraph.networks.static import Statics


def network_of(model: System) -> Network | None:
    """Derive the network of a system; None if it has no components.

    Raises:
        ModelError: the network has no equations; the message names the components at fault.
    """
    if not model.components:
        return None
    branches = edges_of(model.components)
    _require_places(model, branches)
    graphs = projections(branches)
    laws = laws_of(model, branches, graphs)
    wanted = [name for name in model.choices.tree if any(b.name == name for b in branches)]
    selection = select(branches, graphs, laws, wanted)
    statics = Solver(branches, laws, selection).solve()
    return _Derivation(model, branches, laws, selection, statics).network()


def _require_places(model: System, branches: Sequence[Branch]) -> None:
    """Refuse ports in mechanics of the wrong kind, such as 1-D rotation at a joint that slides."""
    units = {joint.name: [q.unit for q in joint.velocities()] for joint in model.joints}
    for branch in branches:
        component = branch.component
        turns = getattr(component, "turns", False)
        who = f'{component.kind} "{component.name}"'
        if branch.port.points is not None and turns:
            raise ModelError(who, "turns, so it has no place between points; give joint or shaft")
        wanted = "rad/s" if turns else "m/s"
        if component.kind in INTERFACES and units.get(branch.port.joint or "", [wanted]) != [
            wanted
        ]:
            word = "turns" if turns else "slides"
            raise ModelError(who, f'joint "{branch.port.joint}" is none of one freedom that {word}')


class _Derivation:
    """Derives 𝓜 and f from the values of the static variables."""

    def __init__(
        self,
        model: System,
        branches: Sequence[Branch],
        laws: Laws,
        selection: Selection,
        statics: Statics,
    ) -> None:
        self._model, self._branches, self._laws = model, branches, laws
        self._selection, self._statics = selection, statics
        self._dag, self._calculus = laws.dag, laws.calculus
        self._residues = Residues()
        self._states = self._listed()
        self._rates = Rates(self._first, self._calculus, self._states, selection.dependent)
        self._place = self._rates.places
        self._valued = substituting(laws, statics.kirchhoff, statics.values)

    def network(self) -> Network:
        """Derive rates, rows, dependent stores and constraints, and collect them."""
        # rates that static laws give are written as such, so that 𝓜 stays symmetric
        for own in self._laws.own:
            rate = self._put(own.rate)
            if not any(kind == DUAL for kind, _ in self._calculus.support(rate)):
                self._rates.known[own.key] = rate
        for residual in self._statics.residuals:
            for kind, place in self._calculus.support(residual):
                if kind == DUAL:
                    raise self._rates.too_deep(kind, place)
        duals = self._duals()
        complete = substitution(self._dag, duals)
        variables = {
            b.name: (complete(self._put(self._across(b))), complete(self._put(self._through(b))))
            for b in self._branches
        }
        rows = [complete(row) for row in self._rows()]
        for store in self._laws.spatial:
            x, _ = variables[store.edge]
            own = self._rates.of(self._put(store.charge)) + complete(self._put(store.rest))
            variables[store.edge] = (x, own)
        reduction = Reduction(self._rates, self._calculus, self._states, self._owners())
        gone = reduction.reduce(rows, variables)
        later = reduction.later
        states = tuple(s for k, s in enumerate(self._states) if k not in gone)
        ports = [b for b in self._branches if b.port.spatial]
        rows += [variables[port.name][1] for port in ports]
        renumbered = self._renumbered(states)
        rows = renumbered.all(rows)
        variables = {name: (renumbered(x), renumbered(y)) for name, (x, y) in variables.items()}
        rates = self._input_rates([*rows, *(x for pair in variables.values() for x in pair)])
        mass, force = self._split(rows, len(states), [port.name for port in ports])

        def put(given: Mapping[str, Scalar]) -> dict[str, Scalar]:
            return {k: renumbered(later(complete(self._put(x)))) for k, x in given.items()}

        found = Network(
            self._laws,
            tuple(self._branches),
            self._selection.topologies,
            states,
            mass,
            tuple(force),
            variables,
            tuple(later.all(self._statics.residuals)),
            tuple(later.all(self._statics.pivots)),
            self._selection.dependent,
            rates,
            self._remarks(rates),
            put(self._laws.energy),
            put(self._laws.heat),
            frozenset(n for n in {*self._model.domains, *DOMAINS} if not self._domain(n).power),
            tuple(self._called(symbol) for symbol in self._statics.loop),
            tuple(later.all(self._statics.eased)),
        )
        self._require_order(found)
        return found

    @property
    def _who(self) -> str:
        return f'model "{self._model.name}"'

    @property
    def _first(self) -> str:
        """The component of the first dependent store, for errors; the model if there is none."""
        for branch in self._branches:
            if branch.name in self._selection.dependent:
                return f'{branch.component.kind} "{branch.component.name}"'
        return self._who

    def _put(self, x: Scalar) -> Scalar:
        """A scalar in terms of states, inputs and those variables that only rates determine.

        Kirchhoff's laws add the latter and subtract them again: the charge of a dependent store does not
        depend on rates, though every edge of its circuit may, so that such symbols are pruned.
        """
        return self._pruned(self._valued(x))

    def _pruned(self, x: Scalar) -> Scalar:
        return pruned(x, self._calculus, self._residues, lambda symbol: symbol[0] == DUAL)

    # -- states and their rates

    def _listed(self) -> list[State]:
        """The states in the order of the components; a component's stored variables before its own states."""
        order = {c.name: k for k, c in enumerate(self._model.components)}
        branch = {b.name: b for b in self._branches}
        found: list[tuple[int, State]] = []
        for store in self._selection.states:
            b = branch[store.edge]
            domain = self._domain(b.port.domain)
            variable = domain.across if store.key[0] == "X" else domain.through
            where = "across" if store.key[0] == "X" else "through"
            name = f"{variable.letter}_{self._short(b, store)}"
            about = f"{variable.name} {where} {store.edge}"
            found.append(
                (order[b.component.name], State(Quantity(name, variable.symbol, about), store.key))
            )
        for own in self._laws.own:
            component = str(own.key[1]).partition(".")[0]
            found.append((order[component], State(own.quantity, own.key)))
        return [state for _, state in sorted(found, key=lambda pair: pair[0])]

    def _called(self, symbol: Symbol) -> str:
        """The name of an across or through variable, with the letter of its domain."""
        kind, edge = symbol
        branch = next(b for b in self._branches if b.name == edge)
        domain = self._domain(branch.port.domain) if branch.port.domain else None
        letter = {"X": "across", "Y": "through"}[kind]
        if domain is not None:
            letter = domain.across.letter if kind == "X" else domain.through.letter
        return f"{letter}_{edge.replace('.', '_')}"

    def _short(self, branch: Branch, store: StoreLaw) -> str:
        """The component's name, or the edge's if the component stores several variables in one domain."""
        alike = [
            b
            for b in self._branches
            if b.component is branch.component and b.kept and b.port.domain == branch.port.domain
        ]
        return branch.component.name if len(alike) == 1 else store.edge.replace(".", "_")

    def _domain(self, name: str) -> Domain:
        return self._model.domains.get(name) or DOMAINS[name]

    def _across(self, branch: Branch) -> Scalar:
        return self._dag.symbol("w" if branch.port.spatial else "X", branch.name)

    def _through(self, branch: Branch) -> Scalar:
        return self._dag.symbol("Y", branch.name)

    # -- rows

    def _duals(self) -> dict[Symbol, Scalar]:
        """The variables that only rates determine, in terms of rates."""
        found: dict[Symbol, Scalar] = {}
        for store in self._selection.determined:
            charge = self._put(store.charge)
            found[(DUAL, store.edge)] = self._rates.of(charge) + self._put(store.rest)
        for _ in found:
            replace = substitution(self._dag, found)
            found = {key: replace(x) for key, x in found.items()}
        for x in found.values():
            deep = [s for s in self._calculus.support(x) if s[0] == DUAL]
            if deep:
                raise self._rates.too_deep(*deep[0])
        return found

    def _rows(self) -> list[Scalar]:
        """Expressions that are zero, for each store that is not dependent and each component's own state."""
        determined = {store.edge for store in self._selection.determined}
        rows = [
            self._rates.of(self._put(store.charge))
            + self._put(store.rest)
            - self._put(self._dual(store))
            for store in self._laws.stores
            if store.edge not in determined
        ]
        own = [
            self._dag.symbol(RATE, self._place[own.key]) - self._put(own.rate)
            for own in self._laws.own
        ]
        return [*rows, *own]

    def _owners(self) -> list[int | None]:
        """For each row the state of its store; None where that store is dependent."""
        determined = {store.edge for store in self._selection.determined}
        keys = [store.key for store in self._laws.stores if store.edge not in determined]
        return [self._place.get(key) for key in (*keys, *(own.key for own in self._laws.own))]

    def _dual(self, store: StoreLaw) -> Scalar:
        return self._dag.symbol(*store.dual)

    def _renumbered(self, states: Sequence[State]) -> Replay:
        new = {self._place[state.key]: k for k, state in enumerate(states)}
        values = {(RATE, old): self._dag.symbol(RATE, k) for old, k in new.items()}
        return substitution(self._dag, values)

    def _split(
        self, rows: Sequence[Scalar], count: int, ports: Sequence[str]
    ) -> tuple[dict[tuple[int, int], Scalar], list[Scalar]]:
        """𝓜 and f of rows that are linear in rates."""
        columns: dict[Symbol, int] = {(RATE, k): k for k in range(count)}
        columns |= {(SHAFT_RATE, name): count + k for k, name in enumerate(ports)}
        mass: dict[tuple[int, int], Scalar] = {}
        force = []
        still = substitution(self._dag, dict.fromkeys(columns, 0))
        for i, row in enumerate(rows):
            for symbol, slope in self._calculus.gradient(row).items():
                if symbol in columns and self._residues(slope):
                    mass[(i, columns[symbol])] = slope
            force.append(-still(row))
        return mass, force

    # -- remarks and errors

    def _input_rates(self, scalars: Sequence[Scalar]) -> dict[str, int]:
        found: dict[str, int] = {}
        for x in scalars:
            for (kind, place), slope in self._calculus.gradient(x).items():
                order = {"du": 1, "ddu": 2}.get(kind, 0)
                if order and self._residues(slope):
                    found[str(place)] = max(order, found.get(str(place), 0))
        declared = [quantity.name for quantity in self._model.inputs]
        return {name: found[name] for name in declared if name in found}

    def _require_order(self, network: Network) -> None:
        """Refuse laws that need third derivatives, and those that are not linear in rates."""
        entries = [(i, x) for i, x in enumerate(network.force)]
        entries += [(i, x) for (i, _), x in network.mass.items()]
        for row, x in entries:
            for kind, place in self._calculus.support(self._pruned(x)):
                if kind == DUAL:
                    raise self._rates.too_deep(kind, place)
                if kind in (RATE, SHAFT_RATE):
                    raise self._curved(network, row)

    def _curved(self, network: Network, row: int) -> ModelError:
        """The error for a law that is not linear in a rate."""
        count = len(network.states)
        if row < count:
            component = network.owner(network.states[row]).name
        else:
            component = network.ports[row - count].component.name
        on = ", ".join(self._selection.dependent) or component
        problem = (
            f"a law is not linear in what flows in {on}, which depends on rates, and its own rate depends on "
            "that law; put a small resistance or store between them"
        )
        kind = next(c.kind for c in self._model.components if c.name == component)
        return ModelError(f'{kind} "{component}"', problem)

    def _remarks(self, rates: Mapping[str, int]) -> tuple[str, ...]:
        found = []
        for projection in (t.projection for t in self._selection.topologies):
            for vertex, edge in dangling(projection):
                found.append(
                    f'{projection.domain} vertex "{vertex}" is an end of {edge} alone: nothing flows there'
                )
        for edge, on in self._selection.dependent.items():
            what = f"follows from {', '.join(on)}" if on else "is given by sources"
            found.append(f"{edge} stores, but is no state of its own: it {what}")
        for store, changed_by in self._laws.driven.items():
            found.append(
                f"{' and '.join(changed_by)} change what {store} stores, and do work on it"
            )
        for name, order in rates.items():
            more = f" and {name}_acceleration" * (order > 1)
            found.append(
                f"the rate of input {name} is needed: {name}_rate{more} follows it as an input"
            )
        if self._statics.laws:
            names = ", ".join(self._statics.laws)
            found.append(f"an algebraic loop of {names} is solved by Newton's method")
        return tuple(found)
