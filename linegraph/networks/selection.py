"""The normal tree: which stores are states, which depend on others, and the tree that shows it.

It is decided by exact rank over all static laws, two-ports and controlled sources included, with pseudorandom
residues for symbols. A normal tree found by weights alone would be wrong there: laws of two-ports relate
edges that have no circuit in common. The variable that a store keeps is a state unless the laws and the
states before it already determine it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.algebra.residues import Residues, Row, Span
from linegraph.components.body import GROUND
from linegraph.errors import ModelError
from linegraph.graph.forest import Topology, choose_forest
from linegraph.networks.kirchhoff import Kirchhoff

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.components.scalar.base import Component
    from linegraph.components.scalar.branches import Branch
    from linegraph.graph.multigraph import Projection
    from linegraph.networks.law_records import Laws, Static, StoreLaw

MOST_NAMED = 8


@dataclass(frozen=True)
class Selection:
    """The states and the trees of a network.

    Attributes:
        states: stores whose kept variable is a state, in declared order.
        dependent: the other stores, each with the names of those that determine it.
        determined: as many stores as are dependent, whose other variable only the rate of their charge
            determines.
        topologies: the tree of each scalar subspace.
    """

    states: tuple[StoreLaw, ...]
    dependent: dict[str, tuple[str, ...]]
    determined: tuple[StoreLaw, ...]
    topologies: tuple[Topology, ...]


def select(
    branches: Sequence[Branch],
    projections: Sequence[Projection],
    laws: Laws,
    wanted: Sequence[str],
) -> Selection:
    """Choose states and trees.

    Args:
        branches: all edges.
        projections: the graph of each scalar subspace.
        laws: the terminal equations.
        wanted: edges that are preferred as states, or as branches.

    Raises:
        ModelError: the laws contradict or repeat each other, or leave a variable undetermined.
    """
    first = Kirchhoff(branches, [choose_forest(p, roots=(GROUND,)) for p in projections])
    judge = _Judge(first, laws, {b.name: b.component for b in branches})
    judge.take_statics()
    order = _preferred(branches, laws.stores, wanted)
    states, dependent = judge.take_stores(order)
    determined = judge.take_duals(states, order)
    judge.require_complete()
    names = {store.edge for store in states}
    weights = _weights(branches, laws, judge, names)
    for name in wanted:
        if name in weights and name not in names:
            # within its class only: nonlinear laws stay where they can be solved
            weights[name] -= 0.4
    topologies = tuple(choose_forest(p, weights, (GROUND,)) for p in projections)
    chosen = tuple(store for store in laws.stores if store.edge in names)
    return Selection(chosen, dependent, determined, topologies)


def _preferred(
    branches: Sequence[Branch], stores: Sequence[StoreLaw], wanted: Sequence[str]
) -> list[StoreLaw]:
    """Requested stores, then those with an end on ground, then the others; each in declared order."""
    ends = {b.name: b.port.between for b in branches}
    return sorted(
        stores,
        key=lambda store: (store.edge not in wanted, GROUND not in (ends[store.edge] or ())),
    )


class _Judge:
    """The rank of all laws and kept variables, which grows law by law."""

    def __init__(
        self, kirchhoff: Kirchhoff, laws: Laws, components: Mapping[str, Component]
    ) -> None:
        self._kirchhoff = kirchhoff
        self._components = components
        self._laws = laws
        self.residues = Residues()
        self._span = Span()

    def row(self, zero: object) -> Row:
        """The slopes of a law with respect to the primary variables."""
        found: Row = {}
        for symbol, slope in self._laws.calculus.gradient(zero).items():
            if self._kirchhoff.knows(symbol):
                value = self.residues(slope)
                for primary, factor in self._kirchhoff.form(symbol).items():
                    found[primary] = found.get(primary, 0) + factor * value
        return found

    def take_statics(self) -> None:
        """Enter all static laws, which must be independent."""
        for k, static in enumerate(self._laws.statics):
            made = self._span.add(self.row(static.zero), ("static", k))
            if made is not None:
                raise self._repeated([self._laws.statics[i] for _, i in made])

    def _repeated(self, statics: Sequence[Static]) -> ModelError:
        """The error for laws that determine the same variables twice."""
        names = list(dict.fromkeys(static.component.name for static in statics))
        kinds = {symbol[0] for static in statics for symbol in self._own(static)}
        shown = ", ".join(names[:MOST_NAMED]) + (", ..." if len(names) > MOST_NAMED else "")
        last = statics[-1].component
        who = f'{last.kind} "{last.name}"'
        if kinds == {"X"} and len(names) > 1:
            problem = (
                f"closes a loop of across variables that are all given ({shown}): they contradict or "
                "repeat each other, and the flow around the loop is undetermined. Remove one, or put a "
                "resistance in series"
            )
        elif kinds == {"Y"}:
            problem = (
                f"closes a cutset of through variables that are all given ({shown}): they contradict or "
                "repeat each other, and the potential beyond is undetermined. Remove one, or put a "
                "resistance in parallel"
            )
        else:
            amplifier = any(static.component.kind == "opamp" for static in statics)
            hint = "; an op-amp may lack its feedback" * amplifier
            problem = f"the laws of {shown} contradict or repeat each other{hint}"
        return ModelError(who, problem)

    def _own(self, static: Static) -> list[Symbol]:
        gradient = self._laws.calculus.gradient(static.zero)
        return [symbol for symbol in gradient if self._kirchhoff.knows(symbol)]

    def take_stores(
        self, order: Sequence[StoreLaw]
    ) -> tuple[list[StoreLaw], dict[str, tuple[str, ...]]]:
        """Enter the kept variables of stores: independent ones are states, the others depend on them."""
        states: list[StoreLaw] = []
        dependent: dict[str, tuple[str, ...]] = {}
        for store in order:
            made = self._span.add(dict(self._kirchhoff.form(store.key)), ("state", store.edge))
            if made is None:
                states.append(store)
                continue
            on = [name for what, name in made if what == "state" and name != store.edge]
            through = [self._laws.statics[i].component.name for what, i in made if what == "static"]
            dependent[store.edge] = tuple(dict.fromkeys((*on, *through)))
        return states, dependent

    def take_duals(
        self, states: Sequence[StoreLaw], order: Sequence[StoreLaw]
    ) -> tuple[StoreLaw, ...]:
        """Enter the other variables of as many stores as are dependent, dependent ones first."""
        independent = {store.edge for store in states}
        found: list[StoreLaw] = []
        for store in sorted(order, key=lambda store: store.edge in independent):
            if len(found) + len(states) == len(order):
                break
            if self._span.add(dict(self._kirchhoff.form(store.dual)), store.edge) is None:
                found.append(store)
        return tuple(found)

    def require_complete(self) -> None:
        """Refuse laws that leave a variable undetermined."""
        if len(self._span) == len(self._kirchhoff.primaries):
            return
        loose = [s for s in self._kirchhoff.primaries if not self._span.holds({s: 1})]
        words = {"X": "across", "Y": "through"}
        names = ", ".join(f"{words[kind]}({edge})" for kind, edge in loose[:MOST_NAMED])
        component = self._components[str(loose[0][1])]
        problem = f"nothing determines {names}: an element is missing, or an op-amp has no feedback"
        raise ModelError(f'{component.kind} "{component.name}"', problem)


def _weights(
    branches: Sequence[Branch], laws: Laws, judge: _Judge, states: set[str]
) -> dict[str, float]:
    """Weights for the tree: from given across variables, low, to given through variables, high."""
    kept = {store.edge: store.key[0] for store in laws.stores}
    own: dict[str, set[str]] = {}
    for static in laws.statics:
        gradient = laws.calculus.gradient(static.zero)
        touched = {symbol for symbol in gradient if symbol[0] in ("X", "Y")}
        for kind, edge in touched:
            own.setdefault(edge, set()).add(kind if len(touched) == 1 else "both")
    found = {}
    for branch in branches:
        if branch.port.spatial:
            continue
        name = branch.name
        if name in kept:
            inner = name not in states
            found[name] = (4.0 if inner else 1.0) if kept[name] == "X" else (4.5 if inner else 6.0)
        else:
            found[name] = {frozenset("X"): 0.0, frozenset("Y"): 7.0}.get(
                frozenset(own.get(name, {"both"})), _stiff(name, laws)
            )
    return found


def _stiff(name: str, laws: Laws) -> float:
    """The weight of a static law: a nonlinear one solved for Y is a branch, one solved for X a chord."""
    for static in laws.statics:
        gradient = laws.calculus.gradient(static.zero)
        x, y = gradient.get(("X", name)), gradient.get(("Y", name))
        if x is None or y is None:
            continue
        unknown = {s for slope in (x, y) for s in laws.calculus.support(slope)}
        if any(symbol in (("X", name), ("Y", name)) for symbol in unknown):
            return 2.0 if isinstance(y, (int, float)) else 5.0
    return 3.0
