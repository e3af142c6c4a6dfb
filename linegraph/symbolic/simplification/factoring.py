"""From terms to a textbook form: collected in rates, inertias grouped, common factors out.

1. The coefficient of each product of rates, accelerations, inputs or multipliers is collected, and
products with the same coefficient share it: m l sin b (2 a' b' + b'^2).

2. Within a coefficient, that of each product of functions of angles is collected: (J + m l^2) sin^2 a.

3. The factor that most terms share is taken out, and so on recursively. A short sum that factors into
sums is written as a product.
"""

from __future__ import annotations

from fractions import Fraction
from functools import reduce
from math import gcd
from typing import TYPE_CHECKING, Any

import sympy

from linegraph.algebra.sympy_scalars import RENAMED, Expr
from linegraph.symbolic.simplification.factor_lists import (
    CommonFactor,
    Term,
    denominator_of,
    factor_list,
    worth_factoring,
)
from linegraph.symbolic.simplification.generators import (
    COS,
    FUNCTION,
    ROOT,
    SIN,
    SYMBOL,
    Harmonic,
    unit,
)
from linegraph.symbolic.simplification.numbers import Terms, near, plain, readable, reciprocal

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.ir.dag import Number
    from linegraph.symbolic.simplification.polynomial import Ring

PARAMETERS = "p"
MOVING = ("v", "a", "u", "lam")
DIGITS = 12
"""Sums with floats are proportional if their coefficients agree in this number of digits."""


