"""The real numbers of emitted C: doubles, or floats for machines that compute only in floats.

Everything is written for doubles. The same text in floats has other words for the type, for the numbers
and for the functions of <math.h>, and nothing else; what compares with rounding says so beforehand, through
`linegraph.ir.rounding` or `tolerance`.
"""

from __future__ import annotations

import math
import re
import struct
from fractions import Fraction

from linegraph.errors import ModelError
from linegraph.ir.functions import ARITY

_COARSER = 2.0**29
"""Ratio of the rounding of floats to that of doubles."""

_FUNCTIONS = sorted({*ARITY, "fabs", "fmax", "fmin"} - {"abs", "max", "min", "sign"})
_WORDS = re.compile(
    r"(?P<kept>/\*.*?\*/|\"(?:\\.|[^\"\\])*\")"
    r"|(?P<number>(?<![\w.])(?:\d+\.\d*(?:e[+-]?\d+)?|\d+e[+-]?\d+))"
    rf"|(?P<function>(?<![\w>.])(?:{'|'.join(_FUNCTIONS)})(?=\())"
    r"|(?P<type>\bdouble\b)|(?P<huge>\bHUGE_VAL\b)",
    re.DOTALL,
)


def tolerance(fraction: float, real: str) -> float:
    """A relative bound of rounding, for the numbers in use.

    Args:
        fraction: the bound for doubles.
        real: ``double`` or ``float``.
    """
    return fraction * _COARSER if real == "float" else fraction


def written(text: str, real: str) -> str:
    """C text written for doubles, converted to another number type.

    Types, numbers and functions of <math.h> are replaced; comments and strings are kept.

    Args:
        text: C for doubles.
        real: ``double`` or ``float``.

    Raises:
        ModelError: a number cannot be represented as a normal float.

    Example:
        >>> written("const double x = 0.1 * sin(y); /* double */", "float")
        'const float x = 0.1F * sinf(y); /* double */'
    """
    return text if real == "double" else _WORDS.sub(_in_float, text)


def _in_float(found: re.Match[str]) -> str:
    if found["kept"]:
        return found[0]
    if found["number"]:
        return shortest(float(found[0]))
    if found["function"]:
        return f"{found[0]}f"
    return "float" if found["type"] else "HUGE_VALF"


def shortest(x: float) -> str:
    """The shortest decimal that reads back as the float nearest to x, as a literal of C.

    Raises:
        ModelError: x is too large for a float, or not zero but too small for one of full precision.

    Example:
        >>> shortest(9.81), shortest(1.0), shortest(2 / 3)
        ('9.81F', '1.0F', '0.6666667F')
    """
    nearest = _nearest(x)
    if nearest is None or (x and abs(nearest) < _SMALLEST):
        problem = f"the number {x!r}, computed from the model's values, is too "
        problem += "large for a float" if nearest is None else "small for a float"
        raise ModelError("", f"{problem}: scale the values (SI units), or emit doubles")
    for digits in range(1, 10):
        text = f"{nearest:.{digits}g}"
        value = float(text)
        # a compiler reads the decimal at once, not by way of a double: rounding twice must not matter
        around = [value]
        if Fraction(text) != Fraction(value):
            around += [math.nextafter(value, math.inf), math.nextafter(value, -math.inf)]
        if all(_nearest(y) == nearest for y in around):
            break
    return f"{float(text)!r}F"


_SMALLEST = 2.0**-126


def _nearest(x: float) -> float | None:
    """The float nearest to x as a double; None where there is none."""
    try:
        found = struct.unpack("<f", struct.pack("<f", x))[0]
    except OverflowError:
        return None
    return float(found) if math.isfinite(found) else None
