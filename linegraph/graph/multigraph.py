"""The system graph, which merges the terminal graphs of all components; no physics (stage 1).

It holds vertices and oriented edges as declared, in one projection for each domain. Parallel edges and
several connected parts are allowed.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.display import Displayed
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator


class Edge(NamedTuple):
    """An oriented edge of a component's terminal graph in one domain.

    The orientation fixes the signs of the edge's through and across variables in the laws of the component.

    Attributes:
        name: unique within its domain.
        component: the component to which it belongs.
        domain: the power subspace, as ``"translation"`` or ``"electrical"``.
        tail, head: names of the vertices that it joins.
    """

    name: str
    component: str
    domain: str
    tail: str
    head: str


@dataclass(frozen=True, repr=False)
class IntegerMatrix:
    """A matrix of exact integers with named rows and columns, stored by its non-zero entries.

    Attributes:
        rows, columns: names of edges or vertices, in order.
        entries: for each row {column number: value}, without zeros.
    """

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    entries: tuple[dict[int, int], ...]

    @property
    def shape(self) -> tuple[int, int]:
        """The numbers of rows and columns."""
        return len(self.rows), len(self.columns)

    def __getitem__(self, place: tuple[int, int]) -> int:
        return self.entries[place[0]].get(place[1], 0)

    def __iter__(self) -> Iterator[tuple[int, ...]]:
        for row in self.entries:
            yield tuple(row.get(column, 0) for column in range(len(self.columns)))

    @property
    def transposed(self) -> IntegerMatrix:
        """The transposed matrix, names included."""
        entries: tuple[dict[int, int], ...] = tuple({} for _ in self.columns)
        for i, row in enumerate(self.entries):
            for j, value in row.items():
                entries[j][i] = value
        return IntegerMatrix(self.columns, self.rows, entries)

    def __neg__(self) -> IntegerMatrix:
        negated = tuple({j: -value for j, value in row.items()} for row in self.entries)
        return IntegerMatrix(self.rows, self.columns, negated)

    def __matmul__(self, other: IntegerMatrix) -> IntegerMatrix:
        entries = []
        for row in self.entries:
            total: dict[int, int] = {}
            for k, a in row.items():
                for j, b in other.entries[k].items():
                    total[j] = total.get(j, 0) + a * b
            entries.append({j: value for j, value in total.items() if value})
        return IntegerMatrix(self.rows, other.columns, tuple(entries))

    def to_sympy(self) -> Any:
        """The dense matrix as a SymPy matrix of integers, without the names."""
        from sympy import Matrix

        return Matrix(*self.shape, [value for row in self for value in row])

    def to_numpy(self) -> Any:
        """The dense matrix as a NumPy array of integers, of shape (rows, columns)."""
        from numpy import array

        return array(list(self), dtype=int).reshape(self.shape)

    def __repr__(self) -> str:
        """The size, and how to see the entries."""
        return f"<{self.shape[0]} x {self.shape[1]} matrix of integers; print it, or to_sympy()>"

    def _repr_html_(self) -> str:
        """The table that a notebook shows, with names along both sides."""
        from html import escape

        def row(cells: Iterable[object], tag: str) -> str:
            return "".join(f"<{tag}>{escape(str(cell))}</{tag}>" for cell in cells)

        lines = [f"<tr><th></th>{row(self.columns, 'th')}</tr>"]
        lines += [
            f"<tr><th>{escape(name)}</th>{row((x or '·' for x in entries), 'td')}</tr>"
            for name, entries in zip(self.rows, self, strict=True)
        ]
        return f"<table>{''.join(lines)}</table>"

    def __str__(self) -> str:
        """A table with names along both sides; zeros are dots."""
        table = [["", *self.columns]]
        for name, row in zip(self.rows, self, strict=True):
            table.append([name, *(f"{value:+d}" if value else "." for value in row)])
        widths = [max(len(line[j]) for line in table) for j in range(len(table[0]))]
        lines = []
        for first, *rest in table:
            cells = [cell.rjust(width) for cell, width in zip(rest, widths[1:], strict=True)]
            lines.append("  ".join([first.ljust(widths[0]), *cells]).rstrip())
        return "\n".join(lines)


@dataclass(frozen=True, repr=False)
class Projection(Displayed):
    """The system graph in one domain.

    Attributes:
        domain: name of the power subspace.
        vertices, edges: in declared order.
    """

    domain: str
    vertices: tuple[str, ...]
    edges: tuple[Edge, ...]

    @cached_property
    def incidence(self) -> IntegerMatrix:
        """The incidence matrix, vertices x edges: +1 where the edge leaves the vertex, -1 where it enters.

        An edge from a vertex to itself has a column of zeros, so that it closes a circuit of its own.
        """
        place = {vertex: i for i, vertex in enumerate(self.vertices)}
        entries: tuple[dict[int, int], ...] = tuple({} for _ in self.vertices)
        for j, edge in enumerate(self.edges):
            if edge.tail != edge.head:
                entries[place[edge.tail]][j] = 1
                entries[place[edge.head]][j] = -1
        return IntegerMatrix(self.vertices, tuple(edge.name for edge in self.edges), entries)

    def to_networkx(self) -> Any:
        """The graph as a `networkx.MultiDiGraph` whose edges are keyed by name."""
        from networkx import MultiDiGraph

        graph = MultiDiGraph(domain=self.domain)
        graph.add_nodes_from(self.vertices)
        for edge in self.edges:
            graph.add_edge(edge.tail, edge.head, key=edge.name, component=edge.component)
        return graph

    def __repr__(self) -> str:
        """The domain with the numbers of vertices and edges."""
        return f"<{self.domain}: {len(self.vertices)} vertices, {len(self.edges)} edges>"


@dataclass(frozen=True, repr=False)
class SystemGraph(Displayed):
    """The terminal graphs merged: one projection for each domain, in the order in which these first appear.

    ``graph["translation"]`` is the projection on a domain; a domain that does not occur is a KeyError.
    """

    projections: tuple[Projection, ...]

    def __getitem__(self, domain: str) -> Projection:
        for projection in self.projections:
            if projection.domain == domain:
                return projection
        raise KeyError(domain)

    @property
    def domains(self) -> tuple[str, ...]:
        """The names of the domains that occur, in the order of the projections."""
        return tuple(projection.domain for projection in self.projections)

    def __repr__(self) -> str:
        """The names of the domains."""
        return f"<system graph in {', '.join(self.domains)}>"


def unite(terminal_graphs: Iterable[Iterable[Edge]]) -> SystemGraph:
    """Merge vertices of the same name within each domain; the terminal graphs become the system graph.

    Args:
        terminal_graphs: for each component its edges.

    Returns:
        The system graph, its domains, vertices and edges in the order in which they first appear.

    Raises:
        ModelError: two edges of one domain have the same name.

    Example:
        >>> cell = [Edge("cell", "cell", "electrical", "0", "a")]
        >>> lamp = [Edge("lamp", "lamp", "electrical", "a", "0")]
        >>> print(unite([cell, lamp])["electrical"].incidence)
           cell  lamp
        0    +1    -1
        a    -1    +1
    """
    edges: dict[str, dict[str, Edge]] = {}
    vertices: dict[str, dict[str, None]] = {}
    for terminal_graph in terminal_graphs:
        for edge in terminal_graph:
            known = edges.setdefault(edge.domain, {})
            if edge.name in known:
                raise ModelError(
                    f'edge "{edge.name}"', f"arises twice in {edge.domain}; rename a component"
                )
            known[edge.name] = edge
            vertices.setdefault(edge.domain, {}).update({edge.tail: None, edge.head: None})
    return SystemGraph(
        tuple(
            Projection(domain, tuple(vertices[domain]), tuple(edges[domain].values()))
            for domain in edges
        )
    )
