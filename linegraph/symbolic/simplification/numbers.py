"""Coefficients: exact integers and fractions, and floats whose rounding must not create terms."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from linegraph.ir.dag import Number

Terms: TypeAlias = "dict[int, Number]"
"""Coefficients by term."""

ROUNDING = 1e-14
"""A sum of floats that is smaller than its parts by this factor is rounding."""

WHOLE = 1e-12
"""Relative distance from an integer below which a quotient of floats is one."""


def gather(terms: Terms, term: int, k: Number) -> None:
    """Add a term to others, in place; a remainder of floats that is only rounding is dropped.

    Args:
        terms: the other terms.
        term: the exponents of the new one.
        k: its coefficient.
    """
    old = terms.get(term)
    if old is None:
        if k:
            terms[term] = k
        return
    new = old + k
    if not new or (isinstance(new, float) and abs(new) <= ROUNDING * abs(float(old))):
        del terms[term]
    else:
        terms[term] = new


LONG = 2**40
"""A fraction with a larger numerator or denominator came from floats, such as 1/2.4 in binary."""


def readable(x: Number) -> Number:
    """A number as a person would write it: a fraction that came from a float is a float again.

    Example:
        >>> readable(Fraction(1, 3)), readable(1 / Fraction(2.4)), readable(Fraction(4, 2))
        (Fraction(1, 3), 0.4166666666666667, 2)
    """
    if isinstance(x, Fraction) and max(abs(x.numerator), x.denominator) > LONG:
        x = float(x)
    return plain(x)


def plain(x: Number) -> Number:
    """A number as an int if it is an integer."""
    if isinstance(x, float):
        return int(x) if x.is_integer() and abs(x) < 1e15 else x
    return int(x) if x == int(x) else x


def near(k: Number) -> Number:
    """A float as an int if only rounding separates it from one."""
    whole = round(k)
    return whole if isinstance(k, float) and whole and abs(k - whole) < WHOLE * abs(k) else plain(k)


def reciprocal(k: Number) -> Number:
    """The reciprocal ``1/k``, exact if k is exact."""
    return 1 / k if isinstance(k, float) else plain(1 / Fraction(k))