class SympyWriter:
    """Writes the terms of a ring as SymPy expressions.

    Args:
        ring: of the terms.
        symbol: returns the expression of a symbol, given its argument and place.
        inner: writes the polynomial inside a root, an inverse or a function.
    """

    def __init__(
        self,
        ring: Ring,
        symbol: Callable[[Symbol], Expr],
        inner: Callable[[Terms], Expr] | None = None,
    ) -> None:
        """Start without expressions; each generator is written once."""
        self.ring = ring
        self._symbol = symbol
        self._inner = inner or self.written
        self._known: dict[int, Expr] = {}
        self._constants: dict[int, bool] = {}

    def written(self, terms: Terms) -> Expr:
        """The terms collected and factored; parameters that all terms share come first."""
        outside = self._shared_parameters(terms)
        times = _scale(terms.values()) * _sign(terms.values(), ()) if outside else 1
        terms = {term - outside: near(k * reciprocal(times)) for term, k in terms.items()}
        coefficients: dict[int, Terms] = {}
        for term, k in sorted(terms.items()):
            moving = sum(unit(p, e) for p, e in self.ring.exponents(term) if self.moves(p))
            coefficients.setdefault(moving, {})[term - moving] = k
        shared: dict[Any, tuple[Terms, Terms]] = {}
        for moving, coefficient in coefficients.items():
            common, rest = self.ring.primitive(coefficient, clear=False)
            ((outer, k),) = common.items()
            key = (outer, tuple((t, _rounded(x)) for t, x in sorted(rest.items())), bool(moving))
            first, members = shared.setdefault(key, (coefficient, {}))
            own = first[min(first)]
            members[moving] = near(coefficient[min(coefficient)] * reciprocal(own))
        whole = sympy.Add(*(self._collected(*pair) for pair in shared.values()))
        return sympy.Mul(self.expanded({outside: times}), whole)

    def _shared_parameters(self, terms: Terms) -> int:
        """The powers of parameters that occur in every term."""
        if len(terms) < 2:
            return 0
        (common,) = self.ring.primitive(terms, clear=False)[0]
        return sum(unit(p, e) for p, e in self.ring.exponents(common) if self.constant(p))

    def _collected(self, coefficient: Terms, moving: Terms) -> Expr:
        """One coefficient with all products that it multiplies."""
        if moving == {0: 1}:
            return self.nested(self.grouped(coefficient))
        inside = _scale(moving.values()) * _sign(moving.values(), coefficient.values())
        rates = self.nested(
            self._terms({t: near(k * reciprocal(inside)) for t, k in moving.items()})
        )
        outside = _scale(coefficient.values()) if len(coefficient) > 1 else 1
        inner = {t: near(k * reciprocal(outside)) for t, k in coefficient.items()}
        return sympy.Mul(number(near(inside * outside)), self.nested(self.grouped(inner)), rates)

    def expanded(self, terms: Terms) -> Expr:
        """The terms as a plain sum."""
        return sympy.Add(*(self._product(term) for term in self._terms(terms)))

    # -- factors

    def generator(self, place: int) -> Expr:
        """A generator as an expression, written once."""
        if place not in self._known:
            kind, content = self.ring.generators[place]
            self._known[place] = self._of(kind, content)
        return self._known[place]

    def _of(self, kind: str, content: Any) -> Expr:
        if kind == SYMBOL:
            return self._symbol(content)
        if kind in (SIN, COS):
            return (sympy.sin if kind == SIN else sympy.cos)(self.angle(content))
        if kind == FUNCTION:
            name, given = content
            parts = [self._inner(dict(part)) for part in given]
            return getattr(sympy, RENAMED.get(name, name))(*parts)
        inner = self._inner(dict(content))
        return sympy.sqrt(inner) if kind == ROOT else 1 / inner

    def angle(self, harmonic: Harmonic) -> Expr:
        """A sum of multiples of angles as an expression."""
        parts = [n * self._inner(dict(self.ring.angles[angle])) for angle, n in harmonic]
        return sympy.Add(*parts)

    def _factor(self, factor: CommonFactor) -> Expr:
        if factor.kernel:
            return self.nested(self._terms(dict(factor.kernel)))
        return self.generator(factor.place)

    def constant(self, place: int) -> bool:
        """Whether a generator depends on parameters alone."""
        if place not in self._constants:
            kind, content = self.ring.generators[place]
            if kind == SYMBOL:
                found = content[0] == PARAMETERS
            elif kind in (SIN, COS):
                found = False
            else:
                found = all(
                    self.constant(p)
                    for t in self._within(kind, content)
                    for p, _ in self.ring.exponents(t)
                )
            self._constants[place] = found
        return self._constants[place]

    def moves(self, place: int) -> bool:
        """Whether a generator is a rate, an acceleration, an input or a multiplier."""
        kind, content = self.ring.generators[place]
        return kind == SYMBOL and content[0] in MOVING

    def _within(self, kind: str, content: Any) -> list[int]:
        """The terms inside a generator."""
        if kind in (SIN, COS):
            return [term for angle, _ in content for term, _ in self.ring.angles[angle]]
        inner = content[1] if kind == FUNCTION else (content,)
        return [term for part in inner for term, _ in part]

    # -- terms

    def _terms(self, terms: Terms) -> list[Term]:
        return [
            Term(k, tuple((CommonFactor(place, ()), e) for place, e in self.ring.exponents(term)))
            for term, k in sorted(terms.items())
        ]

    def grouped(self, terms: Terms) -> list[Term]:
        """Terms with the coefficient of each product of rates and angles as one factor, if it is a sum."""
        groups: dict[int, Terms] = {}
        for term, k in sorted(terms.items()):
            varying = sum(unit(p, e) for p, e in self.ring.exponents(term) if not self.constant(p))
            groups.setdefault(varying, {})[term - varying] = k
        kernels: dict[Any, list[tuple[int, int, Terms, Number]]] = {}
        for varying, inner in groups.items():
            common, rest = self.ring.primitive(inner, clear=False)
            ((shared, k),) = common.items()
            key = tuple((t, _rounded(x)) for t, x in sorted(rest.items()))
            kernels.setdefault(key, []).append((varying, shared, inner, k))
        found: list[Term] = []
        for members in kernels.values():
            first_varying, outer, inner, own = members[0]
            if len(inner) == 1 or (len(members) == 1 and first_varying == 0):
                found += self._terms(
                    {t + v: x for v, _, terms, _ in members for t, x in terms.items()}
                )
                continue
            outside = [k * reciprocal(own) for _, _, _, k in members]
            scale = _scale(inner.values()) * _sign(inner.values(), outside)
            terms = {t - outer: near(x * reciprocal(scale)) for t, x in sorted(inner.items())}
            kernel = CommonFactor(-1, tuple(terms.items()))
            for varying, outer, _, k in members:
                times = near(k * reciprocal(own) * scale)
                (own_term,) = self._terms({varying + outer: times})
                found.append(Term(times, ((kernel, 1), *own_term.factors)))
        return found

    def nested(self, terms: Sequence[Term]) -> Expr:
        """Common factors out, then the one that most terms share, and so on."""
        if not terms:
            return sympy.Integer(0)
        if len(terms) == 1:
            return self._product(terms[0])
        common = _common(terms)
        if common:
            k = _content(terms)
            inner = [_divided(term, k, common) for term in terms]
            outer = [self._factor(f) ** e for f, e in common]
            return sympy.Mul(number(k), *outer, self.nested(inner))
        alike = self._alike(terms)
        if alike:
            rest = [term for term in terms if term not in alike]
            k = _content(alike)
            inside = self.nested([_divided(term, k, ()) for term in alike])
            # otherwise SymPy distributes the number over the sum
            whole = sympy.Mul(number(k), inside, evaluate=not inside.is_Add)
            return sympy.Add(whole, self.nested(rest))
        as_product = self._as_product(terms)
        if as_product is not None:
            return as_product
        best = self._most_shared(terms)
        if best is None:
            return sympy.Add(*(self._product(term) for term in terms))
        having = [term for term in terms if best in term.factors]
        rest = [term for term in terms if best not in term.factors]
        return sympy.Add(self.nested(having), self.nested(rest))

    def _alike(self, terms: Sequence[Term]) -> list[Term]:
        """Terms with the same float as coefficient: all, or the most if no factor is shared by more."""
        sizes: dict[Number, list[Term]] = {}
        for term in terms:
            if isinstance(term.coefficient, float):
                sizes.setdefault(_rounded(_size(term.coefficient)), []).append(term)
        most = max(sizes.values(), key=len, default=[])
        if len(most) < 2 or (len(most) < len(terms) and self._most_shared(terms)):
            return []
        return most

    def _most_shared(self, terms: Sequence[Term]) -> tuple[CommonFactor, int] | None:
        """The power that most terms have; among equals a sum, then a variable factor, then the first."""
        counts: dict[tuple[CommonFactor, int], int] = {}
        for term in terms:
            for power in term.factors:
                counts[power] = counts.get(power, 0) + 1

        def rank(power: tuple[CommonFactor, int]) -> tuple[Any, ...]:
            factor, exponent = power
            varies = factor.kernel or not self.constant(factor.place)
            return -counts[power], not factor.kernel, not varies, factor, exponent

        shared = [power for power, n in counts.items() if n > 1]
        return min(shared, key=rank) if shared else None

    def _as_product(self, terms: Sequence[Term]) -> Expr | None:
        """A short sum as a product of sums; None if it has no factors, or may not be worth the search."""
        found = factor_list(terms) if worth_factoring(terms) else None
        if found is None:
            return None
        content, parts = found
        return sympy.Mul(content, *(self.nested(part) ** exponent for part, exponent in parts))

    def _product(self, term: Term) -> Expr:
        return sympy.Mul(number(term.coefficient), *(self._factor(f) ** e for f, e in term.factors))


