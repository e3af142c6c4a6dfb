"""Kinds of values of few tables only: motions, start values, lists of names, kinds of coordinates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.model.choices import COORDINATES
from linegraph.readers.modelfile.expressions import Scope
from linegraph.readers.modelfile.kinds import WRONG, Items, Real, Schema, Word, said
from linegraph.readers.modelfile.report import shown

if TYPE_CHECKING:
    from linegraph.readers.modelfile.expressions import Names
    from linegraph.readers.modelfile.report import Spot

BY_INPUT = "input"
MOST_COORDINATES = 7


@dataclass(frozen=True)
class Timed:
    """An expression of t, or "input": value and first two derivatives are inputs then."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read an expression of t.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            The number or expression, or "input", or `WRONG` after its errors are noted.
        """
        return value if value == BY_INPUT else Real(Scope.TIME).read(value, spot, names)

    def schema(self) -> Schema:
        """The JSON Schema: a number or a string."""
        return Real(Scope.TIME).schema()


@dataclass(frozen=True)
class PrescribedMotion:
    """A prescribed motion: one expression for each coordinate, or "input" for all.

    Attributes:
        count: number of coordinates; None if the builder checks the number and a single one needs no list.
    """

    count: int | None = None

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read a prescribed motion.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            A tuple of expressions, one expression, or "input", or `WRONG` after its errors are noted.
        """
        if value == BY_INPUT:
            return value
        if not isinstance(value, list) and self.count is None:
            return Timed().read(value, spot, names)
        count = self.count or (len(value) if 1 <= len(value) <= MOST_COORDINATES else 1)
        return Items(Timed(), count, "one expression of t for each coordinate").read(
            value, spot, names
        )

    def schema(self) -> Schema:
        """The JSON Schema: a number, a string or an array."""
        items = Items(Timed(), self.count or 1, "").schema()
        if self.count is None:
            items["maxItems"] = MOST_COORDINATES
        return {"anyOf": [*Timed().schema()["anyOf"], items]}


@dataclass(frozen=True)
class Start:
    """Start of the search for a position: a number, or one for each coordinate."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read start values.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            A number or a tuple, or `WRONG` after its errors are noted.
        """
        if not isinstance(value, list):
            return Real().read(value, spot, names)
        count = len(value) if 1 <= len(value) <= MOST_COORDINATES else 1
        return Items(Real(), count, "one number for each coordinate").read(value, spot, names)

    def schema(self) -> Schema:
        """The JSON Schema: a number, a string or an array."""
        items = Items(Real(), 1, "").schema()
        return {"anyOf": [*Real().schema()["anyOf"], items | {"maxItems": MOST_COORDINATES}]}


@dataclass(frozen=True)
class Listed:
    """A list of names of any length.

    Attributes:
        what: the things named, for messages.
    """

    what: str

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read a list of names; their existence is checked when the tree is chosen.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            A tuple of names, or `WRONG` after its errors are noted.
        """
        if not isinstance(value, list) or not all(isinstance(x, str) for x in value):
            spot.error(f"a list of {self.what} is wanted, not {said(value)}")
            return WRONG
        return tuple(value)

    def schema(self) -> Schema:
        """The JSON Schema: an array of strings."""
        return {"type": "array", "items": {"type": "string"}}


@dataclass(frozen=True)
class Coordinates:
    """One kind of coordinates for all bodies, or a kind for each of some bodies."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read kinds of coordinates.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            The kind, or kinds by body, or `WRONG` after its errors are noted.
        """
        word = Word(COORDINATES)
        if not isinstance(value, dict):
            return word.read(value, spot, names)
        bodies = set(names.terminals.values()) - {"ground"}
        before = spot.report.count
        for body, kind in value.items():
            if body not in bodies:
                hint = spot.report.hint(body, sorted(bodies))
                spot.at(body).error(f'there is no body "{shown(body)}"{hint}')
            else:
                word.read(kind, spot.at(body), names)
        return WRONG if spot.report.count > before else dict(value)

    def schema(self) -> Schema:
        """The JSON Schema: an enumeration, or an object of such."""
        word = Word(COORDINATES).schema()
        return {"anyOf": [word, {"type": "object", "additionalProperties": word}]}
