"""Errors and warnings about a URDF, each with its line."""

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
"""Largest number of warnings of one sort that are listed one by one."""
MOST_LISTED = 3
"""Number of names listed where equal warnings are merged."""
CLOSE = 0.75
"""Least similarity of an unknown tag and a known one for which a misspelling is assumed."""

IGNORED = "ignored, though this may affect the motion"
"""Text about an element that is not read and may change the equations."""

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
    """A warning before equal ones are merged.

    Attributes:
        line: its line in the file.
        kind, name: the thing it is about: ``joint``, ``elbow``; the name is None where there is only one.
        text: the warning.
        sort: text that replaces many warnings of this sort; empty to merge equal texts only.
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
        dropped: lines and tags of elements that may affect the motion and are not read.
    """

    def __init__(self, source: str) -> None:
        """Start without warnings."""
        self.source = shown(source, 1000)
        self.dropped: list[tuple[int, str]] = []
        self._warned: list[Warned] = []

    def warn(self, line: int, thing: str, text: str, sort: str = "") -> None:
        """Note a warning.

        Args:
            line: its line.
            thing: the thing it is about, as messages name it.
            text: the warning.
            sort: text that replaces many warnings of this sort; by default equal texts are merged.
        """
        kind, quote, name = thing.partition(' "')
        self._warned.append(Warned(line, kind, name[:-1] if quote else None, text, sort))

    def error(self, line: int | None, thing: str, problem: str) -> SourceError:
        """Return an error with its place; the caller raises it.

        Args:
            line: its line; None for the whole file.
            thing: the thing at fault, as messages name it.
            problem: what is wrong with it.
        """
        return SourceError(self.source, line, thing, problem)

    @contextmanager
    def placed(self, line: int, thing: str) -> Iterator[None]:
        """Add the place to errors of the model builder.

        Args:
            line: the line that caused them.
            thing: the thing at fault, as messages name it.
        """
        try:
            yield
        except ModelError as error:
            raise self.error(line, thing, error.problem) from error

    @property
    def warnings(self) -> list[str]:
        """All warnings in the order of the file, ``source:line: thing: text``, equal ones merged."""
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
    """The thing that merged warnings are about: its name, or the number of things and the first names."""
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


def named(kind: str, name: str) -> str:
    """Name of a part of the robot in messages: ``joint "elbow"``.

    Args:
        kind: ``link``, ``joint`` or another tag.
        name: its name.
    """
    return f'{kind} "{shown(name)}"'


def mechanical(tag: str) -> bool:
    """Whether the name of an element, without its prefix, contains a word of mechanics.

    Example:
        >>> mechanical("drake:rotor_inertia"), mechanical("loopJoint"), mechanical("d:joints_color_map")
        (True, True, False)
    """
    words = {word.lower() for word in _PART.findall(tag.rpartition(":")[2])}
    return not _MECHANICS.isdisjoint(words)


def nearest(name: str, known: Iterable[str], alike: float = 0.6) -> str:
    """A hint at the end of a message: the most similar known name, or nothing.

    Args:
        name: the unknown name.
        known: the known names.
        alike: least similarity, between 0 and 1.
    """
    from difflib import get_close_matches

    # difflib compares with every name; the limits keep hostile files from making that slow.
    candidates = [k for k in known if len(k) <= 4 * LONGEST_SHOWN][:5000]
    close = get_close_matches(name[: 4 * LONGEST_SHOWN], candidates, 1, alike)
    return f'; did you mean "{shown(close[0])}"?' if close else ""
