"""How formulas look: in LaTeX, in MathML and as plain text, the same names and the same order in all three.

names, apart  Greek letters, subscripts, dots, words; no two alike
tree          what is meant, and the order of factors and summands
expressions   from sympy to trees
writing, latex, mathml, plain
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.notation.apart import told_apart
from linegraph.notation.expressions import Expressions
from linegraph.notation.latex import Latex
from linegraph.notation.mathml import MathMl
from linegraph.notation.names import guessed, names_of
from linegraph.notation.plain import Plain

if TYPE_CHECKING:
    from linegraph.notation.tree import Math, Name
    from linegraph.pipeline import Derivation


class Notation:
    """How the expressions of a derivation look, or of any model where none is given.

    Example:
        >>> from sympy import symbols, sin
        >>> g, l, m, hinge, hinge_dot = symbols("g l m hinge hinge_dot")
        >>> look = Notation()
        >>> look.text(l**2 * m * hinge_dot - g * l * m * sin(hinge) ** 2)
        'm·l²·hinge′ − m·g·l·sin²(hinge)'
    """

    def __init__(self, derivation: Derivation | None = None) -> None:
        """Look up what its symbols stand for."""
        self.names: dict[str, Name] = {} if derivation is None else told_apart(names_of(derivation))
        self.tree = Expressions(self.name)

    def name(self, text: str) -> Name:
        """The look of a symbol."""
        if text not in self.names:
            inner = text.removeprefix("der(").removesuffix(")")
            if f"der({inner})" == text and inner in self.names:
                self.names[text] = self.names[inner].rate()
            else:
                self.names[text] = guessed(text)
        return self.names[text]

    def latex(self, expression: Any) -> str:
        """An expression, a matrix or an equation in LaTeX."""
        return Latex()(self.tree(expression))

    def mathml(self, expression: Any) -> str:
        """The same as a ``math`` element."""
        return math_element(self.tree(expression))

    def text(self, expression: Any) -> str:
        """The same as plain text."""
        return Plain()(self.tree(expression))


def math_element(tree: Math) -> str:
    """A tree as an element to stand among words."""
    return f"<math>{MathMl()(tree)}</math>"


def init_printing(derivation: Derivation | None = None) -> None:
    """Let notebooks show all sympy objects in this notation.

    Args:
        derivation: whose names to look up; without one endings tell: ``hinge_dot`` is a rate.
    """
    from linegraph.notation.printing import install

    install(Notation(derivation))


__all__ = ["Notation", "init_printing", "math_element"]
