"""Every error a user can cause, as one small tree.

    LinegraphError
    ├── ModelError        the model says something that cannot be (a part, and why)
    │   └── SourceError   the same, with the file and the line that said it
    └── NameRefused       a name that cannot appear in emitted code

All carry one complete sentence for the user. A bug raises something else.
"""

from __future__ import annotations


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


class NameRefused(LinegraphError):
    """A name that emitted code cannot carry, or two names that become one there."""
