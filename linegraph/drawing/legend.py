"""The legend of a picture of a graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.drawing.bodies import ARM, ground_sign, quartered
from linegraph.drawing.letters import width
from linegraph.drawing.looks import CHORD_PEN, PLAIN, pen_of
from linegraph.drawing.scene import (
    GREY,
    INK,
    SMALL,
    Disc,
    Item,
    Part,
    Text,
    arrow_head,
    line,
    moved,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

Entry = tuple[tuple[Item, ...], str]
SAMPLE, LINE, APART = 50, 16, 18


def edge_entries(kinds: Sequence[tuple[str, bool]], treed: bool) -> list[Entry]:
    """Samples of the kinds of edges in a picture.

    Args:
        kinds: each kind that occurs, and whether as a branch.
        treed: whether a tree is shown.
    """
    if not treed:
        return [(_sample(PLAIN, False), "edge")]
    entries = [
        (_sample(PLAIN, True), "branch: edge of the tree"),
        (_sample(PLAIN, False), "chord"),
    ]
    others = dict.fromkeys(kind for kind, _ in kinds if kind != PLAIN)
    return entries + [(_sample(kind, (kind, False) not in kinds), kind) for kind in others]


def body_entries() -> list[Entry]:
    """Samples of the symbols inside a body."""
    pen = CHORD_PEN
    inertia = (line((36, 0), (10, 0), pen=pen), arrow_head((9, 0), (-1, 0), pen.color))
    return [
        ((*inertia, *ground_sign(36, 0)), "inertia edge BODY/inertia, from ground"),
        (quartered(23, 0, 5), "mass centre"),
        ((Disc(23, 0, 3.2, None, INK),), "frame; without a name the body's own"),
        ((line((4, 0), (42, 0), pen=ARM),), "rigid arm BODY/arm, a branch"),
    ]


def _sample(kind: str, bold: bool) -> tuple[Item, ...]:
    pen = pen_of(kind, bold)
    return (
        line((2, 0), (44, 0), pen=pen),
        arrow_head((36, 0), (1, 0), pen.color, 8 if bold else 7),
    )


def legend(entries: Sequence[Entry], widest: int) -> tuple[tuple[Item, ...], int, int]:
    """Arrange entries in columns.

    Args:
        entries: samples with their meanings.
        widest: largest width.

    Returns:
        The items, their width and their height.
    """
    column = SAMPLE + APART + max(width(text, SMALL) for _, text in entries)
    columns = max(1, min(len(entries), (widest + APART) // column))
    rows = -(-len(entries) // columns)
    items: list[Item] = []
    for k, (sample, text) in enumerate(entries):
        x, y = k // rows * column, k % rows * LINE + LINE // 2
        items += [*moved(sample, x, y), Text(x + SAMPLE, y + 3.5, text, SMALL, color=GREY)]
    used = -(-len(entries) // rows)
    return (Part("legend", "legend", tuple(items)),), used * column - APART, rows * LINE
