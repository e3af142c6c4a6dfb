"""A report in GitHub's Markdown: formulas between dollar signs, graphs as Mermaid diagrams."""

from __future__ import annotations

import re
from html import escape
from typing import TYPE_CHECKING

from linegraph.notation.latex import Latex
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
from linegraph.report.latex import aligned
from linegraph.report.text import matrix_lines, visible_words

if TYPE_CHECKING:
    from linegraph.graph.forest import Topology

WIDTH = 84
_SPECIAL = re.compile(r"([\\`*_{}\[\]<>()#+.!|~$&^-])")


def render(document: Document) -> str:
    """Write a report as Markdown."""
    parts = [f"# {words(document.title)}"]
    if document.about:
        parts.append(words(document.about))
    for section in document.sections:
        parts += _section(section, 2)
    if document.source:
        parts.append(f"<sub>{words(document.source)}</sub>")
    return "\n\n".join(part for part in parts if part) + "\n"


def words(text: str) -> str:
    """Escape any text for use as words, so that nothing in it is Markdown or HTML."""
    return _SPECIAL.sub(_harmless, visible(text))


def _harmless(found: re.Match[str]) -> str:
    letter = found[0]
    return escape(letter) if letter in "<>&" else f"\\{letter}"


def code(text: str) -> str:
    """Write any text as code; backticks in it get longer ones around it."""
    shown = visible(text).replace("|", "¦")
    if not shown:
        return ""
    if "`" not in shown:
        return f"`{shown}`"
    longest = max(len(run) for run in re.findall("`+", shown)) + 1
    return f"{'`' * longest} {shown} {'`' * longest}"


def _section(section: Section, depth: int) -> list[str]:
    parts = [f"{'#' * min(depth, 6)} {words(section.title)}"]
    for block in section.blocks:
        parts += _section(block, depth + 1) if isinstance(block, Section) else [_block(block)]
    return parts


def _block(block: Block) -> str:
    match block:
        case Paragraph(text):
            return said(text)
        case CellTable(head, rows):
            return _table(head, rows)
        case Matrix():
            lines = matrix_lines(block.matrix, 110)
            return "\n".join(["```text", *(line.replace("```", "'''") for line in lines), "```"])
        case Formulas(rows):
            return _formulas(rows)
        case IntermediateList(groups):
            return "\n\n".join(f"*{words(g.label)}*\n\n{_formulas(g.rows)}" for g in groups)
        case Picture():
            return _diagram(block) if block.topology is not None else ""
    raise TypeError(block)


def said(text: Text) -> str:
    """Write words, names and formulas of one line."""
    return "".join(_inline(part) for part in text)


def _inline(part: object) -> str:
    if isinstance(part, str):
        inner = visible_words(part)
        stripped = inner.strip()
        return inner.replace(stripped, _SPECIAL.sub(_spoken, stripped)) if stripped else inner
    if isinstance(part, Code):
        return f"**{words(part.text)}**" if part.strong else code(part.text)
    return f"${safe(Latex()(part))}$"  # type: ignore[arg-type]


def _spoken(found: re.Match[str]) -> str:
    """Escape only those characters of running text that could be markup."""
    letter = found[0]
    return letter if letter in "().+-!&" else _harmless(found)


def safe(latex: str) -> str:
    """Rewrite LaTeX that Markdown would change: backslashes before punctuation, and bars."""
    return (
        latex.replace(r"\,", r"\thinspace ")
        .replace(r"\\", r"\cr ")
        .replace("\\allowbreak\\ ", " ")
        .replace("|", r"\vert ")
    )


def _formulas(rows: tuple[EquationRow, ...]) -> str:
    lines = aligned(rows, WIDTH)
    body = "\n".join(safe(line) for line in lines)
    return f"$$\n\\begin{{aligned}}\n{body}\n\\end{{aligned}}\n$$"


def _table(head: tuple[str, ...], rows: tuple[tuple[Text, ...], ...]) -> str:
    lines = [
        f"| {' | '.join(words(cell) for cell in head)} |",
        f"|{'|'.join(' --- ' for _ in head)}|",
    ]
    lines += [f"| {' | '.join(said(cell) for cell in row)} |" for row in rows]
    return "\n".join(lines)


def _diagram(picture: Picture) -> str:
    """A Mermaid diagram with thick branches."""
    topology: Topology = picture.topology  # type: ignore[assignment]
    branches = {edge.name for edge in topology.branches}
    place = {vertex: f"v{k}" for k, vertex in enumerate(topology.projection.vertices)}
    lines = ["```mermaid", "graph LR"]
    lines += [f'    {key}(("{label(vertex)}"))' for vertex, key in place.items()]
    for edge in topology.projection.edges:
        arrow = "==>" if edge.name in branches else "-->"
        lines.append(f'    {place[edge.tail]} {arrow}|"{label(edge.name)}"| {place[edge.head]}')
    return "\n".join([*lines, "```"])


def label(text: str) -> str:
    """Escape any text for a Mermaid label: all but letters and digits by number."""
    return "".join(
        c if (c.isalnum() and c.isascii()) or c in " ._/" else f"#{ord(c)};" for c in visible(text)
    )
