"""The algebra of SymPy expressions, and conversion between these and scalars of other algebras."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeAlias

import sympy

from linegraph.algebra.differentiation import Replay
from linegraph.errors import ModelError
from linegraph.ir.functions import ARITY

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from linegraph.algebra.differentiation import Symbol
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar

Expr: TypeAlias = Any
"""A SymPy expression; SymPy has no type annotations."""

RENAMED = {"abs": "Abs", "min": "Min", "max": "Max"}
"""Functions whose name differs from SymPy's."""

OURS = {theirs: ours for ours, theirs in RENAMED.items()}


class Sympy:
    """The algebra of SymPy expressions: every entry of an argument is a symbol with a name of its own.

    Args:
        names: for each argument the names of its entries in order.
    """

    def __init__(self, names: Mapping[str, Iterable[str]] | None = None) -> None:
        """Keep the names of the entries."""
        self._names = {argument: list(given) for argument, given in (names or {}).items()}

    def symbol(self, argument: str, place: int | str | None = None) -> Expr:
        """The SymPy symbol for one entry of an argument.

        Args:
            argument: name of the argument.
            place: index of the entry, or the symbol's own name; None for a symbol with the argument's name.
        """
        if place is None or isinstance(place, str):
            return sympy.Symbol(place or argument)
        return sympy.Symbol(self._names[argument][place])

    sin = staticmethod(sympy.sin)
    cos = staticmethod(sympy.cos)
    sqrt = staticmethod(sympy.sqrt)

    def function(self, name: str, *x: Expr) -> Expr:
        """SymPy's function for an elementary function of `ir.functions.ARITY`.

        Args:
            name: its name in linegraph; ``"abs"`` becomes `sympy.Abs`.
            *x: its arguments.
        """
        return getattr(sympy, RENAMED.get(name, name))(*x)


def evaluate(expression: Expr, algebra: Algebra, parameters: Mapping[str, Scalar]) -> Scalar:
    """A SymPy expression of parameters as a scalar of another algebra.

    Args:
        expression: a SymPy expression or a number, no text.
        algebra: the algebra of the result.
        parameters: scalars of that algebra by name of parameter.

    Raises:
        ModelError: a symbol is not a parameter, or an operation has no counterpart in emitted code.

    Example:
        >>> from linegraph.algebra.protocol import Floats
        >>> m, l = sympy.symbols("m l")
        >>> evaluate(m * l**2 / 3, Floats(), {"m": 6.0, "l": 0.5})
        0.5
    """

    def walk(e: Expr) -> Scalar:
        if e.is_Symbol:
            if e.name not in parameters:
                problem = "is used but not declared; declare it with model.parameter(...)"
                raise ModelError(f'parameter "{e.name}"', problem)
            return parameters[e.name]
        if e.is_Number or e.is_NumberSymbol:
            return number(e)
        return _apply(e, [walk(part) for part in e.args], algebra)

    return walk(sympy.sympify(expression, strict=True))


def number(e: Expr) -> Scalar:
    """A SymPy number as an int or a Fraction if it is rational, else as a float."""
    if e.is_Integer:
        return int(e)
    return Fraction(e.p, e.q) if e.is_Rational else float(e)


def _apply(e: Expr, parts: list[Scalar], algebra: Algebra) -> Scalar:
    """One SymPy operation over another algebra."""
    if e.is_Add:
        return _fold(lambda a, b: a + b, parts)
    if e.is_Mul:
        return _fold(lambda a, b: a * b, parts)
    if e.is_Pow:
        return power(parts[0], e.exp, algebra)
    name = OURS.get(e.func.__name__, e.func.__name__)
    if name in ("min", "max"):
        return _fold(lambda a, b: algebra.function(name, a, b), parts)
    if ARITY.get(name) == len(parts):
        return algebra.function(name, *parts)
    raise ModelError("", f"{name}(...) in {e} has no counterpart in emitted code")


def power(base: Scalar, exponent: Expr, algebra: Algebra) -> Scalar:
    """An integer or half-integer power by products, one root and one division.

    Args:
        base: a scalar of the algebra.
        exponent: a SymPy number; its double must be an integer of at most 128.
        algebra: whose `sqrt` is used.

    Raises:
        ModelError: the exponent is another one, or zero is raised to a negative power.
    """
    twice = 2 * (sympy.Rational(float(exponent)) if exponent.is_Float else exponent)
    if not twice.is_Integer or abs(twice) > 128:
        raise ModelError("", f"the power {exponent} has no counterpart in emitted code")
    whole, half = divmod(abs(int(twice)), 2)
    result: Scalar = algebra.sqrt(base) if half else 1
    for _ in range(whole):
        result = result * base
    if not exponent.is_negative:
        return result
    if isinstance(result, (int, float)) and result == 0:
        raise ModelError("", "a division by zero at the parameters' values")
    return 1 / result


def to_sympy(x: Scalar, symbol: Callable[[Symbol], Expr]) -> Expr:
    """A scalar of a DAG as a SymPy expression, with all intermediates substituted.

    Args:
        x: a node or a number.
        symbol: the SymPy expression for a symbol, given as (argument, place).
    """
    return sympy.sympify(Replay(Sympy(), symbol)(x), strict=True)


def _fold(action: Callable[[Scalar, Scalar], Scalar], parts: list[Scalar]) -> Scalar:
    result = parts[0]
    for part in parts[1:]:
        result = action(result, part)
    return result
