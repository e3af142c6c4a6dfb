"""Layout of one subspace's graph: positions of vertices and routes of edges.

A layer is the number of branches from ground. Layer 0 is the rail, layer k occupies band 2k, and the labels
of the edges from it to the next layer are in band 2k + 1.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

from linegraph.components.body import GROUND
from linegraph.drawing.bands import GAP, BandLink, Bands, Cell
from linegraph.drawing.bodies import HEIGHT, BodyArea, Shape, shape
from linegraph.drawing.letters import short, width
from linegraph.drawing.looks import is_arm, is_inertia
from linegraph.drawing.scene import NORMAL, SMALL

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.graph.multigraph import Edge, Projection

DOT, LABEL_BAND = 18, 17
"""Heights of bands of vertices without bodies and of bands of labels."""

LANE = 4
"""Half the width of a lane without a label."""

LEAST_ZONE, MOST_ZONE = 10, 70
ARCH, LEG, RISE = 19, 6, 7
"""Height of an arch above the next lower one, its additional width on each side, and the height of the lowest
arch.
"""

STRAIGHT = 12
"""Weight of straight lanes; edges of branches have 4 and chords 1."""


@dataclass
class Route:
    """The route of an edge: its cells from the lower end to the upper one.

    Attributes:
        edge: the edge.
        upward: whether its tail is the lower end.
        cells: cells with ports; for an arch the two ends with the label's cell between them.
        label: index in `cells` of the cell with the label.
        arch: for an edge with both ends in one layer, its index in the stack of parallel edges, from below;
            else -1.
    """

    edge: Edge
    upward: bool
    cells: list[tuple[int, str]]
    label: int
    arch: int = -1


@dataclass
class Plan:
    """The layout of one graph, with y upward from the rail.

    Attributes:
        bodies, shapes: bodies and the layouts of their regions, by name.
        node: the body or vertex outside bodies that each vertex belongs to.
        layer: layers of bodies and vertices outside bodies.
        cell, cells: index of the cell of each of these, and all cells.
        routes: routes of the edges outside bodies.
        arms: rigid arms of ground.
        apart: least distances between ends of arches.
        piles: number of arches in each stack, by cell.
        floors, ceilings: lower and upper end of each band.
        width, height: the size.
    """

    bodies: dict[str, BodyArea] = field(default_factory=dict)
    shapes: dict[str, Shape] = field(default_factory=dict)
    node: dict[str, str] = field(default_factory=dict)
    layer: dict[str, int] = field(default_factory=dict)
    cell: dict[str, int] = field(default_factory=dict)
    cells: list[Cell] = field(default_factory=list)
    routes: list[Route] = field(default_factory=list)
    arms: list[Edge] = field(default_factory=list)
    apart: dict[tuple[int, int], int] = field(default_factory=dict)
    piles: dict[int, int] = field(default_factory=dict)
    floors: list[int] = field(default_factory=list)
    ceilings: list[int] = field(default_factory=list)
    width: int = 0
    height: int = 0

    def port(self, cell: int, port: str) -> int:
        """Position of a port, from the left.

        Args:
            cell: index of the cell.
            port: name of the port.
        """
        return self.cells[cell].x + self.cells[cell].offsets.get(port, 0)


def plan(projection: Projection, branches: frozenset[str]) -> Plan:
    """Lay out a graph.

    Args:
        projection: the graph of one subspace.
        branches: names of the branches; empty if no tree is chosen.
    """
    found = Plan()
    _gather(found, projection, branches)
    outer = [e for e in projection.edges if not (is_arm(e) or _inside(found, e))]
    _set_layers(found, projection, outer, branches)
    links = _cells(found, outer, branches)
    bands = Bands(found.cells, links)
    bands.order()
    _measure(found)
    bands.place(found.apart)
    _set_heights(found, links)
    reach = (cell.x + cell.right for cell in found.cells)
    found.width = max(reach, default=0)
    return found


def _gather(found: Plan, projection: Projection, branches: frozenset[str]) -> None:
    """Find bodies, their frames, and the body that each vertex belongs to."""
    for edge in projection.edges:
        if is_arm(edge) and edge.component != GROUND:
            body = found.bodies.setdefault(edge.component, BodyArea(edge.component))
            body.center = edge.tail
            body.arms[edge.head] = edge
            found.node[edge.tail] = found.node[edge.head] = edge.component
        elif is_arm(edge):
            found.arms.append(edge)
    for edge in projection.edges:
        body_of = found.bodies.get(edge.component)
        if is_inertia(edge) and body_of is not None and edge.head == body_of.center:
            body_of.inertia, body_of.bold = edge, edge.name in branches
    for vertex in projection.vertices:
        # The vertex of a body's own frame has the body's name.
        found.node.setdefault(vertex, vertex)


def _inside(found: Plan, edge: Edge) -> bool:
    body = found.bodies.get(edge.component)
    return body is not None and body.inertia is edge


def _set_layers(
    found: Plan, projection: Projection, outer: list[Edge], branches: frozenset[str]
) -> None:
    """Number of branches between each body or vertex and ground; by any edges where no branch leads there."""
    layer = dict.fromkeys([GROUND] * (GROUND in projection.vertices), 0)
    layer |= {edge.head: 0 for edge in found.arms}
    tree = [edge for edge in outer if edge.name in branches]
    _spread(found, layer, tree)
    _spread(found, layer, outer)
    for vertex in projection.vertices:
        if found.node[vertex] not in layer:
            layer[found.node[vertex]] = 1
            _spread(found, layer, outer)
    order = _visited(found, [*layer], [*tree, *outer])
    found.layer = {name: layer[name] for name in order}


def _spread(found: Plan, layer: dict[str, int], edges: Iterable[Edge]) -> None:
    near = _neighbours(found, edges)
    frontier = list(layer)
    while frontier:
        ahead = []
        for here in frontier:
            for there in near.get(here, ()):
                if there not in layer:
                    layer[there] = layer[here] + 1
                    ahead.append(there)
        frontier = ahead


def _visited(found: Plan, starts: list[str], edges: Iterable[Edge]) -> list[str]:
    """Bodies and vertices depth first, so that those on one branch are adjacent in their layer."""
    near = _neighbours(found, edges)
    seen: dict[str, None] = {}
    for start in starts:
        pending = [start]
        while pending:
            here = pending.pop()
            if here not in seen:
                seen[here] = None
                pending += [x for x in reversed(near.get(here, [])) if x not in seen]
    return list(seen)


def _neighbours(found: Plan, edges: Iterable[Edge]) -> dict[str, list[str]]:
    near: dict[str, dict[str, None]] = {}
    for edge in edges:
        a, b = found.node[edge.tail], found.node[edge.head]
        near.setdefault(a, {})[b] = None
        near.setdefault(b, {})[a] = None
    return {name: list(others) for name, others in near.items()}


class _Making:
    """The cells and links of a layout during its construction."""

    def __init__(self, found: Plan, branches: frozenset[str]) -> None:
        self.found, self.branches = found, branches
        self.place = {name: k for k, name in enumerate(found.layer)}
        self.made: list[tuple[tuple[int, ...], Cell]] = []
        self.links: list[BandLink] = []
        self.arches: dict[tuple[str, str], int] = {}

    def add(self, cell: Cell, *key: int) -> int:
        """Add a cell with its key in the order of the walk."""
        self.made.append((key, cell))
        return len(self.made) - 1

    def nodes(self) -> None:
        """Add a cell for each body and each vertex outside bodies."""
        found = self.found
        for name, layer in found.layer.items():
            if name != GROUND:
                body = found.bodies.get(name)
                ports = [
                    vertex
                    for vertex, node in found.node.items()
                    if node == name and (body is None or vertex != body.center)
                ]
                found.cell[name] = self.add(Cell(2 * layer, ports), self.place[name], 0, 0)

    def route(self, k: int, edge: Edge) -> None:
        """Add the cells and links of an edge."""
        node, layer = self.found.node, self.found.layer
        upward = layer[node[edge.tail]] <= layer[node[edge.head]]
        low, high = (edge.tail, edge.head) if upward else (edge.head, edge.tail)
        key = max(self.place[node[low]], self.place[node[high]])
        first, last = layer[node[low]], layer[node[high]]
        if first == last:
            self._arch(k, edge, key)
            return
        weight = 4 if edge.name in self.branches else 1
        cells = [self._end(low, key, k)]
        for band in range(2 * first + 1, 2 * last):
            labelled = band == 2 * last - 1
            lane = _lane(edge if labelled else None, band)
            cells.append((self.add(lane, key, -1, k), ""))
        cells.append(self._end(high, key, k))
        for (a, pa), (b, pb) in pairwise(cells):
            lanes = pa == "" and pb == ""
            self.links.append(BandLink(a, pa, b, pb, STRAIGHT if lanes else weight))
        self.found.routes.append(Route(edge, upward, cells, len(cells) - 2))
        _note_ends(self.found, low, high, arch=False)

    def _arch(self, k: int, edge: Edge, key: int) -> None:
        """Add an edge within a layer; parallel edges share a cell, one arch above the other."""
        node, layer = self.found.node, self.found.layer
        low, high = sorted((edge.tail, edge.head))
        ends = (low, high)
        # Arches to ground have separate ends on the rail and share nothing.
        if GROUND in ends or ends not in self.arches:
            band = 2 * layer[node[low]] + 1
            cell = self.arches[ends] = self.add(Cell(band, ["low", "high"]), key, 1, k)
            self.found.piles[cell] = 0
        cell = self.arches[ends]
        cells = [self._end(low, key, k), (cell, "low"), (cell, "high"), self._end(high, key, k)]
        for end, side in ((cells[0], "low"), (cells[3], "high")):
            self.links.append(BandLink(*end, cell, side, 1))
        route = Route(edge, low == edge.tail, cells, 1, self.found.piles[cell])
        self.found.piles[cell] += 1
        self.found.routes.append(route)
        _note_ends(self.found, low, high, arch=True)

    def _end(self, vertex: str, key: int, k: int) -> tuple[int, str]:
        """The end of an edge; at ground a new place on the rail."""
        if vertex == GROUND:
            return self.add(Cell(0, [""], LANE, LANE), key, -1, k), ""
        return self.found.cell[self.found.node[vertex]], vertex


def _cells(found: Plan, outer: list[Edge], branches: frozenset[str]) -> list[BandLink]:
    """Create a cell for each body, vertex and lane, and return the links between them."""
    making = _Making(found, branches)
    making.nodes()
    for k, edge in enumerate(outer):
        making.route(k, edge)
    return _sorted_cells(found, making.made, making.links)


def _sorted_cells(
    found: Plan, made: list[tuple[tuple[int, ...], Cell]], links: list[BandLink]
) -> list[BandLink]:
    """Sort the cells in the order of the walk, which starts the ordering with few crossings."""
    order = sorted(range(len(made)), key=lambda k: made[k][0])
    new = {old: k for k, old in enumerate(order)}
    found.cells = [made[old][1] for old in order]
    found.cell = {name: new[old] for name, old in found.cell.items()}
    found.piles = {new[old]: count for old, count in found.piles.items()}
    for route in found.routes:
        route.cells = [(new[cell], port) for cell, port in route.cells]
    return [x._replace(low=new[x.low], high=new[x.high]) for x in links]


def _note_ends(found: Plan, low: str, high: str, *, arch: bool) -> None:
    """Count the edges of bodies' vertices on their upper and lower sides."""
    for vertex, above in ((low, True), (high, arch)):
        body = found.bodies.get(found.node[vertex])
        if body is not None:
            side = body.up if above else body.down
            side[vertex] = side.get(vertex, 0) + 1


