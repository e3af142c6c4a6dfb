"""What a report consists of, whatever it is written in: sections, paragraphs, tables, formulas, pictures."""

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
    """Text of a model, such as a name; or words that are `strong`."""

    text: str
    strong: bool = False

    @property
    def tag(self) -> str:
        """The element that it is in HTML."""
        return "strong" if self.strong else "code"


Inline: TypeAlias = "str | Code | Math"
Text: TypeAlias = tuple[Inline, ...]
"""Words, names and formulas in a line."""

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
"""The inlines that are formulas."""


@dataclass(frozen=True)
class Paragraph:
    """Words."""

    text: Text


@dataclass(frozen=True)
class CellTable:
    """Rows of cells under a head."""

    head: tuple[str, ...]
    rows: tuple[tuple[Text, ...], ...]


@dataclass(frozen=True)
class Matrix:
    """An integer matrix with its rows and columns named.

    Attributes:
        name: its letter.
        ways: what its rows and its columns are.
    """

    name: str
    matrix: IntegerMatrix
    ways: tuple[str, str]


@dataclass(frozen=True)
class EquationRow:
    """One equation; without a left side it goes on from the one before."""

    left: Math
    right: Math
    sign: str = "="


@dataclass(frozen=True)
class Formulas:
    """Equations below each other."""

    rows: tuple[EquationRow, ...]


@dataclass(frozen=True)
class Group:
    """Named intermediates that belong together."""

    label: str
    rows: tuple[EquationRow, ...]


@dataclass(frozen=True)
class IntermediateList:
    """Intermediates in the order in which they are computed."""

    groups: tuple[Group, ...]


@dataclass(frozen=True)
class Picture:
    """A drawing, and the graph it is of, for where no drawing can be shown."""

    scene: Scene
    about: str
    topology: Topology | None = None


@dataclass(frozen=True)
class Section:
    """A heading and what stands under it."""

    title: str
    blocks: tuple[Block, ...]


Block: TypeAlias = (
    "Paragraph | CellTable | Matrix | Formulas | IntermediateList | Picture | Section"
)


@dataclass(frozen=True)
class Document:
    """A report."""

    title: str
    about: str
    sections: tuple[Section, ...]
    source: str = ""
    """What it was made from, in small print."""


def said(*text: Inline) -> Paragraph:
    """A paragraph."""
    return Paragraph(text)


def formulas(blocks: tuple[Block, ...]) -> Iterator[Math]:
    """Every formula in some blocks."""
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
