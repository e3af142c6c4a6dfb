"""Trees from SymPy expressions. Factored forms stay factored."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.notation.tree import (
    ONE,
    Fraction,
    FunctionCall,
    Grid,
    Math,
    Name,
    Numeral,
    Power,
    Raw,
    Root,
    Sum,
    TwoSides,
    negated,
    product,
    total,
)

if TYPE_CHECKING:
    from collections.abc import Callable

DIGITS = 6
"""Significant digits of numbers that are not integers."""

RENAMED = {"Abs": "abs", "Max": "max", "Min": "min", "log": "ln"}
"""Functions whose name differs from SymPy's."""


def number(x: Any) -> Math:
    """The tree of a number: six digits, no trailing zeros, powers of ten for numbers far from 1.

    Example:
        >>> number(2.50), number(-3)
        (Numeral(text='2.5', rounded=False), Sum(terms=((True, Numeral(text='3', rounded=False)),)))
    """
    if x < 0:
        return negated(number(-x))
    if isinstance(x, int):
        return Numeral(str(x))
    value = float(x)
    text = f"{value:.{DIGITS}g}"
    inexact = float(text) != value
    if abs(float(text) - value) <= 1e-15 * value:
        inexact = False
    mantissa, _, exponent = text.partition("e")
    return Numeral(f"{mantissa}e{int(exponent)}" if exponent else text, inexact)


class Expressions:
    """Converts SymPy expressions to trees, each subexpression once.

    Args:
        name: gives the look of a symbol from its name.
        other: writes expressions for which there is no tree; by default the name of their class.
    """

    def __init__(
        self, name: Callable[[str], Name], other: Callable[[Any], Raw] | None = None
    ) -> None:
        """Start without known expressions."""
        self._name = name
        self._other = other or (lambda e: Raw(rf"\mathtt{{{type(e).__name__}}}", str(e)))
        self._known: dict[Any, Math] = {}

    def __call__(self, e: Any) -> Math:
        """The tree of an expression, a matrix or an equation."""
        if getattr(e, "is_Matrix", False):
            rows, columns = e.shape
            return Grid(tuple(tuple(self(e[i, j]) for j in range(columns)) for i in range(rows)))
        if e not in self._known:
            self._known[e] = self._tree(e)
        return self._known[e]

    def _tree(self, e: Any) -> Math:
        if e.is_Symbol:
            return self._name(e.name)
        if e.is_Add:
            return total((False, self(part)) for part in e.args)
        if e.is_Mul:
            return self._product(e)
        if e.is_Pow:
            return self._power(e)
        if e.is_Rational and not e.is_Integer:
            ratio = Fraction(Numeral(str(abs(e.p))), Numeral(str(e.q)))
            return negated(ratio) if e.p < 0 else ratio
        if e.is_Integer or e.is_Float:
            whole = int(e) if e.is_Integer or (float(e).is_integer() and abs(e) < 1e6) else float(e)
            return number(whole)
        if e.is_Relational and e.rel_op == "==":
            return TwoSides(self(e.lhs), "=", self(e.rhs))
        if e.is_Function:
            return self._function(e)
        if e.is_Derivative:
            return self._derivative(e)
        if e.is_NumberSymbol and str(e) == "pi":
            return Name("π")
        return self._other(e)

    def _product(self, e: Any) -> Math:
        """A coefficient, the factors, and the divisors in one fraction."""
        above: list[Math] = []
        below: list[Math] = []
        front: Math = ONE
        negative = False
        for part in e.args:
            if part.is_Rational and not part.is_Integer:
                front = Fraction(Numeral(str(abs(part.p))), Numeral(str(part.q)))
                negative ^= part.p < 0
            elif part.is_Pow and part.exp.is_number and part.exp.is_negative:
                below.append(self._power(part.base**-part.exp if part.exp != -1 else part.base))
            else:
                tree = self(part)
                if _minus(tree):
                    tree, negative = negated(tree), not negative
                above.append(tree)
        if below:
            if isinstance(front, Fraction):
                above, below = [front.above, *above], [front.below, *below]
            found: Math = Fraction(product(above), product(below))
        else:
            found = product([*([front] if front != ONE else []), *above])
        return negated(found) if negative else found

    def _power(self, e: Any) -> Math:
        if not e.is_Pow:
            return self(e)
        base, exponent = e.base, e.exp
        if exponent.is_number and exponent.is_negative:
            return Fraction(ONE, self._power(base**-exponent))
        if exponent.is_Rational and exponent.q == 2:
            root = Root(self(base))
            whole = int(exponent.p) // 2
            return root if not whole else product([root, self._raised(base, whole)])
        if exponent.is_Float and float(exponent) == 0.5:
            return Root(self(base))
        return self._raised(base, exponent)

    def _raised(self, base: Any, exponent: Any) -> Math:
        tree = number(exponent) if isinstance(exponent, int) else self(exponent)
        return self(base) if tree == ONE else Power(self(base), tree)

    def _function(self, e: Any) -> Math:
        name = e.func.__name__
        if _of_time(e):
            return self._name(name)
        if len(e.args) == 1 and name in ("sqrt",):
            return Root(self(e.args[0]))
        return FunctionCall(RENAMED.get(name, name), tuple(self(a) for a in e.args))

    def _derivative(self, e: Any) -> Math:
        """A time derivative as dots over the function's name."""
        found = self(e.expr)
        by = [(str(variable), int(count)) for variable, count in e.variable_count]
        if not isinstance(found, Name) or any(variable != "t" for variable, _ in by):
            return self._other(e)
        for _ in range(sum(count for _, count in by)):
            found = found.rate()
        return found


def _of_time(e: Any) -> bool:
    """Whether an expression is an undefined function of the time t alone."""
    undefined = "AppliedUndef" in [kind.__name__ for kind in type(e).__mro__]
    return undefined and [str(a) for a in e.args] == ["t"]


def _minus(tree: Math) -> bool:
    return isinstance(tree, Sum) and len(tree.terms) == 1 and tree.terms[0][0]


__all__ = ["DIGITS", "Expressions", "number"]
