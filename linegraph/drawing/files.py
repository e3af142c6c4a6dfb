"""From a derivation to the content of a file, by its ending."""

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
    """Refuse a file of another kind, before anything is derived.

    Raises:
        LinegraphError: names the three that can be written.
    """
    if output is not None and _ending(output) not in ENDINGS:
        raise LinegraphError(f"cannot draw to {output}: the name must end in .svg, .png or .dot")


def _ending(output: str) -> str:
    """The ending of a file's name; of a device or a pipe that has none, as of standard output, SVG's."""
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
    """The content of a file called `output`; SVG where there is no name.

    Args:
        derivation: a derived model.
        output: the file's name, whose ending says what it is.
        what: "graph", "sketch" or "both".
        subspaces: those to draw; all if none are given.
        hold: coordinates of the sketch that keep the value given, by name.

    Raises:
        LinegraphError: it cannot be drawn, or what is asked for contradicts itself.
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
    """Write a file whole, or not at all; into a device or a pipe as it is."""
    return write_file(output, content)
