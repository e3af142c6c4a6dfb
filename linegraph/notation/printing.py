"""SymPy's own printer with this notation in it, for notebooks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from sympy import (
    Add,
    Derivative,
    Equality,
    Function,
    MatrixBase,
    Mul,
    Pow,
    Rational,
    Symbol,
)
from sympy import init_printing as begin
from sympy.printing.latex import LatexPrinter

from linegraph.notation.expressions import Expressions
from linegraph.notation.latex import Latex
from linegraph.notation.tree import Raw

if TYPE_CHECKING:
    from linegraph.notation.notation import Notation

OURS = (Add, Mul, Pow, Symbol, Rational, Function, Derivative, Equality, MatrixBase)


class FacePrinter(LatexPrinter):  # type: ignore[misc]
    """SymPy's LaTeX printer, in which names, sums, products and matrices are written as in reports."""

    def __init__(self, notation: Notation) -> None:
        """Write with the names of a notation."""
        super().__init__()
        self._tree = Expressions(notation.name, self._others)

    def _print(self, expr: Any, **options: Any) -> str:
        if isinstance(expr, OURS) and getattr(expr, "is_commutative", True):
            return Latex()(self._tree(expr))
        return str(super()._print(expr, **options))

    def _others(self, expr: Any) -> Raw:
        return Raw(str(super()._print(expr)), str(expr))


def install(notation: Notation) -> None:
    """Set the printer of SymPy, and of IPython through it, to this notation."""

    def shown(expression: Any, mode: str = "plain", **options: Any) -> str:
        text = str(FacePrinter(notation).doprint(expression))
        return {
            "plain": text,
            "inline": f"${text}$",
            "equation": rf"\begin{{equation}}{text}\end{{equation}}",
            "equation*": rf"\begin{{equation*}}{text}\end{{equation*}}",
        }.get(mode, text)

    begin(use_latex="mathjax", latex_printer=shown)
