"""The system graph in the DOT language of Graphviz, for layout or editing there."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.components.body import GROUND
from linegraph.drawing.letters import clean
from linegraph.drawing.looks import DASHES, PLAIN, is_arm, kinds_of
from linegraph.drawing.pictures import chosen_panels

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from linegraph.graph.forest import Topology
    from linegraph.numeric.derived import Derived

_STYLES = {kind: "dashed" if dash else "solid" for kind, dash in DASHES.items()}


def dot_text(derivation: Derived, subspace: str | Iterable[str] | None = None) -> str:
    """Write the system graph in DOT: a cluster for each subspace and body, branches bold.

    Args:
        derivation: a derived model.
        subspace: names of the subspaces to write; all if left out.

    Raises:
        ModelError: there is no such subspace.
    """
    kinds = kinds_of(derivation.system)
    lines = [
        f"digraph {quoted(derivation.system.name)} {{",
        "  rankdir=BT; compound=true; fontname=sans;",
        "  node [shape=point, width=0.08, fontname=sans, fontsize=10];",
        "  edge [fontname=sans, fontsize=10, arrowsize=0.6];",
    ]
    for k, (names, topology) in enumerate(chosen_panels(derivation, subspace)):
        lines += _panel(k, " and ".join(names), topology, kinds)
    return "\n".join([*lines, "}"]) + "\n"


def quoted(text: str) -> str:
    """Quote text for DOT, so that nothing in it is an escape."""
    text = clean(text).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{text}"'


def _panel(k: int, title: str, topology: Topology, kinds: Mapping[str, str]) -> list[str]:
    """The cluster of one subspace."""
    projection = topology.projection
    lines = [f"  subgraph cluster_{k} {{", f"    label={quoted(title)};"]
    inside: dict[str, list[str]] = {}
    for edge in projection.edges:
        if is_arm(edge) and edge.component != GROUND:
            inside.setdefault(edge.component, [edge.tail]).append(edge.head)
    grouped = {vertex for vertices in inside.values() for vertex in vertices}
    for vertex in projection.vertices:
        if vertex not in grouped:
            lines.append(f"    {_vertex(k, vertex)}")
    for place, (body, vertices) in enumerate(inside.items()):
        lines += [
            f"    subgraph cluster_{k}_{place} {{",
            f"      label={quoted(body)}; style=rounded; color=gray60;",
            *(f"      {_vertex(k, vertex)}" for vertex in vertices),
            "    }",
        ]
    branches = {edge.name for edge in topology.branches}
    for edge in projection.edges:
        bold = edge.name in branches
        kind = kinds.get(edge.component, PLAIN)
        looks = f"style={quoted('bold' if bold and kind == PLAIN else _STYLES[kind])}"
        looks += f", penwidth={3 if bold else 1}, class={quoted('branch' if bold else 'chord')}"
        if is_arm(edge):
            looks += ", color=gray60"
        ends = f"{quoted(f'{k}:{edge.tail}')} -> {quoted(f'{k}:{edge.head}')}"
        lines.append(f"    {ends} [label={quoted(edge.name)}, {looks}];")
    return [*lines, "  }"]


def _vertex(k: int, vertex: str) -> str:
    """A labelled point, or a bar for ground; the subspace's number makes its name unique."""
    looks = 'shape=box, style=filled, fillcolor=black, width=1.5, height=0.06, label="", '
    return (
        f"{quoted(f'{k}:{vertex}')} [{looks if vertex == GROUND else ''}xlabel={quoted(vertex)}];"
    )
