"""A forest in the system graph: branches, chords, cutset and circuit equations (stage 2).

With branches b and chords c, through variables Y and across variables X:

    fundamental cutset equations    [U A] [Y_b; Y_c] = 0
    fundamental circuit equations   [B U] [X_b; X_c] = 0        B = -A^T

[Boiadzhiev and Lilov 1993]. The cutset matrix is found by cutting branches, the circuit matrix by closing
chords. These are two independent constructions, and a `Topology` that does not satisfy B = -A^T is refused.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from linegraph.display import Displayed
from linegraph.errors import ModelError
from linegraph.graph.multigraph import Edge, IntegerMatrix, Projection

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping


class Step(NamedTuple):
    """One step of a walk from the roots to the leaves of a forest, across `edge` from vertex `near` to `far`.

    Attributes:
        edge: the branch that is crossed.
        near, far: its ends; `near` is the one nearer to the root.
        forward: whether the step goes from the tail of the edge to its head.
    """

    edge: Edge
    near: str
    far: str
    forward: bool


@dataclass(frozen=True, repr=False)
class Topology(Displayed):
    """A projection of the system graph with a forest chosen in it.

    Attributes:
        projection: the graph.
        walk: one step for each branch, from the roots outward, so that `near` is reached before `far`.
        branches, chords: the edges in the forest and the others, each in declared order.
        roots: one vertex of each connected part.

    Raises:
        AssertionError: the numbers of branches and chords, B = -A^T, or the orthogonality of circuits and
            vertices are wrong, which can only be a bug.
    """

    projection: Projection
    walk: tuple[Step, ...]
    branches: tuple[Edge, ...]
    chords: tuple[Edge, ...]
    roots: tuple[str, ...]

    def __post_init__(self) -> None:
        """Check the identities of graph theory: v - n branches, e - v + n chords, B = -A^T, orthogonality."""
        vertices, edges = len(self.projection.vertices), len(self.projection.edges)
        parts = len(self.roots)
        if len(self.branches) != vertices - parts or len(self.chords) != edges - vertices + parts:
            raise AssertionError("branches must number v - n, chords e - v + n")
        if self.circuit.entries != (-self.cutset.transposed).entries:
            raise AssertionError("circuit and cutset matrices must satisfy B = -A^T")
        if any((self.projection.incidence @ self._circuits.transposed).entries):
            raise AssertionError("every circuit must be orthogonal to every vertex")

    @cached_property
    def cutset(self) -> IntegerMatrix:
        """A of [U A], branches x chords: +1 where a chord crosses the cut as the branch does, -1 against it.

        Cutting a branch separates the vertices beyond it from the rest. Y_b = -A Y_c.
        """
        beyond = self._beyond()
        column = {edge.name: j for j, edge in enumerate(self.chords)}
        touching: dict[str, list[tuple[Edge, int]]] = {}
        for edge in self.chords:
            touching.setdefault(edge.tail, []).append((edge, -1))
            touching.setdefault(edge.head, []).append((edge, 1))
        rows: dict[str, dict[int, int]] = {}
        for step in self.walk:
            row: dict[int, int] = {}
            sign = 1 if step.forward else -1
            # a chord with both ends beyond the cut is counted twice with opposite signs, and cancels
            for vertex in beyond[step.far]:
                for edge, entering in touching.get(vertex, ()):
                    j = column[edge.name]
                    row[j] = row.get(j, 0) + sign * entering
            rows[step.edge.name] = {j: value for j, value in sorted(row.items()) if value}
        return IntegerMatrix(
            tuple(edge.name for edge in self.branches),
            tuple(edge.name for edge in self.chords),
            tuple(rows[edge.name] for edge in self.branches),
        )

    @cached_property
    def circuit(self) -> IntegerMatrix:
        """B of [B U], chords x branches: +1 where a branch points along the chord's circuit, -1 against it.

        The circuit is run through in the sense of its chord. X_c = -B X_b.
        """
        row_of = {edge.name: j for j, edge in enumerate(self.branches)}
        inward = {step.far: step for step in self.walk}
        rows = []
        for chord in self.chords:
            row: dict[int, int] = {}
            for start, sense in ((chord.head, 1), (chord.tail, -1)):
                vertex = start
                while vertex in inward:
                    step = inward[vertex]
                    j = row_of[step.edge.name]
                    # a walk inward crosses a forward branch against its orientation
                    row[j] = row.get(j, 0) - sense * (1 if step.forward else -1)
                    vertex = step.near
            rows.append({j: value for j, value in sorted(row.items()) if value})
        return IntegerMatrix(
            tuple(edge.name for edge in self.chords),
            tuple(edge.name for edge in self.branches),
            tuple(rows),
        )

    def __repr__(self) -> str:
        """The domain with the numbers of branches and chords."""
        domain = self.projection.domain
        return f"<tree in {domain}: {len(self.branches)} branches, {len(self.chords)} chords>"

    @property
    def _circuits(self) -> IntegerMatrix:
        """[B U] with its columns in the order of the projection's edges."""
        column = {edge.name: j for j, edge in enumerate(self.projection.edges)}
        rows = []
        for chord, row in zip(self.chords, self.circuit.entries, strict=True):
            whole = {column[self.branches[j].name]: value for j, value in row.items()}
            whole[column[chord.name]] = 1
            rows.append(whole)
        return IntegerMatrix(self.circuit.rows, tuple(column), tuple(rows))

    def _beyond(self) -> dict[str, list[str]]:
        """For each vertex the vertices that are separated from the root if it is removed, itself included."""
        beyond = {vertex: [vertex] for vertex in self.projection.vertices}
        for step in reversed(self.walk):
            beyond[step.near] += beyond[step.far]
        return beyond


