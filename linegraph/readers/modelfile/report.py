"""Errors of a model file, each with its line; all are collected before any is raised."""

from __future__ import annotations

import re
from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple

from linegraph.errors import ModelError, SourceError, SourceErrors

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

LONGEST_SHOWN = 80
MOST_COLLECTED = 1000
MOST_HINTS = 25
MOST_APART = 8
MOST_COMPARED = 300
"""Limits of hints, which compare names letter by letter: hostile files must not make that slow."""

Path = tuple[str | int, ...]

_BARE = re.compile(r"[A-Za-z0-9_-]+")


class ModelReport:
    """Collects the errors of one file.

    Args:
        source: the file as the user named it.
        lines: the line of every table and key.
        flat: tables that hold keys directly instead of tables by name.

    Attributes:
        count: the number of errors.
        errors: the errors that are kept, at most `MOST_COLLECTED`.
    """

    def __init__(self, source: str, lines: Mapping[Path, int], flat: Iterable[str] = ()) -> None:
        """Start without errors."""
        self.source = shown(source, 1000)
        self._lines = lines
        self._flat = frozenset(flat)
        self._hints = 0
        self.count = 0
        self.errors: list[SourceError] = []

    def add(self, path: Path, problem: str, thing: str | None = None) -> None:
        """Note an error at a key.

        Args:
            path: the key.
            problem: what is wrong.
            thing: its name in messages; default its path.
        """
        self.count += 1
        if self.count <= MOST_COLLECTED:
            thing = self.thing(path) if thing is None else thing
            self.errors.append(SourceError(self.source, self.line(path), thing, problem))

    def line(self, path: Path) -> int | None:
        """The line of a key, or of the table it belongs to if the file does not contain it."""
        while path:
            if path in self._lines:
                return self._lines[path]
            path = path[:-1]
        return None

    def thing(self, path: Path) -> str:
        """The name of a key in messages: ``[spring.strut] stiffness``."""
        depth = 1 if path and path[0] in self._flat else 2
        if len(path) < depth and (not path or path not in self._lines):
            return ""
        if len(path) == 1 and path[0] in ("name", "description"):
            return str(path[0])
        table = f"[{_dotted(path[:depth])}]"
        return f"{table} {_dotted(path[depth:])}" if path[depth:] else table

    def hint(self, name: str, known: Iterable[str]) -> str:
        """The end of a message: the most similar known name, or all if there are few.

        Args:
            name: the unknown name.
            known: the known names.

        Returns:
            Text that begins with a semicolon; empty after too many hints.
        """
        self._hints += 1
        names = list(known)
        if self._hints > MOST_HINTS or not names:
            return ""
        from difflib import get_close_matches

        alike = [
            k for k in names if abs(len(k) - len(name)) <= MOST_APART and len(k) <= LONGEST_SHOWN
        ]
        close = get_close_matches(name, alike[:MOST_COMPARED], 1)
        if close:
            return f'; did you mean "{shown(close[0])}"?'
        more = ", ..." if len(names) > 12 else ""
        return f"; known: {', '.join(shown(n) for n in names[:12])}{more}"

    @contextmanager
    def placed(self, path: Path) -> Iterator[None]:
        """Note errors raised by the model builder as errors of this table."""
        try:
            yield
        except ModelError as error:
            self.add(path, error.problem)

    def conclude(self) -> None:
        """Raise the errors collected, in the order of the file.

        Raises:
            SourceErrors: there was at least one error.
        """
        if self.errors:
            raise SourceErrors(sorted(self.errors, key=lambda error: error.line or 0))


class Spot(NamedTuple):
    """A place in the file for errors.

    Attributes:
        report: collects the errors.
        path: the key.
    """

    report: ModelReport
    path: Path

    def at(self, *keys: str | int) -> Spot:
        """A place inside this one."""
        return Spot(self.report, (*self.path, *keys))

    def error(self, problem: str) -> None:
        """Note an error at this place."""
        self.report.add(self.path, problem)


def shown(text: str, longest: int = LONGEST_SHOWN) -> str:
    r"""Make text of a file fit for a message: on one line, printable, not too long.

    Args:
        text: the text.
        longest: largest number of characters.

    Example:
        >>> print(shown("a" + chr(10) + "b"))
        a\x0ab
    """
    cut = text if len(text) <= longest else text[: longest - 3] + "..."
    return "".join(c if c.isprintable() else f"\\x{ord(c):02x}" for c in cut)


def _dotted(path: Path) -> str:
    """Keys as written in the file; items of lists are counted from 1."""
    text = ""
    for key in path:
        if isinstance(key, int):
            text += f" (item {key + 1})"
        else:
            text += "." * bool(text) + (shown(key) if _BARE.fullmatch(key) else f'"{shown(key)}"')
    return text
