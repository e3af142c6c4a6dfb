"""Every error a user can cause, as one small tree.

    LinegraphError
    ├── ModelError        the model says something that cannot be (a part, and why)
    │   └── SourceError   the same, with the file and the line that said it
    ├── SourceErrors      all that is wrong with a file, at once
    ├── NameRefused       a name that cannot appear in emitted code
    └── DeviceFailed      what is written to failed: a full disk, a pipe without a reader

All carry one complete sentence for the user. A bug raises something else.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

MOST_PRINTED = 20


class LinegraphError(Exception):
    """Base of all errors that the input, not the program, is to blame for."""


class ModelError(LinegraphError):
    """The model cannot be: names the component and says what to do.

    Args:
        thing: what is at fault, as the user named it, e.g. ``joint "elbow"``.
        problem: what is wrong with it and what would be right.
    """

    def __init__(self, thing: str, problem: str) -> None:
        """Keep both parts, so that an importer can add file and line."""
        super().__init__(f"{thing}: {problem}" if thing else problem)
        self.thing = thing
        self.problem = problem


class SourceError(ModelError):
    """A `ModelError` placed in a file: ``robot.urdf:12: joint "elbow": ...``.

    Args:
        source: the file as the user named it.
        line: the line, counted from 1; None where the file as a whole is meant.
        thing: what is at fault.
        problem: what is wrong with it and what would be right.
    """

    def __init__(self, source: str, line: int | None, thing: str, problem: str) -> None:
        """Prefix the place to the message."""
        super().__init__(thing, problem)
        self.source = source
        self.line = line

    def __str__(self) -> str:
        """Render ``file:line: thing: problem``."""
        place = self.source if self.line is None else f"{self.source}:{self.line}"
        return f"{place}: {super().__str__()}"


class SourceErrors(LinegraphError):
    """Several errors of one file; as text one line each, not more than a screen of them.

    Args:
        errors: in the order of the file.
    """

    def __init__(self, errors: Iterable[SourceError]) -> None:
        """Keep them all."""
        self.errors = tuple(errors)
        super().__init__("\n".join(self.messages()))

    def messages(self) -> list[str]:
        """One line for each error, then how many more there are."""
        shown = [str(error) for error in self.errors[:MOST_PRINTED]]
        more = len(self.errors) - len(shown)
        return [*shown, f"and {more} more"] if more else shown


class NameRefused(LinegraphError):
    """A name that emitted code cannot carry, or two names that become one there."""


class DeviceFailed(LinegraphError):
    """Writing failed for a reason outside of the input: a full disk, a device, a pipe without a reader."""
