"""A body in the picture of a graph: a tinted region with its vertices, rigid arms and inertia edge.

Vertices with edges towards ground are on the lower border, those with edges away from it on the upper one,
those with both inside. The arms start at the mass centre and share a stem. The inertia edge ends at a
ground symbol of its own, since lines of all bodies to the rail would hide the graph.
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
"""Height of a body's region, and distance of the stem from its top."""

INERTIA = "inertia"
LONGEST_FRAME = 24
FAN = 8
"""Distance between edges that leave a body from a common vertex inside it."""
ARM = Pen(FAINT, 1)


@dataclass
class BodyArea:
    """A body before its region is laid out.

    Attributes:
        name: its name.
        center: vertex of its mass centre.
        arms: the rigid arm to each of its frames' vertices.
        inertia: its inertia edge.
        bold: whether the inertia edge is a branch.
        up, down: numbers of edges of its vertices away from ground and towards it.
    """

    name: str
    center: str = ""
    arms: dict[str, Edge] = field(default_factory=dict)
    inertia: Edge | None = None
    bold: bool = False
    up: dict[str, int] = field(default_factory=dict)
    down: dict[str, int] = field(default_factory=dict)

    def label(self, vertex: str) -> str:
        """Name of a frame inside the body; empty for the body's own frame."""
        return short(vertex.removeprefix(self.name).removeprefix("."), LONGEST_FRAME)


@dataclass(frozen=True)
class Shape:
    """Layout of a body's region, from its upper left corner.

    Attributes:
        width: its width.
        places: positions of vertices.
        info: left end of the name and of the mass centre.
    """

    width: int
    places: dict[str, tuple[int, int]]
    info: int


def shape(body: BodyArea, ports: Sequence[str]) -> Shape:
    """Lay out a body's vertices and its name.

    The upper and the lower row end at the same place, which keeps vertices above and below aligned.

    Args:
        body: the body.
        ports: its vertices, from left to right.
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
    """In the shorter row, shift the vertices behind the last one with edges on both sides to the right."""
    last = max((k for k, (_, y) in enumerate(places.values()) if y == STEM - 10), default=-1)
    end = max(top, bottom)
    shift = {0: end - top, HEIGHT: end - bottom}
    return {
        vertex: (x + shift.get(y, 0) if k > last else x, y)
        for k, (vertex, (x, y)) in enumerate(places.items())
    }


def drawn(body: BodyArea, shape: Shape) -> tuple[list[Item], list[Item]]:
    """Draw a body from its upper left corner.

    Args:
        body: the body.
        shape: its layout.

    Returns:
        Items below edges (region and arms) and items above them (vertices).
    """
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
    """A line along the stem and around a corner to the vertex."""
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
    """The symbol of a mass centre: a quartered disc."""
    return quartered(x, y, 5)


def quartered(x: float, y: float, r: float) -> tuple[Item, ...]:
    """The symbol of a mass centre, a quartered disc.

    Args:
        x: position of its centre.
        y: position of its centre.
        r: its radius.
    """
    k = 0.5523 * r
    right = ((x + k, y - r), (x + r, y - k), (x + r, y))
    left = ((x - k, y + r), (x - r, y + k), (x - r, y))
    return (
        Disc(x, y, r, Pen(INK, 1), PAPER),
        Stroke((x, y), (((x, y - r),), right), None, True, INK),
        Stroke((x, y), (((x, y + r),), left), None, True, INK),
    )


def _inertia(body: BodyArea, hub: tuple[int, int]) -> Part:
    """The inertia edge, from a ground symbol to the mass centre."""
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
    """An upright ground symbol, hatched on its right.

    Args:
        x: position of its middle.
        y: position of its middle.
    """
    pen = Pen(INK, 0.8)
    hatch = [line((x, y - 6 + 4 * k), (x + 4, y - 9 + 4 * k), pen=pen) for k in range(4)]
    return (line((x, y - 7), (x, y + 7), pen=Pen(INK, 1.6)), *hatch)
