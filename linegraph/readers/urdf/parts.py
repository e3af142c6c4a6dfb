"""XML elements with context: strict access to children, strings and numbers; errors name the place."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, NamedTuple

from linegraph.readers.urdf.report import (
    CLOSE,
    IGNORED,
    UrdfReport,
    mechanical,
    named,
    nearest,
    shown,
)

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from linegraph.errors import SourceError
    from linegraph.readers.urdf.document import XmlElement

LARGEST = 1e50
"""Limit of numbers: above any quantity of a robot in SI units, and products of several stay finite."""

LONGEST_NUMBER = 400
"""Longest number in characters: more than any representation of a double needs."""

# Numbers as in URDF; float() would also accept 1_0, nan, inf and digits of other scripts.
# No two parts can match the same digits, so matching takes linear time.
_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_WORD = re.compile(r"[^ \t\r\n]+")
_XACRO = ("${", "$(")
_RUN_XACRO = "is a xacro expression; run xacro first and give its output"


class XmlPart(NamedTuple):
    """An XML element with the thing it belongs to.

    Attributes:
        report: receives warnings and places errors.
        thing: name of its owner in messages, such as ``joint "elbow"``.
        element: the element.
    """

    report: UrdfReport
    thing: str
    element: XmlElement

    def fail(self, problem: str) -> SourceError:
        """Return an error about the element; the caller raises it."""
        return self.report.error(self.element.line, self.thing, problem)

    def warn(self, text: str, sort: str = "") -> None:
        """Warn about the element.

        Args:
            text: the warning.
            sort: text that replaces many warnings of this sort; see `UrdfReport.warn`.
        """
        self.report.warn(self.element.line, self.thing, text, sort)

    def child(self, tag: str) -> XmlPart | None:
        """The child element with a tag, if there is one.

        Raises:
            SourceError: there are two.
        """
        found = [child for child in self.element.children if child.tag == tag]
        if len(found) > 1:
            first, second = found[:2]
            problem = f"has two <{tag}> (the first on line {first.line}); one of them must go"
            raise self.report.error(second.line, self.thing, problem)
        return XmlPart(self.report, self.thing, found[0]) if found else None

    def need(self, tag: str) -> XmlPart:
        """The child element with a tag.

        Raises:
            SourceError: there is none, or there are two.
        """
        found = self.child(tag)
        if found is None:
            hint = nearest(tag, (child.tag for child in self.element.children))
            raise self.fail(f"<{self.element.tag}> has no <{tag}>{hint}")
        return found

    def word(self, attribute: str) -> str:
        """A required attribute.

        Raises:
            SourceError: it is missing, or contains an expression of xacro.
        """
        text = self.element.attributes.get(attribute)
        if text is None:
            others = ", ".join(f'"{shown(other)}"' for other in list(self.element.attributes)[:8])
            found = f", only {others}" if others else ""
            raise self.fail(f'<{self.element.tag}> has no attribute "{attribute}"{found}')
        if any(mark in text for mark in _XACRO):
            raise self.fail(f'<{self.element.tag}> {attribute}="{shown(text)}" {_RUN_XACRO}')
        return text

    def numbers(
        self, attribute: str, count: int, default: tuple[float, ...] | None = None
    ) -> tuple[float, ...]:
        """An attribute with exactly `count` finite numbers, separated by white space.

        Args:
            attribute: its name.
            count: how many numbers.
            default: value of a missing attribute; None if it is required.

        Raises:
            SourceError: it is missing or has other content; the message shows the text.
        """
        if default is not None and attribute not in self.element.attributes:
            return default
        text = self.word(attribute)
        words = _WORD.findall(text)
        said = f'<{self.element.tag}> {attribute}="{shown(text)}"'
        for word in words:
            if len(word) > LONGEST_NUMBER or not _NUMBER.fullmatch(word):
                raise self.fail(f'{said}: "{shown(word, 40)}" is not a finite decimal number')
        if len(words) != count:
            needed = "one number" if count == 1 else f"{count} numbers"
            raise self.fail(f"{said}: {needed} needed, got {len(words)}")
        values = tuple(float(word) for word in words)
        if any(abs(value) > LARGEST for value in values):
            raise self.fail(f"{said}: beyond any quantity in SI units ({LARGEST:.0e})")
        return values

    def number(self, attribute: str, default: float | None = None) -> float:
        """An attribute with one finite number.

        Args:
            attribute: its name.
            default: value of a missing attribute; None if it is required.

        Raises:
            SourceError: it is missing or has other content.
        """
        return self.numbers(attribute, 1, None if default is None else (default,))[0]

    def check_children(self, known: Sequence[str], ignored: Collection[str]) -> None:
        """Warn about unknown children, once for each tag; those with a prefix are extensions.

        Args:
            known: tags that are read.
            ignored: tags known to have no effect.
        """
        said: set[str] = set()
        for child in self.element.children:
            tag = child.tag
            if tag in known or tag in ignored or ":" in tag or tag in said:
                continue
            said.add(tag)
            hint = nearest(tag, known, CLOSE)
            text = f"<{shown(tag)}> is not known and ignored{hint}"
            if not hint and mechanical(tag):
                self.report.dropped.append((child.line, tag))
                text = f"<{shown(tag)}> is not known and {IGNORED}"
            self.report.warn(child.line, self.thing, text)

    def check_attributes(self, known: Sequence[str], ignored: Collection[str] = ()) -> None:
        """Warn about unknown attributes; those with a prefix are extensions.

        Args:
            known: attributes that are read.
            ignored: attributes known to have no effect.
        """
        for attribute in self.element.attributes:
            if attribute not in known and attribute not in ignored and attribute[0] != "{":
                missing = [name for name in known if name not in self.element.attributes]
                hint = nearest(attribute, missing)
                where = f'<{self.element.tag}> attribute "{shown(attribute)}"'
                self.warn(f"{where} is not known and ignored{hint}")


def named_part(report: UrdfReport, element: XmlElement) -> tuple[str, XmlPart]:
    """The name of a link or joint, and the element with that name as its context.

    Args:
        report: receives warnings and places errors.
        element: the ``<link>`` or ``<joint>``.

    Raises:
        SourceError: the name is missing, blank or not printable.
    """
    name = XmlPart(report, f"<{element.tag}>", element).word("name")
    part = XmlPart(report, named(element.tag, name), element)
    if not name.strip():
        raise part.fail("the name is blank")
    for character in name:
        if not character.isprintable():
            raise part.fail(f"the name holds U+{ord(character):04X}, which cannot be printed")
    return name, part


def length(vector: Sequence[float]) -> float:
    """The Euclidean norm of a vector, without underflow."""
    return math.hypot(*vector)
