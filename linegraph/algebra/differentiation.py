"""Differentiation of the expression DAG, and substitution in it; the results are nodes of the DAG again.

A *gradient* is sparse: only the symbols that a node depends on have an entry. Functions with a kink (abs,
min, max) have the derivative of one side there: abs that of positive numbers, min and max that of their first
argument, or of the second one where the first is constant. Powers such as x^(3/2) are differentiated as
powers, whose derivatives are finite where those of the root in them are not.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.algebra.jets import derivatives
from linegraph.algebra.powers import power
from linegraph.algebra.roots import Roots
from linegraph.errors import ModelError
from linegraph.ir.dag import ADD, DIV, MUL, NEG, SUB, SYMBOL, Dag, Node

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar

Symbol = tuple[str, Any]
"""A symbol as (argument, place)."""

Gradient = dict[Symbol, "Scalar"]

SMALLEST = 1e-37
"""Added to divisors so that a quotient of zeros is zero."""


class Calculus:
    """Derivatives and supports of the nodes of one DAG, in forward mode, each found once.

    Example:
        >>> dag = Dag()
        >>> x, y = dag.symbol("x"), dag.symbol("y")
        >>> calculus = Calculus(dag)
        >>> sorted(calculus.gradient(3 * x + y).items())
        [(('x', None), 3), (('y', None), 1)]
        >>> calculus.derivative(x * y, ("x", None)) is y
        True
    """

    def __init__(
        self,
        dag: Dag,
        constants: Collection[str] = (),
        chain: Mapping[Symbol, Gradient] | None = None,
    ) -> None:
        """Start without known derivatives.

        Args:
            dag: whose nodes are differentiated.
            constants: arguments whose symbols count as numbers.
            chain: derivatives of dependent symbols with respect to the independent ones.
        """
        self.dag = dag
        self._constants = constants
        self._chain = chain or {}
        self._gradients: dict[int, Gradient] = {}
        self._supports: dict[int, frozenset[Symbol]] = {}
        self._kinked: dict[int, bool] = {}
        self._roots = Roots(dag)

    def support(self, x: Scalar) -> frozenset[Symbol]:
        """The symbols that a scalar depends on."""
        if not isinstance(x, Node):
            return frozenset()
        for node in _below(x, self._supports):
            if node.op == SYMBOL:
                named = node.a not in self._constants
                self._supports[node.index] = frozenset({(node.a, node.b)} if named else ())
            else:
                parts = [self._supports[p.index] for p in operands(node)]
                self._supports[node.index] = parts[0].union(*parts[1:])
        return self._supports[x.index]

    def derivative(self, x: Scalar, by: Symbol) -> Scalar:
        """The partial derivative of a scalar with respect to one symbol.

        Args:
            x: a node or a number.
            by: the symbol, as (argument, place).
        """
        return self.gradient(x).get(by, 0)

    def gradient(self, x: Scalar) -> Gradient:
        """The partial derivatives of a scalar by symbol; those that are 0 are left out.

        Raises:
            ModelError: a function has no derivative.
        """
        if not isinstance(x, Node):
            return {}
        for node in _below(x, self._gradients):
            self._gradients[node.index] = self._of(node)
        return self._gradients[x.index]

    def _of(self, node: Node) -> Gradient:
        if node.op == SYMBOL:
            symbol = (node.a, node.b)
            return {} if node.a in self._constants else dict(self._chain.get(symbol, {symbol: 1}))
        if node.op == "sqrt" and node.a.op == MUL and node.a.a is node.a.b:
            # the root of a square is an absolute value, and has the slopes of one
            return _combined([(self._side(node.a.a), self._gradients[node.a.a.index])])
        if node.op in _STEEP and self._has_kink(node.a):
            return self._steep(node)
        rooted = self._roots.power_in(node)
        if rooted is not None:
            base, e, rest = rooted.base, rooted.exponent, rooted.rest
            of_base = e * (rest * power(base, e - 1, self.dag))
            return _combined(
                [(of_base, self.gradient(base)), (power(base, e, self.dag), self.gradient(rest))]
            )
        parts = zip(self._partials(node), operands(node), strict=True)
        return _combined((factor, self._gradients[x.index]) for factor, x in parts)

    def _steep(self, node: Node) -> Gradient:
        """A slope that may be infinite, at a kink: in sqrt(max(x, 0)) for x < 0, 0 over 0 counts as 0."""
        divisor = _STEEP[node.op](self.dag, node)
        found: Gradient = {}
        for symbol, slope in self._gradients[node.a.index].items():
            moves = self.dag.function("sign", slope)
            found[symbol] = slope / (divisor + (1 - moves * moves))
        return {symbol: -x for symbol, x in found.items()} if node.op == "acos" else found

    def _has_kink(self, x: Scalar) -> bool:
        """Whether a scalar depends on abs, min or max, which may be constant on one side."""
        if not isinstance(x, Node):
            return False
        for node in _below(x, self._kinked):
            own = node.op in ("abs", "min", "max")
            self._kinked[node.index] = own or any(self._kinked[p.index] for p in operands(node))
        return self._kinked[x.index]

    def _partials(self, node: Node) -> list[Scalar]:
        """The derivatives of one operation with respect to those of its operands that are nodes."""
        a, b = node.a, node.b
        pairs: list[tuple[Any, Callable[[], Scalar]]]
        if node.op == NEG:
            pairs = [(a, lambda: -1)]
        elif node.op == ADD:
            pairs = [(a, lambda: 1), (b, lambda: 1)]
        elif node.op == SUB:
            pairs = [(a, lambda: 1), (b, lambda: -1)]
        elif node.op == MUL:
            pairs = [(a, lambda: b), (b, lambda: a)]
        elif node.op == DIV:
            pairs = [(a, lambda: 1 / b), (b, lambda: -node / b)]
        elif b is None:
            pairs = [(a, lambda: self.slope(node))]
        else:
            first, second = self._slopes(node)
            pairs = [(a, lambda: first), (b, lambda: second)]
        return [partial() for operand, partial in pairs if isinstance(operand, Node)]

    def slope(self, node: Node) -> Scalar:
        """The derivative of a function node of one argument with respect to that argument."""
        if node.op == "abs":
            return self._side(node.a)
        if node.op == "sign":
            return 0
        found = derivatives(node.op, self.dag, node.a, node)
        if found is None:
            raise ModelError("", f"{node.op}(...) has no derivative")
        return found[0]

    def _side(self, x: Scalar) -> Scalar:
        """1 where x is not negative, else -1; sign(x) alone would be 0 at the kink."""
        sign = self.dag.function("sign", x)
        return sign + (1 - sign * sign)

    def _slopes(self, node: Node) -> tuple[Scalar, Scalar]:
        """The two derivatives of a function of two arguments."""
        a, b = node.a, node.b
        if node.op == "atan2":
            squared = a * a + b * b
            return b / squared, -a / squared
        if not self.gradient(a):
            return 0, self._share(node.op, b, a)
        share = self._share(node.op, a, b)
        return share, 1 - share

    def _share(self, op: str, a: Scalar, b: Scalar) -> Scalar:
        """1 where min(a, b) or max(a, b) is a, also where both are equal; else 0. The DAG has no branches."""
        side = self.dag.function("sign", a - b if op == "max" else b - a)
        return 1 + side * (1 - side) / 2


def _combined(parts: Iterable[tuple[Scalar, Gradient]]) -> Gradient:
    """The sum of gradients times factors."""
    found: Gradient = {}
    for factor, slopes in parts:
        for symbol, slope in slopes.items():
            found[symbol] = found.get(symbol, 0) + factor * slope
    return {symbol: slope for symbol, slope in found.items() if slope != 0}


_STEEP: dict[str, Callable[[Dag, Node], Scalar]] = {
    "sqrt": lambda dag, node: 2 * node,
    "asin": lambda dag, node: dag.sqrt(1 - node.a * node.a),
    "acos": lambda dag, node: dag.sqrt(1 - node.a * node.a),
}
"""Functions whose slope is infinite at an end of their domain, with the divisor of the slope."""


class TermSizes:
    """The sum of the absolute values of a scalar's terms, to which its rounding error is proportional.

    Example:
        >>> dag = Dag()
        >>> x, y = dag.symbol("x"), dag.symbol("y")
        >>> difference = TermSizes(Calculus(dag))(x - y)
        >>> from linegraph.algebra.protocol import Floats
        >>> Replay(Floats(), {("x", None): 3.0, ("y", None): -3.0}.__getitem__)(difference)
        6.0
    """

    def __init__(self, calculus: Calculus, unknowns: Collection[str] | None = None) -> None:
        """Start without known sizes.

        Args:
            calculus: of the DAG.
            unknowns: arguments whose symbols vary; a node that depends on none of them is one term. None for
                all.
        """
        self._calculus, self._dag = calculus, calculus.dag
        self._unknowns = unknowns
        self._known: dict[int, Scalar] = {}

    def __call__(self, x: Scalar) -> Scalar:
        """The size of the terms of a scalar, in its unit."""
        if not isinstance(x, Node):
            return abs(x)
        for node in _below(x, self._known):
            self._known[node.index] = self._of(node)
        return self._known[x.index]

    def _of(self, node: Node) -> Scalar:
        if node.op == SYMBOL or self._given(node):
            return self._dag.function("abs", node)
        a, b = (self._operand(part) for part in (node.a, node.b))
        if node.op == NEG:
            return a
        if node.op in (ADD, SUB):
            return a + b
        if node.op == MUL:
            return self._of_product(node, a, b)
        if node.op == DIV:
            return self._of_quotient(node, a, b)
        if node.op == "atan2":
            return self._of_angle(node, a, b)
        if node.b is not None:
            return a + b
        if node.op in _STEEP:
            return self._of_steep(node, a)
        return (
            self._dag.function("abs", node)
            + self._dag.function("abs", self._calculus.slope(node)) * a
        )

    def _of_product(self, node: Node, a: Scalar, b: Scalar) -> Scalar:
        """The error of each factor times the value of the other, since a factor may be a small difference."""
        x, y = (self._dag.function("abs", part) for part in (node.a, node.b))
        if _same(a, x):
            return x * b
        return a * y if _same(b, y) else x * b + a * y

    def _of_quotient(self, node: Node, a: Scalar, b: Scalar) -> Scalar:
        """The error of the numerator, and of the denominator times the quotient; over the denominator."""
        y, quotient = (self._dag.function("abs", part) for part in (node.b, node))
        return a / y if _same(b, y) else (a + quotient * b) / y

    def _of_steep(self, node: Node, a: Scalar) -> Scalar:
        """Where a slope may be infinite, an error of e a in the argument makes one of some sqrt(e a)."""
        steep = a / (_STEEP[node.op](self._dag, node) + (1e-5 * self._dag.sqrt(a) + SMALLEST))
        return self._dag.function("abs", node) + steep

    def _of_angle(self, node: Node, a: Scalar, b: Scalar) -> Scalar:
        """The errors of a point's coordinates turn its angle the more, the nearer it is to the origin."""
        y, x, angle = (self._dag.function("abs", part) for part in (node.a, node.b, node))
        return angle + (x * a + y * b) / (y * y + x * x + SMALLEST)

    def _given(self, node: Node) -> bool:
        """Whether a node is the same number at every evaluation."""
        return self._unknowns is not None and not any(
            symbol[0] in self._unknowns for symbol in self._calculus.support(node)
        )

    def _operand(self, x: Any) -> Scalar:
        if x is None:
            return 0
        return self._known[x.index] if isinstance(x, Node) else abs(x)


