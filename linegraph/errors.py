"""All errors that a user can cause.

    LinegraphError
    ├── ModelError        a part of the model is impossible, with the reason
    │   └── SourceError   the same, with file and line
    ├── SourceErrors      all errors of a file at once
    ├── NameRefused       a name that cannot appear in emitted code
    └── DeviceFailed      writing failed: a full disk, a pipe without a reader

Each message is one complete sentence for the user. Any other exception is a bug of linegraph.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

MOST_PRINTED = 20


class LinegraphError(Exception):
    """Base of all errors caused by the input and not by the program."""


class ModelError(LinegraphError):
    """An impossible model: names the part and says what to change.

    Args:
        thing: the part at fault as the user named it, such as ``joint "elbow"``.
        problem: what is wrong with it and how to correct it.
    """

    def __init__(self, thing: str, problem: str) -> None:
        """Keep both parts, so that an importer can add file and line."""
        super().__init__(f"{thing}: {problem}" if thing else problem)
        self.thing = thing
        self.problem = problem


class SourceError(ModelError):
    """A `ModelError` with its place in a file: ``robot.urdf:12: joint "elbow": ...``.

    Args:
        source: the file as the user named it.
        line: the line, counted from 1; None for the file as a whole.
        thing: the part at fault.
        problem: what is wrong with it and how to correct it.
    """

    def __init__(self, source: str, line: int | None, thing: str, problem: str) -> None:
        """Store the place, which `str` puts before the message."""
        super().__init__(thing, problem)
        self.source = source
        self.line = line

    def __str__(self) -> str:
        """Render ``file:line: thing: problem``."""
        place = self.source if self.line is None else f"{self.source}:{self.line}"
        return f"{place}: {super().__str__()}"


class SourceErrors(LinegraphError):
    """Several errors of one file; the text has one line for each, at most a screenful.

    Args:
        errors: in the order of the file.
    """

    def __init__(self, errors: Iterable[SourceError]) -> None:
        """Keep all errors; the message lists the first `MOST_PRINTED`."""
        self.errors = tuple(errors)
        super().__init__("\n".join(self.messages()))

    def messages(self) -> list[str]:
        """Return one line for each error, then the number of those left out."""
        shown = [str(error) for error in self.errors[:MOST_PRINTED]]
        more = len(self.errors) - len(shown)
        return [*shown, f"and {more} more"] if more else shown


class NameRefused(LinegraphError):
    """A name that is not possible in emitted code, or two names that become equal there."""


class DeviceFailed(LinegraphError):
    """Writing failed for a reason other than the input: a full disk, a device, a pipe without a reader."""
