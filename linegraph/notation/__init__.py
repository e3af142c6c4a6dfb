"""How formulas look: in LaTeX, in MathML and as plain text, the same names and the same order in all three.

names, apart  Greek letters, subscripts, dots, words; no two alike
tree          what is meant, and the order of factors and summands
expressions   from sympy to trees
writing, latex, mathml, plain
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.notation.notation import Notation, math_element

if TYPE_CHECKING:
    from linegraph.numeric.derived import Derived


def init_printing(derivation: Derived | None = None) -> None:
    """Let notebooks show all sympy objects in this notation.

    Args:
        derivation: whose names to look up; without one endings tell: ``hinge_dot`` is a rate.
    """
    from linegraph.notation.printing import install

    install(Notation(derivation))


__all__ = ["Notation", "init_printing", "math_element"]
