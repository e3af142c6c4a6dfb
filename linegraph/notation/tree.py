"""Formulas as trees that say what is meant and not how it is set: the writers beside this file do that.

Order is decided here, once for all writers: factors as people write them (numbers, masses, lengths, then
functions of angles, then rates), summands likewise, a positive one first. Nothing is multiplied out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterable

MASS, GRAVITY, LENGTH, OTHER, COORDINATE, FUNCTION, RATE, ACCELERATION, INPUT = range(9)
"""What a name stands for; the order of factors."""

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
        dots: how often it is differentiated by time.
        bold: whether it is a vector or a matrix.
        before: an operator in front of it: δ.
        role: what it stands for.
        place: where it stands among its like.
    """

    letter: str
    subs: tuple[str, ...] = ()
    dots: int = 0
    bold: bool = False
    before: str = ""
    role: int = OTHER
    place: int = 0

    def rate(self) -> Name:
        """Its derivative by time."""
        role = ACCELERATION if self.role == RATE else RATE
        return replace(self, dots=self.dots + 1, role=role)


@dataclass(frozen=True)
class Numeral:
    """A number as it is written, without its sign, such as ``2.5`` or ``3e-5``.

    Attributes:
        rounded: whether digits were left out.
    """

    text: str
    rounded: bool = False


@dataclass(frozen=True)
class Sum:
    """Summands, each with whether it is subtracted."""

    terms: tuple[tuple[bool, Math], ...]


@dataclass(frozen=True)
class Product:
    """Factors; between them nothing, ``·`` or ``×``."""

    factors: tuple[Math, ...]
    sign: str = ""


@dataclass(frozen=True)
class Fraction:
    """A fraction."""

    above: Math
    below: Math


@dataclass(frozen=True)
class Power:
    """A power; the exponent may be any text, such as T of a transposed matrix."""

    base: Math
    exponent: Math


@dataclass(frozen=True)
class Root:
    """A square root."""

    of: Math


@dataclass(frozen=True)
class FunctionCall:
    """A function of something."""

    name: str
    arguments: tuple[Math, ...]


@dataclass(frozen=True)
class Components:
    """Components in brackets: (x, y, z)."""

    entries: tuple[Math, ...]


@dataclass(frozen=True)
class Grid:
    """A matrix, row by row."""

    rows: tuple[tuple[Math, ...], ...]


@dataclass(frozen=True)
class TwoSides:
    """Two sides."""

    left: Math
    sign: str
    right: Math


@dataclass(frozen=True)
class Over:
    """An operator over what follows: Σ over something, or d/dt."""

    sign: str
    under: str
    body: Math


@dataclass(frozen=True)
class Raw:
    """What another printer has written."""

    latex: str
    text: str


@dataclass(frozen=True)
class Traits:
    """What decides where a tree stands among others."""

    highest: int = -1
    lowest: int = OTHER
    functions: int = 0
    rates: int = 0
    first: tuple[tuple[int, int], ...] = ()

    @cached_property
    def rank(self) -> float:
        """Of a bracket among factors: with its parameters, or behind what it contains."""
        return (self.lowest if self.highest < COORDINATE else self.highest) + 0.5


def parts(tree: Math) -> tuple[Math, ...]:
    """What a tree is made of."""
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
    """What a tree contains."""
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
    """Accelerations, rates, the rest with constants first, numbers, inputs; shorter before longer."""
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
    """Factors in order, those of products among them, too."""
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
    """Equal factors beside each other as a power."""
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
    """Summands in order, a positive one first; sums among them become part of it."""
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
    """The same with its sign turned."""
    if isinstance(tree, Sum) and len(tree.terms) == 1:
        ((negative, term),) = tree.terms
        return term if negative else Sum(((True, term),))
    return ZERO if tree == ZERO else Sum(((True, tree),))


def rounded(tree: Math) -> bool:
    """Whether a number in it lacks digits."""
    if isinstance(tree, Numeral):
        return tree.rounded
    return any(rounded(part) for part in parts(tree))


ZERO, ONE = Numeral("0"), Numeral("1")
TRANSPOSED = Name("T")
"""The exponent of a transposed matrix."""
