"""Sums as products of sums: which are worth a search, and the factors that SymPy finds."""

from __future__ import annotations

from fractions import Fraction
from functools import reduce
from math import gcd
from typing import TYPE_CHECKING, NamedTuple

import sympy

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.algebra.sympy_scalars import Expr
    from linegraph.ir.dag import Number
    from linegraph.symbolic.simplification.generators import Frozen

MOST_TERMS_AS_PRODUCT = 10
"""Longer sums are not factored into sums."""


class CommonFactor(NamedTuple):
    """A factor of terms: a generator of the ring (with an empty `kernel`), or a sum of terms."""

    place: int
    kernel: Frozen


class Term(NamedTuple):
    """A number times powers of factors, in ascending order of place."""

    coefficient: Number
    factors: tuple[tuple[CommonFactor, int], ...]


def worth_factoring(terms: Sequence[Term]) -> bool:
    """Whether a sum is short, exact and polynomial, and no factor alone shows that it is irreducible."""
    if not 3 <= len(terms) <= MOST_TERMS_AS_PRODUCT:
        return False
    if any(isinstance(term.coefficient, float) for term in terms):
        return False
    if any(exponent < 0 for term in terms for _, exponent in term.factors):
        return False
    factors = {factor for term in terms for factor, _ in term.factors}
    return bool(factors) and not any(_irreducible(terms, factor) for factor in factors)


def factor_list(terms: Sequence[Term]) -> tuple[Expr, list[tuple[list[Term], int]]] | None:
    """The factors of a sum by `sympy.Poly.factor_list`: content, and sums with their exponents.

    None if the sum is irreducible.
    """
    factors = list(dict.fromkeys(f for term in terms for f, _ in term.factors))
    places = {factor: n for n, factor in enumerate(factors)}
    denominator = denominator_of(term.coefficient for term in terms)
    rows: dict[tuple[int, ...], int] = {}
    for term in terms:
        row = [0] * len(factors)
        for factor, exponent in term.factors:
            row[places[factor]] = exponent
        rows[tuple(row)] = int(term.coefficient * denominator)
    poly = sympy.Poly.from_dict(rows, *sympy.symbols(f"x:{len(factors)}"))
    content, parts = poly.factor_list()
    if len(parts) == 1 and parts[0][1] == 1:
        return None
    found = []
    for part, exponent in parts:
        inner = [
            Term(int(k), tuple((factors[n], e) for n, e in enumerate(row) if e))
            for row, k in part.terms()
        ]
        found.append((inner, exponent))
    return sympy.Rational(content, denominator) if denominator != 1 else content, found


def _irreducible(terms: Sequence[Term], factor: CommonFactor) -> bool:
    """Whether a sum is A x + B with A or B a single term; without common factors it is then irreducible."""
    exponents = [dict(term.factors).get(factor, 0) for term in terms]
    having = sum(e != 0 for e in exponents)
    return max(exponents) == 1 and (having == 1 or len(terms) - having == 1)


def denominator_of(numbers: Iterable[Number]) -> int:
    """The least common denominator of the exact numbers."""
    exact = [Fraction(k).denominator for k in numbers if not isinstance(k, float)]
    return reduce(lambda a, b: a * b // gcd(a, b), exact, 1)
