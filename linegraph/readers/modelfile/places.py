"""Lines of a text by the keys that stand there, kept within limits."""

from __future__ import annotations

from bisect import bisect_right
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from linegraph.readers.modelfile.report import Path

DEEPEST = 16
"""Deepest nesting of keys and lists; a model needs five levels."""
MOST_ENTRIES = 50_000
"""Most keys and items; each costs the reader some microseconds."""
MOST_LINES = 200_000
LONGEST_STRING = 20_000
LONGEST_STRINGS = 500_000
"""Characters of all texts together: as expressions, each costs a microsecond or more."""
LONGEST_SCALAR = 400
"""Characters of a number: long ones take time that grows with the square of their length."""


class Limit(Exception):
    """The text is larger or deeper than any model; with the line that is too much."""

    def __init__(self, line: int, problem: str) -> None:
        """Keep both."""
        super().__init__(problem)
        self.line = line
        self.problem = problem


class NotUnderstood(Exception):
    """Here is what the scanner does not understand."""


class Twice(NamedTuple):
    """A key given twice."""

    path: Path
    line: int
    first: int


class Lines:
    """The line of every key, in the order of the text.

    Attributes:
        lines: by path; items of lists by number.
        twice: the first key that is given twice, if any.
    """

    def __init__(self, text: str) -> None:
        """Count the lines.

        Raises:
            Limit: there are too many.
        """
        self.lines: dict[Path, int] = {}
        self.twice: Twice | None = None
        self._strings = 0
        if text.count("\n") > MOST_LINES:
            raise Limit(MOST_LINES, f"has more than {MOST_LINES} lines")
        self._starts = [0]
        end = text.find("\n")
        while end >= 0:
            self._starts.append(end + 1)
            end = text.find("\n", end + 1)

    def line(self, offset: int) -> int:
        """The line of an offset, counted from 1."""
        return bisect_right(self._starts, offset)

    def note(self, path: Path, offset: int, again: bool = False) -> None:
        """Remember where a key is.

        Args:
            path: the key.
            offset: where it is.
            again: it may have been named before: a table that more is added to.
        """
        self.require_depth(len(path), offset)
        if path not in self.lines:
            self.lines[path] = self.line(offset)
        elif not again and self.twice is None:
            self.twice = Twice(path, self.line(offset), self.lines[path])
        if len(self.lines) > MOST_ENTRIES:
            raise Limit(self.line(offset), f"has more than {MOST_ENTRIES} keys and items")

    def require_depth(self, depth: int, offset: int) -> None:
        """Refuse what is nested too deeply.

        Raises:
            Limit: it is.
        """
        if depth > DEEPEST:
            raise Limit(self.line(offset), f"is nested more than {DEEPEST} deep")

    def string(self, length: int, offset: int) -> None:
        """Count a text.

        Raises:
            Limit: it is too long, or all texts together are.
        """
        self._require(length, LONGEST_STRING, offset, "has a text of")
        self._strings += length
        self._require(self._strings, LONGEST_STRINGS, offset, "has texts of together")

    def scalar(self, length: int, offset: int) -> None:
        """Count a number or another word.

        Raises:
            Limit: it is too long.
        """
        self._require(length, LONGEST_SCALAR, offset, "has a number of")

    def _require(self, length: int, longest: int, offset: int, what: str) -> None:
        if length > longest:
            raise Limit(self.line(offset), f"{what} more than {longest} characters")
