"""A scene as a LaTeX ``picture``: text set by LaTeX, lines as operators of PDF.

It needs the package ``color`` and the commands of `PREAMBLE`. Where LaTeX writes no PDF, only the text
appears.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.drawing.scene import Disc, Item, Part, Pen, Region, Scene, Stroke, Text
from linegraph.drawing.svg import number
from linegraph.notation.latex import escaped

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linegraph.drawing.scene import Point

PREAMBLE = r"""\ifdefined\pdfextension % LuaTeX
  \newcommand{\drawn}[1]{\pdfextension literal{q #1 Q}}
\else\ifdefined\pdfliteral
  \newcommand{\drawn}[1]{\ifnum\pdfoutput>0 \pdfliteral{q #1 Q}\fi}
\else\ifdefined\XeTeXversion
  \newcommand{\drawn}[1]{\special{pdf:content #1}}
\else
  \newcommand{\drawn}[1]{}
\fi\fi\fi
\newcommand{\lettering}[2]{\fontsize{#1}{#1}\selectfont\sffamily\color[rgb]{#2}}
"""
"""Definitions for the head of the document."""

ROUND = 0.5523
"""Distance of the control points of a quarter circle, relative to the radius."""


def picture(scene: Scene, width: float, height: float, largest: float = 0.75) -> str:
    r"""Write a scene as a picture that fits into a given space.

    Args:
        scene: the scene.
        width: width of the space, in points.
        height: height of the space, in points.
        largest: largest number of points per unit of the scene.

    Example:
        >>> from linegraph.drawing.scene import Scene, Text
        >>> print(picture(Scene(40, 20, "", "", (Text(4, 12, "a_1"),)), 100, 100))
        {\setlength{\unitlength}{0.75pt}%
        \begin{picture}(40,20)
        \put(4,8){\makebox(0,0)[bl]{\lettering{9}{0.106,0.106,0.106}a\_1}}
        \end{picture}}
    """
    scale = min(largest, width / scene.width, height / scene.height)
    lines = [
        rf"{{\setlength{{\unitlength}}{{{decimal(scale)}pt}}%",
        rf"\begin{{picture}}({scene.width},{scene.height})",
        *_written(scene.items, scene.height, scale),
        r"\end{picture}}",
    ]
    return "\n".join(lines)


def decimal(x: float) -> str:
    """A number with three decimals, without trailing zeros."""
    return f"{x:.3f}".rstrip("0").rstrip(".")


def color(hexadecimal: str, sign: str = " ") -> str:
    """Red, green and blue of a colour, each from 0 to 1.

    Args:
        hexadecimal: the colour as ``#rrggbb``.
        sign: separator.
    """
    return sign.join(decimal(int(hexadecimal[k : k + 2], 16) / 255) for k in (1, 3, 5))


def _written(items: tuple[Item, ...], height: int, scale: float) -> Iterator[str]:
    """Write items, consecutive lines as one object."""
    # A point of PDF is 1/72 in, one of TeX 1/72.27 in.
    pdf = scale * 72 / 72.27
    steps: list[str] = []
    for item in _flat(items):
        if isinstance(item, Text):
            yield from _drawn(steps, height, pdf)
            yield _text(item, height, scale)
            steps = []
        else:
            steps.append(_shape(item))
    yield from _drawn(steps, height, pdf)


def _flat(items: tuple[Item, ...]) -> Iterator[Stroke | Disc | Region | Text]:
    for item in items:
        if isinstance(item, Part):
            yield from _flat(item.items)
        else:
            yield item


def _drawn(steps: list[str], height: int, pdf: float) -> Iterator[str]:
    if steps:
        yield rf"\put(0,{height}){{\drawn{{1 j {decimal(pdf)} 0 0 {decimal(-pdf)} 0 0 cm"
        yield from steps
        yield "}}"


def _text(item: Text, height: int, scale: float) -> str:
    style = rf"\lettering{{{decimal(item.size * scale)}}}{{{color(item.color, ',')}}}"
    style += r"\bfseries" * item.bold + r"\itshape" * item.slanted
    place = f"{number(item.x)},{number(height - item.y)}"
    anchor = {"start": "bl", "middle": "b", "end": "br"}[item.anchor]
    gap = " " if item.bold or item.slanted else ""
    return rf"\put({place}){{\makebox(0,0)[{anchor}]{{{style}{gap}{escaped(item.text)}}}}}"


def _shape(item: Stroke | Disc | Region) -> str:
    if isinstance(item, Stroke):
        path = [f"{_at(item.start)} m"]
        for step in item.steps:
            path.append(f"{' '.join(map(_at, step))} {'l' if len(step) == 1 else 'c'}")
        path += ["h"] * item.closed
        return " ".join([*_paint(item.pen, item.fill), *path, _operator(item.pen, item.fill)])
    if isinstance(item, Disc):
        r = item.radius
        path = _rounded(item.x - r, item.y - r, 2 * r, 2 * r, r)
    else:
        path = _rounded(item.x, item.y, item.width, item.height, item.radius)
    return " ".join([*_paint(item.pen, item.fill), *path, _operator(item.pen, item.fill)])


def _rounded(x: float, y: float, width: float, height: float, radius: float) -> list[str]:
    """The path of a rectangle with round corners."""
    right, low = x + width, y + height
    if not radius:
        return [f"{_at((x, y))} {number(width)} {number(height)} re"]
    k = radius * (1 - ROUND)
    corners = (
        ((right - radius, y), (right - k, y), (right, y + k), (right, y + radius)),
        ((right, low - radius), (right, low - k), (right - k, low), (right - radius, low)),
        ((x + radius, low), (x + k, low), (x, low - k), (x, low - radius)),
        ((x, y + radius), (x, y + k), (x + k, y), (x + radius, y)),
    )
    path = [f"{_at(corners[0][0])} m"]
    for k_, (start, *curve) in enumerate(corners):
        path += [f"{_at(start)} l"] * bool(k_)
        path.append(f"{' '.join(map(_at, curve))} c")
    return [*path, "h"]


def _at(point: Point) -> str:
    return f"{number(point[0])} {number(point[1])}"


def _paint(pen: Pen | None, fill: str) -> Iterator[str]:
    if fill:
        yield f"{color(fill)} rg"
    if pen is not None:
        yield f"{color(pen.color)} RG {number(pen.width)} w"
        yield f"[{' '.join(map(number, pen.dash))}] 0 d"


def _operator(pen: Pen | None, fill: str) -> str:
    if pen is None:
        return "f" if fill else "n"
    return "B" if fill else "S"


__all__ = ["PREAMBLE", "picture"]
