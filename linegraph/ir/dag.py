"""The expression DAG: scalars that remember how they were computed.

A `Node` is one operation on earlier nodes or numbers. Nodes are made by ordinary arithmetic and are
*hash-consed*: the same operation on the same operands is the same node, so common subexpressions never
arise twice. Simplification is local and happens at construction only:

    x + 0 = x      x * 0 = 0      x * 1 = x      x - x = 0      numbers are folded
    signs move outward: a * (-b) = -(a * b),  a + (-b) = a - b,  (-a) - b = -(a + b)

Plain Python numbers are scalars too and stay numbers until they meet a node: structural zeros cost
nothing. Numbering follows the order of construction, so equal input gives equal programs.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeAlias

from linegraph.ir.functions import of_numbers

if TYPE_CHECKING:
    from collections.abc import Mapping

Number: TypeAlias = int | float | Fraction

SYMBOL, NEG, ADD, SUB, MUL, DIV = "symbol", "neg", "add", "sub", "mul", "div"


class Node:
    """One operation of the DAG: ``op(a, b)``.

    Attributes:
        dag: the DAG that the node belongs to.
        op: the operation: `SYMBOL`, `NEG`, `ADD`, `SUB`, `MUL`, `DIV` or a name in `functions.ARITY`.
        a: the first operand; for a symbol the name of the argument from which it is read.
        b: the second operand, None if there is none; for a symbol its place in that argument: 3 for
            ``q[3]``, ``"mass"`` for a parameter, None for the time.
        index: the number of nodes that were made before this one.
        label: the part of the system for which the node was derived.
    """

    __slots__ = ("a", "b", "dag", "index", "label", "op")

    def __init__(self, dag: Dag, op: str, a: Any, b: Any) -> None:
        """Number the node and copy the current label; only `Dag` calls this.

        Args:
            dag: the DAG that the node belongs to; its count goes up by one.
            op: the operation.
            a: the first operand.
            b: the second operand, None if there is none.
        """
        self.dag = dag
        self.op = op
        self.a = a
        self.b = b
        self.index = dag.count
        self.label = dag.label
        dag.count += 1

    def __repr__(self) -> str:
        """Name a symbol, number everything else."""
        if self.op != SYMBOL:
            return f"n{self.index}"
        return self.a if self.b is None else f"{self.a}[{self.b}]"

    def __neg__(self) -> Operand:
        return self.dag.negate(self)

    def __add__(self, other: Operand) -> Operand:
        return self.dag.add(self, other) if isinstance(other, _OPERANDS) else NotImplemented

    def __radd__(self, other: Number) -> Operand:
        return self.dag.add(self, other)

    def __sub__(self, other: Operand) -> Operand:
        return self.dag.subtract(self, other) if isinstance(other, _OPERANDS) else NotImplemented

    def __rsub__(self, other: Number) -> Operand:
        return self.dag.subtract(other, self)

    def __mul__(self, other: Operand) -> Operand:
        return self.dag.multiply(self, other) if isinstance(other, _OPERANDS) else NotImplemented

    def __rmul__(self, other: Number) -> Operand:
        return self.dag.multiply(self, other)

    def __truediv__(self, other: Operand) -> Operand:
        return self.dag.divide(self, other) if isinstance(other, _OPERANDS) else NotImplemented

    def __rtruediv__(self, other: Number) -> Operand:
        return self.dag.divide(other, self)


Operand: TypeAlias = "Node | Number"

_OPERANDS = (Node, int, float, Fraction)
"""What a node calculates with; anything else, such as a `jets.Jet`, calculates with it."""


class Dag:
    """A family of hash-consed nodes: the algebra over which programs are derived.

    Attributes:
        label: stamped on every node made from now on; set it to the name of the part being derived.

    Example:
        >>> dag = Dag()
        >>> x = dag.symbol("x")
        >>> (x + 1) * 0 + x - x
        0
        >>> dag.sin(x) is dag.sin(x)
        True
    """

    def __init__(self) -> None:
        """Start empty."""
        self.count = 0
        self.label = ""
        self._known: dict[object, Node] = {}

    def release(self) -> None:
        """Forget the nodes: those no result needs are freed. Operations repeated later are new nodes."""
        self._known.clear()

    def symbol(self, argument: str, place: int | str | None = None) -> Node:
        """The node that reads an input; repeated calls return the same node.

        Args:
            argument: the name of the emitted function's argument, such as ``q`` or ``p``.
            place: the index in an array, the name of a parameter, or None for a single number.
        """
        return self._node(SYMBOL, argument, place)

    def copied(self, node: Node, known: Mapping[int, Operand]) -> Operand:
        """Copy an operation of another DAG into this one.

        Args:
            node: the operation in the other DAG.
            known: by index in the other DAG, the copies of the nodes on which it operates.
        """
        a, b = node.a, node.b
        a = known[a.index] if isinstance(a, Node) else a
        return self._node(node.op, a, known[b.index] if isinstance(b, Node) else b)

    def sin(self, x: Operand) -> Operand:
        """Sine of an angle in radians."""
        return self._function("sin", x)

    def cos(self, x: Operand) -> Operand:
        """Cosine of an angle in radians."""
        return self._function("cos", x)

    def sqrt(self, x: Operand) -> Operand:
        """The non-negative square root."""
        return self._function("sqrt", x)

    def function(self, name: str, *x: Operand) -> Operand:
        """The value of an elementary function; it is a number if all arguments are numbers.

        Args:
            name: one of `functions.ARITY`.
            x: as many arguments as the function takes; angles in radians.

        Raises:
            ModelError: all arguments are numbers, and the function has no finite value there.
        """
        numbers = [part for part in x if not isinstance(part, Node)]
        if len(numbers) == len(x):
            return of_numbers(name, *numbers)
        if name in ("sin", "cos"):
            return self._function(name, x[0])
        return self._node(name, x[0], x[1] if len(x) > 1 else None)

    def negate(self, x: Operand) -> Operand:
        """``-x``, with a double negation cancelled and a constant factor's sign turned."""
        if not isinstance(x, Node):
            return -x
        if x.op == NEG:
            inner: Node = x.a
            return inner
        return self._node(NEG, x, None)

    def add(self, x: Operand, y: Operand) -> Operand:
        """The sum ``x + y``; negations are moved outward, where they need no operation.

        Args:
            x: one summand.
            y: the other summand; equal nodes become ``2 x``.
        """
        if not isinstance(x, Node):
            return self._shift(y, x) if isinstance(y, Node) else x + y
        if not isinstance(y, Node):
            return self._shift(x, y)
        if y.op == NEG:
            return self.subtract(x, y.a)
        if x.op == NEG:
            return self.subtract(y, x.a)
        if x is y:
            return self._scale(2, x)
        return self._node(ADD, x, y) if x.index <= y.index else self._node(ADD, y, x)

    def subtract(self, x: Operand, y: Operand) -> Operand:
        """The difference ``x - y``; if ``y - x`` already exists, its negative is returned.

        Args:
            x: the minuend.
            y: the subtrahend.
        """
        if not isinstance(y, Node):
            return self.add(x, -y)
        if y.op == NEG:
            return self.add(x, y.a)
        if not isinstance(x, Node):
            return self.negate(y) if x == 0 else self._node(SUB, x, y)
        if x is y:
            return 0
        if x.op == NEG:
            return self.negate(self.add(x.a, y))
        turned = self._known.get((SUB, y.index, x.index))
        return self._node(SUB, x, y) if turned is None else self.negate(turned)

    def multiply(self, x: Operand, y: Operand) -> Operand:
        """The product ``x * y``; signs are moved outward and numeric factors are combined.

        Args:
            x: one factor.
            y: the other factor.
        """
        if not isinstance(x, Node):
            return self._scale(x, y) if isinstance(y, Node) else x * y
        if not isinstance(y, Node):
            return self._scale(y, x)
        if x.op == NEG:
            return self.negate(self.multiply(x.a, y))
        if y.op == NEG:
            return self.negate(self.multiply(x, y.a))
        return self._node(MUL, x, y) if x.index <= y.index else self._node(MUL, y, x)

    def divide(self, x: Operand, y: Operand) -> Operand:
        """The quotient ``x / y``.

        Args:
            x: the numerator.
            y: the denominator; a division by a number becomes a multiplication by its reciprocal.

        Raises:
            ZeroDivisionError: y is the number zero, which is an error of the derivation.
        """
        if not isinstance(y, Node):
            return x / y if not isinstance(x, Node) else self.multiply(1 / Fraction(y), x)
        if not isinstance(x, Node):
            if x == 0:
                return 0
        elif x is y:
            return 1
        elif x.op == NEG:
            return self.negate(self.divide(x.a, y))
        if y.op == NEG:
            return self.negate(self.divide(x, y.a))
        return self._node(DIV, x, y)

    def _shift(self, x: Node, number: Number) -> Operand:
        if number == 0:
            return x
        return self._node(SUB, number, x.a) if x.op == NEG else self._node(ADD, x, number)

    def _scale(self, factor: Number, x: Node) -> Operand:
        if factor == 0:
            return 0
        if factor == 1:
            return x
        if factor == -1:
            return self.negate(x)
        if x.op == NEG:
            return self._scale(-factor, x.a)
        if x.op == MUL and not isinstance(x.b, Node):
            return self._scale(factor * x.b, x.a)
        if factor < 0:
            return self.negate(self._node(MUL, x, -factor))
        return self._node(MUL, x, factor)

    def _function(self, name: str, x: Operand) -> Operand:
        if not isinstance(x, Node):
            return of_numbers(name, x)
        if x.op == NEG and name == "cos":
            return self._node(name, x.a, None)
        if x.op == NEG and name == "sin":
            return self.negate(self._node(name, x.a, None))
        return self._node(name, x, None)

    def _node(self, op: str, a: Any, b: Any) -> Node:
        key = (
            op,
            a.index if isinstance(a, Node) else (a,),
            b.index if isinstance(b, Node) else (b,),
        )
        node = self._known.get(key)
        if node is None:
            node = self._known[key] = Node(self, op, a, b)
        return node
