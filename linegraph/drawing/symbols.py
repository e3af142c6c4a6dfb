"""Symbols of joints and force elements, each drawn around a point; y is down."""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING

from linegraph.drawing.scene import (
    ACCENT,
    GREY,
    INK,
    PAPER,
    Disc,
    Item,
    Pen,
    Point,
    Stroke,
    arrow_head,
    line,
    polygon,
)

if TYPE_CHECKING:
    from collections.abc import Callable

THIN, SOLID = Pen(INK, 1), Pen(INK, 1.5)
AXIS, DASHED = Pen(ACCENT, 1, (7, 2.5, 1.5, 2.5)), Pen(GREY, 1.2, (4, 3))
END_ON = 0.35
"""An axis whose projection is shorter than this is drawn end-on."""


def joint_symbol(kind: str, at: Point, axis: Point) -> list[Item]:
    """The symbol of a joint.

    Args:
        kind: the joint type; unknown ones get that of a compound joint.
        at: position in the picture.
        axis: projected direction of its axis, shorter than 1 if not parallel to the picture.
    """
    length = sqrt(axis[0] * axis[0] + axis[1] * axis[1])
    end_on = length < END_ON
    along = (1.0, 0.0) if end_on else (axis[0] / length, axis[1] / length)
    draw = _SIGNS.get(kind, _compound)
    return draw(at, along, end_on)


def _about(at: Point, along: Point) -> Callable[[float, float], Point]:
    """Convert coordinates along and across a direction to the picture."""
    (x, y), (dx, dy) = at, along
    return lambda a, b: (x + a * dx - b * dy, y + a * dy + b * dx)


def _axis(at: Point, along: Point, reach: float) -> list[Item]:
    """A dash-dotted line with an arrow head."""
    place = _about(at, along)
    return [
        line(place(-reach, 0), place(reach, 0), pen=AXIS),
        arrow_head(place(reach + 3, 0), along, ACCENT, 6),
    ]


def _box(at: Point, along: Point, long: float, wide: float, pen: Pen = SOLID) -> Stroke:
    place = _about(at, along)
    return polygon(
        place(-long, -wide),
        place(long, -wide),
        place(long, wide),
        place(-long, wide),
        fill=PAPER,
        pen=pen,
    )


def _revolute(at: Point, along: Point, end_on: bool) -> list[Item]:
    """A pin: a circle if seen end-on, else a short cylinder around its axis."""
    if end_on:
        return [Disc(*at, 5, SOLID, PAPER), Disc(*at, 1.4, None, INK)]
    return [*_axis(at, along, 19), _box(at, along, 8, 4.5)]


def _prismatic(at: Point, along: Point, end_on: bool) -> list[Item]:
    """A slider on a guide."""
    if end_on:
        return [_box(at, (1, 0), 7, 7), Disc(*at, 1.8, None, ACCENT)]
    place = _about(at, along)
    guides = [line(place(-19, b), place(19, b), pen=THIN) for b in (-6, 6)]
    arrow = [
        line(place(-6, 0), place(6, 0), pen=Pen(ACCENT, 1.2)),
        arrow_head(place(9, 0), along, ACCENT, 6),
    ]
    return [*guides, _box(at, along, 11, 6), *arrow]


def carriage(at: Point, axis: Point) -> list[Item]:
    """A slider that is a body with other joints in its middle; its arrow is next to it.

    Args:
        at: position in the picture.
        axis: projected direction of its axis.
    """
    length = sqrt(axis[0] * axis[0] + axis[1] * axis[1])
    along = (axis[0] / length, axis[1] / length)
    place = _about(at, along)
    arrow = [
        line(place(25, 0), place(38, 0), pen=Pen(ACCENT, 1.2)),
        arrow_head(place(43, 0), along, ACCENT, 6),
    ]
    return [_box(at, along, 22, 12), *arrow]


