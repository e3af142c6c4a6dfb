"""A report as plain text for a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.notation.plain import Plain
from linegraph.notation.writing import visible
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
from linegraph.report.lines import broken

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.graph.multigraph import IntegerMatrix

WIDTH = 96
UNDERLINES = "=-~"
WIDEST_CELL = 48


def render(document: Document) -> str:
    """Write a report as plain text."""
    lines = _heading(document.title, 0)
    if document.about:
        lines += [*_wrapped(visible(document.about)), ""]
    for section in document.sections:
        lines += _section(section, 1)
    if document.source:
        lines += ["", *_wrapped(visible(document.source))]
    return "\n".join(line.rstrip() for line in lines).rstrip() + "\n"


def _heading(title: str, depth: int) -> list[str]:
    shown = visible(title)
    return [shown, UNDERLINES[min(depth, 2)] * len(shown), ""]


def _section(section: Section, depth: int) -> list[str]:
    lines = _heading(section.title, depth)
    for block in section.blocks:
        lines += _section(block, depth + 1) if isinstance(block, Section) else [*_block(block), ""]
    return lines


def _block(block: Block) -> list[str]:
    match block:
        case Paragraph(text):
            return _wrapped(said(text))
        case CellTable(head, rows):
            return _table([head, *([said(cell) for cell in row] for row in rows)])
        case Matrix():
            return matrix_lines(block.matrix, WIDTH)
        case Formulas(rows):
            return [line for row in rows for line in _row(row)]
        case IntermediateList(groups):
            lines: list[str] = []
            for group in groups:
                lines += [
                    f"  {visible(group.label)}:",
                    *(x for row in group.rows for x in _row(row)),
                ]
            return lines
        case Picture():
            return _wrapped(f"[{block.about} Edges and their roles are in the tables.]")
    raise TypeError(block)


def said(text: Text) -> str:
    """Write words, names and formulas of one line."""
    return "".join(_inline(part) for part in text)


def _inline(part: object) -> str:
    if isinstance(part, str):
        return visible_words(part)
    if isinstance(part, Code):
        return visible(part.text)
    return Plain()(part)  # type: ignore[arg-type]


def visible_words(text: str) -> str:
    """Make text printable and keep one blank at each end if there was any."""
    inner = visible(text)
    before = " " if text[:1].isspace() else ""
    after = " " if text[-1:].isspace() and inner else ""
    return f"{before}{inner}{after}"


def _row(row: EquationRow) -> list[str]:
    left = f"    {Plain()(row.left)} {row.sign} "
    indent = min(len(left), 24)
    first, *others = broken(row.right, Plain(), WIDTH - indent, max(0, len(left) - indent))
    if len(left) > WIDTH // 2:
        lines = broken(row.left, Plain(), WIDTH - 8)
        start = [f"    {lines[0]}", *(f"        {line}" for line in lines[1:])]
        start[-1] += f" {row.sign} {first}"
        return [*start, *(f"        {line}" for line in others)]
    return [left + first, *(" " * indent + line for line in others)]


def _wrapped(text: str) -> list[str]:
    """Break text into lines at blanks, inside formulas as well."""
    lines, line = [], ""
    for word in text.split():
        if line and len(line) + 1 + len(word) > WIDTH:
            lines.append(line)
            line = ""
        line = f"{line} {word}" if line else word
    return [*lines, line] if line else lines


def _table(rows: Iterable[Iterable[str]]) -> list[str]:
    cells = [list(row) for row in rows]
    widths = [max(len(row[j]) for row in cells) for j in range(len(cells[0]))]
    lines = []
    for row in cells:
        padded = (
            cell.ljust(min(width, WIDEST_CELL)) for cell, width in zip(row, widths, strict=True)
        )
        lines.append("  " + "  ".join(padded).rstrip())
    return [lines[0], "  " + "  ".join("-" * min(w, WIDEST_CELL) for w in widths), *lines[1:]]


def matrix_lines(matrix: IntegerMatrix, width: int) -> list[str]:
    """Write a matrix as a table if it fits, else row by row as sums.

    Args:
        matrix: the matrix.
        width: characters per line.
    """
    if not matrix.rows or not matrix.columns:
        return ["  (empty)"]
    table = [visible(line) if not line.isprintable() else line for line in str(matrix).splitlines()]
    if max(map(len, table)) <= width - 2:
        return [f"  {line}" for line in table]
    lines = []
    for name, row in zip(matrix.rows, matrix.entries, strict=True):
        terms = (
            f"{'+' if v > 0 else '-'} {visible(matrix.columns[j])}" for j, v in sorted(row.items())
        )
        first, *others = _wrapped(f"{visible(name)}: {' '.join(terms) or '0'}")
        lines += [f"  {first}", *(f"      {line}" for line in others)]
    return lines
