"""What the tests of pictures share: examples by name, boxes of what must stay clear."""

from __future__ import annotations

import hashlib
from functools import cache
from itertools import combinations, pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from linegraph import Derivation, derive
from linegraph.drawing.dot import dot_text
from linegraph.drawing.pictures import graph_scene, whole_scene
from linegraph.drawing.scene import Box, Disc, Stroke, flat
from linegraph.drawing.svg import svg_text
from linegraph.readers import modelfile, urdf

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linegraph.drawing.scene import Point, Scene

EXAMPLES = Path(__file__).parents[2] / "examples"
FILES = {
    path.stem: path for kind in ("toml", "urdf") for path in sorted(EXAMPLES.glob(f"*/*.{kind}"))
}


@cache
def example(name: str) -> Derivation:
    """An example derived; ANYmal floats."""
    path = FILES[name]
    if path.suffix == ".urdf":
        base = "floating" if name == "anymal" else "fixed"
        return derive(urdf.read(str(path), base=base))
    return derive(modelfile.read(str(path)))


@cache
def picture(name: str) -> Scene:
    """The picture of an example's graph."""
    return graph_scene(example(name))


def digests() -> str:
    """Of pictures of several examples, to be compared with those of another process."""
    found = []
    for name in ("andrews_squeezer", "stewart_platform", "arm_with_drives", "panda"):
        text = svg_text(whole_scene(example(name))) + dot_text(example(name))
        found.append(hashlib.sha256(text.encode()).hexdigest())
    return " ".join(found)


def overlaps(scene: Scene) -> list[tuple[str, str]]:
    """Pairs of texts whose boxes meet."""
    texts = list(scene.texts())
    return [(a.text, b.text) for a, b in combinations(texts, 2) if a.box.meets(b.box)]


def outside(scene: Scene) -> list[str]:
    """Texts that leave the canvas."""
    return [
        text.text
        for text in scene.texts()
        if text.box.left < 0
        or text.box.top < 0
        or text.box.right > scene.width
        or text.box.bottom > scene.height
    ]


def covered(scene: Scene) -> list[str]:
    """Texts over the dot of a vertex."""
    dots = [
        Box(item.x - item.radius, item.y - item.radius, item.x + item.radius, item.y + item.radius)
        for part in scene.parts()
        if part.kind == "vertex"
        for item in flat(part.items)
        if isinstance(item, Disc)
    ]
    return [text.text for text in scene.texts() for dot in dots if text.box.meets(dot)]


def crossed(scene: Scene) -> set[tuple[str, str]]:
    """Edges that run through a text."""
    boxes = [(text.text, text.box) for text in scene.texts()]
    return {
        (part.name, text)
        for part in scene.parts()
        if part.kind in ("branch", "chord", "edge", "arm")
        for item in flat(part.items)
        if isinstance(item, Stroke)
        for x, y in along(item)
        for text, box in boxes
        if box.left + 0.5 < x < box.right - 0.5 and box.top + 0.5 < y < box.bottom - 0.5
    }


def along(stroke: Stroke) -> Iterator[Point]:
    """Points along a line, close enough together to meet every text."""
    start = stroke.start
    for step in stroke.steps:
        corners = [start, *step]
        reach = max(abs(a - b) for p in corners for a, b in zip(p, start, strict=True))
        count = 2 + int(reach / 4)
        for k in range(count + 1):
            yield _between(corners, k / count)
        start = step[-1]


def _between(corners: list[Point], t: float) -> Point:
    """De Casteljau's construction."""
    while len(corners) > 1:
        pairs = pairwise(corners)
        corners = [((1 - t) * a[0] + t * b[0], (1 - t) * a[1] + t * b[1]) for a, b in pairs]
    return corners[0]