def _cylindrical(at: Point, along: Point, end_on: bool) -> list[Item]:
    """A pin that slides: a longer cylinder in a sleeve."""
    if end_on:
        return [Disc(*at, 7, SOLID, PAPER), Disc(*at, 3.5, THIN, PAPER)]
    return [*_axis(at, along, 24), _box(at, along, 14, 3), _box(at, along, 7, 5.5)]


def _helical(at: Point, along: Point, end_on: bool) -> list[Item]:
    """A nut on a thread."""
    items = _cylindrical(at, along, end_on)
    if end_on:
        return items
    place = _about(at, along)
    return items + [line(place(a - 3, 5.5), place(a + 1, -5.5), pen=THIN) for a in (-3, 1, 5)]


def _spherical(at: Point, along: Point, end_on: bool) -> list[Item]:
    """A ball in its socket."""
    x, y = at
    r, k = 8.5, 0.5523 * 8.5
    socket = Stroke(
        (x - r, y),
        (
            ((x - r, y + k), (x - k, y + r), (x, y + r)),
            ((x + k, y + r), (x + r, y + k), (x + r, y)),
        ),
        SOLID,
    )
    return [socket, Disc(x, y, 5.2, None, INK)]


def _universal(at: Point, along: Point, end_on: bool) -> list[Item]:
    """A cross in a ring."""
    place = _about(at, (0.7071, 0.7071))
    bars = [
        line(place(-7.5, 0), place(7.5, 0), pen=SOLID),
        line(place(0, -7.5), place(0, 7.5), pen=SOLID),
    ]
    return [Disc(*at, 7.5, SOLID, PAPER), *bars]


def _planar(at: Point, along: Point, end_on: bool) -> list[Item]:
    """A plate on a plane."""
    across = (-along[1], along[0])
    if end_on:
        return [_box(at, (1, 0), 8, 8), *_axis_pair(at)]
    return [*_axis(at, along, 14), _box(at, across, 12, 2)]


def _axis_pair(at: Point) -> list[Item]:
    x, y = at
    pen = Pen(ACCENT, 1)
    lines = (line((x - 4, y), (x + 4, y), pen=pen), line((x, y + 4), (x, y - 4), pen=pen))
    return [
        *lines,
        arrow_head((x + 8, y), (1, 0), ACCENT, 5),
        arrow_head((x, y - 8), (0, -1), ACCENT, 5),
    ]


def _free(at: Point, along: Point, end_on: bool) -> list[Item]:
    """A dashed ring: no motion is constrained."""
    return [Disc(*at, 9, DASHED), Disc(*at, 1.8, None, INK)]


def _compound(at: Point, along: Point, end_on: bool) -> list[Item]:
    """A diamond: several joints at one place."""
    axis = [] if end_on else _axis(at, along, 17)
    return [*axis, _box(at, (0.7071, 0.7071), 6, 6), Disc(*at, 1.8, None, INK)]


_SIGNS: dict[str, Callable[[Point, Point, bool], list[Item]]] = {
    "revolute": _revolute,
    "prismatic": _prismatic,
    "cylindrical": _cylindrical,
    "helical": _helical,
    "spherical": _spherical,
    "universal": _universal,
    "planar": _planar,
    "free": _free,
}


def ground_symbol(at: Point, below: bool = True) -> list[Item]:
    """A support on hatched ground.

    Args:
        at: the supported point.
        below: whether the support is below the point.
    """
    (x, y), s = at, 1 if below else -1
    base = y + 14 * s
    hatch = [
        line((x + 5 * k, base), (x + 5 * k - 5, base + 5 * s), pen=Pen(INK, 0.8))
        for k in range(-2, 4)
    ]
    triangle = polygon((x, y), (x - 9, base), (x + 9, base), fill=PAPER, pen=THIN)
    return [triangle, line((x - 15, base), (x + 15, base), pen=Pen(INK, 1.8)), *hatch]


