"""Kinds of values that only some tables have: motions, start values, lists of names, kinds of coordinates."""

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
    """An expression of t, or "input": the value and its first two derivatives come from inputs."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """The expression, or the word."""
        return value if value == BY_INPUT else Real(Scope.TIME).read(value, spot, names)

    def schema(self) -> Schema:
        """A number or a text."""
        return Real(Scope.TIME).schema()


@dataclass(frozen=True)
class PrescribedMotion:
    """A prescribed motion: one for each coordinate, or "input" for all.

    Attributes:
        count: of coordinates; None where one may stand alone, and the builder counts them.
    """

    count: int | None = None

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """As the builder wants it."""
        if value == BY_INPUT:
            return value
        if not isinstance(value, list) and self.count is None:
            return Timed().read(value, spot, names)
        count = self.count or (len(value) if 1 <= len(value) <= MOST_COORDINATES else 1)
        return Items(Timed(), count, "one expression of t for each coordinate").read(
            value, spot, names
        )

    def schema(self) -> Schema:
        """A number, a text or a list."""
        items = Items(Timed(), self.count or 1, "").schema()
        if self.count is None:
            items["maxItems"] = MOST_COORDINATES
        return {"anyOf": [*Timed().schema()["anyOf"], items]}


@dataclass(frozen=True)
class Start:
    """Where the search for a position begins: a number, or one for each coordinate."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """A number or a tuple."""
        if not isinstance(value, list):
            return Real().read(value, spot, names)
        count = len(value) if 1 <= len(value) <= MOST_COORDINATES else 1
        return Items(Real(), count, "one number for each coordinate").read(value, spot, names)

    def schema(self) -> Schema:
        """A number, a text or a list."""
        items = Items(Real(), 1, "").schema()
        return {"anyOf": [*Real().schema()["anyOf"], items | {"maxItems": MOST_COORDINATES}]}


@dataclass(frozen=True)
class Listed:
    """A list of names of any length.

    Attributes:
        what: what they name.
    """

    what: str

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """A tuple; whether the names exist is asked when the tree is chosen."""
        if not isinstance(value, list) or not all(isinstance(x, str) for x in value):
            spot.error(f"a list of {self.what} is wanted, not {said(value)}")
            return WRONG
        return tuple(value)

    def schema(self) -> Schema:
        """An array of strings."""
        return {"type": "array", "items": {"type": "string"}}


@dataclass(frozen=True)
class Coordinates:
    """One kind of coordinates for all bodies, or kinds for single bodies."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """The word, or words by body."""
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
        """A word, or an object of words."""
        word = Word(COORDINATES).schema()
        return {"anyOf": [word, {"type": "object", "additionalProperties": word}]}
