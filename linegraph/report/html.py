"""A report as one HTML file with MathML, SVG and style sheet; without scripts and external files.

Browsers break no lines inside a ``math`` element. A long formula is therefore a sequence of elements, one
for each summand, and wraps like words on screen and paper.
"""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

from linegraph.drawing.svg import svg_text
from linegraph.notation.mathml import MathMl
from linegraph.notation.plain import Plain
from linegraph.notation.writing import pieces, visible
from linegraph.report.document import (
    Block,
    CellTable,
    Code,
    Document,
    EquationRow,
    Formulas,
    IntermediateList,
    Matrix,
    Paragraph,
    Picture,
    Section,
    Text,
)
from linegraph.report.style import STYLE
from linegraph.report.text import visible_words

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from linegraph.graph.multigraph import IntegerMatrix
    from linegraph.notation.tree import Math

MOST_COLUMNS = 28
MANY = 12
"""Least number of short formulas that are set in columns."""

SHORT = 44
"""Formulas of at most this many characters are not broken."""


def render(document: Document) -> str:
    """Write a report as an HTML file."""
    body = [f"<h1>{shown(document.title)}</h1>"]
    if document.about:
        body.append(f'<p class="about">{shown(document.about)}</p>')
    body.append(_contents(document))
    for k, section in enumerate(document.sections, 1):
        body += _section(section, 2, str(k))
    return "\n".join([
        "<!DOCTYPE html>",
        '<html lang="en" xmlns="http://www.w3.org/1999/xhtml">',
        "<head>",
        '<meta charset="utf-8"/>',
        '<meta name="viewport" content="width=device-width, initial-scale=1"/>',
        f"<title>{shown(document.title)}</title>",
        f"<style>{STYLE}</style>",
        "</head>",
        "<body>",
        "<main>",
        *body,
        *([f"<footer>{shown(document.source)}</footer>"] if document.source else []),
        "</main>",
        "</body>",
        "</html>",
        "",
    ])  # fmt: skip


def shown(text: str) -> str:
    """Escape any text for use as words."""
    return escape(visible(text))


def _contents(document: Document) -> str:
    lines = []
    for k, section in enumerate(document.sections, 1):
        inner = [b for b in section.blocks if isinstance(b, Section)]
        below = "".join(
            f'<li><a href="#s{k}.{j}">{shown(b.title)}</a></li>' for j, b in enumerate(inner, 1)
        )
        below = f"<ul>{below}</ul>" if below else ""
        lines.append(f'<li><a href="#s{k}">{shown(section.title)}</a>{below}</li>')
    return f"<nav><ol>{''.join(lines)}</ol></nav>"


def _section(section: Section, depth: int, number: str) -> Iterator[str]:
    title = section.title[:1].upper() + section.title[1:]
    mark = f'<span class="n">{number}</span> ' if depth < 4 else ""
    yield "<section>"
    yield f'<h{depth} id="s{number}">{mark}{shown(title)}</h{depth}>'
    below = 0
    for block in section.blocks:
        if isinstance(block, Section):
            below += 1
            yield from _section(block, min(depth + 1, 6), f"{number}.{below}")
        else:
            yield from _block(block)
    yield "</section>"


def _block(block: Block) -> Iterator[str]:
    match block:
        case Paragraph(text):
            yield f"<p>{said(text)}</p>"
        case CellTable(head, rows):
            yield from _table(head, rows)
        case Matrix():
            yield from _matrix(block.matrix)
        case Formulas(rows):
            yield from _formulas(rows)
        case IntermediateList(groups):
            yield '<div class="listing">'
            for group in groups:
                yield f'<p class="label">{shown(group.label)}</p>'
                yield from _formulas(group.rows)
            yield "</div>"
        case Picture(scene, about):
            caption = f"<figcaption>{shown(about)}</figcaption>"
            yield f"<figure>{svg_text(scene).strip()}{caption}</figure>"


def said(text: Text) -> str:
    """Write words, names and formulas of one line."""
    return "".join(_inline(part) for part in text)


def _inline(part: object) -> str:
    if isinstance(part, str):
        return escape(visible_words(part))
    if isinstance(part, Code):
        return f"<{part.tag}>{breakable(part.text)}</{part.tag}>"
    return _running(part)  # type: ignore[arg-type]


def breakable(text: str) -> str:
    """Escape a name, with possible line breaks after slashes, dots and underscores."""
    found = shown(text)
    for stop in ("/", ".", "_"):
        found = found.replace(stop, f"{stop}<wbr/>")
    return found


def _running(tree: Math) -> str:
    """A formula in running text, in pieces if it is long."""
    return "<wbr/>".join(f"<math>{piece}</math>" for piece in _pieces(tree))


def _pieces(tree: Math) -> list[str]:
    text = MathMl().marked(tree)
    if len(Plain()(tree)) <= SHORT:
        return [MathMl()(tree)]
    return [piece for _, piece in pieces(text)]


def _formulas(rows: Sequence[EquationRow]) -> Iterator[str]:
    longest = max((len(Plain()(row.left)) + len(Plain()(row.right)) for row in rows), default=0)
    columns = len(rows) >= MANY and longest <= SHORT
    yield f'<div class="eqs{" many" * columns}">'
    for row in rows:
        sign = f'<mo form="infix">{escape(row.sign)}</mo>'
        *before, last = _pieces(row.left)
        first, *others = _pieces(row.right)
        together = [*before, f"{last}{sign}{first}", *others]
        yield f"<p>{'<wbr/>'.join(f'<math>{piece}</math>' for piece in together)}</p>"
    yield "</div>"


def _table(head: Sequence[str], rows: Sequence[Sequence[Text]]) -> Iterator[str]:
    yield '<div class="wide"><table>'
    yield f"<thead><tr>{''.join(f'<th>{shown(cell)}</th>' for cell in head)}</tr></thead><tbody>"
    for row in rows:
        yield f"<tr>{''.join(f'<td>{said(cell)}</td>' for cell in row)}</tr>"
    yield "</tbody></table></div>"


def _matrix(matrix: IntegerMatrix) -> Iterator[str]:
    """A matrix with upright names of columns; wide ones row by row."""
    if not matrix.rows or not matrix.columns:
        yield "<p>(empty)</p>"
        return
    if len(matrix.columns) > MOST_COLUMNS:
        yield '<div class="sums">'
        for name, entries in zip(matrix.rows, matrix.entries, strict=True):
            terms = (
                f"{'+' if value > 0 else '−'}&#160;<code>{breakable(matrix.columns[j])}</code>"
                for j, value in sorted(entries.items())
            )
            yield f"<p><code>{breakable(name)}</code>: {' '.join(terms) or '0'}</p>"
        yield "</div>"
        return
    names = "".join(f"<th><span>{shown(name)}</span></th>" for name in matrix.columns)
    yield f'<div class="wide"><table class="matrix"><thead><tr><td></td>{names}</tr></thead><tbody>'
    for name, row in zip(matrix.rows, matrix, strict=True):
        cells = "".join(f"<td>{_entry(value)}</td>" for value in row)
        yield f"<tr><th>{shown(name)}</th>{cells}</tr>"
    yield "</tbody></table></div>"


def _entry(value: int) -> str:
    return "·" if not value else f"{'+' if value > 0 else '−'}{abs(value)}"
