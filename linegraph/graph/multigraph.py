"""Stage 1: the system graph, the union of the components' terminal graphs. No word of physics in it.

What was said, nothing chosen: vertices and oriented edges, one projection per domain. Parallel edges and
several connected parts are ordinary.
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
    """An oriented edge of a component's terminal graph in one domain, from `tail` to `head`."""

    name: str
    component: str
    domain: str
    tail: str
    head: str


@dataclass(frozen=True, repr=False)
class IntegerMatrix:
    """A matrix of exact integers with named rows and columns, stored by its non-zero entries.

    Attributes:
        entries: for each row, {column: value}.
    """

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    entries: tuple[dict[int, int], ...]

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return len(self.rows), len(self.columns)

    def __getitem__(self, place: tuple[int, int]) -> int:
        return self.entries[place[0]].get(place[1], 0)

    def __iter__(self) -> Iterator[tuple[int, ...]]:
        for row in self.entries:
            yield tuple(row.get(column, 0) for column in range(len(self.columns)))

    @property
    def transposed(self) -> IntegerMatrix:
        """Rows and columns exchanged."""
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
        """The dense matrix as sympy's."""
        from sympy import Matrix

        return Matrix(*self.shape, [value for row in self for value in row])

    def to_numpy(self) -> Any:
        """The dense matrix as an integer array."""
        from numpy import array

        return array(list(self), dtype=int).reshape(self.shape)

    def __repr__(self) -> str:
        """Its size."""
        return f"<{self.shape[0]} x {self.shape[1]} matrix of integers; print it, or to_sympy()>"

    def _repr_html_(self) -> str:
        """The table a notebook shows, with names along both sides."""
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
    """The system graph seen in one domain.

    Attributes:
        vertices, edges: in the order in which they were declared.
    """

    domain: str
    vertices: tuple[str, ...]
    edges: tuple[Edge, ...]

    @cached_property
    def incidence(self) -> IntegerMatrix:
        """Vertices x edges: +1 where the edge leaves the vertex, -1 where it enters."""
        place = {vertex: i for i, vertex in enumerate(self.vertices)}
        entries: tuple[dict[int, int], ...] = tuple({} for _ in self.vertices)
        for j, edge in enumerate(self.edges):
            if edge.tail != edge.head:
                entries[place[edge.tail]][j] = 1
                entries[place[edge.head]][j] = -1
        return IntegerMatrix(self.vertices, tuple(edge.name for edge in self.edges), entries)

    def to_networkx(self) -> Any:
        """A `networkx.MultiDiGraph` with the edges keyed by name."""
        from networkx import MultiDiGraph

        graph = MultiDiGraph(domain=self.domain)
        graph.add_nodes_from(self.vertices)
        for edge in self.edges:
            graph.add_edge(edge.tail, edge.head, key=edge.name, component=edge.component)
        return graph

    def __repr__(self) -> str:
        """Its size."""
        return f"<{self.domain}: {len(self.vertices)} vertices, {len(self.edges)} edges>"


@dataclass(frozen=True, repr=False)
class SystemGraph(Displayed):
    """The united terminal graph: its projections on the domains, in the order these first appear."""

    projections: tuple[Projection, ...]

    def __getitem__(self, domain: str) -> Projection:
        for projection in self.projections:
            if projection.domain == domain:
                return projection
        raise KeyError(domain)

    @property
    def domains(self) -> tuple[str, ...]:
        """The names of the domains present."""
        return tuple(projection.domain for projection in self.projections)

    def __repr__(self) -> str:
        """Its subspaces."""
        return f"<system graph in {', '.join(self.domains)}>"


def unite(terminal_graphs: Iterable[Iterable[Edge]]) -> SystemGraph:
    """Unite terminal graphs by merging vertices of one name within each domain.

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
