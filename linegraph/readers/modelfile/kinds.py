"""Kinds of values of keys: each reads a value, notes its errors and gives its JSON Schema.

The tables in `tables.py` are built from these. Reading returns the value for the builder, or `WRONG` after
errors were noted; it raises nothing, so that one run reports all errors of a file.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Protocol

from linegraph.readers.modelfile.expressions import Scope, number_problem, read_expression, value_of
from linegraph.readers.modelfile.names import name_problem
from linegraph.readers.modelfile.report import shown

if TYPE_CHECKING:
    from linegraph.readers.modelfile.expressions import Names
    from linegraph.readers.modelfile.report import Spot

LONGEST_LABEL = 400

WRONG: Final = object()
"""Returned in place of a value whose errors have been noted."""

Schema = dict[str, Any]


class Kind(Protocol):
    """A kind of value that a key may have."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Check a value and convert it for the builder.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            The value for the builder, or `WRONG` after its errors are noted.
        """
        ...

    def schema(self) -> Schema:
        """The JSON Schema of the values."""
        ...


def said(value: Any) -> str:
    """A value as messages show it: short, or by its type."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return f'"{shown(value, 40)}"'
    if isinstance(value, (int, float)):
        return shown(str(value), 40)
    if isinstance(value, (list, tuple)):
        return f"a list of {len(value)}"
    if isinstance(value, dict):
        return "a table"
    return "nothing" if value is None else "a date or time"


@dataclass(frozen=True)
class Real:
    """A number, or an expression in quotes.

    Attributes:
        scope: the names that the expression may use.
        least: the smallest value allowed; None for any.
        folded: whether an expression without names becomes its value. The value then decides the structure
            of the equations, as a zero angle does.
        own: further names that it may use.
    """

    scope: Scope = Scope.PARAMETERS
    least: float | None = None
    folded: bool = False
    own: tuple[str, ...] = ()

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read a number or an expression.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            The number, or the text of the expression, or `WRONG` after its errors are noted.
        """
        # bool is a subclass of int, but true is not a number of a model.
        if isinstance(value, bool) or not isinstance(value, (int, float, str)):
            spot.error(f"a number or an expression in quotes is wanted, not {said(value)}")
            return WRONG
        if not isinstance(value, str):
            problem = number_problem(value) or self._problem(value, str(value))
            if problem:
                spot.error(problem)
            return WRONG if problem else value
        return self._expression(value, spot, names)

    def _expression(self, text: str, spot: Spot, names: Names) -> Any:
        formula = read_expression(text, self.scope, spot, names, self.own)
        if formula is None:
            return WRONG
        before = spot.report.count
        value = value_of(formula, names, spot)
        problem = (
            self._problem(value, f"{shown(text, 40)} = {value:g}") if value is not None else ""
        )
        if problem:
            spot.error(problem)
        if spot.report.count > before:
            return WRONG
        constant = self.folded and not any(formula.names())
        return value if constant else text

    def _problem(self, value: float, text: str) -> str:
        if self.least is None or value >= self.least:
            return ""
        return f"is negative ({text}); it must be {self.least:g} or more"

    def schema(self) -> Schema:
        """The JSON Schema: a number or a string."""
        number: Schema = {"type": "number"}
        if self.least is not None:
            number["minimum"] = self.least
        return {"anyOf": [number, {"type": "string", "description": "an expression"}]}


@dataclass(frozen=True)
class Items:
    """A list of values of one kind, of fixed length.

    Attributes:
        kind: kind of each item.
        count: number of items.
        words: the list in words, for messages.
    """

    kind: Kind
    count: int
    words: str

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read a list of fixed length.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.
        """
        if not isinstance(value, list) or len(value) != self.count:
            spot.error(f"{self.words} is wanted, not {said(value)}")
            return WRONG
        items = tuple(self.kind.read(item, spot.at(i), names) for i, item in enumerate(value))
        return WRONG if any(item is WRONG for item in items) else items

    def schema(self) -> Schema:
        """The JSON Schema: an array of fixed length."""
        items = self.kind.schema()
        return {"type": "array", "items": items, "minItems": self.count, "maxItems": self.count}


def vector(scope: Scope = Scope.PARAMETERS, folded: bool = False) -> Items:
    """A list of three numbers or expressions.

    Args:
        scope: the names that expressions may use.
        folded: whether expressions without names become their values.
    """
    return Items(Real(scope, folded=folded), 3, "a list of three numbers")


@dataclass(frozen=True)
class Direction:
    """Three numbers, not all zero."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read a direction; it is not normalised, which the builder does.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.
        """
        found = vector(Scope.NUMBERS, folded=True).read(value, spot, names)
        if found is not WRONG and all(x == 0 for x in found):
            spot.error("has length zero; give a direction such as [0, 0, 1]")
            return WRONG
        return found

    def schema(self) -> Schema:
        """The JSON Schema of a vector."""
        return vector(Scope.NUMBERS).schema()


