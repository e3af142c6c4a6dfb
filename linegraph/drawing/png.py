"""A scene as PNG, by matplotlib with its own fonts: the same bytes for the same version of it."""

from __future__ import annotations

import io
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from linegraph.drawing.letters import clean
from linegraph.drawing.scene import PAPER, Disc, Pen, Region, Scene, Stroke, Text, flat
from linegraph.errors import LinegraphError

if TYPE_CHECKING:
    from collections.abc import Iterator

SCALE, MOST_PIXELS = 2, 12000
"""Pixels per unit, and the longest side in pixels; larger pictures have fewer pixels per unit."""

POINTS = 72
ANCHORS: dict[str, Literal["left", "center", "right"]] = {
    "start": "left",
    "middle": "center",
    "end": "right",
}


def png_bytes(scene: Scene) -> bytes:
    """Write a scene as the bytes of a PNG file.

    Raises:
        LinegraphError: matplotlib is not installed.
    """
    try:
        import matplotlib
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise LinegraphError(
            'PNG needs matplotlib; install it with: pip install "linegraph-dynamics[plot]", or write SVG'
        ) from None
    scale = min(SCALE, MOST_PIXELS / max(scene.width, scene.height))
    with matplotlib.rc_context(), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # letters that the font does not have
        # Settings of the user must not change the picture.
        matplotlib.rcdefaults()
        size = (scene.width / POINTS, scene.height / POINTS)
        figure = Figure(figsize=size, dpi=scale * POINTS, facecolor=PAPER)
        canvas = FigureCanvasAgg(figure)
        axes = figure.add_axes((0, 0, 1, 1))
        axes.set_xlim(0, scene.width)
        axes.set_ylim(scene.height, 0)
        axes.axis("off")
        for place, artist in enumerate(_artists(scene, _fonts(matplotlib))):
            artist.set_zorder(place)
            axes.add_artist(artist)
        file = io.BytesIO()
        # The version of matplotlib is left out of the file, so that equal pictures have equal bytes.
        canvas.print_png(file, metadata={"Software": None})  # type: ignore[no-untyped-call]
    return file.getvalue()


def _fonts(matplotlib: Any) -> dict[tuple[bool, bool], Path]:
    """Files of DejaVu Sans, by bold and slanted."""
    folder = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
    return {
        (bold, slanted): folder
        / f"DejaVuSans{'-' * (bold or slanted)}{'Bold' * bold}{'Oblique' * slanted}.ttf"
        for bold in (False, True)
        for slanted in (False, True)
    }


def _artists(scene: Scene, fonts: dict[tuple[bool, bool], Path]) -> Iterator[Any]:
    """The artists of matplotlib, in order of drawing."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.patches import Circle, FancyBboxPatch, PathPatch
    from matplotlib.text import Text as Words

    for item in flat(scene.items):
        if isinstance(item, Text):
            font = FontProperties(fname=str(fonts[(item.bold, item.slanted)]), size=item.size)
            yield Words(
                item.x,
                item.y,
                clean(item.text),
                color=item.color,
                fontproperties=font,
                horizontalalignment=ANCHORS[item.anchor],
                verticalalignment="baseline",
                parse_math=False,
            )
        elif isinstance(item, Stroke):
            yield PathPatch(_path(item), **_paint(item.pen, item.fill))
        elif isinstance(item, Disc):
            yield Circle((item.x, item.y), item.radius, **_paint(item.pen, item.fill))
        elif isinstance(item, Region):
            corner = f"round,pad=0,rounding_size={item.radius}"
            place = ((item.x, item.y), item.width, item.height)
            yield FancyBboxPatch(*place, boxstyle=corner, **_paint(item.pen, item.fill))


def _path(item: Stroke) -> Any:
    from matplotlib.path import Path as Outline

    points, codes = [item.start], [Outline.MOVETO]
    for step in item.steps:
        points += step
        codes += [Outline.LINETO] if len(step) == 1 else [Outline.CURVE4] * 3
    if item.closed:
        points.append(item.start)
        codes.append(Outline.CLOSEPOLY)
    return Outline(points, codes)


def _paint(pen: Pen | None, fill: str) -> dict[str, Any]:
    """Style of line and area; a unit of the picture is a point."""
    paint: dict[str, Any] = {"facecolor": fill or "none", "edgecolor": "none", "linewidth": 0}
    if pen is not None:
        paint |= {"edgecolor": pen.color, "linewidth": pen.width, "capstyle": "butt"}
        if pen.dash:
            paint["linestyle"] = (0, [x / pen.width for x in pen.dash])
    return paint
