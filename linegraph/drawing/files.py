"""From a derivation to the content of a picture file, by its ending."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from linegraph.drawing.dot import dot_text
from linegraph.drawing.mechanism import mechanism_scene
from linegraph.drawing.pictures import graph_scene, whole_scene
from linegraph.drawing.png import png_bytes
from linegraph.drawing.svg import svg_text
from linegraph.errors import LinegraphError
from linegraph.files import is_stream, write_file

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.numeric.derived import Derived

ENDINGS = (".svg", ".png", ".dot")


def require_ending(output: str | None) -> None:
    """Refuse an unknown ending before anything is derived.

    Raises:
        LinegraphError: the ending is not one of `ENDINGS`.
    """
    if output is not None and _ending(output) not in ENDINGS:
        raise LinegraphError(f"cannot draw to {output}: the name must end in .svg, .png or .dot")


def _ending(output: str) -> str:
    """Ending of a file name; that of SVG for a device or pipe without one."""
    ending = Path(output).suffix.lower()
    return ".svg" if ending not in ENDINGS and is_stream(output) else ending


def picture(
    derivation: Derived,
    output: str | None = None,
    *,
    what: str = "graph",
    subspaces: Sequence[str] = (),
    hold: Mapping[str, float] | None = None,
) -> str | bytes:
    """Draw the content of a picture file.

    Args:
        derivation: a derived model.
        output: name of the file, whose ending decides the format; SVG if left out.
        what: "graph", "sketch" or "both".
        subspaces: names of the subspaces to draw; all if empty.
        hold: values (rad or m) of coordinates of the sketch, by name.

    Returns:
        Text for SVG and DOT, bytes for PNG.

    Raises:
        LinegraphError: it cannot be drawn, or arguments contradict each other.
    """
    require_ending(output)
    ending = ".svg" if output is None else _ending(output)
    if what == "graph" and hold:
        raise LinegraphError("--set places the mechanism: add --what sketch or --what both")
    if what == "sketch" and subspaces:
        raise LinegraphError("--subspace is of the graph: leave it out, or draw --what both")
    if ending == ".dot":
        if what != "graph":
            raise LinegraphError(
                "a .dot file holds the graph alone: write the sketch as .svg or .png"
            )
        return dot_text(derivation, subspaces or None)
    if what == "sketch":
        scene = mechanism_scene(derivation, hold=hold)
    elif what == "both":
        scene = whole_scene(derivation, subspaces or None, hold=hold)
    else:
        scene = graph_scene(derivation, subspaces or None)
    return png_bytes(scene) if ending == ".png" else svg_text(scene)


def write(output: str, content: str | bytes) -> Path:
    """Write a file, completely or not at all; a device or pipe is written into.

    Args:
        output: the file.
        content: its content.
    """
    return write_file(output, content)
