"""Placing of names next to things: at the nearest free position, with a line where that is far."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from linegraph.drawing.letters import short
from linegraph.drawing.scene import (
    FAINT,
    INK,
    NORMAL,
    PAPER,
    Box,
    Item,
    Pen,
    Point,
    Region,
    Text,
    line,
    tenth,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

LONGEST_LABEL = 30
_DIRECTIONS = (
    (1.0, 0.0),
    (0.8, -0.7),
    (0.8, 0.7),
    (-1.0, 0.0),
    (-0.8, -0.7),
    (-0.8, 0.7),
    (0.0, -1.0),
    (0.0, 1.0),
    (0.35, -1.0),
    (0.35, 1.0),
    (-0.35, -1.0),
    (-0.35, 1.0),
)
_REACHES = (11, 17, 25, 36, 50, 68, 90, 115, 145)
LEADING = 24
"""Least distance at which a line leads to a label."""

CROSSED = 4
"""Cost of covering a line, in steps of distance."""


@dataclass
class Labels:
    """Labels of a picture during their placement.

    Attributes:
        inside: area for labels; those that find no place go to the right of it.
        taken: areas that labels must not cover.
        lines: points along lines that labels should not cover.
        aside: number of labels to the right of the area.
    """

    inside: Box
    taken: list[Box] = field(default_factory=list)
    lines: list[Point] = field(default_factory=list)
    aside: int = 0

    def along(self, points: Iterable[Point]) -> None:
        """Add a line that labels should not cover."""
        before: Point | None = None
        for point in points:
            if before is not None:
                (x, y), (dx, dy) = before, (point[0] - before[0], point[1] - before[1])
                steps = 1 + int(max(abs(dx), abs(dy)) / 6)
                self.lines += [(x + dx * k / steps, y + dy * k / steps) for k in range(steps + 1)]
            before = point

    def place(
        self, name: str, at: Point, *, color: str = INK, bold: bool = False, size: int = NORMAL
    ) -> list[Item]:
        """Place a name near a point.

        Args:
            name: the name, shortened if it is long.
            at: the point.
            color: colour of the text.
            bold: whether the text is bold.
            size: size of the text.

        Returns:
            The text, and a line to it if it is far from the point.
        """
        text = short(name, LONGEST_LABEL)
        best: tuple[float, Text, float] | None = None
        for step, reach in enumerate(_REACHES):
            if best is not None and best[0] <= step:
                break
            for turn, (dx, dy) in enumerate(_DIRECTIONS):
                label = _beside(text, at, (dx * reach, dy * reach), size, bold, color)
                box = label.box
                if not self._free(box):
                    continue
                cost = step + 0.1 * turn + CROSSED * any(_holds(box, p) for p in self.lines)
                if best is None or cost < best[0]:
                    best = (cost, label, reach)
        if best is None:
            y = self.inside.top + 12 + 16 * self.aside
            self.aside += 1
            best = (0, Text(self.inside.right + 24, y, text, size, color=color, bold=bold), 99)
        label = best[1]
        self.taken.append(label.box)
        box = label.box
        ground: list[Item] = []
        if any(_holds(box, p) for p in self.lines):  # white ground interrupts the line
            wide, high = tenth(box.right - box.left), tenth(box.bottom - box.top)
            ground = [Region(tenth(box.left), tenth(box.top), wide, high, 2, None, PAPER)]
        if best[2] < LEADING:
            return [*ground, label]
        x = min(max(at[0], box.left - 2), box.right + 2)
        y = min(max(at[1], box.top), box.bottom)
        return [line(at, (tenth(x), tenth(y)), pen=Pen(FAINT, 0.8)), *ground, label]

    def _free(self, box: Box) -> bool:
        room = self.inside
        if (
            box.left < room.left
            or box.right > room.right
            or box.top < room.top
            or box.bottom > room.bottom
        ):
            return False
        return not any(box.meets(other, 1.5) for other in self.taken)


def _beside(text: str, at: Point, away: Point, size: int, bold: bool, color: str) -> Text:
    """A label on one side of a point."""
    anchor = "start" if away[0] > 0 else "end" if away[0] < 0 else "middle"
    y = at[1] + away[1] + 0.28 * size
    return Text(tenth(at[0] + away[0]), tenth(y), text, size, anchor, color, bold)


def _holds(box: Box, point: Point) -> bool:
    return box.left < point[0] < box.right and box.top < point[1] < box.bottom
