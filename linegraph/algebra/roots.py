"""Half-integer powers among products: x sqrt(x) is x^(3/2), differentiable at 0 where sqrt(x) is not."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING

from linegraph.algebra.powers import power
from linegraph.ir.dag import DIV, MUL, NEG, Node

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.ir.dag import Dag


@dataclass(frozen=True)
class RootedPower:
    """A product ``base^exponent rest`` one of whose factors is a root of the base.

    Attributes:
        base: a scalar.
        exponent: a multiple of 1/2, at least 1.
        rest: the product of the other factors.
    """

    base: Scalar
    exponent: Fraction
    rest: Scalar


@dataclass
class _Factors:
    """The factors of a product.

    Attributes:
        signs: for each base, by its index, the sign that it has under its root.
        coefficient: product of the numbers.
        exponents: how often each base is a factor; a root counts one half.
        bases: the bases by index.
        others: factors without such a root.
        divisors: the divisors.
    """

    signs: dict[int, int]
    coefficient: Scalar = 1
    exponents: dict[int, Fraction] = field(default_factory=dict)
    bases: dict[int, Node] = field(default_factory=dict)
    others: list[Node] = field(default_factory=list)
    divisors: list[Scalar] = field(default_factory=list)

    def add(self, x: Scalar) -> None:
        """Take one more factor apart and enter its parts."""
        if not isinstance(x, Node):
            self.coefficient = self.coefficient * x
            return
        number, core = _stripped(x)
        self.coefficient = self.coefficient * number
        if core.index in self.signs:
            self.coefficient = self.coefficient * self.signs[core.index]
            self._count(core, Fraction(1))
        elif core.op == "sqrt":
            inner, base = _stripped(core.a)
            if abs(inner) != 1:
                self.coefficient = self.coefficient * float(abs(inner)) ** 0.5
            self._count(base, Fraction(1, 2))
        elif core.op == MUL:
            self.add(core.a)
            self.add(core.b)
        elif core.op == DIV:
            self.add(core.a)
            self.divisors.append(core.b)
        else:
            self.others.append(core)

    def _count(self, base: Node, exponent: Fraction) -> None:
        self.bases[base.index] = base
        self.exponents[base.index] = self.exponents.get(base.index, Fraction(0)) + exponent


class Roots:
    """Finds half-integer powers among the nodes of one DAG."""

    def __init__(self, dag: Dag) -> None:
        """Start without known nodes."""
        self._dag = dag
        self._rooted: dict[int, bool] = {}

    def power_in(self, node: Node) -> RootedPower | None:
        """A product as a half-integer power; None where no factor is the root of another factor's base.

        Example:
            >>> from linegraph.ir.dag import Dag
            >>> dag = Dag()
            >>> x, y = dag.symbol("x"), dag.symbol("y")
            >>> found = Roots(dag).power_in(3 * x * y * dag.sqrt(x))
            >>> found.base is x, found.exponent, found.rest is 3 * y
            (True, Fraction(3, 2), True)
        """
        if node.op != MUL or not self._has_root(node):
            return None
        signs: dict[int, int] = {}
        pending: list[Scalar] = [node]
        while pending:
            x = pending.pop()
            if not isinstance(x, Node) or not self._has_root(x):
                continue
            if x.op == "sqrt":
                number, base = _stripped(x.a)
                signs[base.index] = 1 if number > 0 else -1
            else:
                pending += [x.a] if x.op in (NEG, DIV) else [x.a, x.b]
        factors = _Factors(signs)
        factors.add(node)
        for index, exponent in factors.exponents.items():
            if exponent >= 1:
                return self._apart(factors, index, exponent)
        return None

    def _apart(self, factors: _Factors, index: int, exponent: Fraction) -> RootedPower:
        rest: Scalar = factors.coefficient
        for other in factors.others:
            rest = rest * other
        for key, base in factors.bases.items():
            if key != index:
                rest = rest * power(factors.signs[key] * base, factors.exponents[key], self._dag)
        for divisor in factors.divisors:
            rest = rest / divisor
        return RootedPower(factors.signs[index] * factors.bases[index], exponent, rest)

    def _has_root(self, node: Node) -> bool:
        """Whether a square root is a factor, in quotients of the numerator."""
        found = self._rooted.get(node.index)
        if found is None:
            inner = {NEG: (node.a,), DIV: (node.a,), MUL: (node.a, node.b)}.get(node.op, ())
            found = node.op == "sqrt"
            found = found or any(self._has_root(x) for x in inner if isinstance(x, Node))
            self._rooted[node.index] = found
        return found


def _stripped(node: Node) -> tuple[Scalar, Node]:
    """The number and the node whose product a node is."""
    number: Scalar = 1
    while True:
        if node.op == NEG:
            number, node = -number, node.a
        elif node.op == MUL and not isinstance(node.b, Node):
            number, node = number * node.b, node.a
        else:
            return number, node
