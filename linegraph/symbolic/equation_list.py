"""Equations of motion as a list of `sympy.Eq` that notebooks show line by line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import sympy

if TYPE_CHECKING:
    from linegraph.notation.notation import Notation


class Equations(list[Any]):
    """Equations ``left = right``, one `sympy.Eq` each.

    Args:
        left: the left-hand sides.
        right: the right-hand sides, as many.
        notation: the appearance of names in notebooks.
    """

    def __init__(self, left: Any, right: Any, notation: Notation) -> None:
        """Pair the sides; SymPy evaluates none of them to true or false."""
        super().__init__(sympy.Eq(a, b, evaluate=False) for a, b in zip(left, right, strict=True))
        self.notation = notation

    def _repr_latex_(self) -> str:
        lines = [f"{self.notation.latex(e.lhs)} &= {self.notation.latex(e.rhs)}" for e in self]
        return "$\\displaystyle \\begin{aligned}" + r" \\ ".join(lines) + "\\end{aligned}$"
