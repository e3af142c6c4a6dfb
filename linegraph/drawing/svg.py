"""A scene as SVG: without fonts, scripts, ids and external files; the same bytes each time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.drawing.letters import clean, is_common, width
from linegraph.drawing.scene import PAPER, Disc, Item, Part, Pen, Region, Scene, Stroke, Text

if TYPE_CHECKING:
    from collections.abc import Iterator

FONT = "DejaVu Sans,Verdana,Helvetica,Arial,sans-serif"


def svg_text(scene: Scene) -> str:
    """Write a scene as an SVG element, which is a complete file and may be embedded in HTML.

    Background and colours are fixed, so it looks the same on a dark page.
    """
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{scene.width}" height="{scene.height}" '
        f'viewBox="0 0 {scene.width} {scene.height}" role="img" font-family="{FONT}" '
        'style="max-width:100%;height:auto" fill="none" stroke-linejoin="round" '
        'text-rendering="geometricPrecision">'
    )
    paper = f'<rect width="{scene.width}" height="{scene.height}" fill="{PAPER}"/>'
    lines = [head, f"<title>{escaped(scene.title)}</title>", f"<desc>{escaped(scene.about)}</desc>"]
    return "\n".join([*lines, paper, *_written(scene.items), "</svg>"]) + "\n"


def escaped(text: str) -> str:
    """Escape text for XML, in content and in attributes."""
    for sign, entity in (("&", "amp"), ("<", "lt"), (">", "gt"), ('"', "quot"), ("'", "#39")):
        text = text.replace(sign, f"&{entity};")
    return clean(text)


def number(x: float) -> str:
    """A number rounded to a tenth, without trailing zero.

    Example:
        >>> number(12.0), number(0.25), number(-0.04)
        ('12', '0.3', '0')
    """
    tenths = int(abs(x) * 10 + 0.5001)
    sign = "-" if x < 0 and tenths else ""
    whole, rest = divmod(tenths, 10)
    return f"{sign}{whole}.{rest}" if rest else f"{sign}{whole}"


def _written(items: tuple[Item, ...]) -> Iterator[str]:
    for item in items:
        if isinstance(item, Part):
            yield f'<g class="lg-{escaped(item.kind)}">'
            about = f" ({item.about})" if item.about else ""
            yield f"<title>{escaped(item.name + about)}</title>"
            yield from _written(item.items)
            yield "</g>"
        elif isinstance(item, Stroke):
            yield _stroke(item)
        elif isinstance(item, Disc):
            place = f'cx="{number(item.x)}" cy="{number(item.y)}" r="{number(item.radius)}"'
            yield f"<circle {place}{_paint(item.pen, item.fill)}/>"
        elif isinstance(item, Region):
            yield _region(item)
        else:
            yield _text(item)


def _stroke(item: Stroke) -> str:
    path = [f"M{_point(item.start)}"]
    for step in item.steps:
        path.append(("L" if len(step) == 1 else "C") + " ".join(map(_point, step)))
    closing = "Z" if item.closed else ""
    return f'<path d="{"".join(path)}{closing}"{_paint(item.pen, item.fill)}/>'


def _point(point: tuple[float, float]) -> str:
    return f"{number(point[0])},{number(point[1])}"


def _region(item: Region) -> str:
    place = f'x="{number(item.x)}" y="{number(item.y)}"'
    size = f'width="{number(item.width)}" height="{number(item.height)}"'
    corner = f' rx="{number(item.radius)}"' if item.radius else ""
    return f"<rect {place} {size}{corner}{_paint(item.pen, item.fill)}/>"


def _paint(pen: Pen | None, fill: str) -> str:
    paint = f' fill="{fill}"' if fill else ""
    if pen is not None:
        paint += f' stroke="{pen.color}" stroke-width="{number(pen.width)}"'
        if pen.dash:
            paint += f' stroke-dasharray="{" ".join(map(number, pen.dash))}"'
    return paint


def _text(item: Text) -> str:
    place = f'x="{number(item.x)}" y="{number(item.y)}"'
    style = f' font-size="{item.size}" fill="{item.color}"'
    if item.anchor != "start":
        style += f' text-anchor="{item.anchor}"'
    if item.bold:
        style += ' font-weight="bold"'
    if item.slanted:
        style += ' font-style="italic"'
    if not is_common(item.text):
        # Widths of uncommon letters depend on the font; textLength enforces the width used in the layout.
        wide = width(item.text, item.size, bold=item.bold)
        style += f' textLength="{wide}" lengthAdjust="spacingAndGlyphs"'
    return f"<text {place}{style}>{escaped(item.text)}</text>"
