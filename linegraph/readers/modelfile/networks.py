"""Kinds of values of network components: vertices, windings, matrices, equations; tables of components.

The tables follow from the dataclasses in the register of components, like those of joints and elements.
"""

from __future__ import annotations

from dataclasses import MISSING, dataclass, fields
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import DOMAINS, SPATIAL
from linegraph.components.scalar import COMPONENTS
from linegraph.components.scalar.base import ACROSS, THROUGH, Component
from linegraph.components.scalar.element import LawEquation
from linegraph.readers.modelfile.expressions import Scope, read_expression
from linegraph.readers.modelfile.fields import Field, Table
from linegraph.readers.modelfile.kinds import (
    WRONG,
    Ends,
    Flag,
    FreeText,
    Items,
    JointName,
    Real,
    Schema,
    Word,
    said,
)
from linegraph.readers.modelfile.names import name_problem

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from linegraph.readers.modelfile.expressions import Names
    from linegraph.readers.modelfile.kinds import Kind
    from linegraph.readers.modelfile.report import Spot

MOST_ENTRIES = 100


@dataclass(frozen=True)
class Vertex:
    """A vertex of a network: any name; "ground" is the reference."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read the name of a vertex, which need not be declared.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            The name, or `WRONG` after its errors are noted.
        """
        problem = (
            "" if isinstance(value, str) else f"the name of a vertex is wanted, not {said(value)}"
        )
        problem = problem or name_problem(value, dots=True)
        if problem:
            spot.error(problem)
        return WRONG if problem else value

    def schema(self) -> Schema:
        """The JSON Schema: a string that is not empty."""
        return {"type": "string", "minLength": 1}


@dataclass(frozen=True)
class DomainName:
    """The name of a scalar domain."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read the name of a domain, built in or defined in the file.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            The name, or `WRONG` after its errors are noted.
        """
        known = [*(name for name in DOMAINS if name not in SPATIAL), *sorted(names.domains)]
        if isinstance(value, str) and value in known:
            return value
        hint = spot.report.hint(value, known) if isinstance(value, str) else ""
        spot.error(f"a domain is wanted ({', '.join(known)}), not {said(value)}{hint}")
        return WRONG

    def schema(self) -> Schema:
        """The JSON Schema: a string, since files may define domains."""
        return {"type": "string"}


@dataclass(frozen=True)
class Several:
    """A list of values of one kind, with at least one item.

    Attributes:
        kind: kind of each item.
        what: the list in words, for messages.
    """

    kind: Kind
    what: str

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read a list with at least one item.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            A tuple, or `WRONG` after its errors are noted.
        """
        if not isinstance(value, list) or not 0 < len(value) <= MOST_ENTRIES:
            spot.error(f"{self.what} is wanted, not {said(value)}")
            return WRONG
        found = tuple(self.kind.read(item, spot.at(i), names) for i, item in enumerate(value))
        return WRONG if any(item is WRONG for item in found) else found

    def schema(self) -> Schema:
        """The JSON Schema: an array that is not empty."""
        return {"type": "array", "items": self.kind.schema(), "minItems": 1}


@dataclass(frozen=True)
class LawText:
    """An equation in quotes.

    Attributes:
        own: variables of the component that it may use.
    """

    own: tuple[str, ...]

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read an equation, two expressions with one equals sign between them.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            The equation, or `WRONG` after its errors are noted.
        """
        if not isinstance(value, str) or value.count("=") != 1:
            spot.error(f'an equation such as "y = f(x)" is wanted, not {said(value)}')
            return WRONG
        sides = [
            read_expression(side, Scope.NETWORK, spot, names, self.own) for side in value.split("=")
        ]
        left, right = sides
        return WRONG if left is None or right is None else LawEquation(left, right)

    def schema(self) -> Schema:
        """The JSON Schema: a string with one equals sign."""
        return {"type": "string", "pattern": "^[^=]+=[^=]+$"}


_VERTICES = Items(Vertex(), 2, "[tail, head], two vertices,")
_PLACED: Mapping[str, Kind] = {
    "between": _VERTICES,
    "second": _VERTICES,
    "output": _VERTICES,
    "shaft": _VERTICES,
    "points": Ends(),
    "joint": JointName(),
    "windings": Several(_VERTICES, "a list of windings, each [tail, head],"),
    "of": Several(Vertex(), "a list of names of components or force elements"),
    "domain": DomainName(),
    "domains": Items(DomainName(), 2, "a list of two domains"),
    "keeps": Word((ACROSS, THROUGH)),
}
"""Kinds of the fields that have the same meaning in all components."""


def component_table(name: str, abouts: Callable[[type], dict[str, str]]) -> Table:
    """The table of a component type.

    Args:
        name: the type's name in the register.
        abouts: returns descriptions of the fields of a dataclass, by name.
    """
    kind = COMPONENTS[name]
    told = abouts(kind)
    required = {*kind.required, "between", "second", "output", "windings", "of"}
    entries = {
        f.name: Field(
            _kind_of(kind, f.name, str(f.type)),
            told.get(f.name, "").rstrip("."),
            f.name in required and (f.default is MISSING or f.name in kind.required),
        )
        for f in fields(kind)
        if f.name != "name"
    }
    if name == "element":
        entries["domain"] = Field(DomainName(), told["domain"].rstrip("."), True)
    groups = kind.needs
    places = tuple(key for key in ("joint", "points", "shaft") if key in entries)
    if places:
        groups = (*groups, places)
    about = (kind.__doc__ or "").strip().split("\n")[0]
    return Table(entries, groups, groups, about)


def _kind_of(kind: type[Component], key: str, annotation: str) -> Kind:
    own = kind.own.get(key, ())
    if key in _PLACED:
        return _PLACED[key]
    if kind.kind == "element":
        names = ("x", "y", "s")
        return LawText(names) if key == "law" else Real(Scope.NETWORK, own=names)
    number = Real(Scope.NETWORK, own=own)
    if annotation == "tuple[tuple[Any, ...], ...]":
        return Several(Several(number, "a row of the matrix, a list,"), "a matrix, a list of rows,")
    if annotation.startswith("tuple[Any, ...]"):
        return Several(number, "a list of numbers or expressions")
    return number


VARIABLE = Table(
    {
        "name": Field(FreeText(), "what it is called", True),
        "unit": Field(FreeText(), "its unit, such as Pa or m^3/s", True),
        "letter": Field(FreeText(8), "what names of states begin with", True),
    }
)
DOMAIN = Table(
    {
        "across": Field(VARIABLE, "the variable measured between the ends of an edge", True),
        "through": Field(VARIABLE, "the variable that flows along an edge", True),
        "power": Field(Flag(), "whether through times across is a power; true if left out"),
    },
    about="a power subspace of the file's own",
)
