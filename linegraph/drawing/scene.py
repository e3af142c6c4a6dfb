"""What a picture consists of: lines, curves, discs, regions and text on a canvas. x right, y down.

A scene says nothing of files; `svg` and `png` write it. Items are grouped into parts that say what they
show, so that a reader, a screen reader or a test finds a branch among lines.
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
"""Colours that differ in lightness, too: they stay apart in grey print and for the colour-blind."""

SMALL, NORMAL, LARGE = 10, 12, 14
"""Sizes of text."""


@dataclass(frozen=True)
class Pen:
    """How a line is drawn; no dash is a solid line."""

    color: str = INK
    width: float = 1.2
    dash: tuple[float, ...] = ()


@dataclass(frozen=True)
class Stroke:
    """Lines and cubic curves end to end: each step is one point, or two controls and a point.

    Attributes:
        fill: the colour inside; empty for none.
    """

    start: Point
    steps: tuple[tuple[Point, ...], ...]
    pen: Pen | None = None
    closed: bool = False
    fill: str = ""


@dataclass(frozen=True)
class Disc:
    """A circle."""

    x: float
    y: float
    radius: float
    pen: Pen | None = None
    fill: str = ""


@dataclass(frozen=True)
class Region:
    """A rectangle with round corners."""

    x: float
    y: float
    width: float
    height: float
    radius: float = 0
    pen: Pen | None = None
    fill: str = ""


@dataclass(frozen=True)
class Text:
    """A line of text that stands on y; `anchor` is start, middle or end."""

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
        """What it covers at most."""
        wide = width(self.text, self.size, bold=self.bold)
        left = self.x - {"start": 0, "middle": wide / 2, "end": wide}[self.anchor]
        return Box(left, self.y - 0.8 * self.size, left + wide, self.y + 0.25 * self.size)


@dataclass(frozen=True)
class Part:
    """Items that show one thing.

    Attributes:
        kind: what the thing is, e.g. ``branch`` or ``body``.
        name: its whole name.
        about: more on it, for whoever points at it.
    """

    kind: str
    name: str
    items: tuple[Item, ...]
    about: str = ""


Item = Stroke | Disc | Region | Text | Part


@dataclass(frozen=True)
class Box:
    """An upright rectangle."""

    left: float
    top: float
    right: float
    bottom: float

    def meets(self, other: Box, gap: float = 0) -> bool:
        """Whether they overlap, or are closer than `gap`."""
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
        width, height: of the canvas.
        title: one line that says what it shows.
        about: what there is to see, for those who cannot.
    """

    width: int
    height: int
    title: str
    about: str
    items: tuple[Item, ...]

    def __repr__(self) -> str:
        """What it shows, and its size."""
        return f"<picture of {self.width} x {self.height}: {self.title}>"

    def parts(self) -> Iterator[Part]:
        """All parts, outer ones first."""
        yield from _parts(self.items)

    def texts(self) -> Iterator[Text]:
        """All text."""
        yield from (item for item in flat(self.items) if isinstance(item, Text))


def _parts(items: Iterable[Item]) -> Iterator[Part]:
    for item in items:
        if isinstance(item, Part):
            yield item
            yield from _parts(item.items)


def flat(items: Iterable[Item]) -> Iterator[Stroke | Disc | Region | Text]:
    """The items that are drawn, in order."""
    for item in items:
        if isinstance(item, Part):
            yield from flat(item.items)
        else:
            yield item


def moved(items: Iterable[Item], dx: float, dy: float) -> tuple[Item, ...]:
    """The same items elsewhere."""
    return tuple(_moved(item, dx, dy) for item in items)


def _moved(item: Item, dx: float, dy: float) -> Item:
    if isinstance(item, Part):
        return replace(item, items=moved(item.items, dx, dy))
    if isinstance(item, Stroke):
        steps = tuple(tuple((x + dx, y + dy) for x, y in step) for step in item.steps)
        return replace(item, start=(item.start[0] + dx, item.start[1] + dy), steps=steps)
    return replace(item, x=item.x + dx, y=item.y + dy)


def line(*points: Point, pen: Pen) -> Stroke:
    """A line through points."""
    return Stroke(points[0], tuple((point,) for point in points[1:]), pen)


def polygon(*points: Point, fill: str, pen: Pen | None = None) -> Stroke:
    """A closed area."""
    return Stroke(points[0], tuple((point,) for point in points[1:]), pen, closed=True, fill=fill)


def arrow_head(tip: Point, along: Point, color: str, size: float = 7) -> Stroke:
    """A solid head whose tip points along a direction of length 1."""
    (x, y), (dx, dy) = tip, along
    back, half = (x - size * dx, y - size * dy), 0.42 * size
    return polygon(
        tip,
        (back[0] - half * dy, back[1] + half * dx),
        (back[0] + half * dy, back[1] - half * dx),
        fill=color,
    )


def tenth(x: float) -> float:
    """Rounded to 0.1, in the same way where a computed value lies on the border but for rounding."""
    return int(x * 10 + 0.5001 if x >= 0 else x * 10 - 0.4999) / 10
