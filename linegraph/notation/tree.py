"""Formulas as trees of their meaning, without their appearance, which is left to the writers.

The order is decided here, once for all writers: factors as people write them (numbers, masses, lengths, then
functions of angles, then rates), summands likewise, with a positive one first. Nothing is expanded.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterable

MASS, GRAVITY, LENGTH, OTHER, COORDINATE, FUNCTION, RATE, ACCELERATION, INPUT = range(9)
"""Roles of names, in the order in which factors are written."""

Math: TypeAlias = (
    "Name | Numeral | Sum | Product | Fraction | Power | Root | FunctionCall | Components | Grid | "
    "TwoSides | Over | Raw"
)


@dataclass(frozen=True)
class Name:
    """A named quantity.

    Attributes:
        letter: a letter, a Greek letter, or a word that is one name.
        subs: its subscripts.
        dots: the number of time derivatives.
        bold: whether it is a vector or a matrix.
        before: an operator in front of it, such as δ.
        role: the kind of quantity, which decides its place among factors.
        place: its place among quantities of the same role.
    """

    letter: str
    subs: tuple[str, ...] = ()
    dots: int = 0
    bold: bool = False
    before: str = ""
    role: int = OTHER
    place: int = 0

    def rate(self) -> Name:
        """The time derivative, with one more dot."""
        role = ACCELERATION if self.role == RATE else RATE
        return replace(self, dots=self.dots + 1, role=role)


@dataclass(frozen=True)
class Numeral:
    """A number as it is written, without its sign, such as ``2.5`` or ``3e-5``.

    Attributes:
        text: digits, with ``e`` before an exponent.
        rounded: whether digits were left out.
    """

    text: str
    rounded: bool = False


@dataclass(frozen=True)
class Sum:
    """A sum: summands, each after a flag that is true if it is subtracted."""

    terms: tuple[tuple[bool, Math], ...]


@dataclass(frozen=True)
class Product:
    """A product of factors, with nothing, ``·`` or ``×`` between them."""

    factors: tuple[Math, ...]
    sign: str = ""


@dataclass(frozen=True)
class Fraction:
    """A fraction with numerator `above` and denominator `below`."""

    above: Math
    below: Math


@dataclass(frozen=True)
class Power:
    """A power; the exponent may be any tree, such as the T of a transposed matrix."""

    base: Math
    exponent: Math


@dataclass(frozen=True)
class Root:
    """The square root of a tree."""

    of: Math


@dataclass(frozen=True)
class FunctionCall:
    """A function with its arguments."""

    name: str
    arguments: tuple[Math, ...]


@dataclass(frozen=True)
class Components:
    """The components of a vector in brackets: (x, y, z)."""

    entries: tuple[Math, ...]


@dataclass(frozen=True)
class Grid:
    """A matrix, row by row."""

    rows: tuple[tuple[Math, ...], ...]


@dataclass(frozen=True)
class TwoSides:
    """An equation or another relation: two sides and the sign between them."""

    left: Math
    sign: str
    right: Math


@dataclass(frozen=True)
class Over:
    """An operator applied to a tree: Σ over a range, or d/dt."""

    sign: str
    under: str
    body: Math


@dataclass(frozen=True)
class Raw:
    """The output of another printer, as LaTeX and as plain text."""

    latex: str
    text: str


@dataclass(frozen=True)
class Traits:
    """Properties of a tree that decide its place among others.

    Attributes:
        highest, lowest: largest and smallest role of the names in it.
        functions: the number of functions in it.
        rates: the number of rates and accelerations.
        first: role and place of each name, in order.
    """

    highest: int = -1
    lowest: int = OTHER
    functions: int = 0
    rates: int = 0
    first: tuple[tuple[int, int], ...] = ()

    @cached_property
    def rank(self) -> float:
        """The place of a bracket among factors: beside its parameters, or after the highest role in it."""
        return (self.lowest if self.highest < COORDINATE else self.highest) + 0.5


def parts(tree: Math) -> tuple[Math, ...]:
    """The trees of which a tree is composed."""
    match tree:
        case Sum(terms):
            return tuple(term for _, term in terms)
        case Product(factors):
            return factors
        case Fraction(above, below):
            return (above, below)
        case Power(base, exponent):
            return (base, exponent)
        case Root(of):
            return (of,)
        case FunctionCall(_, arguments):
            return arguments
        case Components(entries):
            return entries
        case Grid(rows):
            return tuple(entry for row in rows for entry in row)
        case TwoSides(left, _, right):
            return (left, right)
        case Over(_, _, body):
            return (body,)
    return ()


def traits(tree: Math) -> Traits:
    """The properties that decide a tree's place."""
    if isinstance(tree, Name):
        rates = tree.role in (RATE, ACCELERATION)
        return Traits(tree.role, tree.role, 0, int(rates), ((tree.role, tree.place),))
    found = [traits(part) for part in parts(tree)]
    called = isinstance(tree, FunctionCall)
    return Traits(
        max([FUNCTION if called else -1, *(t.highest for t in found)]),
        min([OTHER, *(t.lowest for t in found)]),
        called + sum(t.functions for t in found),
        sum(t.rates for t in found),
        tuple(x for t in found for x in t.first),
    )


