"""The packages and how they stand on each other, drawn from their imports: docs/packages.svg.

python tests/house/picture.py
"""

from __future__ import annotations

import sys
from pathlib import Path

import networkx as nx

sys.path[:0] = [str(Path(__file__).parents[1]), str(Path(__file__).parents[2])]

from house.rooms import ROOMS, ROOT, between_rooms, files, room  # noqa: E402

from linegraph.drawing.scene import (  # noqa: E402
    BRANCH,
    EDGE_OF_TINT,
    GREY,
    PAPER,
    SMALL,
    TINT,
    Item,
    Part,
    Pen,
    Region,
    Scene,
    Stroke,
    Text,
)
from linegraph.drawing.svg import svg_text  # noqa: E402

FILE = ROOT / "docs" / "packages.svg"
WIDTH, HEIGHT, GAP, STEP, MARGIN = 104, 30, 14, 62, 16


GROUND = ("errors", "version", "exits", "tolerance", "display", "files")
"""Modules that all may use: they stand at the bottom, without arrows."""


def arrows() -> nx.DiGraph:
    """Which package imports which, arrows left out that follow from others."""
    pairs = ((room(x.source), room(x.target)) for x in between_rooms())
    return nx.transitive_reduction(nx.DiGraph(pair for pair in pairs if not {*pair} & {*GROUND}))


def floors(graph: nx.DiGraph) -> list[list[str]]:
    """Packages from the ground up, each above all that it imports and near what it stands on."""
    level: dict[str, int] = {}
    for name in reversed(list(nx.topological_sort(graph))):
        level[name] = max((level[below] + 1 for below in graph.successors(name)), default=0)
    found = [[n for n in ROOMS if level.get(n) == k] for k in range(max(level.values()) + 1)]
    place: dict[str, float] = {}
    for floor in found:
        wanted = {
            n: sum(x) / len(x) if (x := [place[b] for b in graph.successors(n)]) else 0.0
            for n in floor
        }
        floor.sort(key=lambda n: (wanted[n], ROOMS.index(n)))
        for k, name in enumerate(floor):
            place[name] = k - (len(floor) - 1) / 2
    return [list(GROUND), *found]


def scene() -> Scene:
    """The picture: the ground at the bottom, an arrow's target always below its source."""
    graph = arrows()
    stack = floors(graph)
    widest = max(map(len, stack))
    width = 2 * MARGIN + widest * (WIDTH + GAP) - GAP
    height = 2 * MARGIN + (len(stack) - 1) * STEP + HEIGHT
    at = {}
    for k, floor in enumerate(stack):
        left = (width - len(floor) * (WIDTH + GAP) + GAP) / 2
        for j, name in enumerate(floor):
            at[name] = (left + j * (WIDTH + GAP), height - MARGIN - HEIGHT - k * STEP)
    lines = [_line(at[a], at[b], f"{a} imports {b}") for a, b in sorted(graph.edges)]
    boxes = [_box(*at[name], name) for floor in stack for name in floor]
    about = (
        "Each package stands above those it imports; arrows that follow from others are left out."
    )
    return Scene(int(width), int(height), "Packages of linegraph", about, (*lines, *boxes))


def _line(above: tuple[float, float], below: tuple[float, float], name: str) -> Item:
    start = (above[0] + WIDTH / 2, above[1] + HEIGHT)
    end = (below[0] + WIDTH / 2, below[1])
    middle = (start[1] + end[1]) / 2
    curve = ((start[0], middle), (end[0], middle), end)
    return Part("arrow", name, (Stroke(start, (curve,), Pen(EDGE_OF_TINT, 1.2)),))


def _box(x: float, y: float, name: str) -> Item:
    count = sum(room(module) == name for module in files())
    whole = count > 1 or name == "codegen"
    items: list[Item] = [
        Region(x, y, WIDTH, HEIGHT, 5, Pen(BRANCH if whole else GREY), TINT if whole else PAPER),
        Text(x + WIDTH / 2, y + 14, name, anchor="middle", bold=whole),
        Text(
            x + WIDTH / 2, y + 25, f"{count} files" if whole else "one file", SMALL, "middle", GREY
        ),
    ]
    return Part("package", name, tuple(items))


if __name__ == "__main__":
    FILE.write_text(svg_text(scene()), encoding="utf-8")
