"""What a derivation is written over: scalars that know + - * / and these few functions.

The same derivation runs over three algebras:

    expression.Dag      nodes           programs to emit, costs to count, closed forms by `simplification`
    sympy_walk.Sympy    sympy           the paper's own matrices, to be read as they are
    algebra.Floats      floats          the numeric reference

Numbers belong to every algebra.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, Protocol

from linegraph.errors import ModelError
from linegraph.ir.functions import of_numbers

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar


class Algebra(Protocol):
    """The functions a derivation may apply to a scalar."""

    def symbol(self, argument: str, place: int | str | None = None) -> Scalar:
        """The scalar standing at `place` of an argument: ``q, 3`` or ``p, "mass"`` or ``t, None``."""

    def sin(self, x: Scalar) -> Scalar:
        """Sine of an angle in radians."""

    def cos(self, x: Scalar) -> Scalar:
        """Cosine of an angle in radians."""

    def sqrt(self, x: Scalar) -> Scalar:
        """The non-negative square root."""

    def function(self, name: str, *x: Scalar) -> Scalar:
        """Any function of `functions.ARITY`."""


class Floats:
    """Double precision: the algebra in which a derivation simply computes.

    Args:
        arguments: the numbers of each argument, by name: a sequence, a mapping or one number.
    """

    def __init__(self, **arguments: Scalar) -> None:
        """Keep the numbers that `symbol` looks up."""
        self.arguments = arguments

    def symbol(self, argument: str, place: int | str | None = None) -> Scalar:
        """The number given for this place."""
        given = self.arguments[argument]
        return given if place is None else given[place]

    sin = staticmethod(math.sin)
    cos = staticmethod(math.cos)
    sqrt = staticmethod(math.sqrt)

    def function(self, name: str, *x: Scalar) -> Scalar:
        """Any function of `functions.ARITY`."""
        return of_numbers(name, *x)


class Constants:
    """Numbers by the standard library, symbols by sympy: what is known before an algebra is chosen."""

    def symbol(self, argument: str, place: int | str | None = None) -> Scalar:
        """There are none among constants."""
        raise KeyError(argument)

    def sin(self, x: Scalar) -> Scalar:
        """Sine of an angle in radians."""
        return _constant("sin", x)

    def cos(self, x: Scalar) -> Scalar:
        """Cosine of an angle in radians."""
        return _constant("cos", x)

    def sqrt(self, x: Scalar) -> Scalar:
        """The non-negative square root."""
        return _constant("sqrt", x)

    def function(self, name: str, *x: Scalar) -> Scalar:
        """Any function of `functions.ARITY`; of numbers only."""
        return of_numbers(name, *x)


def _constant(function: str, x: Scalar) -> Scalar:
    if isinstance(x, (int, float, Fraction)):
        return getattr(math, function)(x)
    if isinstance(x, str):
        # sympy would run it
        raise ModelError("", "an angle takes numbers, parameters or sympy expressions, not text")
    import sympy

    return getattr(sympy, function)(x)


def set_label(algebra: Algebra, text: str) -> None:
    """Tell a DAG which part the next nodes belong to."""
    if hasattr(algebra, "label"):
        algebra.label = text
