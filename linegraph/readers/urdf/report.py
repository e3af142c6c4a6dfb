"""What is said about a file: errors and warnings, each with its place."""

from __future__ import annotations

import re
from collections import Counter
from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple

from linegraph.errors import ModelError, SourceError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

LONGEST_SHOWN = 80
MOST_APART = 3
"""So many warnings of one sort are told one by one."""
MOST_LISTED = 3
"""So many names are listed where equal warnings are gathered."""
CLOSE = 0.75
"""How alike the name of an unknown element and a known one are where one is meant to be the other."""

IGNORED = "ignored, though this may affect the motion"
"""What to tell of an element that is not read and would change the equations."""

_MECHANICS = frozenset(
    {
        *(
            "joint",
            "loop",
            "constraint",
            "bushing",
            "coupler",
            "tendon",
            "weld",
            "mimic",
            "equality",
        ),
        *("inertia", "inertial", "mass", "rotor", "armature", "gear", "gearbox", "pitch"),
        *("spring", "stiffness", "damper", "damping", "friction"),
    }
)
_PART = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")


class Warned(NamedTuple):
    """A warning, before equal ones are gathered.

    Attributes:
        kind, name: of the part it is about: ``joint``, ``elbow``; the name is None where there is only one.
        text: what it says.
        sort: what many of this sort have in common; empty where the texts themselves are alike.
    """

    line: int
    kind: str
    name: str | None
    text: str
    sort: str


class UrdfReport:
    """Collects the warnings of one file and places its errors.

    Args:
        source: the file as the user named it.

    Attributes:
        dropped: elements that say something of the motion and are not read: lines and tags.
    """

    def __init__(self, source: str) -> None:
        """Start without warnings."""
        self.source = shown(source, 1000)
        self.dropped: list[tuple[int, str]] = []
        self._warned: list[Warned] = []

    def warn(self, line: int, thing: str, text: str, sort: str = "") -> None:
        """Note something that a user should know but that stops nothing.

        Args:
            line: where it is.
            thing: what it is about, as messages call it.
            text: what to tell.
            sort: what to tell where many of this sort are gathered; else those of equal text are.
        """
        kind, quote, name = thing.partition(' "')
        self._warned.append(Warned(line, kind, name[:-1] if quote else None, text, sort))

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
        """All warnings in the order of the file, each ``source:line: thing: text``, equal ones as one."""
        ordered = sorted(self._warned, key=lambda warned: warned.line)
        sorts = Counter((w.kind, w.sort) for w in ordered if w.sort)
        groups: dict[tuple[str, str], list[Warned]] = {}
        for warned in ordered:
            many = sorts[(warned.kind, warned.sort)] > MOST_APART
            groups.setdefault((warned.kind, warned.sort if many else warned.text), []).append(
                warned
            )
        return [
            f"{self.source}:{group[0].line}: {_things(group)}: {text}"
            for (_, text), group in groups.items()
        ]


def _things(group: Sequence[Warned]) -> str:
    """What warnings of one text are about: one thing by its name, of several how many and the first."""
    kind = group[0].kind
    names = list(dict.fromkeys(w.name for w in group if w.name is not None))
    if not names:
        return kind
    if len(names) == 1:
        return f'{kind} "{names[0]}"'
    listed = ", ".join(f'"{name}"' for name in names[:MOST_LISTED])
    more = len(names) - MOST_LISTED
    return f"{len(names)} {kind}s ({listed}{f' and {more} more' if more > 0 else ''})"


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


def mechanical(tag: str) -> bool:
    """Whether the name of an element, its prefix left out, tells of mechanics.

    Example:
        >>> mechanical("drake:rotor_inertia"), mechanical("loopJoint"), mechanical("d:joints_color_map")
        (True, True, False)
    """
    words = {word.lower() for word in _PART.findall(tag.rpartition(":")[2])}
    return not _MECHANICS.isdisjoint(words)


def nearest(name: str, known: Iterable[str], alike: float = 0.6) -> str:
    """A hint that ends a message: the known name most like `name`, or nothing.

    `alike` is how much, between 0 and 1.
    """
    from difflib import get_close_matches

    # difflib compares with every name: hostile files must not make that slow
    candidates = [k for k in known if len(k) <= 4 * LONGEST_SHOWN][:5000]
    close = get_close_matches(name[: 4 * LONGEST_SHOWN], candidates, 1, alike)
    return f'; did you mean "{shown(close[0])}"?' if close else ""