def choose_forest(
    projection: Projection,
    weights: Mapping[str, float] | None = None,
    roots: Iterable[str] = (),
    branches: Iterable[str] = (),
) -> Topology:
    """Choose the forest of least total weight; of equal weights the edge declared first is taken.

    Edges are tried in order of their weights and taken if they close no circuit [Kruskal 1956].

    Args:
        projection: the graph.
        weights: by edge name; an edge that is not named has weight 0.
        roots: vertices at which the walk starts, each in its connected part; a part without any of them
            starts at its first declared vertex.
        branches: names of edges that must be branches, whatever their weight.

    Returns:
        The forest, with its walk depth first from the roots.

    Raises:
        ModelError: the requested `branches` close a circuit or are not edges of the graph.

    Example:
        >>> from linegraph.graph.multigraph import unite
        >>> graph = unite([[Edge("R", "R", "e", "0", "a"), Edge("C", "C", "e", "0", "a")]])
        >>> print(choose_forest(graph["e"], weights={"R": 1}).cutset)
            R
        C  +1
    """
    weights = weights or {}
    wanted = dict.fromkeys(branches)
    names = {edge.name for edge in projection.edges}
    for name in wanted:
        if name not in names:
            raise ModelError(f'branch "{name}"', "there is no edge of that name")
    # requested branches come first, whatever they weigh
    order = sorted(projection.edges, key=lambda e: (e.name not in wanted, weights.get(e.name, 0.0)))
    part = {vertex: vertex for vertex in projection.vertices}

    def find(vertex: str) -> str:
        # union-find; halving the paths keeps them short
        while part[vertex] != vertex:
            part[vertex] = part[part[vertex]]
            vertex = part[vertex]
        return vertex

    chosen: set[str] = set()
    for edge in order:
        tail, head = find(edge.tail), find(edge.head)
        if tail != head:
            part[head] = tail
            chosen.add(edge.name)
        elif edge.name in wanted:
            raise ModelError(f'branch "{edge.name}"', "the wanted tree closes a circuit here")
    return _walked(projection, chosen, tuple(roots))


def _walked(projection: Projection, chosen: set[str], roots: tuple[str, ...]) -> Topology:
    """Walk the chosen forest depth first from the roots, branches in declared order."""
    touching: dict[str, list[Edge]] = {vertex: [] for vertex in projection.vertices}
    for edge in projection.edges:
        if edge.name in chosen:
            touching[edge.tail].append(edge)
            touching[edge.head].append(edge)
    seen: set[str] = set()
    walk: list[Step] = []
    starts = []
    for root in (*(r for r in roots if r in touching), *projection.vertices):
        if root in seen:
            continue
        starts.append(root)
        seen.add(root)
        pending = _steps(touching, root)
        while pending:
            step = pending.pop()
            if step.far in seen:
                continue
            seen.add(step.far)
            walk.append(step)
            pending += _steps(touching, step.far)
    edges = projection.edges
    return Topology(
        projection,
        tuple(walk),
        tuple(edge for edge in edges if edge.name in chosen),
        tuple(edge for edge in edges if edge.name not in chosen),
        tuple(starts),
    )


def _steps(touching: Mapping[str, list[Edge]], vertex: str) -> list[Step]:
    """The steps that leave a vertex, the last declared first, since a stack returns them in reverse."""
    return [
        Step(edge, vertex, edge.head, True)
        if edge.tail == vertex
        else Step(edge, vertex, edge.tail, False)
        for edge in reversed(touching[vertex])
    ]
