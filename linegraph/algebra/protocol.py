"""The protocol of scalar algebras: + - * / of the scalars themselves and a few functions.

The same derivation runs over three algebras:

    ir.dag.Dag              nodes      programs to emit, costs to count, closed forms by `simplification`
    sympy_scalars.Sympy     SymPy      the paper's own matrices, to be read as they are
    protocol.Floats         floats     the numeric reference

Python numbers belong to every algebra.
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
    """The functions that a derivation may apply to a scalar."""

    def symbol(self, argument: str, place: int | str | None = None) -> Scalar:
        """The scalar for one entry of an argument, as ``symbol("q", 3)`` or ``symbol("p", "mass")``.

        Args:
            argument: name of the argument.
            place: index or name of the entry; None if the argument is one scalar.
        """

    def sin(self, x: Scalar) -> Scalar:
        """Sine of an angle in radians."""

    def cos(self, x: Scalar) -> Scalar:
        """Cosine of an angle in radians."""

    def sqrt(self, x: Scalar) -> Scalar:
        """The non-negative square root."""

    def function(self, name: str, *x: Scalar) -> Scalar:
        """An elementary function of `ir.functions.ARITY`.

        Args:
            name: its name, as ``"exp"`` or ``"atan2"``.
            *x: as many scalars as it takes.
        """


class Floats:
    """Double precision, in which a derivation computes numbers at one state.

    Args:
        arguments: the numbers of each argument by its name: a sequence, a mapping or one number.
    """

    def __init__(self, **arguments: Scalar) -> None:
        """Keep the numbers that `symbol` looks up."""
        self.arguments = arguments

    def symbol(self, argument: str, place: int | str | None = None) -> Scalar:
        """The number given for one entry of an argument.

        Args:
            argument: name of the argument.
            place: index or name of the entry; None if the argument is one number.

        Raises:
            KeyError: nothing was given for it.
        """
        given = self.arguments[argument]
        return given if place is None else given[place]

    sin = staticmethod(math.sin)
    cos = staticmethod(math.cos)
    sqrt = staticmethod(math.sqrt)

    def function(self, name: str, *x: Scalar) -> Scalar:
        """The value of an elementary function of `ir.functions.ARITY`.

        Args:
            name: its name.
            *x: its arguments; angles in rad.

        Raises:
            ModelError: the function has no value there.
        """
        return of_numbers(name, *x)


class Constants:
    """Numbers by the standard library, SymPy expressions by SymPy, before an algebra has been chosen."""

    def symbol(self, argument: str, place: int | str | None = None) -> Scalar:
        """Constants have no symbols, so this always fails.

        Args:
            argument: name of the argument.
            place: index or name of the entry.

        Raises:
            KeyError: always.
        """
        raise KeyError(argument)

    def sin(self, x: Scalar) -> Scalar:
        """Sine of an angle in radians, a number or a SymPy expression."""
        return _constant("sin", x)

    def cos(self, x: Scalar) -> Scalar:
        """Cosine of an angle in radians, a number or a SymPy expression."""
        return _constant("cos", x)

    def sqrt(self, x: Scalar) -> Scalar:
        """The non-negative square root of a number or a SymPy expression."""
        return _constant("sqrt", x)

    def function(self, name: str, *x: Scalar) -> Scalar:
        """The value of an elementary function of numbers.

        Args:
            name: its name in `ir.functions.ARITY`.
            *x: numbers; angles in rad.
        """
        return of_numbers(name, *x)


def _constant(function: str, x: Scalar) -> Scalar:
    if isinstance(x, (int, float, Fraction)):
        return getattr(math, function)(x)
    if isinstance(x, str):
        # SymPy would evaluate a text as Python code
        raise ModelError("", "an angle takes numbers, parameters or sympy expressions, not text")
    import sympy

    return getattr(sympy, function)(x)


def set_label(algebra: Algebra, text: str) -> None:
    """Label the nodes that a DAG creates from now on; emitted temporaries are traced by these labels.

    Args:
        algebra: without effect unless it is a DAG.
        text: the joint, body or term that is derived next.
    """
    if hasattr(algebra, "label"):
        algebra.label = text