def hatched(at: Point, along: Point, away: float) -> list[Item]:
    """Hatched ground along a guide, on its lower side.

    Args:
        at: middle of the guide.
        along: its direction, of length 1.
        away: distance of the ground from the middle.
    """
    if along[0] < 0 or (along[0] == 0 and along[1] < 0):
        along = (-along[0], -along[1])
    place = _about(at, along)
    hatch = [
        line(place(5 * k, away), place(5 * k - 5, away + 5), pen=Pen(INK, 0.8))
        for k in range(-6, 8)
    ]
    return [line(place(-35, away), place(35, away), pen=Pen(INK, 1.8)), *hatch]


def tie_symbol(kind: str, tail: Point, head: Point, beside: float = 0) -> list[Item]:
    """The symbol of a spring, damper or other element between two points.

    Args:
        kind: the type of the element.
        tail: the first point.
        head: the second point.
        beside: sideways shift, for several elements between the same points.

    Returns:
        The items; none if the points are too close.
    """
    dx, dy = head[0] - tail[0], head[1] - tail[1]
    length = sqrt(dx * dx + dy * dy)
    if length < 8:
        return []
    place = _about(tail, (dx / length, dy / length))
    if kind == "rod":
        return [
            line(tail, head, pen=Pen(INK, 2.4)),
            *(Disc(*p, 3, SOLID, PAPER) for p in (tail, head)),
        ]
    if kind == "spring":
        return _spring(place, length, beside)
    if kind == "damper":
        return _damper(place, length, beside)
    return [line(tail, place(6, beside), place(length - 6, beside), head, pen=DASHED)]


def _spring(place: Callable[[float, float], Point], length: float, beside: float) -> list[Item]:
    """A zigzag line."""
    turns = max(3, min(9, int(length / 12)))
    first, last = 0.2 * length, 0.8 * length
    step = (last - first) / (2 * turns)
    teeth = [
        place(first + step * (k + 0.5), beside + (5 if k % 2 else -5)) for k in range(2 * turns)
    ]
    ends = (place(0, 0), place(0.1 * length, beside), place(first, beside))
    rest = (place(last, beside), place(0.9 * length, beside), place(length, 0))
    return [line(*ends, *teeth, *rest, pen=SOLID)]


def _damper(place: Callable[[float, float], Point], length: float, beside: float) -> list[Item]:
    """A piston in a cup."""
    a, b = 0.5 * length - 6, 0.5 * length + 8
    cup = line(
        place(b, beside - 6),
        place(a, beside - 6),
        place(a, beside + 6),
        place(b, beside + 6),
        pen=SOLID,
    )
    return [
        line(place(0, 0), place(0.1 * length, beside), place(a, beside), pen=SOLID),
        cup,
        line(place(a + 7, beside - 5), place(a + 7, beside + 5), pen=SOLID),
        line(place(a + 7, beside), place(0.9 * length, beside), place(length, 0), pen=SOLID),
    ]


def capsule(a: Point, b: Point, r: float, pen: Pen, fill: str) -> list[Item]:
    """A bar with round ends.

    Args:
        a: centre of the first end.
        b: centre of the second end.
        r: radius of the ends.
        pen: style of the line.
        fill: colour of the area.
    """
    dx, dy = b[0] - a[0], b[1] - a[1]
    length = sqrt(dx * dx + dy * dy)
    if length < 1:
        return [Disc(*a, r, pen, fill)]
    place = _about(a, (dx / length, dy / length))
    k = 0.5523 * r
    steps = (
        (place(length, -r),),
        (place(length + k, -r), place(length + r, -k), place(length + r, 0)),
        (place(length + r, k), place(length + k, r), place(length, r)),
        (place(0, r),),
        (place(-k, r), place(-r, k), place(-r, 0)),
        (place(-r, -k), place(-k, -r), place(0, -r)),
    )
    return [Stroke(place(0, -r), steps, pen, True, fill)]
