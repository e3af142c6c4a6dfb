"""What a rewritten form is held against: the expression as derived, at random points, to fifty digits.

A DAG's node, the terms of a ring and a sympy expression are evaluated by three walks that share nothing but
the values of the symbols.
"""

from __future__ import annotations

import random
from functools import reduce
from typing import TYPE_CHECKING, Any

from mpmath.ctx_mp import MPContext

from linegraph.algebra.differentiation import Replay
from linegraph.algebra.sympy_scalars import OURS
from linegraph.symbolic.simplification.polynomial import COS, FUNCTION, ROOT, SIN, SYMBOL

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.algebra.sympy_scalars import Expr
    from linegraph.symbolic.simplification.numbers import Terms
    from linegraph.symbolic.simplification.polynomial import Ring

DIGITS = 50
EXACT = 1e-40
"""How far forms may differ, relative to the terms they are sums of, where all numbers are exact ..."""
INEXACT = 1e-12
"""... and where some are floats, whose sums are rounded."""

OWN = {"abs": "fabs"}
"""Functions that mpmath calls otherwise."""


class Precise:
    """The algebra of numbers with fifty digits."""

    def __init__(self) -> None:
        """A context of its own: nobody's precision is changed."""
        self.context = MPContext()
        self.context.dps = DIGITS

    def symbol(self, argument: str, place: int | str | None = None) -> Scalar:
        """There are none here; a `SamplePoint` has them."""
        raise KeyError(argument, place)

    def sin(self, x: Scalar) -> Scalar:
        """Sine of an angle in radians."""
        return self.context.sin(x)

    def cos(self, x: Scalar) -> Scalar:
        """Cosine of an angle in radians."""
        return self.context.cos(x)

    def sqrt(self, x: Scalar) -> Scalar:
        """The square root, complex where x is negative."""
        return self.context.sqrt(x)

    def function(self, name: str, *x: Scalar) -> Scalar:
        """Any function of `functions.ARITY`."""
        if name in ("min", "max"):
            return (min if name == "min" else max)(x, key=lambda z: z.real)
        return getattr(self.context, OWN.get(name, name))(*x)


class SamplePoint:
    """Random values of all symbols, and what expressions are worth there.

    Args:
        ring: whose terms are evaluated.
        names: a symbol of the ring by the sympy symbol it is written as; filled while writing.
        seed: of the values.
        units: symbols whose values are those of a unit vector.
    """

    def __init__(
        self,
        ring: Ring,
        names: dict[Expr, Symbol],
        seed: int,
        units: Iterable[Sequence[Symbol]] = (),
    ) -> None:
        """Values arise when they are asked for, each from its symbol's name alone."""
        self._ring = ring
        self._names = names
        self._seed = seed
        self._algebra = Precise()
        self._values: dict[Symbol, Any] = {}
        self._replay = Replay(self._algebra, self.value, self._algebra.context.convert)
        self._generators: dict[int, Any] = {}
        self._known: dict[Expr, Any] = {}
        for unit in units:
            entries = [self.value(symbol) for symbol in unit]
            length = self._algebra.sqrt(sum(x * x for x in entries))
            self._values |= {symbol: x / length for symbol, x in zip(unit, entries, strict=True)}

    def value(self, symbol: Symbol) -> Any:
        """A symbol's value."""
        if symbol not in self._values:
            draw = random.Random(f"{self._seed} {symbol}")
            self._values[symbol] = self._algebra.context.mpf(draw.randint(20, 150)) / 107
        return self._values[symbol]

    def define(self, symbol: Symbol, e: Expr) -> None:
        """Give a symbol the value of an expression."""
        self._values[symbol] = self._of(e)

    def replay(self, symbol: Callable[[Symbol], Any]) -> Replay:
        """Evaluates scalars of the DAG with other values of symbols."""
        return Replay(self._algebra, symbol, self._algebra.context.convert)

    def node(self, x: Scalar) -> Any:
        """What a scalar of the DAG is worth."""
        return self._replay(x)

    def terms(self, terms: Terms) -> tuple[Any, Any]:
        """What a polynomial is worth, and the sum of its terms' sizes."""
        found = [self._term(term) * self._number(k) for term, k in terms.items()]
        return sum(found), sum(abs(x) for x in found)

    def expression(self, e: Expr) -> Any:
        """What a sympy expression is worth."""
        if e not in self._known:
            self._known[e] = self._of(e)
        return self._known[e]

    def _term(self, term: int) -> Any:
        value: Any = 1
        for place, exponent in self._ring.exponents(term):
            if place not in self._generators:
                self._generators[place] = self._generator(*self._ring.generators[place])
            value *= self._generators[place] ** exponent
        return value

    def _generator(self, kind: str, content: Any) -> Any:
        algebra = self._algebra
        if kind == SYMBOL:
            return self.value(content)
        if kind in (SIN, COS):
            parts = [n * self.terms(dict(self._ring.angles[angle]))[0] for angle, n in content]
            return (algebra.sin if kind == SIN else algebra.cos)(sum(parts))
        if kind == FUNCTION:
            name, given = content
            return algebra.function(name, *(self.terms(dict(part))[0] for part in given))
        inner = self.terms(dict(content))[0]
        return algebra.sqrt(inner) if kind == ROOT else 1 / inner

    def _number(self, k: Any) -> Any:
        mpf = self._algebra.context.mpf
        return mpf(k) if isinstance(k, float) else mpf(k.numerator) / k.denominator

    def _of(self, e: Expr) -> Any:
        mpf = self._algebra.context.mpf
        if e in self._names:
            return self.value(self._names[e])
        if e.is_Rational:
            return mpf(e.p) / e.q
        if e.is_Float:
            return mpf(float(e))
        if e.is_NumberSymbol:
            return mpf(str(e.evalf(DIGITS + 10)))
        parts = [self.expression(part) for part in e.args]
        if e.is_Add:
            return sum(parts)
        if e.is_Mul:
            return reduce(lambda a, b: a * b, parts)
        if e.is_Pow:
            return parts[0] ** (int(e.exp) if e.exp.is_Integer else parts[1])
        name = e.func.__name__
        return self._algebra.function(OURS.get(name, name), *parts)
