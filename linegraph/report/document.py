"""Parts of a report, independent of the format: sections, paragraphs, tables, formulas, pictures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from linegraph.notation.tree import (
    Components,
    Fraction,
    FunctionCall,
    Grid,
    Math,
    Name,
    Numeral,
    Over,
    Power,
    Product,
    Raw,
    Root,
    Sum,
    TwoSides,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linegraph.drawing.scene import Scene
    from linegraph.graph.forest import Topology
    from linegraph.graph.multigraph import IntegerMatrix


@dataclass(frozen=True)
class Code:
    """Text from a model, such as a name; or emphasised text.

    Attributes:
        text: the text.
        strong: whether it is emphasised instead of set as code.
    """

    text: str
    strong: bool = False

    @property
    def tag(self) -> str:
        """Name of its HTML element."""
        return "strong" if self.strong else "code"


Inline: TypeAlias = "str | Code | Math"
Text: TypeAlias = tuple[Inline, ...]
"""Words, names and formulas in one line."""

FORMULA = (
    Name,
    Numeral,
    Sum,
    Product,
    Fraction,
    Power,
    Root,
    FunctionCall,
    Components,
    Grid,
    TwoSides,
    Over,
    Raw,
)
"""Types of inline parts that are formulas."""


@dataclass(frozen=True)
class Paragraph:
    """A paragraph of running text.

    Attributes:
        text: its words, names and formulas.
    """

    text: Text


@dataclass(frozen=True)
class CellTable:
    """A table with a head.

    Attributes:
        head: titles of the columns.
        rows: the cells of each row.
    """

    head: tuple[str, ...]
    rows: tuple[tuple[Text, ...], ...]


@dataclass(frozen=True)
class Matrix:
    """An integer matrix with named rows and columns.

    Attributes:
        name: its letter.
        matrix: the entries.
        ways: the things that label rows and columns, such as branches and chords.
    """

    name: str
    matrix: IntegerMatrix
    ways: tuple[str, str]


@dataclass(frozen=True)
class EquationRow:
    """One equation; an empty left side continues the one before.

    Attributes:
        left, right: the two sides.
        sign: the sign between them.
    """

    left: Math
    right: Math
    sign: str = "="


@dataclass(frozen=True)
class Formulas:
    """Equations, one below the other.

    Attributes:
        rows: the equations.
    """

    rows: tuple[EquationRow, ...]


@dataclass(frozen=True)
class Group:
    """Named intermediates that belong together.

    Attributes:
        label: the joint or body they belong to.
        rows: their definitions.
    """

    label: str
    rows: tuple[EquationRow, ...]


@dataclass(frozen=True)
class IntermediateList:
    """Intermediates in the order in which they are computed.

    Attributes:
        groups: the intermediates, by joint or body.
    """

    groups: tuple[Group, ...]


@dataclass(frozen=True)
class Picture:
    """A drawing.

    Attributes:
        scene: the drawing.
        about: its caption.
        topology: the graph it shows, for formats without drawings; None for a sketch.
    """

    scene: Scene
    about: str
    topology: Topology | None = None


@dataclass(frozen=True)
class Section:
    """A heading with the blocks below it.

    Attributes:
        title: the heading.
        blocks: paragraphs, tables, formulas and further sections.
    """

    title: str
    blocks: tuple[Block, ...]


Block: TypeAlias = (
    "Paragraph | CellTable | Matrix | Formulas | IntermediateList | Picture | Section"
)


@dataclass(frozen=True)
class Document:
    """A report in no particular format.

    Attributes:
        title: its heading.
        about: description of the model.
        sections: its content.
        source: note about the file it was derived from, in small print.
    """

    title: str
    about: str
    sections: tuple[Section, ...]
    source: str = ""
    """Note about the file it was derived from, in small print."""


def said(*text: Inline) -> Paragraph:
    """Make a paragraph of words, names and formulas."""
    return Paragraph(text)


def formulas(blocks: tuple[Block, ...]) -> Iterator[Math]:
    """All formulas in some blocks, in order."""
    for block in blocks:
        match block:
            case Paragraph(text):
                yield from _of(text)
            case CellTable(_, rows):
                yield from (m for row in rows for cell in row for m in _of(cell))
            case Formulas(rows):
                yield from (side for row in rows for side in (row.left, row.right))
            case IntermediateList(groups):
                yield from (x for g in groups for row in g.rows for x in (row.left, row.right))
            case Section(_, inner):
                yield from formulas(inner)


def _of(text: Text) -> Iterator[Math]:
    return (part for part in text if isinstance(part, FORMULA))