def _same(size: Scalar, value: Scalar) -> bool:
    """Whether a size is that of one term, whose only error is the rounding of the number itself."""
    return size is value or not (isinstance(size, Node) or isinstance(value, Node))


def operands(node: Node) -> list[Node]:
    """The operands that are nodes."""
    return [x for x in (node.a, node.b) if isinstance(x, Node)] if node.op != SYMBOL else []


def _below(x: Node, known: Mapping[int, Any]) -> list[Node]:
    """The nodes that a node depends on and that are not known yet, itself included, operands first."""
    found: dict[int, Node] = {}
    pending = [x]
    while pending:
        node = pending.pop()
        if node.index not in found and node.index not in known:
            found[node.index] = node
            pending += operands(node)
    return [found[index] for index in sorted(found)]


_OPERATIONS: dict[str, Callable[..., Scalar]] = {
    NEG: lambda a: -a,
    ADD: lambda a, b: a + b,
    SUB: lambda a, b: a - b,
    MUL: lambda a, b: a * b,
    DIV: lambda a, b: a / b,
}


class Replay:
    """Repeats the operations of a DAG over another algebra, or over the same DAG with symbols replaced.

    Args:
        algebra: the algebra of the results.
        symbol: the scalar for a symbol, given as (argument, place).
        number: the scalar for a number; by default the number itself.

    Example:
        >>> from linegraph.algebra.protocol import Floats
        >>> dag = Dag()
        >>> x = dag.symbol("x")
        >>> Replay(Floats(), {("x", None): 3.0}.__getitem__)(x * x)
        9.0
    """

    def __init__(
        self,
        algebra: Algebra,
        symbol: Callable[[Symbol], Scalar],
        number: Callable[[Scalar], Scalar] | None = None,
    ) -> None:
        """Start without known nodes; each node is computed once."""
        self._algebra = algebra
        self._symbol = symbol
        self._number = number or (lambda x: x)
        self._known: dict[int, Scalar] = {}

    def __call__(self, x: Scalar) -> Scalar:
        """The scalar over the other algebra."""
        if not isinstance(x, Node):
            return self._number(x)
        for node in _below(x, self._known):
            self._known[node.index] = self._value(node)
        return self._known[x.index]

    def all(self, given: Iterable[Scalar]) -> list[Scalar]:
        """Several scalars over the other algebra."""
        return [self(x) for x in given]

    def _value(self, node: Node) -> Scalar:
        if node.op == SYMBOL:
            return self._symbol((node.a, node.b))
        given = [
            self._known[x.index] if isinstance(x, Node) else self._number(x)
            for x in (node.a, node.b)
            if x is not None
        ]
        action = _OPERATIONS.get(node.op)
        return action(*given) if action else self._algebra.function(node.op, *given)


def substitute(x: Scalar, dag: Dag, values: Mapping[Symbol, Scalar]) -> Scalar:
    """A scalar of a DAG with some of its symbols replaced.

    Args:
        x: a node or a number.
        dag: its DAG, to which the result belongs.
        values: scalars of the same DAG by symbol.
    """
    return substitution(dag, values)(x)


def substitution(dag: Dag, values: Mapping[Symbol, Scalar]) -> Replay:
    """The replacement of symbols in many scalars of a DAG, which computes common nodes once.

    Args:
        dag: the DAG.
        values: scalars of the same DAG by symbol.
    """
    return Replay(dag, lambda symbol: values[symbol] if symbol in values else dag.symbol(*symbol))
