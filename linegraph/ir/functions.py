"""The elementary functions that all algebras, formulas and target languages support."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Callable
    from fractions import Fraction

ARITY: dict[str, int] = {
    "sin": 1,
    "cos": 1,
    "tan": 1,
    "asin": 1,
    "acos": 1,
    "atan": 1,
    "atan2": 2,
    "sinh": 1,
    "cosh": 1,
    "tanh": 1,
    "exp": 1,
    "log": 1,
    "sqrt": 1,
    "abs": 1,
    "sign": 1,
    "min": 2,
    "max": 2,
}
"""How many arguments each takes."""

_OWN: dict[str, Callable[..., float]] = {
    "abs": abs,
    "min": min,
    "max": max,
    "sign": lambda x: (x > 0) - (x < 0),
}


def of_numbers(name: str, *x: float | Fraction) -> float:
    """The value of an elementary function of numbers.

    Args:
        name: one of `ARITY`.
        x: as many numbers as the function takes; angles in radians.

    Returns:
        A float, or an integer if the arguments are 0 or 1 and the result is 0, 1 or -1.

    Raises:
        ModelError: the function has no finite value there.
    """
    try:
        y = _OWN[name](*x) if name in _OWN else getattr(math, name)(*x)
    except (ValueError, OverflowError):
        given = ", ".join(str(float(part)) for part in x)
        raise ModelError("", f"{name}({given}) is not a finite number") from None
    return int(y) if y in (0, 1, -1) and all(part in (0, 1) for part in x) else float(y)
