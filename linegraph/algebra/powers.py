"""Integer and half-integer powers over any algebra."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from linegraph.errors import ModelError

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar

LARGEST_NUMBER = 4096
"""The largest number of bits of an exact power."""


def quotient(a: Scalar, b: Scalar) -> Scalar:
    """The quotient ``a / b``, an exact fraction if both are integers or fractions.

    Args:
        a: the dividend, a scalar of any algebra.
        b: the divisor.

    Raises:
        ModelError: b is the number zero.
    """
    if isinstance(b, (int, float, Fraction)) and b == 0:
        raise ModelError("", "division by zero")
    exact = isinstance(a, (int, Fraction)) and isinstance(b, (int, Fraction))
    return Fraction(a) / Fraction(b) if exact else a / b


def power(base: Scalar, exponent: Fraction | int, algebra: Algebra) -> Scalar:
    """An integer or half-integer power by repeated squaring, one root and one division.

    An algebra whose scalars carry derivatives may define `power` itself for half-integers: in x^(3/2) = x
    sqrt(x) the derivative of the factor sqrt(x) is infinite at 0, that of the product is not.

    Args:
        base: a scalar of the algebra.
        exponent: a multiple of 1/2.
        algebra: whose `sqrt` is used.

    Raises:
        ModelError: a power of numbers has more than `LARGEST_NUMBER` bits, or zero is raised to a negative
            power.
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
