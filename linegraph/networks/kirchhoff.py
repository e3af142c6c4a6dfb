"""Cutset and circuit equations: every across and through variable in terms of the *primary* ones.

Primary are the across variables of branches and the through variables of chords. By [U A] Y = 0 and [B U] X =
0 the others are integer combinations of them, so that Kirchhoff's laws hold exactly, whatever values these
get.
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
    """The cutset and circuit equations of chosen trees.

    Args:
        branches: all edges. A port in 3-D mechanics has a primary through variable alone, or none if it
            stores, since rates determine it then.
        topologies: one for each scalar subspace.

    Attributes:
        primaries: the primary variables, in declared order of the edges.
    """

    def __init__(self, branches: Sequence[Branch], topologies: Iterable[Topology]) -> None:
        """Find each variable's combination of primary ones."""
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
        """A variable as a combination of primary ones, with integer factors."""
        return self._forms[symbol]

    def knows(self, symbol: Symbol) -> bool:
        """Whether a symbol is the across or through variable of an edge."""
        return symbol in self._forms

    def combined(self, symbol: Symbol, dag: Dag, values: dict[Symbol, Scalar]) -> Scalar:
        """A variable from values of the primary ones; primary variables without a value stay symbols.

        Args:
            symbol: the variable: ("X", edge) or ("Y", edge).
            dag: of all scalars.
            values: scalars by primary variable.
        """
        total: Scalar = 0
        for primary, factor in self._forms[symbol].items():
            value = values[primary] if primary in values else dag.symbol(*primary)
            total = total + factor * value
        return total
