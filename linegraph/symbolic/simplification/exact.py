"""Exact values of symbols at a point: sin π = 0, cos(π/6) = √3/2, √(h²) = h for h > 0.

An algebra over the polynomials of a ring. SymPy evaluates functions; those that it leaves unevaluated,
such as sin(1/4), and constants such as π become generators with known values at the points where forms
are compared.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import sympy

from linegraph.algebra.sympy_scalars import OURS, RENAMED, Expr, number, power
from linegraph.errors import ModelError
from linegraph.ir.functions import ARITY, of_numbers
from linegraph.symbolic.simplification.generators import ROOT, SYMBOL
from linegraph.symbolic.simplification.polynomial import Poly, frozen

if TYPE_CHECKING:
    from linegraph.algebra.differentiation import Symbol
    from linegraph.symbolic.simplification import Simplifier

CONSTANT = "constant"
"""The argument of symbols for numbers and expressions that SymPy leaves unevaluated."""

PLAIN = ("sin", "cos")


class Exact:
    """An algebra (`algebra.protocol.Algebra`) of polynomials with exact values.

    Args:
        simplifier: has the ring, and writes expressions for SymPy.
    """

    def __init__(self, simplifier: Simplifier) -> None:
        """Start without constants."""
        self._simplifier = simplifier
        self._ring = simplifier.ring
        self._constants: dict[Expr, Symbol] = {}

    def symbol(self, argument: str, place: int | str | None = None) -> Poly:
        """A symbol without a value.

        Args:
            argument: the argument that it belongs to.
            place: its index or name there.
        """
        return self._ring.symbol(argument, place)

    def sin(self, x: Any) -> Poly:
        """Sine of an angle in radians."""
        return self.function("sin", x)

    def cos(self, x: Any) -> Poly:
        """Cosine of an angle in radians."""
        return self.function("cos", x)

    def sqrt(self, x: Any) -> Poly:
        """Square root, exact if SymPy can simplify it."""
        return self.function("sqrt", x)

    def function(self, name: str, *x: Any) -> Poly:
        """Any function of `functions.ARITY`.

        Args:
            name: of the function.
            x: its arguments.
        """
        given = [self._ring.poly(part) for part in x]
        numbers = [_number(part) for part in given]
        rounded = self._ring.inexact or any(isinstance(k, float) for k in numbers)
        if rounded and None not in numbers:
            return self._ring.poly(of_numbers(name, *(float(k) for k in numbers if k is not None)))
        if name in PLAIN and not any(self._is_constant(part) for part in given):
            return self._ring.poly(self._ring.function(name, *given))
        written = [self._simplifier.of_terms(part.terms) for part in given]
        return self.value(getattr(sympy, RENAMED.get(name, name))(*written))

    def value(self, e: Expr) -> Poly:
        """A sympy expression as a polynomial; its symbols are letters unless the ring knows them.

        Raises:
            ModelError: it is not a real number.
        """
        if e.is_Symbol:
            return self._letter(e)
        if e.is_Rational or e.is_Float:
            # 1.0 counts as a float too: its sine is a number, not a generator
            self._ring.inexact |= e.is_Float
            return self._ring.poly(number(e))
        if e.is_Add or e.is_Mul:
            parts = [self.value(part) for part in e.args]
            found = parts[0]
            for part in parts[1:]:
                found = found + part if e.is_Add else found * part
            return found
        if e.has(sympy.I, sympy.zoo, sympy.nan, sympy.oo, -sympy.oo):
            raise ModelError("", f"{e} is no real number")
        if e.is_Pow and (2 * e.exp).is_Integer:
            return self._power(e)
        name = OURS.get(e.func.__name__, e.func.__name__)
        if ARITY.get(name) == len(e.args):
            given = [self.value(part) for part in e.args]
            if not any(self._is_constant(part) for part in given):
                return self._ring.poly(self._ring.function(name, *given))
            if name in PLAIN:
                self._tie(e.args[0])
        return self._constant(e)

    def _power(self, e: Expr) -> Poly:
        base = self.value(e.base)
        if not e.exp.is_Integer:
            root = self._ring.power(ROOT, frozen(base))
            return self._ring.poly(power(root, 2 * e.exp, self))
        return self._ring.poly(power(base, e.exp, self))

    def _letter(self, e: Expr) -> Poly:
        known = self._simplifier.known(e)
        if known is None:
            known = ("p", e.name)
            self._simplifier.define(known, e)
        return self._ring.symbol(*known)

    def _constant(self, e: Expr) -> Poly:
        """An expression that SymPy leaves unevaluated, as a generator."""
        if e not in self._constants:
            symbol = self._constants[e] = (CONSTANT, len(self._constants))
            for argument in sorted(e.free_symbols, key=str):
                self._letter(argument)
            self._simplifier.define(symbol, e, valued=True)
        return self._ring.symbol(*self._constants[e])

    def _tie(self, angle: Expr) -> None:
        """Replace the square of an unevaluated cosine by 1 - sin^2."""
        cosine, sine = sympy.cos(angle), sympy.sin(angle)
        if cosine in self._constants or (cosine.func, sine.func) != (sympy.cos, sympy.sin):
            return
        (place,) = (p for t in self._constant(cosine).terms for p, _ in self._ring.exponents(t))
        self._ring.replace_square(place, (1 - self._constant(sine) ** 2).terms)

    def _is_constant(self, x: Poly) -> bool:
        """Whether SymPy must evaluate it: it contains a number, a root or an unevaluated expression."""
        return any(
            not term
            or any(
                self._ring.generators[place].kind == ROOT
                or self._ring.generators[place] == (SYMBOL, content)
                for place, _ in self._ring.exponents(term)
                for content in self._constants.values()
            )
            for term in x.terms
        )


def _number(x: Poly) -> float | Fraction | None:
    """The number that a polynomial equals; None for others."""
    if not x.terms:
        return Fraction(0)
    k = x.terms.get(0)
    if k is None or len(x.terms) > 1:
        return None
    return k if isinstance(k, float) else Fraction(k)
