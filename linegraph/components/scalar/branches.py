"""The terminal graph of scalar components: their edges, and the variable that each keeps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.body import COMMON_NAMES, GROUND
from linegraph.components.scalar.base import STATIC, Component, Port
from linegraph.errors import ModelError
from linegraph.graph.multigraph import Edge, Projection, unite

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.components.scalar.base import Pair


@dataclass(frozen=True)
class Branch:
    """One edge of a component, as the network sees it.

    Attributes:
        name: of the edge.
        component: whose it is.
        place: which of the component's ports, from 0.
        port: the port.
        kept: "across" or "through", whichever variable it keeps; "" for a static port.
    """

    name: str
    component: Component
    place: int
    port: Port
    kept: str

    @property
    def between(self) -> Pair:
        """Its vertices (tail, head) in a scalar subspace."""
        assert self.port.between is not None
        return self.port.between


def edges_of(components: Sequence[Component]) -> list[Branch]:
    """Every port of every component, in declared order.

    Args:
        components: those of a system.

    Raises:
        ModelError: a port begins where it ends.
    """
    found = []
    for component in components:
        kept = component.kept()
        for k, port in enumerate(component.ports()):
            if port.between is not None and port.between[0] == port.between[1]:
                problem = f'its edge begins and ends at "{port.between[0]}"'
                raise ModelError(f'{component.kind} "{component.name}"', problem)
            found.append(Branch(port.edge(component.name), component, k, port, kept[k]))
    return found


def terminal_graph(branches: Sequence[Branch]) -> list[Edge]:
    """The terminal graph: the edges in scalar subspaces, without those in 3-D mechanics.

    Args:
        branches: those of a system.
    """
    return [
        Edge(b.name, b.component.name, b.port.domain, *b.between)
        for b in branches
        if b.port.between is not None
    ]


def projections(branches: Sequence[Branch]) -> tuple[Projection, ...]:
    """The graph of each scalar subspace.

    Args:
        branches: those of a system.

    Raises:
        ModelError: two edges have one name, or a part of a network is not connected with ground.
    """
    found = unite([terminal_graph(branches)]).projections
    kinds = {branch.component.name: branch.component.kind for branch in branches}
    for projection in found:
        _require_ground(projection, kinds)
    return found


def _require_ground(projection: Projection, kinds: Mapping[str, str]) -> None:
    """Refuse parts of a network without a reference."""
    part = _parts(projection)
    for edge in projection.edges:
        if part[edge.tail] == part.get(GROUND):
            continue
        island = [e.name for e in projection.edges if part[e.tail] == part[edge.tail]]
        vertices = dict.fromkeys(
            v for e in projection.edges if e.name in island for v in (e.tail, e.head)
        )
        meant = next((v for v in vertices if v.lower() in COMMON_NAMES), None)
        hint = f'; is "{meant}" meant to be "{GROUND}"?' if meant else ""
        shown = ", ".join(island[:6]) + (", ..." if len(island) > 6 else "")
        problem = (
            f"the {projection.domain} network of {shown} has no reference: connect one of its vertices "
            f'({", ".join(list(vertices)[:6])}) to "{GROUND}"{hint}'
        )
        raise ModelError(f'{kinds[edge.component]} "{edge.component}"', problem)


def _parts(projection: Projection) -> dict[str, str]:
    """For each vertex, the one that represents all vertices it is connected with."""
    part = {vertex: vertex for vertex in projection.vertices}

    def find(vertex: str) -> str:
        while part[vertex] != vertex:
            part[vertex] = part[part[vertex]]
            vertex = part[vertex]
        return vertex

    for edge in projection.edges:
        part[find(edge.tail)] = find(edge.head)
    return {vertex: find(vertex) for vertex in projection.vertices}


def dangling(projection: Projection) -> list[tuple[str, str]]:
    """The vertices at which one edge alone ends, and that edge: nothing can flow through it.

    Args:
        projection: the graph of one subspace; ground may end a single edge.
    """
    touching: dict[str, list[str]] = {vertex: [] for vertex in projection.vertices}
    for edge in projection.edges:
        touching[edge.tail].append(edge.name)
        touching[edge.head].append(edge.name)
    return [(v, names[0]) for v, names in touching.items() if len(names) == 1 and v != GROUND]


def stores(branches: Sequence[Branch]) -> list[Branch]:
    """The edges in scalar subspaces that keep a variable.

    Args:
        branches: those of a system.
    """
    return [b for b in branches if b.kept != STATIC and not b.port.spatial]
