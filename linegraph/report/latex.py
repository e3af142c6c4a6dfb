"""A report as a LaTeX article that uses amsmath, booktabs and similar packages, and no other file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.drawing.latex import PREAMBLE, picture
from linegraph.notation.latex import Latex, escaped
from linegraph.notation.plain import Plain
from linegraph.notation.tree import Name
from linegraph.notation.writing import pieces
from linegraph.report.document import (
    Block,
    CellTable,
    Code,
    Document,
    EquationRow,
    Formulas,
    Group,
    IntermediateList,
    Matrix,
    Paragraph,
    Picture,
    Section,
    Text,
)
from linegraph.report.lines import broken, typeset
from linegraph.report.text import said as plain
from linegraph.report.text import visible_words

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.graph.multigraph import IntegerMatrix

WIDTH = 84
"""Characters of plain text per line of formulas."""

MOST_COLUMNS = 18
NARROW = 16
"""Columns of at most this many characters are not broken."""

MANY, HALF, THIRD = 12, 42, 28
"""Least number of equations set in columns, and their largest widths for two and for three columns."""

WIDE, HIGH, LOW = 472, 560, 270
"""Space for a picture in points: width, height of a graph, height of a sketch."""

LEVELS = ("section", "subsection", "subsubsection", "paragraph")

HEAD = r"""\documentclass[11pt,a4paper,fleqn]{article}
\usepackage[utf8]{inputenc}
\usepackage[T1]{fontenc}
\usepackage{lmodern}
\usepackage{textcomp}
\usepackage[a4paper,margin=22mm]{geometry}
\usepackage{amsmath}
\usepackage{amssymb}
\usepackage{array}
\usepackage{longtable}
\usepackage{booktabs}
\usepackage{graphicx}
\usepackage{color}
\usepackage{multicol}
\usepackage[hidelinks]{hyperref}
\allowdisplaybreaks
\setlength{\parindent}{0pt}
\setlength{\parskip}{0.6em plus 0.2em}
\setlength{\LTleft}{0pt}
\setlength{\jot}{4pt}
\setlength{\mathindent}{1.5em}
\setcounter{MaxMatrixCols}{40}
\emergencystretch=3em
\newcolumntype{L}[1]{>{\raggedright\arraybackslash}p{#1\linewidth}}
\newcommand{\step}[1]{\par\hangindent=1.5em #1}
"""


def render(document: Document) -> str:
    """Write a report as a LaTeX file."""
    lines = [
        HEAD + PREAMBLE + rf"\title{{{escaped(document.title)}}}",
        r"\author{}",
        r"\date{}",
        r"\begin{document}",
        r"\abovedisplayskip=4pt plus 2pt \abovedisplayshortskip=4pt plus 2pt",
        r"\belowdisplayskip=4pt plus 2pt \belowdisplayshortskip=4pt plus 2pt",
        r"\maketitle",
    ]
    if document.about:
        lines.append(rf"{{\raggedright {escaped(document.about)}\par}}")
    lines.append(r"{\setlength{\parskip}{0pt}\tableofcontents}")
    for section in document.sections:
        lines += _section(section, 0)
    if document.source:
        lines += ["", rf"\bigskip{{\footnotesize\raggedright {breakable(document.source)}\par}}"]
    return "\n".join([*lines, r"\end{document}"]) + "\n"


def _section(section: Section, depth: int) -> list[str]:
    title = escaped(section.title[:1].upper() + section.title[1:])
    lines = ["", rf"\{LEVELS[min(depth, 3)]}{{{title}}}"]
    for block in section.blocks:
        if isinstance(block, Section):
            lines += _section(block, depth + 1)
        else:
            # Without an empty line before it, a display belongs to the paragraph above.
            lines += [*([] if isinstance(block, Formulas) else [""]), *_block(block)]
    return lines


def _block(block: Block) -> list[str]:
    match block:
        case Paragraph(text):
            return [said(text)]
        case CellTable(head, rows):
            return _table(head, rows)
        case Matrix():
            return _matrix(block.matrix)
        case Formulas(rows):
            return _display(rows)
        case IntermediateList(groups):
            return _listing(groups)
        case Picture(scene, about):
            drawn = picture(scene, WIDE, HIGH if block.topology else LOW)
            return [
                r"\begin{center}",
                drawn,
                rf"\\[1ex]{{\small {escaped(about)}}}",
                r"\end{center}",
            ]
    raise TypeError(block)


def said(text: Text) -> str:
    """Write words, names and formulas of one line."""
    return "".join(_inline(part) for part in text)


def _inline(part: object) -> str:
    if isinstance(part, str):
        inner = visible_words(part)
        stripped = inner.strip()
        return inner.replace(stripped, escaped(stripped)) if stripped else inner
    if isinstance(part, Code):
        command = "textbf" if part.strong else "textsf"
        return rf"\{command}{{{breakable(part.text)}}}"
    return f"${Latex()(part)}$"  # type: ignore[arg-type]


def breakable(text: str) -> str:
    """Escape a name, with possible line breaks after slashes, dots and underscores."""
    shown = escaped(text)
    for stop in ("/", ".", r"\_"):
        shown = shown.replace(stop, rf"{stop}\allowbreak{{}}")
    return shown


def aligned(rows: Sequence[EquationRow], width: int) -> list[str]:
    """Write equations one below the other, long ones broken over lines.

    They are aligned at their signs if all left sides are names.

    Args:
        rows: the equations.
        width: characters of plain text per line.
    """
    level = all(isinstance(row.left, Name) for row in rows)
    lines: list[str] = []
    for k, row in enumerate(rows):
        end = r" \\" if k + 1 < len(rows) else ""
        own = _named(row, width) if level else _broken(row, width)
        lines += [*(line + r" \\" for line in own[:-1]), own[-1] + end]
    return lines


def _named(row: EquationRow, width: int) -> list[str]:
    """A name and its definition."""
    used = typeset(Plain()(row.left)) + 3
    first, *others = broken(row.right, Latex(), width - 4, max(0, used - 4), typeset)
    left = Latex()(row.left)
    return [f"{left} &{row.sign} {first}", *(rf"&\qquad {line}" for line in others)]


def _broken(row: EquationRow, width: int) -> list[str]:
    """An equation whose sides may both be long."""
    lines = broken(row.left, Latex(), width - 4, 0, typeset)
    used = typeset(Plain()(row.left)) + 3 if len(lines) == 1 else width // 2
    first, *others = broken(row.right, Latex(), width - 4, min(used, width - 8), typeset)
    lines[-1] += f" {row.sign} {first}"
    return [f"&{lines[0]}", *(rf"&\qquad {line}" for line in (*lines[1:], *others))]


def _display(rows: Sequence[EquationRow]) -> list[str]:
    size = max(typeset(Plain()(row.left)) + _solid(row) for row in rows)
    length = max(typeset(Plain()(row.right)) for row in rows)
    if len(rows) >= MANY and size <= HALF and length <= WIDTH:
        lines = [r"\begin{multicols}{2}\raggedright\raggedcolumns"]
        return [*lines, *map(_step, rows), r"\end{multicols}"]
    return [r"\begin{align*}", *aligned(rows, WIDTH), r"\end{align*}"]


def _listing(groups: Sequence[Group]) -> list[str]:
    """Intermediates in columns, in small print."""
    rows = [row for group in groups for row in group.rows]
    columns = 3 if max(map(_solid, rows), default=0) <= THIRD else 2
    lines = [
        r"{\footnotesize\setlength{\columnsep}{1.2em}\setlength{\parskip}{1pt plus 1pt}",
        r"\setlength{\multicolsep}{4pt}\raggedcolumns"
        rf"\begin{{multicols}}{{{columns}}}\raggedright",
    ]
    for group in groups:
        lines.append(rf"\par\medskip\textit{{{escaped(group.label)}}}\nopagebreak")
        lines += map(_step, group.rows)
    return [*lines, r"\end{multicols}}"]


def _solid(row: EquationRow) -> int:
    """Width of the longest part without a possible line break."""
    return max(typeset(piece) for _, piece in pieces(Plain().marked(row.right)))


def _step(row: EquationRow) -> str:
    return rf"\step{{${Latex()(row.left)} {row.sign} {Latex()(row.right)}$}}"


def _table(head: Sequence[str], rows: Sequence[Sequence[Text]]) -> list[str]:
    widths = _widths(head, rows)
    columns = "".join(f"L{{{width:.3f}}}" for width in widths)
    lines = [
        r"{\small\setlength{\tabcolsep}{3pt}",
        rf"\begin{{longtable}}{{@{{}}{columns}@{{}}}}",
        r"\toprule",
        f"{' & '.join(escaped(cell) for cell in head)} \\\\",
        r"\midrule",
        r"\endhead",
    ]
    lines += [f"{' & '.join(said(cell) for cell in row)} \\\\" for row in rows]
    return [*lines, r"\bottomrule", r"\end{longtable}}"]


def _widths(head: Sequence[str], rows: Sequence[Sequence[Text]]) -> list[float]:
    """Share of each column in the line: narrow ones get their width, the others share the rest."""
    longest = [
        max([len(title), 3, *(len(plain(row[j])) for row in rows)]) for j, title in enumerate(head)
    ]
    needed = [0.0122 * size + 0.012 for size in longest]
    gaps = 0.014 * len(head)
    if sum(needed) + gaps <= 1:
        return needed
    kept = [size <= NARROW for size in longest]
    rest = 1 - gaps - sum(w for w, keep in zip(needed, kept, strict=True) if keep)
    shares = [
        0.0 if keep else min(size, 60) ** 0.7 for size, keep in zip(longest, kept, strict=True)
    ]
    whole = sum(shares) or 1
    return [
        w if keep else rest * share / whole
        for w, keep, share in zip(needed, kept, shares, strict=True)
    ]


def _matrix(matrix: IntegerMatrix) -> list[str]:
    """A matrix with upright names of columns; wide ones row by row."""
    if not matrix.rows or not matrix.columns:
        return ["(empty)"]
    if len(matrix.columns) > MOST_COLUMNS:
        return _sums(matrix)
    columns = "l" + "c" * len(matrix.columns)
    names = [rf"\rotatebox{{90}}{{\textsf{{{escaped(name)}}}}}" for name in matrix.columns]
    lines = [
        r"{\footnotesize\setlength{\tabcolsep}{4pt}",
        rf"\begin{{longtable}}{{{columns}}}",
        f" & {' & '.join(names)} \\\\",
        r"\midrule",
        r"\endhead",
    ]
    for name, row in zip(matrix.rows, matrix, strict=True):
        cells = (f"${value:+d}$" if value else r"$\cdot$" for value in row)
        lines.append(rf"\textsf{{{escaped(name)}}} & {' & '.join(cells)} \\")
    return [*lines, r"\end{longtable}}"]


def _sums(matrix: IntegerMatrix) -> list[str]:
    lines = [
        r"{\footnotesize\setlength{\parskip}{1pt}\setlength{\multicolsep}{4pt}",
        r"\begin{multicols}{2}\raggedright",
    ]
    for name, row in zip(matrix.rows, matrix.entries, strict=True):
        terms = [
            rf"${'+' if value > 0 else '-'}$\,\textsf{{{breakable(matrix.columns[j])}}}"
            for j, value in sorted(row.items())
        ]
        lines.append(rf"\step{{\textsf{{{breakable(name)}}}: {' '.join(terms) or '0'}}}")
    return [*lines, r"\end{multicols}}"]