@dataclass(frozen=True)
class FreeText:
    """A label or a paragraph.

    Attributes:
        longest: largest number of characters.
        lines: whether it may have several lines, which are joined by spaces.
    """

    longest: int = LONGEST_LABEL
    lines: bool = False

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read a text without control characters.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.
        """
        if not isinstance(value, str):
            spot.error(f"a text in quotes is wanted, not {said(value)}")
            return WRONG
        if len(value) > self.longest:
            spot.error(f"has {len(value)} characters; at most {self.longest} can be shown")
            return WRONG
        plain = value.replace("\n", " ").replace("\t", " ") if self.lines else value
        if not plain.isprintable():
            spot.error("holds control characters or line ends; leave them out")
            return WRONG
        return " ".join(value.split()) if self.lines else value

    def schema(self) -> Schema:
        """The JSON Schema: a string of limited length."""
        return {"type": "string", "maxLength": self.longest}


@dataclass(frozen=True)
class Label:
    """A name that does not occur in expressions, so that it may have dots."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read a name.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.
        """
        problem = "" if isinstance(value, str) else f"a name in quotes is wanted, not {said(value)}"
        problem = problem or name_problem(value, dots=True)
        if problem:
            spot.error(problem)
        return WRONG if problem else value

    def schema(self) -> Schema:
        """The JSON Schema: a string that is not empty."""
        return {"type": "string", "minLength": 1}


@dataclass(frozen=True)
class Flag:
    """A truth value: true or false."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read a truth value; numbers and strings are errors.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.
        """
        if not isinstance(value, bool):
            spot.error(f"true or false is wanted, not {said(value)}")
            return WRONG
        return value

    def schema(self) -> Schema:
        """The JSON Schema of a boolean."""
        return {"type": "boolean"}


@dataclass(frozen=True)
class Word:
    """One of several fixed strings."""

    words: tuple[str, ...]

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read one of the fixed strings.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.
        """
        if isinstance(value, str) and value in self.words:
            return value
        known = " or ".join(f'"{word}"' for word in self.words)
        spot.error(f"{known} is wanted, not {said(value)}")
        return WRONG

    def schema(self) -> Schema:
        """The JSON Schema: an enumeration."""
        return {"enum": list(self.words)}


@dataclass(frozen=True)
class Terminal:
    """A terminal: a body or a frame of a body."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read the name of an existing terminal.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            The name, ``body`` or ``body.frame``, or `WRONG` after its errors are noted.
        """
        if not isinstance(value, str):
            spot.error(f'"body" or "body.frame" is wanted, not {said(value)}')
            return WRONG
        if value not in names.terminals:
            ground = value in ("world", "base", "inertial", "fixed")
            hint = (
                '; did you mean "ground"?' if ground else spot.report.hint(value, names.terminals)
            )
            spot.error(f'there is no body or frame "{shown(value)}"{hint}')
            return WRONG
        return value

    def schema(self) -> Schema:
        """The JSON Schema: a string with a description."""
        return {"type": "string", "description": '"body" or "body.frame"; "ground" is a body too'}


@dataclass(frozen=True)
class Ends:
    """Two terminals of different bodies: tail and head."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read tail and head of an edge.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            The tuple (tail, head), or `WRONG` after its errors are noted.
        """
        ends = Items(Terminal(), 2, "[tail, head], two bodies or frames,").read(value, spot, names)
        if ends is WRONG:
            return WRONG
        tail, head = (names.terminals[end] for end in ends)
        if tail == head:
            spot.error(f'connects body "{shown(tail)}" to itself')
            return WRONG
        return ends

    def schema(self) -> Schema:
        """The JSON Schema: a pair of strings."""
        return Items(Terminal(), 2, "").schema()


@dataclass(frozen=True)
class JointName:
    """A joint of the file with one degree of freedom."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read the name of an existing joint.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.
        """
        if not isinstance(value, str):
            spot.error(f"the name of a joint is wanted, not {said(value)}")
            return WRONG
        if value not in names.joints:
            hint = spot.report.hint(value, names.joints)
            spot.error(f'there is no joint "{shown(value)}"{hint}')
            return WRONG
        freedoms = names.joints[value]
        if freedoms not in (1, None):
            problem = f'joint "{shown(value)}" has {freedoms} degrees of freedom; it must have one'
            spot.error(problem)
            return WRONG
        return value

    def schema(self) -> Schema:
        """The JSON Schema of a string."""
        return {"type": "string"}
