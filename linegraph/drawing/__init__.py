"""Pictures: the system graph as papers draw it, the mechanism as engineers sketch it.

    Derivation ─→ Scene ─→ SVG, PNG          Derivation ─→ DOT

A scene is laid out in whole units by rules of its own, so that the same model gives the same bytes.
"""

from linegraph.drawing.dot import dot_text
from linegraph.drawing.mechanism import mechanism_svg
from linegraph.drawing.pictures import graph_svg, whole_scene
from linegraph.drawing.png import png_bytes
from linegraph.drawing.scene import Scene
from linegraph.drawing.svg import svg_text

__all__ = [
    "Scene",
    "dot_text",
    "graph_svg",
    "mechanism_svg",
    "png_bytes",
    "svg_text",
    "whole_scene",
]
