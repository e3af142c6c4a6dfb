"""The notation of one derivation in all output formats."""

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
    from linegraph.numeric.derived import Derived


class Notation:
    """The look of a derivation's expressions, or of any expressions if no derivation is given.

    Args:
        derivation: whose symbols are looked up.

    Example:
        >>> from sympy import symbols, sin
        >>> g, l, m, hinge, hinge_dot = symbols("g l m hinge hinge_dot")
        >>> look = Notation()
        >>> look.text(l**2 * m * hinge_dot - g * l * m * sin(hinge) ** 2)
        'm·l²·hinge′ − m·g·l·sin²(hinge)'
    """

    def __init__(self, derivation: Derived | None = None) -> None:
        """Look up the names of the derivation and make them look different from each other."""
        self.names: dict[str, Name] = {} if derivation is None else told_apart(names_of(derivation))
        self.tree = Expressions(self.name)

    def name(self, text: str) -> Name:
        """The look of a symbol, given its name; of ``der(x)`` x with one more dot."""
        if text not in self.names:
            inner = text.removeprefix("der(").removesuffix(")")
            if f"der({inner})" == text and inner in self.names:
                self.names[text] = self.names[inner].rate()
            else:
                self.names[text] = guessed(text)
        return self.names[text]

    def latex(self, expression: Any) -> str:
        """A SymPy expression, matrix or equation in LaTeX, for math mode."""
        return Latex()(self.tree(expression))

    def mathml(self, expression: Any) -> str:
        """A SymPy expression, matrix or equation as a ``math`` element."""
        return math_element(self.tree(expression))

    def text(self, expression: Any) -> str:
        """A SymPy expression, matrix or equation as plain text."""
        return Plain()(self.tree(expression))


def math_element(tree: Math) -> str:
    """A tree as a ``math`` element in running text."""
    return f"<math>{MathMl()(tree)}</math>"
