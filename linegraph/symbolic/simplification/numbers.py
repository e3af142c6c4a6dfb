"""Coefficients: exact where they are whole or fractions, floats whose rounding is kept from making terms."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from linegraph.ir.dag import Number

Terms: TypeAlias = "dict[int, Number]"
"""Coefficients by term."""

ROUNDING = 1e-14
"""A difference of floats this much smaller than they is rounding."""

WHOLE = 1e-12
"""A quotient of floats this close to a whole number, relatively, is one."""


def gather(terms: Terms, term: int, k: Number) -> None:
    """Add a term to others; what is left of floats by rounding alone is nothing."""
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
"""A fraction with a numerator or denominator beyond this is what floats leave, such as 1/2.4 in binary."""


def readable(x: Number) -> Number:
    """A number as a person would write it: what came of a float is a float again.

    Example:
        >>> readable(Fraction(1, 3)), readable(1 / Fraction(2.4)), readable(Fraction(4, 2))
        (Fraction(1, 3), 0.4166666666666667, 2)
    """
    if isinstance(x, Fraction) and max(abs(x.numerator), x.denominator) > LONG:
        x = float(x)
    return plain(x)


def plain(x: Number) -> Number:
    """A number as an int where it is one."""
    if isinstance(x, float):
        return int(x) if x.is_integer() and abs(x) < 1e15 else x
    return int(x) if x == int(x) else x


def near(k: Number) -> Number:
    """A float that rounding has moved off a whole number, as that."""
    whole = round(k)
    return whole if isinstance(k, float) and whole and abs(k - whole) < WHOLE * abs(k) else plain(k)


def reciprocal(k: Number) -> Number:
    """``1/k``, exact where k is."""
    return 1 / k if isinstance(k, float) else plain(1 / Fraction(k))