def number(k: Number) -> Expr:
    """A coefficient as a SymPy number."""
    if isinstance(k, float):
        return sympy.Float(k)
    return sympy.Rational(k.numerator, k.denominator)


def in_decimals(e: Expr) -> Expr:
    """An expression with readable numbers: fractions that came from floats become floats again."""
    fractions = {k: readable(Fraction(k.p, k.q)) for k in e.atoms(sympy.Rational)}
    return e.xreplace({k: sympy.Float(x) for k, x in fractions.items() if isinstance(x, float)})


def _rounded(k: Number) -> Number:
    return float(f"{k:.{DIGITS}e}") if isinstance(k, float) else k


def _size(k: Number) -> Number:
    return -k if k < 0 else k


def _common(terms: Sequence[Term]) -> tuple[tuple[CommonFactor, int], ...]:
    """The factors of all terms; negative powers only if all have them."""
    least = dict(terms[0].factors)
    for term in terms[1:]:
        found = dict(term.factors)
        both = {f: (e, found[f]) for f, e in least.items() if f in found}
        least = {f: min(e, key=abs) for f, e in both.items() if (e[0] > 0) == (e[1] > 0)}
    return tuple(least.items())


def _content(terms: Sequence[Term]) -> Number:
    """A number that all coefficients are multiples of, negative if most of them are."""
    numbers = [term.coefficient for term in terms]
    return plain(_sign(numbers, ()) * _scale(numbers))


def _scale(numbers: Iterable[Number]) -> Number:
    """The largest number that divides all; among floats their common absolute value, or 1."""
    numbers = list(numbers)
    if any(isinstance(k, float) for k in numbers):
        alike = len(numbers) > 1 and len({_rounded(_size(k)) for k in numbers}) == 1
        return _size(numbers[0]) if alike else 1
    below = denominator_of(numbers)
    above = reduce(gcd, (abs(int(k * below)) for k in numbers))
    return plain(Fraction(above, below))


def _sign(inside: Iterable[Number], outside: Iterable[Number]) -> int:
    """The sign to take out of a sum so that fewer minus signs remain before and inside it."""
    inside, outside = list(inside), list(outside)
    within, without = sum(k < 0 for k in inside), sum(k < 0 for k in outside)
    turned_within, turned_without = len(inside) - within, len(outside) - without
    turned = (turned_within + turned_without, turned_within)
    return -1 if turned < (within + without, within) else 1


def _divided(term: Term, k: Number, common: tuple[tuple[CommonFactor, int], ...]) -> Term:
    least = dict(common)
    factors = [(f, e - least.get(f, 0)) for f, e in term.factors]
    coefficient = plain(term.coefficient * reciprocal(k))
    return Term(coefficient, tuple((f, e) for f, e in factors if e))
