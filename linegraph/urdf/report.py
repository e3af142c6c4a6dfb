"""What is said about a file: errors and warnings, each with its place."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from linegraph.errors import ModelError, SourceError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

LONGEST_SHOWN = 80


class Report:
    """Collects the warnings of one file and places its errors.

    Args:
        source: the file as the user named it.
    """

    def __init__(self, source: str) -> None:
        """Start without warnings."""
        self.source = shown(source, 1000)
        self._warnings: list[tuple[int, str]] = []

    def warn(self, line: int, thing: str, text: str) -> None:
        """Note something that a user should know but that stops nothing."""
        self._warnings.append((line, f"{self.source}:{line}: {thing}: {text}"))

    def error(self, line: int | None, thing: str, problem: str) -> SourceError:
        """The error that says this at this place; the caller raises it."""
        return SourceError(self.source, line, thing, problem)

    @contextmanager
    def placed(self, line: int, thing: str) -> Iterator[None]:
        """Give errors of the model builder the place in the file that caused them."""
        try:
            yield
        except ModelError as error:
            raise self.error(line, thing, error.problem) from error

    @property
    def warnings(self) -> list[str]:
        """All warnings in the order of the file, each ``source:line: thing: text``."""
        return [text for _, text in sorted(self._warnings, key=lambda warning: warning[0])]


def shown(text: str, longest: int = LONGEST_SHOWN) -> str:
    r"""File text made fit for a message: on one line, printable, not too long.

    Example:
        >>> print(shown("a" + chr(10) + "b"))
        a\x0ab
    """
    cut = text if len(text) <= longest else text[: longest - 3] + "..."
    return "".join(c if c.isprintable() else f"\\x{ord(c):02x}" for c in cut)


def named(kind: str, name: str) -> str:
    """How messages call a part of the robot: ``joint "elbow"``."""
    return f'{kind} "{shown(name)}"'


def nearest(name: str, known: Iterable[str]) -> str:
    """A hint that ends a message: the known name most like `name`, or nothing."""
    from difflib import get_close_matches

    # difflib compares with every name: hostile files must not make that slow
    candidates = [k for k in known if len(k) <= 4 * LONGEST_SHOWN][:5000]
    close = get_close_matches(name[: 4 * LONGEST_SHOWN], candidates, 1)
    return f'; did you mean "{shown(close[0])}"?' if close else ""
