"""Cutset and circuit equations: every across and through variable by the *primary* ones.

Primary are the across variables of branches and the through variables of chords. With [U A] Y = 0 and
[B U] X = 0 the others are integer combinations of them, so that Kirchhoff's laws hold whatever comes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.components.scalar.base import STATIC

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.branches import Branch
    from linegraph.graph.forest import Topology
    from linegraph.ir.dag import Dag


class Kirchhoff:
    """The equations of chosen trees.

    Args:
        branches: all edges; those in 3-D mechanics have a primary through variable alone, or none if they
            store: then rates determine it.
        topologies: one for each scalar subspace.

    Attributes:
        primaries: in declared order of the edges.
    """

    def __init__(self, branches: Sequence[Branch], topologies: Iterable[Topology]) -> None:
        """Find the combinations."""
        self._forms: dict[Symbol, dict[Symbol, int]] = {}
        for topology in topologies:
            self._add(topology)
        for branch in branches:
            if branch.port.spatial and branch.kept == STATIC:
                self._forms[("Y", branch.name)] = {("Y", branch.name): 1}
        self.primaries = [
            symbol
            for branch in branches
            for symbol in (("X", branch.name), ("Y", branch.name))
            if self._forms.get(symbol) == {symbol: 1}
        ]

    def _add(self, topology: Topology) -> None:
        cutset, circuit = topology.cutset, topology.circuit
        for edge in topology.branches:
            self._forms[("X", edge.name)] = {("X", edge.name): 1}
        for edge in topology.chords:
            self._forms[("Y", edge.name)] = {("Y", edge.name): 1}
        for name, row in zip(cutset.rows, cutset.entries, strict=True):
            self._forms[("Y", name)] = {("Y", cutset.columns[j]): -a for j, a in row.items()}
        for name, row in zip(circuit.rows, circuit.entries, strict=True):
            self._forms[("X", name)] = {("X", circuit.columns[j]): -b for j, b in row.items()}

    def form(self, symbol: Symbol) -> dict[Symbol, int]:
        """A variable as a combination of primary ones."""
        return self._forms[symbol]

    def knows(self, symbol: Symbol) -> bool:
        """Whether a symbol is an across or through variable of an edge."""
        return symbol in self._forms

    def combined(self, symbol: Symbol, dag: Dag, values: dict[Symbol, Scalar]) -> Scalar:
        """A variable from the values of the primary ones; those without value stand for themselves."""
        total: Scalar = 0
        for primary, factor in self._forms[symbol].items():
            value = values[primary] if primary in values else dag.symbol(*primary)
            total = total + factor * value
        return total
