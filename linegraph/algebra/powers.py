"""Integer and half-integer powers over any algebra."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from linegraph.errors import ModelError

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar

LARGEST_NUMBER = 4096
"""Bits of an exact power."""


def quotient(a: Scalar, b: Scalar) -> Scalar:
    """A quotient, exact where both numbers are.

    Raises:
        ModelError: b is the number zero.
    """
    if isinstance(b, (int, float, Fraction)) and b == 0:
        raise ModelError("", "division by zero")
    exact = isinstance(a, (int, Fraction)) and isinstance(b, (int, Fraction))
    return Fraction(a) / Fraction(b) if exact else a / b


def power(base: Scalar, exponent: Fraction | int, algebra: Algebra) -> Scalar:
    """Integer and half-integer powers by products, one root and one division.

    An algebra whose scalars carry derivatives takes half-integer powers itself: the derivatives of the
    factors may be infinite where that of the product is not.

    Raises:
        ModelError: a power of numbers is too large, or zero is raised to a negative power.
    """
    if isinstance(base, (int, Fraction)):
        size = max(base.numerator.bit_length(), base.denominator.bit_length())
        if size * abs(float(exponent)) > LARGEST_NUMBER:
            raise ModelError("", "a power of numbers is too large")
    whole, half = divmod(abs(2 * Fraction(exponent)), 2)
    own = getattr(algebra, "power", None)
    if half and own is not None:
        return own(base, Fraction(exponent))
    result: Scalar = algebra.sqrt(base) if half else 1
    square = base
    count = int(whole)
    while count:
        if count % 2:
            result = result * square
        count //= 2
        square = square * square if count else square
    return quotient(1, result) if exponent < 0 else result
