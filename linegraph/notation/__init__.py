"""Formulas in LaTeX, in MathML and as plain text, with the same names and the same order in all three.

names, apart                        Greek letters, subscripts, dots and words; no two names look alike
tree                                formulas as trees, and the order of factors and summands
expressions                         trees from SymPy expressions
writing, latex, mathml, plain       the writers
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.notation.notation import Notation, math_element

if TYPE_CHECKING:
    from linegraph.numeric.derived import Derived


def init_printing(derivation: Derived | None = None) -> None:
    """Let notebooks show all SymPy objects in this notation.

    Args:
        derivation: whose names are looked up. Without one, endings decide: ``hinge_dot`` is a rate.
    """
    from linegraph.notation.printing import install

    install(Notation(derivation))


__all__ = ["Notation", "init_printing", "math_element"]
