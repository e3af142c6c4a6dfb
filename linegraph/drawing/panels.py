"""The picture of one subspace's graph, drawn from its layout."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.components.body import GROUND
from linegraph.drawing.bodies import FAN, HEIGHT, drawn
from linegraph.drawing.layout import ARCH, LEG, RISE, Plan, Route, label_of, plan
from linegraph.drawing.letters import short, width
from linegraph.drawing.looks import PLAIN, pen_of
from linegraph.drawing.scene import (
    GREY,
    INK,
    LARGE,
    NORMAL,
    SMALL,
    Disc,
    Item,
    Part,
    Pen,
    Point,
    Stroke,
    Text,
    arrow_head,
    line,
    moved,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.graph.multigraph import Projection

TITLE, BELOW = 30, 30
"""Space above a panel for its title, and below the rail for names of frames."""

RAIL = Pen(INK, 4)


class Panel:
    """The drawing of one graph.

    Attributes:
        items: the items, from the upper left corner.
        width, height: their size.
        kinds: kinds of edges that occur, and whether as branches.
        about: description in words.
    """

    def __init__(
        self, title: str, projection: Projection, branches: frozenset[str], kinds: Mapping[str, str]
    ) -> None:
        """Lay out and draw a graph.

        Args:
            title: the subspaces it is drawn for.
            projection: the graph.
            branches: names of the branches; empty if no tree is chosen.
            kinds: kinds of components of spatial mechanics, by name.
        """
        self.plan = plan(projection, branches)
        self.branches, self.by_component = branches, kinds
        self.kinds: dict[tuple[str, bool], None] = {}
        self.bodies = bool(self.plan.bodies)
        self.margin = width(GROUND, NORMAL, bold=True) + 12
        self.width = max(self.margin + self.plan.width + 12, width(title, LARGE, bold=True))
        self.height = TITLE + self.plan.height + BELOW
        self.fans = _fans(self.plan)
        edges = [self._edge(route) for route in self.plan.routes]
        under, above = self._bodies()
        items = [
            Text(0, 13, title, LARGE, bold=True),
            *under,
            *self._rail(),
            *edges,
            *self._vertices(),
            *above,
        ]
        self.items: tuple[Item, ...] = tuple(items)
        vertices, count = len(projection.vertices), len(projection.edges)
        self.about = f"{title}: {vertices} vertices, {count} edges"

    def _at(self, x: float, up: float) -> Point:
        """Convert coordinates of the layout to those of the panel."""
        return (self.margin + x, TITLE + self.plan.height - up)

    def _rail(self) -> list[Item]:
        """Ground: a thick line, hatched below, with its frames on it."""
        if GROUND not in self.plan.layer:
            return []
        (left, y), (right, _) = self._at(-2, 0), self._at(self.plan.width + 4, 0)
        hatch = [
            line((x, y + 2), (x - 7, y + 9), pen=Pen(INK, 0.8))
            for x in range(int(left) + 8, int(right) + 1, 9)
        ]
        name = Text(left - 6, y + 4, GROUND, NORMAL, "end", bold=True)
        rail = line((left, y), (right, y), pen=RAIL)
        items: list[Item] = [Part("vertex", GROUND, (rail, *hatch, name), "the reference")]
        for edge in self.plan.arms:
            x, _ = self._at(self.plan.port(self.plan.cell[edge.head], edge.head), 0)
            label = short(edge.head.removeprefix(f"{GROUND}."))
            arm = line((x - 9, y), (x, y), pen=Pen("#ffffff", 1))
            items.append(Part("arm", edge.name, (arm,), f"rigid arm, {edge.tail} → {edge.head}"))
            dot = Disc(x, y, 4, Pen(INK, 1.4), "#ffffff")
            text = Text(x, y + 21, label, SMALL, "middle", GREY)
            items.append(Part("vertex", edge.head, (dot, text), "a frame of ground"))
        return items

    def _bodies(self) -> tuple[list[Item], list[Item]]:
        under: list[Item] = []
        above: list[Item] = []
        for name, body in self.plan.bodies.items():
            x, y = self._at(*self._corner(name))
            behind, before = drawn(body, self.plan.shapes[name])
            under += moved(behind, x, y)
            above += moved(before, x, y)
        return under, above

    def _corner(self, name: str) -> tuple[float, float]:
        """Upper left corner of a body's region, which is centred in its band."""
        cell = self.plan.cells[self.plan.cell[name]]
        middle = self.plan.floors[cell.band] + self.plan.ceilings[cell.band]
        return cell.x, middle / 2 + HEIGHT / 2

    def _vertices(self) -> list[Item]:
        """Vertices outside bodies, those of networks."""
        items: list[Item] = []
        for name, k in self.plan.cell.items():
            cell = self.plan.cells[k]
            if name in self.plan.bodies or not cell.band:
                continue
            x, y = self._at(*self._place(k, name))
            label = Text(x + 8, y + 4, short(name), NORMAL, bold=True)
            items.append(Part("vertex", name, (Disc(x, y, 4, None, INK), label)))
        return items

    def _place(self, k: int, vertex: str) -> tuple[float, float]:
        """Position of a vertex in the layout."""
        cell = self.plan.cells[k]
        node = self.plan.node.get(vertex, "")
        if node in self.plan.bodies:
            x, top = self._corner(node)
            dx, dy = self.plan.shapes[node].places[vertex]
            return x + dx, top - dy
        middle = (self.plan.floors[cell.band] + self.plan.ceilings[cell.band]) / 2
        return cell.x, middle

    def _edge(self, route: Route) -> Part:
        edge = route.edge
        bold = edge.name in self.branches
        kind = self.by_component.get(edge.component, PLAIN)
        self.kinds[(kind, bold)] = None
        pen = pen_of(kind, bold)
        steps, head, text = self._arch(route) if route.arch >= 0 else self._lane(route)
        points = [self._at(*point) for step in steps for point in step]
        shaped: list[tuple[Point, ...]] = []
        at = 1
        for step in steps[1:]:
            shaped.append(tuple(points[at : at + len(step)]))
            at += len(step)
        tip, along = head
        label = Text(*self._at(*text[0]), label_of(edge), NORMAL, text[1])
        items = (
            Stroke(points[0], tuple(shaped), pen),
            arrow_head(self._at(*tip), along, pen.color, 8 if bold else 7),
            label,
        )
        role = ("branch" if bold else "chord") if self.branches else "edge"
        about = ", ".join(x for x in (role, kind, f"{edge.tail} → {edge.head}") if x)
        return Part(role, edge.name, items, about)

    def _lane(
        self, route: Route
    ) -> tuple[list[list[Point]], tuple[Point, Point], tuple[Point, str]]:
        """An edge between layers: straight in each band, bent in the zones between them."""
        low, high = route.cells[0], route.cells[-1]
        start = self._end(low)
        first = self._exit(route, low, True)
        last = (first, max(start[1], self.plan.ceilings[self.plan.cells[low[0]].band]))
        steps: list[list[Point]] = [[start], _bend(start, last)]
        for cell, _ in route.cells[1:-1]:
            x, band = self.plan.cells[cell].x, self.plan.cells[cell].band
            steps += [_bend(last, (x, self.plan.floors[band])), [(x, self.plan.ceilings[band])]]
            last = steps[-1][-1]
        end = self._place(*high)
        floor = self.plan.floors[self.plan.cells[high[0]].band]
        entry = (self._exit(route, high, False), min(floor, end[1]))
        steps += [_bend(last, entry), _bend(entry, end)]
        cell = route.cells[route.label][0]
        x, band = self.plan.cells[cell].x, self.plan.cells[cell].band
        middle = (self.plan.floors[band] + self.plan.ceilings[band]) / 2
        sense = 1 if route.upward else -1
        head = ((x, middle + 4 * sense), (0, -sense))
        return steps, head, ((x + 7, middle - 4), "start")

    def _arch(
        self, route: Route
    ) -> tuple[list[list[Point]], tuple[Point, Point], tuple[Point, str]]:
        """An edge within a layer: up from one end, along below its label, down to the other."""
        k = route.cells[1][0]
        cell, floor = self.plan.cells[k], self.plan.floors[self.plan.cells[k].band]
        level = floor + RISE + ARCH * route.arch
        half = cell.left - 2 - LEG * (self.plan.piles[k] - 1 - route.arch)
        side = 1 if cell.offsets["low"] < cell.offsets["high"] else -1
        ends = [self._end(end) for end in (route.cells[0], route.cells[3])]
        ceiling = self.plan.ceilings[cell.band - 1]
        a, b = cell.x - side * half, cell.x + side * half
        r = min(6, level - floor)
        steps: list[list[Point]] = [
            [ends[0]],
            [(ends[0][0], max(ends[0][1], ceiling))],
            _bend((ends[0][0], max(ends[0][1], ceiling)), (a, floor)),
            [(a, level - r)],
            [(a, level - r / 2), (a + side * r / 2, level), (a + side * r, level)],
            [(b - side * r, level)],
            [(b - side * r / 2, level), (b, level - r / 2), (b, level - r)],
            [(b, floor)],
            _bend((b, floor), (ends[1][0], max(ends[1][1], ceiling))),
            [ends[1]],
        ]
        sense = side if route.upward else -side
        head = ((cell.x + 4 * sense, level), (sense, 0))
        return steps, head, ((cell.x, level + 6), "middle")

    def _exit(self, route: Route, end: tuple[int, str], upward: bool) -> float:
        """Position where an edge leaves the band of its end; edges of a vertex inside a body are spread."""
        x, _ = self._end(end)
        fan = self.fans.get((end[1], upward), [])
        node = self.plan.node.get(end[1], "")
        if len(fan) < 2 or node not in self.plan.bodies:
            return x
        if self.plan.shapes[node].places[end[1]][1] in (0, HEIGHT):
            return x
        return x + FAN * (fan.index(route.edge.name) - (len(fan) - 1) / 2)

    def _end(self, end: tuple[int, str]) -> Point:
        """End of an edge: a vertex, or a place on the rail."""
        return self._place(*end) if end[1] else (self.plan.cells[end[0]].x, 0)


def _fans(plan: Plan) -> dict[tuple[str, bool], list[str]]:
    """For each vertex and side the edges that leave there, from left to right."""
    found: dict[tuple[str, bool], list[tuple[int, str]]] = {}
    for route in plan.routes:
        if route.arch < 0:
            (_, low), (_, high) = route.cells[0], route.cells[-1]
            for vertex, upward, beside in (
                (low, True, route.cells[1]),
                (high, False, route.cells[-2]),
            ):
                place = plan.cells[beside[0]].x
                found.setdefault((vertex, upward), []).append((place, route.edge.name))
    return {key: [name for _, name in sorted(edges)] for key, edges in found.items()}


def _bend(a: Point, b: Point) -> list[Point]:
    """A curve between two heights, vertical at both ends."""
    if a[0] == b[0]:
        return [b]
    rise = 0.55 * (b[1] - a[1])
    return [(a[0], a[1] + rise), (b[0], b[1] - rise), b]
