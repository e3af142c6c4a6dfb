"""A body in the picture of a graph: a tinted region with its vertices, its rigid arms and its inertia edge.

Vertices that lead towards ground stand on the lower border, those that lead away from it on the upper one,
those that do both inside. The arms run from the mass centre along a common stem. The inertia edge ends in a
ground sign of its own instead of running to the rail.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from linegraph.drawing.letters import short, width
from linegraph.drawing.scene import (
    EDGE_OF_TINT,
    FAINT,
    GREY,
    INK,
    PAPER,
    SMALL,
    TINT,
    Disc,
    Item,
    Part,
    Pen,
    Region,
    Stroke,
    Text,
    arrow_head,
    line,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.graph.multigraph import Edge

HEIGHT, STEM = 48, 26
"""Of a body's region, and of the stem from its top."""

INERTIA = "inertia"
LONGEST_FRAME = 24
FAN = 8
"""How far apart edges leave a body that have a vertex inside it in common."""
ARM = Pen(FAINT, 1)


@dataclass
class BodyArea:
    """What is known of a body before it is drawn.

    Attributes:
        arms: the edge to each of its frames' vertices.
        inertia: its inertia edge and whether that is a branch.
        up, down: how many edges its vertices have away from ground, and towards it.
    """

    name: str
    center: str = ""
    arms: dict[str, Edge] = field(default_factory=dict)
    inertia: Edge | None = None
    bold: bool = False
    up: dict[str, int] = field(default_factory=dict)
    down: dict[str, int] = field(default_factory=dict)

    def label(self, vertex: str) -> str:
        """What a frame is called inside the body; its own frame has no name beside the body's."""
        return short(vertex.removeprefix(self.name).removeprefix("."), LONGEST_FRAME)


@dataclass(frozen=True)
class Shape:
    """Where things are in a body's region, from its upper left corner."""

    width: int
    places: dict[str, tuple[int, int]]
    info: int


def shape(body: BodyArea, ports: Sequence[str]) -> Shape:
    """Lay out a body's vertices, in the order given, and its name.

    Rows end at the stem's root, so that a vertex above and one below stand in one line.
    """
    top = bottom = 6
    places: dict[str, tuple[int, int]] = {}
    for vertex in ports:
        label = body.label(vertex)
        wide = width(label, SMALL) + 12 if label else 10
        up, down = body.up.get(vertex, 0), body.down.get(vertex, 0)
        if up and down:
            spread = FAN * (max(up, down) - 1) // 2
            at = max(top, bottom) + max(wide, spread + 8)
            places[vertex] = (at, STEM - 10)
            top = bottom = at + max(10, spread + 6)
        elif down:
            bottom += wide
            places[vertex] = (bottom, HEIGHT)
            bottom += 8
        else:
            top += wide
            places[vertex] = (top, 0)
            top += 8
    places = _aligned(places, top, bottom)
    info = max(top, bottom) + 6
    title = width(short(body.name), 11, bold=True)
    sign = 58 if body.inertia is not None else 20
    return Shape(info + max(title, sign) + 8, places, info)


def _aligned(
    places: dict[str, tuple[int, int]], top: int, bottom: int
) -> dict[str, tuple[int, int]]:
    """Shift what follows the last vertex with edges on both sides to the right, in the shorter row."""
    last = max((k for k, (_, y) in enumerate(places.values()) if y == STEM - 10), default=-1)
    end = max(top, bottom)
    shift = {0: end - top, HEIGHT: end - bottom}
    return {
        vertex: (x + shift.get(y, 0) if k > last else x, y)
        for k, (vertex, (x, y)) in enumerate(places.items())
    }


def drawn(body: BodyArea, shape: Shape) -> tuple[list[Item], list[Item]]:
    """The region with its arms, and what stands above edges; from the upper left corner."""
    name = short(body.name)
    region = Region(0, 0, shape.width, HEIGHT, 10, Pen(EDGE_OF_TINT, 1), TINT)
    title = Text(shape.info, 13, name, 11, bold=True)
    under: list[Item] = [Part("body", body.name, (region, title), "body")]
    above: list[Item] = []
    hub = (shape.info + 6, STEM)
    for vertex, (x, y) in shape.places.items():
        edge = body.arms.get(vertex)
        if edge is not None:
            about = f"rigid arm, {edge.tail} → {edge.head}"
            under.append(Part("arm", edge.name, (_arm(hub, (x, y)),), about))
        above.append(_vertex(body, vertex, x, y))
    if body.inertia is not None:
        under.append(_inertia(body, hub))
    if body.center:
        above.append(Part("vertex", body.center, _center(*hub), "mass centre"))
    return under, above


def _arm(hub: tuple[int, int], end: tuple[int, int]) -> Stroke:
    """Along the stem, then round the corner to the vertex."""
    (x, y), r = end, min(8, abs(end[1] - hub[1]))
    turn = hub[1] + (r if y > hub[1] else -r)
    corner = ((x + r / 2, hub[1]), (x, (hub[1] + turn) / 2), (x, turn))
    return Stroke(hub, (((x + r, hub[1]),), corner, (end,)), ARM)


def _vertex(body: BodyArea, vertex: str, x: int, y: int) -> Part:
    label = body.label(vertex)
    items: list[Item] = [Disc(x, y, 3.2, None, INK)]
    if label:
        inside = {0: 12, HEIGHT: HEIGHT - 5}.get(y, y + 3)
        items.append(Text(x - 6, inside, label, SMALL, "end", GREY))
    return Part(
        "vertex", vertex, tuple(items), "frame of the body" if label else "the body's own frame"
    )


def _center(x: int, y: int) -> tuple[Item, ...]:
    """The quartered disc."""
    return quartered(x, y, 5)


def quartered(x: float, y: float, r: float) -> tuple[Item, ...]:
    """The sign of a mass centre."""
    k = 0.5523 * r
    right = ((x + k, y - r), (x + r, y - k), (x + r, y))
    left = ((x - k, y + r), (x - r, y + k), (x - r, y))
    return (
        Disc(x, y, r, Pen(INK, 1), PAPER),
        Stroke((x, y), (((x, y - r),), right), None, True, INK),
        Stroke((x, y), (((x, y + r),), left), None, True, INK),
    )


def _inertia(body: BodyArea, hub: tuple[int, int]) -> Part:
    """The inertia edge: from a ground sign to the mass centre."""
    from linegraph.drawing.looks import BRANCH_PEN, CHORD_PEN

    assert body.inertia is not None
    x, y = hub
    pen = BRANCH_PEN if body.bold else CHORD_PEN
    end = x + 36
    items: list[Item] = [
        line((end, y), (x + 10, y), pen=pen),
        arrow_head((x + 12, y), (-1, 0), pen.color),
        *ground_sign(end, y),
        Text(x + 8, y + 16, INERTIA, SMALL, color=GREY),
    ]
    role = "branch" if body.bold else "chord"
    about = f"{role}, {body.inertia.tail} → {body.inertia.head}"
    return Part(role, body.inertia.name, tuple(items), about)


def ground_sign(x: float, y: float) -> tuple[Item, ...]:
    """An upright piece of ground, hatched on its right."""
    pen = Pen(INK, 0.8)
    hatch = [line((x, y - 6 + 4 * k), (x + 4, y - 9 + 4 * k), pen=pen) for k in range(4)]
    return (line((x, y - 7), (x, y + 7), pen=Pen(INK, 1.6)), *hatch)
