"""Verification of rewritten forms: comparison with the derived expression at random points, to fifty digits.

The node of a DAG, the terms of a ring and a SymPy expression are evaluated by three independent walks
that share only the values of the symbols. An error in one rewrite cannot cancel in another.
"""

from __future__ import annotations

import random
from functools import reduce
from typing import TYPE_CHECKING, Any

from mpmath.ctx_mp import MPContext

from linegraph.algebra.differentiation import Replay
from linegraph.algebra.sympy_scalars import OURS
from linegraph.symbolic.simplification.generators import COS, FUNCTION, ROOT, SIN, SYMBOL

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.algebra.sympy_scalars import Expr
    from linegraph.symbolic.simplification.numbers import Terms
    from linegraph.symbolic.simplification.polynomial import Ring

DIGITS = 50
EXACT = 1e-40
"""Greatest relative difference, compared with the terms of the sum, if all numbers are exact ..."""
INEXACT = 1e-12
"""... and if some are floats, whose sums are rounded."""

OWN = {"abs": "fabs"}
"""Functions with another name in mpmath."""


class Precise:
    """The algebra of numbers with fifty digits."""

    def __init__(self) -> None:
        """Use a context of its own, so that no other precision changes."""
        self.context = MPContext()
        self.context.dps = DIGITS

    def symbol(self, argument: str, place: int | str | None = None) -> Scalar:
        """Symbols have no values here, only at a `SamplePoint`.

        Args:
            argument: the argument that the symbol belongs to.
            place: its index or name there.

        Raises:
            KeyError: in every case.
        """
        raise KeyError(argument, place)

    def sin(self, x: Scalar) -> Scalar:
        """Sine of an angle in radians."""
        return self.context.sin(x)

    def cos(self, x: Scalar) -> Scalar:
        """Cosine of an angle in radians."""
        return self.context.cos(x)

    def sqrt(self, x: Scalar) -> Scalar:
        """Square root, complex if x is negative."""
        return self.context.sqrt(x)

    def function(self, name: str, *x: Scalar) -> Scalar:
        """Any function of `functions.ARITY`.

        Args:
            name: of the function.
            x: its arguments.
        """
        if name in ("min", "max"):
            return (min if name == "min" else max)(x, key=lambda z: z.real)
        return getattr(self.context, OWN.get(name, name))(*x)


class SamplePoint:
    """Random values of all symbols, and the values of expressions there.

    Args:
        ring: of the terms that are evaluated.
        names: symbols of the ring by the SymPy symbols that they are written as; filled while writing.
        seed: of the values.
        units: groups of symbols whose values form a unit vector.
    """

    def __init__(
        self,
        ring: Ring,
        names: dict[Expr, Symbol],
        seed: int,
        units: Iterable[Sequence[Symbol]] = (),
    ) -> None:
        """Draw values on demand, each from the symbol's name alone: the order of use does not matter."""
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
        """The value of a symbol."""
        if symbol not in self._values:
            draw = random.Random(f"{self._seed} {symbol}")
            self._values[symbol] = self._algebra.context.mpf(draw.randint(20, 150)) / 107
        return self._values[symbol]

    def define(self, symbol: Symbol, e: Expr) -> None:
        """Set the value of a symbol to that of an expression.

        Args:
            symbol: its argument and place.
            e: a SymPy expression.
        """
        self._values[symbol] = self._of(e)

    def replay(self, symbol: Callable[[Symbol], Any]) -> Replay:
        """A replay that evaluates scalars of the DAG with other values of symbols."""
        return Replay(self._algebra, symbol, self._algebra.context.convert)

    def node(self, x: Scalar) -> Any:
        """The value of a scalar of the DAG."""
        return self._replay(x)

    def terms(self, terms: Terms) -> tuple[Any, Any]:
        """The value of a polynomial, and the sum of the sizes of its terms."""
        found = [self._term(term) * self._number(k) for term, k in terms.items()]
        return sum(found), sum(abs(x) for x in found)

    def expression(self, e: Expr) -> Any:
        """The value of a SymPy expression."""
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
