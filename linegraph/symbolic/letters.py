"""A state in letters, and the same state in numbers: values of scalars, and linear equations between them.

`Letters` calculates with polynomials that have exact values, and writes the results. `Numbers` does the
same at a random point with fifty digits, and solves in another way. Results of both are compared before
they are used.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import sympy

from linegraph.algebra.differentiation import Replay
from linegraph.errors import ModelError
from linegraph.symbolic.simplification.exact import Exact
from linegraph.symbolic.simplification.numbers import plain
from linegraph.symbolic.simplification.quotients import ROUNDED, ZERO, Quotients, Singular

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.algebra.sympy_scalars import Expr
    from linegraph.symbolic.simplification import Simplifier
    from linegraph.symbolic.simplification.numbers import Terms
    from linegraph.symbolic.simplification.polynomial import Poly, Ring
    from linegraph.symbolic.simplification.proof import SamplePoint
    from linegraph.symbolic.simplification.quotients import Quotient

Rows = list[list[Any]]
NOTHING: Rows = []

UNDEFINED = "something is divided by zero there, or has no derivative"


class Letters:
    """Scalars of a DAG as polynomials with inverses; some symbols have exact values.

    Args:
        simplifier: has the ring of polynomials, and writes.
        values: SymPy expressions for some symbols.
    """

    def __init__(self, simplifier: Simplifier, values: Mapping[Symbol, Expr]) -> None:
        """Convert the values; scalars are evaluated on demand."""
        self._simplifier = simplifier
        ring = simplifier.ring
        exact = self._exact = Exact(simplifier)
        self._known: dict[Symbol, Poly] = {symbol: exact.value(e) for symbol, e in values.items()}
        self._replay = Replay(exact, self._symbol, ring.poly)
        self._quotients = Quotients(ring, simplifier.points[0])

    def _symbol(self, symbol: Symbol) -> Poly:
        known = self._known.get(symbol)
        return self._simplifier.ring.symbol(*symbol) if known is None else known

    def __call__(self, x: Scalar) -> Poly:
        """The value of a scalar of the DAG.

        Raises:
            ModelError: it is not defined at the state.
        """
        try:
            found: Any = self._replay(x)
        except ZeroDivisionError:
            raise ModelError("linearise", UNDEFINED) from None
        return self._simplifier.ring.poly(found)

    def give(self, symbol: Symbol, value: Poly) -> None:
        """Set the value of a symbol for all later evaluations.

        Args:
            symbol: its argument and place.
            value: a polynomial of the ring.
        """
        self._known[symbol] = value

    def value(self, e: Expr) -> Poly:
        """The polynomial of a SymPy expression."""
        return self._exact.value(e)

    def solve(
        self, rows: Rows, rights: Rows, through: Rows = NOTHING, direct: Rows = NOTHING
    ) -> tuple[Rows, Rows]:
        """X of ``rows X = rights``, by fraction-free elimination, and ``through X + direct``.

        Args:
            rows: a square matrix.
            rights: the right-hand sides, as columns of a matrix.
            through: rows that multiply X.
            direct: rows that are added to the products.

        Raises:
            Singular: X is not determined.
        """
        return self._quotients.solve(rows, rights, through, direct)

    def vanishes(self, x: Poly) -> bool:
        """Whether a scalar is zero, judged at a random point."""
        return self._quotients.vanishes(x)

    def quotient(self, x: Poly) -> Quotient:
        """A scalar as a quotient without common factors."""
        return self._quotients.of(x)

    def shared(self, parts: Sequence[Terms]) -> Terms:
        """The greatest common factor of several polynomials."""
        return self._quotients.shared(parts)

    def divided(self, terms: Terms, factor: Terms) -> Terms:
        """The quotient of a polynomial and one of its factors.

        Args:
            terms: the polynomial.
            factor: divides it without remainder.
        """
        return self._quotients.divided(terms, factor)

    def written(self, x: Poly) -> Expr:
        """A scalar as a SymPy expression: a quotient without common factors."""
        return quotient_written(self._simplifier, self._quotients.of(x))


class Numbers:
    """The same state in numbers with fifty digits, at a random point.

    Args:
        point: the values of all letters.
        values: SymPy expressions for some symbols.
        ring: knows whether some numbers are floats.
    """

    def __init__(self, point: SamplePoint, values: Mapping[Symbol, Expr], ring: Ring) -> None:
        """Evaluate the values; scalars are evaluated on demand."""
        self._known: dict[Symbol, Any] = {s: point.expression(e) for s, e in values.items()}
        self._point = point
        self._replay = point.replay(self._symbol)
        self._ring = ring

    @property
    def zero(self) -> float:
        """The size, relative to the terms of its sum, below which a number is zero."""
        return ROUNDED if self._ring.inexact else ZERO

    def _symbol(self, symbol: Symbol) -> Any:
        return self._known[symbol] if symbol in self._known else self._point.value(symbol)

    def __call__(self, x: Scalar) -> Any:
        """The value of a scalar of the DAG.

        Raises:
            ModelError: it is not defined at the state.
        """
        try:
            return self._replay(x)
        except ZeroDivisionError:
            raise ModelError("linearise", UNDEFINED) from None

    def give(self, symbol: Symbol, value: Any) -> None:
        """Set the value of a symbol for all later evaluations.

        Args:
            symbol: its argument and place.
            value: a number with fifty digits.
        """
        self._known[symbol] = value

    def value(self, e: Expr) -> Any:
        """The value of a SymPy expression at the point."""
        return self._point.expression(e)

    def solve(
        self, rows: Rows, rights: Rows, through: Rows = NOTHING, direct: Rows = NOTHING
    ) -> tuple[Rows, Rows]:
        """X of ``rows X = rights``, by Gaussian elimination with row pivots, and ``through X + direct``.

        Args:
            rows: a square matrix.
            rights: the right-hand sides, as columns of a matrix.
            through: rows that multiply X.
            direct: rows that are added to the products.

        Raises:
            Singular: X is not determined.
        """
        size, zero = len(rows), self.zero
        both = [[*row, *right] for row, right in zip(rows, rights, strict=True)]
        scales = [max((abs(x) for x in row), default=0) for row in rows]
        for k in range(size):
            best = max(range(k, size), key=lambda i: abs(both[i][k]) / (scales[i] or 1))
            if abs(both[best][k]) <= zero * scales[best]:
                raise Singular(list(range(k, size)))
            both[k], both[best] = both[best], both[k]
            scales[k], scales[best] = scales[best], scales[k]
            pivot = both[k]
            for i in range(size):
                if i != k and both[i][k] != 0:
                    factor = both[i][k] / pivot[k]
                    both[i] = [a - factor * b for a, b in zip(both[i], pivot, strict=True)]
        found = [[x / row[k] for x in row[size:]] for k, row in enumerate(both)]
        products = [
            [
                sum((x * other[k] for x, other in zip(row, found, strict=True)), start=y)
                for k, y in enumerate(start)
            ]
            for row, start in zip(through, direct, strict=True)
        ]
        return found, products

    def basis(
        self, rows: Rows, sizes: Sequence[Any], columns: Sequence[int]
    ) -> list[tuple[int, int]]:
        """Independent rows, each with a column that it determines; earlier columns are preferred.

        Args:
            rows: of a matrix.
            sizes: for each row the size of the terms that its entries are sums of: the scale of
                rounding.
            columns: columns that may be determined, in order of preference.

        Returns:
            (row, column) pairs, ascending.
        """
        left, zero = {i: list(row) for i, row in enumerate(rows) if sizes[i]}, self.zero
        found = []
        for j in columns:
            if not left:
                break
            best = max(left, key=lambda i: (abs(left[i][j]) / sizes[i], -i))
            if abs(left[best][j]) <= zero * sizes[best]:
                continue
            own = left.pop(best)
            found.append((best, j))
            for i, row in left.items():
                factor = row[j] / own[j]
                left[i] = [a - factor * b for a, b in zip(row, own, strict=True)]
                left[i][j] = 0
        return sorted(found)


def quotient_written(simplifier: Simplifier, x: Quotient) -> Expr:
    """A quotient as a SymPy expression, with most signs in the denominator positive.

    With floats, coefficients are scaled so that the largest of the denominator is 1.

    Args:
        simplifier: writes numerator and denominator.
        x: the quotient.
    """
    above, below = x
    if not above:
        return sympy.Integer(0)
    scale: Fraction | int = 1
    if simplifier.ring.inexact:
        scale = max(abs(Fraction(k)) for k in below.values())
    if 2 * sum(k < 0 for k in below.values()) > len(below):
        scale = -scale
    parts = [scaled(terms, scale) for terms in (above, below)]
    upper, lower = (simplifier.of_terms(terms) for terms in parts)
    return upper / lower


def scaled(terms: Terms, scale: Fraction | int) -> Terms:
    """Terms with coefficients divided by a number: integers if possible, else floats.

    Args:
        terms: of a polynomial.
        scale: the divisor.
    """
    if scale in (1, -1):
        return {term: k * int(scale) for term, k in terms.items()}
    found = {}
    for term, k in terms.items():
        exact = Fraction(k) / scale
        found[term] = int(exact) if exact.denominator == 1 else plain(float(exact))
    return found