_CALLS = ("sin", "cos", "tan")


def _factor_key(tree: Math) -> tuple[Any, ...]:
    base = tree.base if isinstance(tree, Power) else tree
    if isinstance(base, Name):
        return (float(base.role), base.place, (base.letter, base.subs, base.dots))
    if isinstance(base, Numeral) or (
        isinstance(base, Fraction) and isinstance(base.below, Numeral)
    ):
        return (-1.0, 0, ())
    if isinstance(base, FunctionCall):
        place = _CALLS.index(base.name) if base.name in _CALLS else len(_CALLS)
        return (float(FUNCTION), place, tuple(repr(a) for a in base.arguments))
    return (traits(base).rank, 0, (repr(base),))


def _term_key(tree: Math) -> tuple[Any, ...]:
    """Orders summands: accelerations, rates, constants, coordinates, numbers, inputs; short ones first."""
    found = traits(tree)
    kind = 3 if isinstance(tree, Numeral) else 2
    if found.highest == INPUT:
        kind = 4
    elif found.highest == ACCELERATION:
        kind = 0
    elif found.rates:
        kind = 1
    led = min((place for role, place in found.first if role == ACCELERATION), default=0)
    size = len(tree.factors) if isinstance(tree, Product) else 1
    return (kind, led, found.functions, size, found.first, repr(tree))


def product(factors: Iterable[Math]) -> Math:
    """The product of factors, in order; products among them are merged, equal factors become powers."""
    flat: list[Math] = []
    for factor in factors:
        nested = isinstance(factor, Product) and not factor.sign
        flat += factor.factors if nested else (factor,)  # type: ignore[union-attr]
    flat = [f for f in flat if f != ONE]
    flat.sort(key=_factor_key)
    flat = _powers(flat)
    if not flat:
        return ONE
    return flat[0] if len(flat) == 1 else Product(tuple(flat))


def _powers(factors: list[Math]) -> list[Math]:
    """Equal adjacent factors as a power."""
    found: list[tuple[Math, int]] = []
    for factor in factors:
        base, count = factor, 1
        if isinstance(factor, Power) and isinstance(factor.exponent, Numeral):
            digits = factor.exponent.text
            base, count = (factor.base, int(digits)) if digits.isdigit() else (factor, 1)
        if found and found[-1][0] == base and not isinstance(base, Numeral):
            found[-1] = (base, found[-1][1] + count)
        else:
            found.append((base, count))
    return [base if n == 1 else Power(base, Numeral(str(n))) for base, n in found]


def total(terms: Iterable[tuple[bool, Math]], *, ordered: bool = True) -> Math:
    """The sum of terms, a positive one first; sums among them are merged.

    Args:
        terms: each after a flag that is true if it is subtracted.
        ordered: whether terms are sorted; otherwise they stay as given.
    """
    flat: list[tuple[bool, Math]] = []
    for negative, term in terms:
        if isinstance(term, Sum):
            flat += [(negative != own, inner) for own, inner in term.terms]
        elif term != ZERO:
            flat.append((negative, term))
    if ordered:
        flat.sort(key=lambda pair: _term_key(pair[1]))
        lead = next((k for k, (negative, _) in enumerate(flat) if not negative), 0)
        flat.insert(0, flat.pop(lead)) if flat else None
    if not flat:
        return ZERO
    if len(flat) == 1 and not flat[0][0]:
        return flat[0][1]
    return Sum(tuple(flat))


def negated(tree: Math) -> Math:
    """The tree with the opposite sign."""
    if isinstance(tree, Sum) and len(tree.terms) == 1:
        ((negative, term),) = tree.terms
        return term if negative else Sum(((True, term),))
    return ZERO if tree == ZERO else Sum(((True, tree),))


def rounded(tree: Math) -> bool:
    """Whether a number in the tree was rounded."""
    if isinstance(tree, Numeral):
        return tree.rounded
    return any(rounded(part) for part in parts(tree))


ZERO, ONE = Numeral("0"), Numeral("1")
TRANSPOSED = Name("T")
"""The exponent of a transposed matrix."""
