"""The equations ``𝓜 ż = f`` of a network over its states, with the forces that it exerts on mechanics.

Each store whose variable is a state gives a row, ``d/dt charge + rest = other variable``. Stores that depend
on them add to 𝓜 by the same equations, as masses do in the paper's congruence: their other variable is the
rate of a charge that the states determine. Where 𝓜 is still singular, its null combinations are constraints
among the states, which are solved and differentiated until it is regular.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from linegraph.algebra.differentiation import substitution
from linegraph.algebra.residues import Residues
from linegraph.components.domains import DOMAINS
from linegraph.components.scalar.branches import dangling, edges_of, projections
from linegraph.errors import ModelError
from linegraph.networks.laws import laws_of
from linegraph.networks.network import RATE, SHAFT_RATE, Network, State
from linegraph.networks.rates import Rates
from linegraph.networks.reduction import Reduction
from linegraph.networks.selection import select
from linegraph.networks.state_names import domain_of, states_of, variable_name
from linegraph.networks.static import DUAL, Solver, pruned, substituting

INTERFACES = ("rotational_interface", "translational_interface")

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.algebra.differentiation import Replay, Symbol
    from linegraph.algebra.scalar import Scalar
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


@dataclass(frozen=True)
class _Draft:
    """A network between two passes.

    Attributes:
        states: those that are left.
        rows: expressions that are zero, linear in the rates of states and of ports in mechanics.
        variables: (X, Y) by edge.
        complete: a scalar of the laws in terms of states, inputs and rates.
        later: replaces states that constraints fix; None before they are found.
        number: gives rates their final numbers; None before.
    """

    states: Sequence[State]
    rows: Sequence[Scalar]
    variables: Mapping[str, tuple[Scalar, Scalar]]
    complete: Callable[[Scalar], Scalar]
    later: Replay | None = None
    number: Replay | None = None

    def last(self, x: Scalar) -> Scalar:
        """A scalar of the laws as it is after all passes."""
        assert self.later is not None
        assert self.number is not None
        return self.number(self.later(self.complete(x)))


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
        self._states = states_of(model, branches, laws, selection)
        self._rates = Rates(self._first, self._calculus, self._states, selection.dependent)
        self._place = self._rates.places
        self._valued = substituting(laws, statics.kirchhoff, statics.values)

    def network(self) -> Network:
        """Pass by pass: rows over all states, dependent stores, constraints, 𝓜 and f."""
        self._enter_own_rates()
        self._require_known_loops()
        draft = self._drafted()
        draft = self._with_spatial_stores(draft)
        draft = self._reduced(draft)
        draft = self._renumbered(draft)
        found = self._collected(draft)
        self._require_order(found)
        return found

    # -- the passes

    def _enter_own_rates(self) -> None:
        """Write rates that static laws give as such, so that 𝓜 stays symmetric."""
        for own in self._laws.own:
            rate = self._put(own.rate)
            if not any(kind == DUAL for kind, _ in self._calculus.support(rate)):
                self._rates.known[own.key] = rate

    def _require_known_loops(self) -> None:
        """Refuse algebraic loops of variables that only rates determine."""
        for residual in self._statics.residuals:
            for kind, place in self._calculus.support(residual):
                if kind == DUAL:
                    raise self._rates.too_deep(kind, place)

    def _drafted(self) -> _Draft:
        """Rows and variables over all states, dependent stores replaced by the rates that determine them."""
        replaced = substitution(self._dag, self._duals())

        def complete(x: Scalar) -> Scalar:
            return replaced(self._put(x))

        variables = {
            b.name: (complete(self._across(b)), complete(self._through(b))) for b in self._branches
        }
        return _Draft(self._states, replaced.all(self._rows()), variables, complete)

    def _with_spatial_stores(self, draft: _Draft) -> _Draft:
        """Stores whose edges lie in 3-D mechanics: their rates are accelerations there."""
        variables = dict(draft.variables)
        for store in self._laws.spatial:
            x, _ = variables[store.edge]
            own = self._rates.of(self._put(store.charge)) + draft.complete(store.rest)
            variables[store.edge] = (x, own)
        return replace(draft, variables=variables)

    def _reduced(self, draft: _Draft) -> _Draft:
        """Constraints among states solved and differentiated until 𝓜 is regular."""
        rows, variables = list(draft.rows), dict(draft.variables)
        reduction = Reduction(self._rates, self._calculus, self._states, self._owners())
        gone = reduction.reduce(rows, variables)
        states = [s for k, s in enumerate(draft.states) if k not in gone]
        return replace(draft, states=states, rows=rows, variables=variables, later=reduction.later)

    def _renumbered(self, draft: _Draft) -> _Draft:
        """Rates numbered by the states that are left; the rows of ports in mechanics last."""
        new = {self._place[state.key]: k for k, state in enumerate(draft.states)}
        values = {(RATE, old): self._dag.symbol(RATE, k) for old, k in new.items()}
        number = substitution(self._dag, values)
        rows = number.all([*draft.rows, *(draft.variables[b.name][1] for b in self._ports)])
        variables = {name: (number(x), number(y)) for name, (x, y) in draft.variables.items()}
        return replace(draft, rows=rows, variables=variables, number=number)

    def _collected(self, draft: _Draft) -> Network:
        """𝓜, f and all that is told of the network."""
        variables, later = dict(draft.variables), draft.later
        assert later is not None
        rates = self._input_rates([*draft.rows, *(x for pair in variables.values() for x in pair)])
        ports = [port.name for port in self._ports]
        mass, force = self._split(draft.rows, len(draft.states), ports)
        return Network(
            self._laws,
            tuple(self._branches),
            self._selection.topologies,
            tuple(draft.states),
            mass,
            tuple(force),
            variables,
            tuple(later.all(self._statics.residuals)),
            tuple(later.all(self._statics.pivots)),
            self._selection.dependent,
            rates,
            self._remarks(rates),
            {name: draft.last(x) for name, x in self._laws.energy.items()},
            {name: draft.last(x) for name, x in self._laws.heat.items()},
            frozenset(
                n for n in {*self._model.domains, *DOMAINS} if not domain_of(self._model, n).power
            ),
            tuple(variable_name(self._model, self._branches, x) for x in self._statics.loop),
            tuple(later.all(self._statics.eased)),
        )

    @property
    def _ports(self) -> list[Branch]:
        return [b for b in self._branches if b.port.spatial]

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
