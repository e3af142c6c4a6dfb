"""Line breaks in equations, before + and - where the fewest brackets are open."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from linegraph.notation.plain import Plain
from linegraph.notation.writing import pieces, solid

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.notation.tree import Math
    from linegraph.notation.writing import Writer


_SUBSCRIPTS = re.compile(r"_[\w/.]+")


def typeset(text: str) -> int:
    """Width of plain text in characters, with subscripts counted as narrower."""
    small = sum(len(found) for found in _SUBSCRIPTS.findall(text))
    return len(text) - small // 4


def broken(
    tree: Math,
    writer: Writer,
    width: int,
    first: int = 0,
    measure: Callable[[str], int] = len,
) -> list[str]:
    """Break a formula into lines.

    Args:
        tree: the formula.
        writer: writes it in the format of the report.
        width: characters of plain text per line.
        first: characters already used in the first line.
        measure: returns the width of plain text.

    Returns:
        The lines, in the format of the writer.
    """
    text, plain = pieces(writer.marked(tree)), pieces(Plain().marked(tree))
    if len(text) != len(plain):
        return [solid(writer.marked(tree))]
    sizes = [measure(piece) for _, piece in plain]
    lines: list[str] = []
    start, room = 0, width - first
    while start < len(text):
        end = _end(text, sizes, start, room)
        lines.append("".join(piece for _, piece in text[start:end]).strip())
        start, room = end, width
    return lines


def _end(text: list[tuple[int, str]], sizes: list[int], start: int, room: int) -> int:
    """End of a line: as late as possible, but outside brackets if the line is half full there."""
    total, last = 0, start
    while last < len(text) and (last == start or total + sizes[last] <= room):
        total += sizes[last]
        last += 1
    if last == len(text):
        return last
    best, filled = last, 0
    for k in range(start, last):
        filled += sizes[k]
        if 2 * filled >= room and k + 1 <= last and text[k + 1][0] <= text[best][0]:
            best = k + 1
    return best
