"""Linear systems in letters, with conversion to other tools.

ẋ = A x + B u + E u̇        y = C x + D u + F u̇
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from math import gcd
from typing import TYPE_CHECKING, Any

import sympy

from linegraph.errors import ModelError
from linegraph.symbolic.letters import Letters, Numbers, scaled
from linegraph.symbolic.simplification import Simplifier
from linegraph.symbolic.simplification.generators import Swollen, unit

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.symbolic.simplification.numbers import Terms

Expr = Any


@dataclass(frozen=True, repr=False)
class StateSpace:
    """A linear time-invariant system.

    Attributes:
        states, inputs, outputs: names, in the order of rows and columns.
        A, B, C, D: SymPy matrices.
        E, F: for the inputs' derivatives; zero unless stores are tied to sources.
        defaults: the default values of the parameters.

    Example:
        >>> from linegraph import Model, derive
        >>> model = Model("low_pass")
        >>> R, C, _ = model.parameter("R", 1e3), model.parameter("C", 1e-6), model.input("u", "V")
        >>> _ = model.voltage_source("s", ("a", "ground"), voltage="u")
        >>> _ = model.resistor("R1", ("a", "b"), resistance="R")
        >>> _ = model.capacitor("C1", ("b", "ground"), capacitance="C")
        >>> space = derive(model).state_space
        >>> space.A, space.B, space.transfer_function()[0]
        (Matrix([[-1/(C*R)]]), Matrix([[1/(C*R)]]), 1/(C*R*s + 1))
    """

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    A: Expr
    B: Expr
    C: Expr
    D: Expr
    E: Expr
    F: Expr
    defaults: Mapping[str, float]

    def __repr__(self) -> str:
        """The names of its states, inputs and outputs."""
        names = (", ".join(part) for part in (self.states, self.inputs, self.outputs))
        return "<linear system: states {}; inputs {}; outputs {}>".format(*names)

    def _repr_latex_(self) -> str:
        from linegraph.notation.notation import Notation

        look = Notation()
        rates = f"{look.latex(self.A)} x + {look.latex(self.B)} u"
        if any(entry != 0 for entry in self.E):
            rates += rf" + {look.latex(self.E)} \dot u"
        names = ", ".join(look.latex(sympy.Symbol(name)) for name in self.states)
        return rf"$\displaystyle \dot x = {rates}, \quad x = ({names})$"

    @property
    def halves(self) -> tuple[tuple[Expr, Expr, Expr], tuple[Expr, Expr, Expr]]:
        """The matrices of both equations: (A, B, E) and (C, D, F)."""
        return (self.A, self.B, self.E), (self.C, self.D, self.F)

    @property
    def shifted(self) -> StateSpace:
        """The system with states ``x - E u``, which needs derivatives of inputs in outputs only."""
        if not any(self.E):
            return self
        at = Letters(Simplifier(_named), {})

        def moved(left: Expr, right: Expr) -> Expr:
            return (left * self.E + right).applyfunc(lambda e: at.written(at.value(e)))

        zero = sympy.zeros(*self.E.shape)
        return replace(self, B=moved(self.A, self.B), D=moved(self.C, self.D), E=zero)

    def transfer_function(self, s: Expr = None) -> Expr:
        """The matrix H(s), outputs x inputs: quotients of polynomials in s.

        Numerator and denominator are collected in s and have no common factor; a factor that all
        coefficients of one share comes before it. Coefficients are not fractions, and that of the
        denominator's highest power has more positive terms than negative ones; with floats its largest
        number is 1.

        Args:
            s: the variable; by default the symbol ``s``.

        Raises:
            ModelError: it has too many terms, or the model uses the symbol's name.
        """
        symbol = s if isinstance(s, sympy.Symbol) else sympy.Symbol("s")
        if any(symbol in part.free_symbols for part in self._matrices):
            problem = f"the model has a symbol {symbol}, too; give another, as transfer_function(Symbol('p'))"
            raise ModelError("transfer function", problem)
        found = _Response(self, symbol).written()
        return found if s is None or s == symbol else found.subs(symbol, s)

    @property
    def _matrices(self) -> tuple[Expr, ...]:
        return (self.A, self.B, self.C, self.D, self.E, self.F)

    def numeric(self, parameters: Mapping[str, float] | None = None) -> tuple[Any, Any, Any, Any]:
        """A, B, C, D as arrays, of the shifted system if there are derivatives of inputs.

        Args:
            parameters: values instead of the model's own, by name.

        Raises:
            ModelError: an output contains a derivative of an input, or a parameter has no value.
        """
        import numpy

        space = self.shifted
        if any(entry != 0 for entry in space.F):
            raise ModelError(
                "state space", "an output has a derivative of an input: it is not proper"
            )
        values = {**self.defaults, **(parameters or {})}
        matrices = []
        for matrix in (space.A, space.B, space.C, space.D):
            # by name: letters may be symbols with assumptions
            found = matrix.subs(
                {x: values[x.name] for x in matrix.free_symbols if x.name in values}
            )
            missing = sorted(symbol.name for symbol in found.free_symbols)
            if missing:
                raise ModelError("state space", f"no value is known of {', '.join(missing)}")
            matrices.append(numpy.array(found.tolist(), dtype=float).reshape(matrix.shape))
        return matrices[0], matrices[1], matrices[2], matrices[3]

    def to_scipy(self, parameters: Mapping[str, float] | None = None) -> Any:
        """The system as a ``scipy.signal.StateSpace``, at given parameters."""
        from scipy.signal import StateSpace as Found

        return Found(*self.numeric(parameters))

    def to_control(self, parameters: Mapping[str, float] | None = None) -> Any:
        """The system as a ``control.StateSpace`` with its names, at given parameters."""
        import control

        return control.ss(
            *self.numeric(parameters),
            states=list(self.states),
            inputs=list(self.inputs),
            outputs=list(self.outputs),
        )


class _Response:
    """The transfer function ``C (s I - A)^-1 (B + s E) + D + s F``, in letters."""

    def __init__(self, space: StateSpace, s: Expr) -> None:
        self.space, self.s = space, s
        self.simplifier = Simplifier(_named)
        self.simplifier.start()
        self.letters = Letters(self.simplifier, {})
        parts = (part for half in space.halves for part in half)
        for letter in sorted({s}.union(*(part.free_symbols for part in parts)), key=str):
            self.letters.value(letter)  # fixes the order of terms in sums
        self.place = _place(self.letters.value(s))

    def written(self) -> Expr:
        """The matrix, compared with numbers at random points."""
        try:
            found = [[self._collected(x) for x in row] for row in self._solved(self.letters)]
        except Swollen:
            problem = "the transfer function has too many terms for a closed form; give parameters numbers"
            raise ModelError("state space", problem) from None
        for point in self.simplifier.points:
            numbers = Numbers(point, {}, self.simplifier.ring)
            for row, values in zip(found, self._solved(numbers), strict=True):
                for e, x in zip(row, values, strict=True):
                    if abs(point.expression(e) - x) > numbers.zero * (1 + abs(x)):
                        raise AssertionError(f"{e} differs from what was derived: a bug")
        shape = (len(self.space.outputs), len(self.space.inputs))
        return sympy.Matrix(*shape, [x for row in found for x in row])

    def _solved(self, at: Letters | Numbers) -> Any:
        """The rows of the matrix, over polynomials or numbers."""
        space = self.space
        parts = (space.A, space.B, space.C, space.D, space.E, space.F)
        A, B, C, D, E, F = ([[at.value(x) for x in row] for row in part.tolist()] for part in parts)
        s = at.value(self.s)
        inner = [[s * int(i == j) - x for j, x in enumerate(row)] for i, row in enumerate(A)]
        left, direct = (
            [
                [x + s * dx for x, dx in zip(row, slope, strict=True)]
                for row, slope in zip(part, steep, strict=True)
            ]
            for part, steep in ((B, E), (D, F))
        )
        return at.solve(inner, left, C, direct)[1]

    def _collected(self, x: Any) -> Expr:
        """A quotient with both parts collected in s."""
        above, below = self.letters.quotient(x)
        powers = self._powers(below)
        leading = powers[max(powers)]
        scale: Any = 1
        if self.simplifier.ring.inexact:
            scale = max(abs(Fraction(k)) for k in leading.values())
        if 2 * sum(k < 0 for k in leading.values()) > len(leading):
            scale = -scale
        return self._polynomial(above, scale) / self._polynomial(below, scale)

    def _powers(self, terms: Terms) -> dict[int, Terms]:
        """The coefficients of the powers of s."""
        found: dict[int, Terms] = {}
        for term, k in terms.items():
            exponent = self.simplifier.ring.exponent(term, self.place)
            found.setdefault(exponent, {})[term - unit(self.place, exponent)] = k
        return found

    def _polynomial(self, terms: Terms, scale: Any) -> Expr:
        """The common factor of all coefficients times a polynomial in s, over a number."""
        if not terms:
            return sympy.Integer(0)
        powers = self._powers(terms)
        outside = self.letters.shared(list(powers.values()))
        if self.simplifier.ring.inexact:  # keep floats in the coefficients
            outside = scaled(outside, gcd(*map(int, outside.values())))
        inner = [
            self.simplifier.of_terms(scaled(self.letters.divided(part, outside), scale)) * self.s**n
            for n, part in sorted(powers.items(), reverse=True)
        ]
        return sympy.Mul(self.simplifier.of_terms(outside), sympy.Add(*inner))


def _named(symbol: Any) -> Expr:
    return sympy.Symbol(str(symbol[1]))


def _place(x: Any) -> int:
    """The generator of the ring that a symbol is."""
    (term,) = x.terms
    ((place, _),) = x.ring.exponents(term)
    return int(place)
