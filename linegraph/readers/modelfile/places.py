"""Line numbers of the keys of a text, with limits on its size."""

from __future__ import annotations

from bisect import bisect_right
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from linegraph.readers.modelfile.report import Path

DEEPEST = 16
"""Deepest nesting of keys and lists; a model needs five levels."""
MOST_ENTRIES = 50_000
"""Largest number of keys and items; each costs the reader some microseconds."""
MOST_LINES = 200_000
LONGEST_STRING = 20_000
LONGEST_STRINGS = 500_000
"""Largest number of characters of all texts together: an expression costs a microsecond for each, or more."""
LONGEST_SCALAR = 400
"""Largest number of characters of a number: conversion takes time quadratic in the length."""


class Limit(Exception):
    """The text exceeds a limit.

    Attributes:
        line: the line at which it does.
        problem: the limit, in words.
    """

    def __init__(self, line: int, problem: str) -> None:
        """Keep line and problem."""
        super().__init__(problem)
        self.line = line
        self.problem = problem


class NotUnderstood(Exception):
    """The scanner has met text that it does not understand."""


class Twice(NamedTuple):
    """A key that is given twice.

    Attributes:
        path: the key.
        line, first: lines of the second and the first occurrence.
    """

    path: Path
    line: int
    first: int


class Lines:
    """The line of every key, in the order of the text.

    Attributes:
        lines: line numbers by path; items of lists are numbered from 0.
        twice: the first key that is given twice, if any.
    """

    def __init__(self, text: str) -> None:
        """Find the line starts.

        Raises:
            Limit: there are too many lines.
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
        """The line of a character offset, counted from 1."""
        return bisect_right(self._starts, offset)

    def note(self, path: Path, offset: int, again: bool = False) -> None:
        """Record the line of a key.

        Args:
            path: the key.
            offset: its character offset in the text.
            again: whether it may have occurred before: a table to which keys are added.

        Raises:
            Limit: it is nested too deeply, or there are too many keys.
        """
        self.require_depth(len(path), offset)
        if path not in self.lines:
            self.lines[path] = self.line(offset)
        elif not again and self.twice is None:
            self.twice = Twice(path, self.line(offset), self.lines[path])
        if len(self.lines) > MOST_ENTRIES:
            raise Limit(self.line(offset), f"has more than {MOST_ENTRIES} keys and items")

    def require_depth(self, depth: int, offset: int) -> None:
        """Refuse nesting beyond the limit.

        Args:
            depth: the nesting.
            offset: its character offset in the text.

        Raises:
            Limit: the nesting is too deep.
        """
        if depth > DEEPEST:
            raise Limit(self.line(offset), f"is nested more than {DEEPEST} deep")

    def string(self, length: int, offset: int) -> None:
        """Count the characters of a text.

        Args:
            length: number of characters.
            offset: its character offset in the text.

        Raises:
            Limit: it is too long, or all texts together are.
        """
        self._require(length, LONGEST_STRING, offset, "has a text of")
        self._strings += length
        self._require(self._strings, LONGEST_STRINGS, offset, "has texts of together")

    def scalar(self, length: int, offset: int) -> None:
        """Count the characters of a number, date or truth value.

        Args:
            length: number of characters.
            offset: its character offset in the text.

        Raises:
            Limit: it is too long.
        """
        self._require(length, LONGEST_SCALAR, offset, "has a number of")

    def _require(self, length: int, longest: int, offset: int, what: str) -> None:
        if length > longest:
            raise Limit(self.line(offset), f"{what} more than {longest} characters")
