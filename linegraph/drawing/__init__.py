"""Pictures: the system graph as in textbooks, and a sketch of the mechanism.

    Derivation ─→ Scene ─→ SVG, PNG          Derivation ─→ DOT

Scenes are laid out with integers and fixed widths of letters, so that a model gives the same bytes
everywhere.
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
