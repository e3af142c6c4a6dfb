"""Formulas from nodes of the expression DAG."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.ir.dag import ADD, DIV, MUL, NEG, SUB, SYMBOL, Node
from linegraph.notation.expressions import RENAMED, number
from linegraph.notation.tree import (
    ONE,
    Fraction,
    FunctionCall,
    Math,
    Power,
    Root,
    Sum,
    negated,
    product,
    total,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Container


class Nodes:
    """Converts nodes to formulas.

    Args:
        symbol: typesets a symbol, given its argument and its place in it.
        turned: indices of nodes ``a - b`` of which only the negative is used.

    Attributes:
        known: names of nodes by index.
    """

    def __init__(
        self, symbol: Callable[[str, Any], Math], turned: Container[int] = frozenset()
    ) -> None:
        """Start without named nodes."""
        self._symbol = symbol
        self._turned = turned
        self.known: dict[int, Math] = {}

    def __call__(self, x: Any) -> Math:
        """Convert an operand; a named node becomes its name."""
        if not isinstance(x, Node):
            whole = float(x).is_integer() and abs(x) < 1e6
            return number(int(x) if whole else float(x))
        found = self.known.get(x.index)
        return self.expression(x) if found is None else found

    def expression(self, node: Node) -> Math:
        """Convert the operation of a node, even if the node has a name."""
        op, a, b = node.op, node.a, node.b
        if op == SYMBOL:
            return self._symbol(str(a), b)
        if op == NEG:
            if a.index in self._turned and a.index in self.known:
                return self.known[a.index]
            return negated(self(a))
        if op in (ADD, SUB):
            return self._sum(node)
        if op == MUL:
            return self._product(self(a), self(b))
        if op == DIV:
            return self._quotient(self(a), self(b))
        if op == "sqrt":
            return Root(self(a))
        arguments = [a] if b is None else [a, b]
        return FunctionCall(RENAMED.get(op, op), tuple(self(x) for x in arguments))

    def _sum(self, node: Node) -> Math:
        a, b = node.a, node.b
        if node.op == SUB and node.index in self._turned and node.index in self.known:
            a, b = b, a
        return total(_cancelled([(False, self(a)), (node.op == SUB, self(b))]))

    def named(self, node: Node) -> Math:
        """Convert a node that is about to get a name, with opposite sign if only its negative is used."""
        if node.index in self._turned and node.op == SUB:
            return total([(False, self(node.b)), (True, self(node.a))])
        return self.expression(node)

    @staticmethod
    def _product(left: Math, right: Math) -> Math:
        """A product with its sign in front and equal factors as a power."""
        (negative, left), (other, right) = _unsigned(left), _unsigned(right)
        found = Power(left, number(2)) if left == right else product([left, right])
        return negated(found) if negative != other else found

    @staticmethod
    def _quotient(above: Math, below: Math) -> Math:
        (negative, above), (other, below) = _unsigned(above), _unsigned(below)
        found = above if below == ONE else Fraction(above, below)
        return negated(found) if negative != other else found


def _cancelled(terms: list[tuple[bool, Math]]) -> list[tuple[bool, Math]]:
    """Summands without pairs of opposite sign."""
    flat: list[tuple[bool, Math]] = []
    for negative, term in terms:
        inner = term.terms if isinstance(term, Sum) else ((False, term),)
        for own, part in inner:
            opposite = (negative == own, part)
            if opposite in flat:
                flat.remove(opposite)
            else:
                flat.append((negative != own, part))
    return flat


def _unsigned(tree: Math) -> tuple[bool, Math]:
    minus = isinstance(tree, Sum) and len(tree.terms) == 1 and tree.terms[0][0]
    return (True, negated(tree)) if minus else (False, tree)
