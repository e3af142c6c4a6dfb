"""Elements of pictures: lines, curves, discs, regions and text on a canvas, x to the right, y down.

A scene is independent of file formats; `svg`, `png` and `latex` write it. Items are grouped into parts that
name the thing they show, so that a screen reader or a test finds a branch among lines.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from linegraph.display import Displayed
from linegraph.drawing.letters import width

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

Point = tuple[float, float]

INK, GREY, FAINT, PAPER = "#1b1b1b", "#5c5c5c", "#9a9a9a", "#ffffff"
BRANCH, ACCENT, TINT, EDGE_OF_TINT = "#0a4a8f", "#b3400e", "#eef3f9", "#aebfd2"
"""Colours that also differ in lightness, for grey print and for the colour-blind."""

SMALL, NORMAL, LARGE = 10, 12, 14
"""Sizes of text, in units of the canvas."""


@dataclass(frozen=True)
class Pen:
    """The style of a line.

    Attributes:
        color: as ``#rrggbb``.
        width: in units of the canvas.
        dash: lengths of dashes and gaps; empty for a solid line.
    """

    color: str = INK
    width: float = 1.2
    dash: tuple[float, ...] = ()


@dataclass(frozen=True)
class Stroke:
    """Lines and cubic Bézier curves in sequence.

    Attributes:
        start: the first point.
        steps: one point for a line, or two control points and a point for a curve.
        pen: style of the line; None for none.
        closed: whether the last point is joined to the first.
        fill: colour of the area; empty for none.
    """

    start: Point
    steps: tuple[tuple[Point, ...], ...]
    pen: Pen | None = None
    closed: bool = False
    fill: str = ""


@dataclass(frozen=True)
class Disc:
    """A circle with its area.

    Attributes:
        x, y: its centre.
        radius: its radius.
        pen: style of the line; None for none.
        fill: colour of the area; empty for none.
    """

    x: float
    y: float
    radius: float
    pen: Pen | None = None
    fill: str = ""


@dataclass(frozen=True)
class Region:
    """A rectangle with round corners.

    Attributes:
        x, y: its upper left corner.
        width, height: its size.
        radius: radius of the corners.
        pen: style of the line; None for none.
        fill: colour of the area; empty for none.
    """

    x: float
    y: float
    width: float
    height: float
    radius: float = 0
    pen: Pen | None = None
    fill: str = ""


@dataclass(frozen=True)
class Text:
    """A line of text.

    Attributes:
        x: position of its anchor.
        y: position of its base line.
        text: the text.
        size: its size.
        anchor: ``start``, ``middle`` or ``end``.
        color: as ``#rrggbb``.
        bold, slanted: style of the font.
    """

    x: float
    y: float
    text: str
    size: int = NORMAL
    anchor: str = "start"
    color: str = INK
    bold: bool = False
    slanted: bool = False

    @property
    def box(self) -> Box:
        """The area that it covers at most."""
        wide = width(self.text, self.size, bold=self.bold)
        left = self.x - {"start": 0, "middle": wide / 2, "end": wide}[self.anchor]
        return Box(left, self.y - 0.8 * self.size, left + wide, self.y + 0.25 * self.size)


@dataclass(frozen=True)
class Part:
    """Items that together show one thing.

    Attributes:
        kind: its kind, such as ``branch`` or ``body``.
        name: its full name.
        items: the items.
        about: further information, shown when one points at it.
    """

    kind: str
    name: str
    items: tuple[Item, ...]
    about: str = ""


Item = Stroke | Disc | Region | Text | Part


@dataclass(frozen=True)
class Box:
    """A rectangle with sides parallel to the axes; y is down.

    Attributes:
        left, top, right, bottom: positions of its sides.
    """

    left: float
    top: float
    right: float
    bottom: float

    def meets(self, other: Box, gap: float = 0) -> bool:
        """Whether two rectangles overlap or are too close.

        Args:
            other: the other rectangle.
            gap: least distance.
        """
        return (
            self.left < other.right + gap
            and other.left < self.right + gap
            and self.top < other.bottom + gap
            and other.top < self.bottom + gap
        )


@dataclass(frozen=True, repr=False)
class Scene(Displayed):
    """A picture.

    Attributes:
        width, height: size of the canvas.
        title: one line about its content.
        about: description in words, for readers who cannot see it.
        items: its content, in order of drawing.
    """

    width: int
    height: int
    title: str
    about: str
    items: tuple[Item, ...]

    def __repr__(self) -> str:
        """Return its title and size."""
        return f"<picture of {self.width} x {self.height}: {self.title}>"

    def parts(self) -> Iterator[Part]:
        """All parts, outer ones before those inside."""
        yield from _parts(self.items)

    def texts(self) -> Iterator[Text]:
        """All texts, in order of drawing."""
        yield from (item for item in flat(self.items) if isinstance(item, Text))


def _parts(items: Iterable[Item]) -> Iterator[Part]:
    for item in items:
        if isinstance(item, Part):
            yield item
            yield from _parts(item.items)


def flat(items: Iterable[Item]) -> Iterator[Stroke | Disc | Region | Text]:
    """Items without parts around them, in order of drawing."""
    for item in items:
        if isinstance(item, Part):
            yield from flat(item.items)
        else:
            yield item


def moved(items: Iterable[Item], dx: float, dy: float) -> tuple[Item, ...]:
    """Return items at another place.

    Args:
        items: the items.
        dx: shift to the right.
        dy: shift down.
    """
    return tuple(_moved(item, dx, dy) for item in items)


def _moved(item: Item, dx: float, dy: float) -> Item:
    if isinstance(item, Part):
        return replace(item, items=moved(item.items, dx, dy))
    if isinstance(item, Stroke):
        steps = tuple(tuple((x + dx, y + dy) for x, y in step) for step in item.steps)
        return replace(item, start=(item.start[0] + dx, item.start[1] + dy), steps=steps)
    return replace(item, x=item.x + dx, y=item.y + dy)


def line(*points: Point, pen: Pen) -> Stroke:
    """A line through points.

    Args:
        points: at least two points.
        pen: style of the line.
    """
    return Stroke(points[0], tuple((point,) for point in points[1:]), pen)


def polygon(*points: Point, fill: str, pen: Pen | None = None) -> Stroke:
    """A closed polygon.

    Args:
        points: its corners.
        fill: colour of the area.
        pen: style of the line; None for none.
    """
    return Stroke(points[0], tuple((point,) for point in points[1:]), pen, closed=True, fill=fill)


def arrow_head(tip: Point, along: Point, color: str, size: float = 7) -> Stroke:
    """A solid arrow head.

    Args:
        tip: its tip.
        along: its direction, of length 1.
        color: its colour.
        size: its length.
    """
    (x, y), (dx, dy) = tip, along
    back, half = (x - size * dx, y - size * dy), 0.42 * size
    return polygon(
        tip,
        (back[0] - half * dy, back[1] + half * dx),
        (back[0] + half * dy, back[1] - half * dx),
        fill=color,
    )


def tenth(x: float) -> float:
    """Round to 0.1, upwards at the border between two tenths.

    The margin makes the result independent of rounding errors for computed values on the border.
    """
    return int(x * 10 + 0.5001 if x >= 0 else x * 10 - 0.4999) / 10