def label_of(edge: Edge) -> str:
    """The label of an edge in the picture."""
    return short(edge.name)


def _lane(edge: Edge | None, band: int) -> Cell:
    wide = 8 + width(label_of(edge), NORMAL) if edge is not None else LANE
    return Cell(band, [""], LANE, wide)


def _measure(found: Plan) -> None:
    """Set sizes of bodies and vertices, once their ports are in order."""
    for name, k in found.cell.items():
        cell = found.cells[k]
        if name in found.bodies:
            made = found.shapes[name] = shape(found.bodies[name], cell.ports)
            cell.left, cell.right = 0, made.width
            cell.offsets = {vertex: x for vertex, (x, _) in made.places.items()}
        elif found.layer[name] == 0:
            half = width(short(name), SMALL) // 2 + 2
            cell.left = cell.right = half
        else:
            cell.left, cell.right = 6, 8 + width(short(name), NORMAL)
    for cell_of_arch in found.piles:
        _measure_arch(found, cell_of_arch)


def _measure_arch(found: Plan, k: int) -> None:
    """Set the width of a stack of arches from its labels, and the distance of its ends."""
    cell = found.cells[k]
    routes = [route for route in found.routes if route.cells[1][0] == k and route.arch >= 0]
    inner = max(width(label_of(route.edge), NORMAL) for route in routes) // 2 + 3
    legs = LEG * (len(routes) - 1)
    cell.left = cell.right = inner + legs + 2
    first, second = cell.ports
    cell.offsets = {first: -inner - legs // 2, second: inner + legs // 2}
    (a, vertex_a), (b, vertex_b) = routes[0].cells[0], routes[0].cells[3]
    if (
        found.node.get(vertex_a) not in found.bodies
        and found.node.get(vertex_b) not in found.bodies
    ):
        found.apart[(a, b)] = found.apart[(b, a)] = 2 * cell.left + GAP


def _set_heights(found: Plan, links: list[BandLink]) -> None:
    """Set heights of bands and of the zones between them, larger where lines bend far."""
    count = 1 + max((cell.band for cell in found.cells), default=0)
    heights = [LABEL_BAND if band % 2 else 0 for band in range(count)]
    for name, k in found.cell.items():
        band = found.cells[k].band
        if band:
            heights[band] = max(heights[band], HEIGHT if name in found.bodies else DOT)
    for k, pile in found.piles.items():
        band = found.cells[k].band
        heights[band] = max(heights[band], RISE + ARCH * pile)
    zones = [LEAST_ZONE] * count
    for x in links:
        band = found.cells[x.low].band
        bend = abs(found.port(x.low, x.low_port) - found.port(x.high, x.high_port))
        zones[band] = max(zones[band], min(MOST_ZONE, LEAST_ZONE + bend // 5))
    at = 0
    for height, zone in zip(heights, zones, strict=True):
        found.floors.append(at)
        found.ceilings.append(at + height)
        at += height + zone
    found.height = found.ceilings[-1] if found.ceilings else 0
