"""Antiderivatives of a scalar of a DAG with respect to one symbol, by exact rules.

Integrated are: sums; polynomials and their quotients by a power; functions that are homogeneous in one linear
argument L, such as ``L |L|``, ``sign(L) sqrt(|L|)`` and ``max(L, 0)^1.5``; max and min of linear ones and
limits of these; the elementary functions of a linear argument; and ``u' g(u)``. Anything else has no
antiderivative here.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

from linegraph.algebra.differentiation import operands, substitution
from linegraph.algebra.residues import Residues
from linegraph.errors import ModelError
from linegraph.ir.dag import ADD, DIV, MUL, NEG, SUB, SYMBOL, Node

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.differentiation import Calculus, Symbol
    from linegraph.algebra.scalar import Scalar

MOST_POWERS = 64
MOST_STEPS = 500

Polynomial = dict[int, "Scalar"]
"""Coefficients by power; powers may be negative."""


class _None(Exception):
    """Raised where no rule applies."""


def antiderivative(calculus: Calculus, f: Scalar, by: Symbol) -> Scalar | None:
    """A scalar F with ∂F/∂s = f for a symbol s; None where no rule gives one.

    F is zero at s = 0, unless it may be infinite there.

    Args:
        calculus: derivatives over the DAG of f.
        f: the scalar.
        by: the symbol s, as (argument, place).

    Example:
        >>> from linegraph.algebra.differentiation import Calculus
        >>> from linegraph.ir.dag import Dag
        >>> dag = Dag()
        >>> x, k = dag.symbol("x"), dag.symbol("k")
        >>> calculus = Calculus(dag)
        >>> energy = antiderivative(calculus, k * x + 2 * x * x * x, ("x", None))
        >>> from linegraph.algebra.protocol import Floats
        >>> from linegraph.algebra.differentiation import Replay
        >>> Replay(Floats(), {("x", None): 2.0, ("k", None): 3.0}.__getitem__)(energy)
        14.0
    """
    try:
        found = _Rules(calculus, by).of(f)
    except (_None, ZeroDivisionError):
        return None
    try:
        at_zero = substitution(calculus.dag, {by: 0})(found)
    except (ArithmeticError, ModelError):
        return found
    # the value at zero may be symbolic and infinite: it is subtracted only if it surely is not
    sure = not isinstance(at_zero, Node) or not _has_pole(calculus, found, by)
    return found - at_zero if sure else found


def _has_pole(calculus: Calculus, f: Scalar, by: Symbol) -> bool:
    """Whether a divisor, or the argument of a logarithm, depends on the symbol."""
    pending = [f]
    seen: set[int] = set()
    while pending:
        x = pending.pop()
        if not isinstance(x, Node) or x.index in seen or by not in calculus.support(x):
            continue
        seen.add(x.index)
        below = {DIV: x.b, "log": x.a}.get(x.op)
        if isinstance(below, Node) and by in calculus.support(below):
            return True
        pending += operands(x)
    return False


class _Rules:
    def __init__(self, calculus: Calculus, by: Symbol) -> None:
        self._calculus, self._dag, self._by = calculus, calculus.dag, by
        self._x = self._dag.symbol(*by)
        self._residues = Residues()
        self._depth = 0

    def of(self, f: Scalar) -> Scalar:
        """The antiderivative.

        Raises:
            _None: no rule gives it.
        """
        self._depth += 1
        if self._depth > MOST_STEPS:
            raise _None
        if not self._varies(f):
            return f * self._x
        if f.op == NEG:
            return -self.of(f.a)
        if f.op == ADD:
            return self.of(f.a) + self.of(f.b)
        if f.op == SUB:
            return self.of(f.a) - self.of(f.b)
        return self._of_product(*self._factors(f))

    def _varies(self, f: Scalar) -> bool:
        return isinstance(f, Node) and self._by in self._calculus.support(f)

    def _factors(self, f: Scalar) -> tuple[Scalar, list[Node]]:
        """The constant factor of a product, and the factors that vary."""
        constant: Scalar = 1
        varying: list[Node] = []
        pending = [f]
        while pending:
            x = pending.pop()
            if not self._varies(x):
                constant = constant * x
            elif x.op == MUL:
                pending += [x.b, x.a]
            elif x.op == NEG:
                constant = -constant
                pending.append(x.a)
            elif x.op == DIV and not self._varies(x.b):
                constant = constant / x.b
                pending.append(x.a)
            else:
                varying.append(x)
        return constant, varying

    def _of_product(self, constant: Scalar, factors: Sequence[Node]) -> Scalar:
        if len(factors) == 1 and factors[0].op in (ADD, SUB):
            return constant * self.of(factors[0])
        for rule in (self._homogeneous, self._clipped, self._function, self._laurent, self._inner):
            found = rule(factors)
            if found is not None:
                return constant * found
        return constant * self._distributed(factors)

    def _slope(self, f: Scalar) -> Scalar | None:
        """The slope of a scalar that is linear in the symbol; None for any other."""
        slope = self._calculus.derivative(f, self._by)
        return None if self._varies(slope) or not self._residues(slope) else slope

    def _homogeneous(self, factors: Sequence[Node]) -> Scalar | None:
        """``L f / ((p + 1) L')`` for f of degree p in one linear L, as ``|L| L``, by Euler's theorem."""
        found = self._linear_in(factors)
        if found is None:
            return None
        linear, slope = found
        f: Scalar = 1
        degree = Fraction(0)
        for factor in factors:
            f = f * factor
            own = self._degree(factor, linear, slope)
            if own is None:
                return None
            degree += own
        if degree == -1:
            # f is a multiple of 1 / L, and p + 1 would be divided by
            size = self._dag.function("abs", linear)
            return linear * f * self._dag.function("log", size) / slope
        above = degree + 1
        return above.denominator * (linear * f) / (above.numerator * slope)

    def _linear_in(self, factors: Sequence[Node]) -> tuple[Node, Scalar] | None:
        """The first part of a product that is linear in the symbol, and its slope."""
        pending: list[Node] = list(reversed(factors))
        while pending:
            x = pending.pop()
            slope = self._slope(x)
            if slope is not None:
                return x, slope
            if x.op not in (ADD, SUB):
                pending += [part for part in reversed(operands(x)) if self._varies(part)]
        return None

    def _degree(self, f: Scalar, linear: Node, slope: Scalar) -> Fraction | None:
        """The degree of a scalar that is homogeneous in a linear L; None for any other."""
        if not self._varies(f):
            return Fraction(0)
        own = self._slope(f)
        if own is not None:
            return None if self._residues(f * slope - linear * own) else Fraction(1)
        parts = [
            self._degree(x, linear, slope) for x in (f.a, f.b) if x is not None and f.op != SYMBOL
        ]
        if f.op in ("max", "min"):
            return parts[0 if f.b == 0 else 1] if 0 in (f.a, f.b) else None
        if f.op == DIV and not self._varies(f.a):
            parts[0] = Fraction(0)
        if not parts or None in parts:
            return None
        a, b = parts[0], parts[-1]
        assert a is not None
        assert b is not None
        degrees = {NEG: a, MUL: a + b, DIV: a - b, "abs": a, "sign": 0 * a, "sqrt": a / 2}
        return degrees.get(f.op)

    def _clipped(self, factors: Sequence[Node]) -> Scalar | None:
        """``max(a, b)`` of linear ones, and a limit of such a limit: ``min(p, max(q, L))``."""
        clip = factors[0]
        if len(factors) != 1 or clip.op not in ("max", "min"):
            return None
        inner = next(
            (x for x in (clip.a, clip.b) if self._varies(x) and x.op in ("max", "min")), None
        )
        other = clip.b if inner is clip.a else clip.a
        if inner is not None and not self._varies(other):
            return self._limited(clip.op, other, inner)
        apart = clip.a - clip.b
        slope = self._slope(apart)
        if slope is None:
            return None
        # max(a, b) is half of a + b + |a - b|
        half = apart * self._dag.function("abs", apart) / (2 * slope)
        total = self.of(clip.a) + self.of(clip.b)
        return (total + half) / 2 if clip.op == "max" else (total - half) / 2

    def _limited(self, op: str, p: Scalar, inner: Node) -> Scalar | None:
        function = self._dag.function
        if self._varies(inner.a) == self._varies(inner.b):
            return None
        q, f = (inner.b, inner.a) if self._varies(inner.a) else (inner.a, inner.b)
        if inner.op == op:
            return self.of(function(op, function(op, p, q), f))
        if op == "min":
            return self.of(inner) - self.of(function("max", function("max", 0, q - p), f - p))
        return self.of(inner) + self.of(function("max", function("max", 0, p - q), p - f))

    def _function(self, factors: Sequence[Node]) -> Scalar | None:
        """An elementary function of a linear argument."""
        f = factors[0]
        if len(factors) != 1 or f.op in (SYMBOL, DIV) or f.b is not None:
            return None
        slope = self._slope(f.a)
        primitive = None if slope is None else self._primitive(f.op, f.a, f)
        return None if primitive is None else primitive / slope

    def _inner(self, factors: Sequence[Node]) -> Scalar | None:
        """``u' g(u)``, and ``u'/u`` and ``u'/sqrt(u)``, up to a constant factor."""
        for place, factor in enumerate(factors):
            rest: Scalar = 1
            for k, other in enumerate(factors):
                rest = rest if k == place else rest * other
            g = factor
            if factor.op == DIV:
                rest, g = rest * factor.a, factor.b
            over = factor.op == DIV
            for u in (g.a, g) if isinstance(g, Node) and g.op != SYMBOL else ():
                scale = self._constant_ratio(rest, u)
                found = None if scale is None else self._of_inner(g, u, over)
                if found is not None:
                    return scale * found
        return None

    def _of_inner(self, g: Node, u: Scalar, over: bool) -> Scalar | None:
        """The primitive of g with respect to u, which is its argument or itself; of 1/g if `over`."""
        if u is g:
            return self._dag.function("log", self._dag.function("abs", g)) if over else None
        if g.b is not None or g.op == NEG:
            return None
        if g.op == "sqrt":
            return 2 * g if over else 2 * (u * g) / 3
        return None if over else self._primitive(g.op, u, g)

    def _constant_ratio(self, f: Scalar, u: Scalar) -> Scalar | None:
        """The factor between a scalar and the derivative of u, if that is constant.

        It is compared at two values of the symbol. A zero derivative of the ratio would not prove it
        constant: that of a sign is zero, too, and so is that of the slope of max(u, 0).
        """
        if not self._varies(u):
            return None
        ratio = f / self._calculus.derivative(u, self._by)
        elsewhere = substitution(self._dag, {self._by: self._dag.symbol("elsewhere")})(ratio)
        if self._residues(ratio - elsewhere):
            return None
        return substitution(self._dag, {self._by: 1})(ratio)

    def _distributed(self, factors: Sequence[Node]) -> Scalar:
        """A product with a sum among its factors as a sum of products."""
        place = next((k for k, x in enumerate(factors) if x.op in (ADD, SUB)), None)
        if place is None or len(factors) == 1:
            raise _None
        left: Scalar = factors[place].a
        right: Scalar = factors[place].b
        for k, factor in enumerate(factors):
            if k != place:
                left, right = left * factor, right * factor
        a, b = self.of(left), self.of(right)
        return a + b if factors[place].op == ADD else a - b

    def _primitive(self, name: str, x: Node, f: Node) -> Scalar | None:
        function = self._dag.function
        size = function("abs", x)
        if name == "tanh":
            # log(cosh(x)), which does not overflow
            return size + function("log", 1 + function("exp", -2 * size)) - math.log(2)
        return {
            "sqrt": lambda: 2 * (x * f) / 3,
            "sin": lambda: -function("cos", x),
            "cos": lambda: function("sin", x),
            "tan": lambda: -function("log", function("abs", function("cos", x))),
            "exp": lambda: f,
            "sinh": lambda: function("cosh", x),
            "cosh": lambda: function("sinh", x),
            "atan": lambda: x * f - function("log", 1 + x * x) / 2,
            "asin": lambda: x * f + function("sqrt", 1 - x * x),
            "acos": lambda: x * f - function("sqrt", 1 - x * x),
            "log": lambda: x * f - x,
        }.get(name, lambda: None)()

    # -- polynomials, and their quotients by a power of the symbol

    def _laurent(self, factors: Sequence[Node]) -> Scalar | None:
        total: Polynomial = {0: 1}
        try:
            for factor in factors:
                total = _times(total, self._terms(factor))
        except _None:
            return None
        return self._of_terms(total)

    def _terms(self, f: Scalar) -> Polynomial:
        """A polynomial in the symbol, with negative powers.

        Raises:
            _None: it is not one.
        """
        if not self._varies(f):
            return {0: f}
        if f is self._x:
            return {1: 1}
        if f.op == NEG:
            return {n: -c for n, c in self._terms(f.a).items()}
        if f.op in (ADD, SUB):
            return _plus(self._terms(f.a), self._terms(f.b), 1 if f.op == ADD else -1)
        if f.op == MUL:
            return _times(self._terms(f.a), self._terms(f.b))
        if f.op == DIV:
            below = self._terms(f.b)
            if len(below) == 1:
                ((power, divisor),) = below.items()
                return {n - power: c / divisor for n, c in self._terms(f.a).items()}
        raise _None

    def _of_terms(self, terms: Polynomial) -> Scalar:
        total: Scalar = 0
        for n, c in sorted(terms.items()):
            if n == -1:
                total = total + c * self._dag.function("log", self._dag.function("abs", self._x))
            elif n >= 0:
                total = total + c * _raised(self._x, n + 1) / (n + 1)
            else:
                total = total + c / ((n + 1) * _raised(self._x, -n - 1))
        return total


def _raised(x: Scalar, n: int) -> Scalar:
    total: Scalar = 1
    for _ in range(n):
        total = total * x
    return total


def _plus(a: Polynomial, b: Polynomial, sign: int) -> Polynomial:
    total = dict(a)
    for n, c in b.items():
        total[n] = total.get(n, 0) + sign * c
    return total


def _times(a: Polynomial, b: Polynomial) -> Polynomial:
    total: Polynomial = {}
    for n, c in a.items():
        for m, d in b.items():
            if abs(n + m) > MOST_POWERS:
                raise _None
            total[n + m] = total.get(n + m, 0) + c * d
    return total
