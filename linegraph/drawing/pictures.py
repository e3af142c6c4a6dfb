"""Pictures of derivations, trees and graphs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.components.domains import SPATIAL
from linegraph.components.validation import nearest
from linegraph.drawing.legend import body_entries, edge_entries, legend
from linegraph.drawing.letters import short, width
from linegraph.drawing.looks import kinds_of
from linegraph.drawing.mechanism import Sketch
from linegraph.drawing.panels import Panel
from linegraph.drawing.poses import poses
from linegraph.drawing.scene import GREY, SMALL, Item, Scene, Text, moved
from linegraph.drawing.svg import svg_text
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from linegraph.graph.forest import Topology
    from linegraph.graph.multigraph import Projection
    from linegraph.numeric.derived import Derived

MARGIN, APART, LEAST_LEGEND = 16, 28, 420
WIDEST = 1100
"""Largest width of panels next to each other."""

LONGEST_REMARK = 120


def graph_scene(derivation: Derived, subspace: str | Iterable[str] | None = None) -> Scene:
    """Draw the system graph: a panel for each subspace, branches bold.

    Args:
        derivation: a derived model.
        subspace: names of the subspaces to draw; all if left out.

    Raises:
        ModelError: there is no such subspace.
    """
    return composed(f"Linear graph of {derivation.system.name}", _panels(derivation, subspace))


def whole_scene(
    derivation: Derived,
    subspace: str | Iterable[str] | None = None,
    q: Sequence[float] | None = None,
    hold: Mapping[str, float] | None = None,
) -> Scene:
    """Draw the graph with the mechanism next to it, or a remark if that cannot be sketched.

    Args:
        derivation: a derived model.
        subspace: names of the subspaces to draw; all if left out.
        q: coordinates of the sketch, as for `mechanism_scene`.
        hold: values of coordinates of the sketch, by name.

    Raises:
        ModelError: there is no such subspace.
    """
    panels = _panels(derivation, subspace)
    title = f"Linear graph and mechanism of {derivation.system.name}"
    try:
        found = poses(derivation, q, hold)
    except ModelError as error:
        if hold or q is not None:
            raise
        remark = f"no sketch: {error.thing} {error.problem}" * bool(derivation.system.bodies)
        return composed(title, panels, remark=remark)
    sketch = Sketch(found)
    return composed(title, panels, sketch)


def whole_svg(derivation: Derived, subspace: str | Iterable[str] | None = None) -> str:
    """Draw graph and mechanism (`whole_scene`) as the text of an SVG file.

    Args:
        derivation: a derived model.
        subspace: names of the subspaces to draw; all if left out.
    """
    return svg_text(whole_scene(derivation, subspace))


def _panels(derivation: Derived, subspace: str | Iterable[str] | None) -> list[Panel]:
    kinds = kinds_of(derivation.system)
    panels = []
    for names, topology in chosen_panels(derivation, subspace):
        branches = frozenset(edge.name for edge in topology.branches)
        panels.append(Panel(" and ".join(names), topology.projection, branches, kinds))
    return panels


def graph_svg(derivation: Derived, subspace: str | Iterable[str] | None = None) -> str:
    """Draw the graph of some subspaces (`graph_scene`) as the text of an SVG file.

    Args:
        derivation: a derived model.
        subspace: names of the subspaces to draw; all if left out.
    """
    return svg_text(graph_scene(derivation, subspace))


def topology_svg(topology: Topology) -> str:
    """Draw the graph of one subspace with its tree as the text of an SVG file."""
    branches = frozenset(edge.name for edge in topology.branches)
    panel = Panel(topology.projection.domain, topology.projection, branches, {})
    return svg_text(composed(f"Linear graph in {topology.projection.domain}", [panel]))


def projection_svg(projection: Projection) -> str:
    """Draw the graph of one subspace without a tree as the text of an SVG file."""
    return system_svg([projection])


def system_svg(projections: Sequence[Projection]) -> str:
    """Draw the graphs of several subspaces without trees as the text of an SVG file."""
    panels = []
    done: list[Projection] = []
    for projection in projections:
        if projection in done:
            continue
        same = [p for p in projections if _shape(p) == _shape(projection)]
        done += same
        title = " and ".join(p.domain for p in same)
        panels.append(Panel(title, projection, frozenset(), {}))
    names = ", ".join(p.domain for p in projections)
    return svg_text(composed(f"Linear graph in {names}", panels))


def chosen_panels(
    derivation: Derived, subspace: str | Iterable[str] | None = None
) -> list[tuple[list[str], Topology]]:
    """The trees to draw, each with the subspaces it is for.

    Translation and rotation mostly have the same graph and tree, which are drawn once.

    Args:
        derivation: a derived model.
        subspace: names of the subspaces to draw; all if left out.

    Raises:
        ModelError: there is no such subspace.
    """
    wanted = _wanted(derivation, subspace)
    pairs = _distinct(topologies(derivation))
    shown = [([name for name in names if name in wanted], topology) for names, topology in pairs]
    return [pair for pair in shown if pair[0]]


def topologies(derivation: Derived) -> list[Topology]:
    """The chosen trees of all subspaces with edges, in the order of the graph."""
    formulation = derivation.formulation
    found = {t.projection.domain: t for t in (formulation.translation, formulation.rotation)}
    if formulation.network is not None:
        found |= {t.projection.domain: t for t in formulation.network.topologies}
    return [found[domain] for domain in derivation.graph.domains if domain in found]


def _shape(projection: Projection) -> tuple[object, ...]:
    return tuple((e.name, e.tail, e.head) for e in projection.edges)


def _distinct(found: Sequence[Topology]) -> list[tuple[list[str], Topology]]:
    """Trees with their subspaces; translation and rotation are merged where graph and tree are equal."""
    pairs: list[tuple[list[str], Topology]] = []
    for topology in found:
        domain = topology.projection.domain
        twin = next((pair for pair in pairs if _same(pair[1], topology)), None)
        if twin is not None and domain in SPATIAL:
            twin[0].append(domain)
        else:
            pairs.append(([domain], topology))
    return pairs


def _same(a: Topology, b: Topology) -> bool:
    """Whether graph and tree are the same in both."""
    if a.projection.domain not in SPATIAL or _shape(a.projection) != _shape(b.projection):
        return False
    return [e.name for e in a.branches] == [e.name for e in b.branches]


def _wanted(derivation: Derived, subspace: str | Iterable[str] | None) -> Sequence[str]:
    """Names of the requested subspaces.

    Raises:
        ModelError: one of them is not in the model.
    """
    present = derivation.graph.domains
    if subspace is None:
        return present
    wanted = [subspace] if isinstance(subspace, str) else list(subspace)
    for name in wanted:
        if name not in present:
            raise ModelError(
                f'subspace "{name}"', f"is not in this model; {nearest(name, present)}"
            )
    return wanted


def composed(
    title: str, panels: Sequence[Panel], sketch: Sketch | None = None, remark: str = ""
) -> Scene:
    """Arrange panels in rows, with a legend below.

    Args:
        title: title of the picture.
        panels: the panels.
        sketch: the sketch of the mechanism, placed after the first panel.
        remark: text below the legend.
    """
    kinds = dict.fromkeys(kind for panel in panels for kind in panel.kinds)
    entries = edge_entries(list(kinds), any(panel.branches for panel in panels))
    if any(panel.bodies for panel in panels):
        entries += body_entries()
    blocks: list[Block] = [(panel.items, panel.width, panel.height) for panel in panels]
    if sketch is not None:
        blocks.insert(1, (sketch.items, sketch.width, sketch.height))
    widest = max([WIDEST, *(wide for _, wide, _ in blocks)])
    items, right, bottom = rows(blocks, widest)
    key, key_width, key_height = legend(entries, max(right, LEAST_LEGEND))
    items += moved(key, 0, bottom + APART // 2)
    right, bottom = max(right, key_width), bottom + APART // 2 + key_height
    if remark:
        text = short(remark, LONGEST_REMARK)
        bottom += 16
        items.append(Text(0, bottom, text, SMALL, color=GREY))
        right = max(right, width(text, SMALL))
    about = "; ".join([panel.about for panel in panels] + ([sketch.about] if sketch else []))
    placed = moved(items, MARGIN, MARGIN)
    return Scene(right + 2 * MARGIN, bottom + 2 * MARGIN, title, about, placed)


Block = tuple["tuple[Item, ...]", int, int]


def rows(blocks: Sequence[Block], widest: int) -> tuple[list[Item], int, int]:
    """Arrange blocks in rows of columns, low ones above each other.

    Args:
        blocks: items with their widths and heights.
        widest: largest width of a row.

    Returns:
        The items, their width and their height.
    """
    items: list[Item] = []
    top = bottom = left = edge = y = right = tallest = 0
    for block, wide, high in blocks:
        if items and y + high <= top + tallest * 5 // 4 and left + wide <= widest:
            pass  # below the last one
        elif items and edge + wide <= widest:
            left, y = edge, top
        elif items:
            left, edge, top, tallest = 0, 0, bottom + APART, 0
            y = top
        items += moved(block, left, y)
        y += high + APART
        edge, right = max(edge, left + wide + APART), max(right, left + wide)
        bottom, tallest = max(bottom, y - APART), max(tallest, high)
    return items, right, bottom
