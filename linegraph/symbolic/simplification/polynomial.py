"""Polynomials over symbols, sines and cosines: a normal form in which equal expressions are equal.

An expression is a sum of terms, a term a number times powers of *generators*: symbols, the sine and
cosine of each angle, and subexpressions that cannot be multiplied out (roots, quotients by sums, other
functions). With ``cos^2 = 1 - sin^2`` applied throughout, two polynomials in symbols and angles are
equal exactly if they have the same terms. Sums of angles of coordinates are expanded.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.ir.functions import of_numbers
from linegraph.symbolic.simplification.generators import (
    COS,
    FUNCTION,
    INVERSE,
    ROOT,
    SIN,
    SYMBOL,
    Frozen,
    Generators,
    Harmonic,
    Swollen,
    unit,
)
from linegraph.symbolic.simplification.numbers import Terms, gather, plain, readable, reciprocal

if TYPE_CHECKING:
    from linegraph.algebra.differentiation import Symbol
    from linegraph.ir.dag import Number

MOST_ANGLES = 4
"""Sines of longer sums are not expanded."""

COORDINATES = "q"


class Ring(Generators):
    """All polynomials of one calculation; an `algebra.protocol.Algebra`.

    Args:
        budget: the number of products of two terms that may be formed.

    Attributes:
        angles: each angle as a polynomial.
        waves: the terms that are sine and cosine of an angle.
        work: products of two terms formed so far.
        inexact: whether a float other than an integer has occurred.

    Example:
        >>> ring = Ring()
        >>> x = ring.symbol("q", 0)
        >>> (ring.sin(x) ** 2 + ring.cos(x) ** 2).terms
        {0: 1}
    """

    def __init__(self, budget: float = float("inf")) -> None:
        """Start without generators."""
        super().__init__()
        self.budget = budget
        self.work = 0
        self.inexact = False
        self.angles: list[Frozen] = []
        self.waves: dict[Harmonic, tuple[int, int]] = {}

    # -- an algebra

    def power(self, kind: str, content: Any, exponent: int = 1) -> Poly:
        """A power of a generator as a polynomial.

        Args:
            kind: see `Generator`.
            content: see `Generator`.
            exponent: may be negative.
        """
        return Poly(self, {unit(self.generator(kind, content), exponent): 1})

    def symbol(self, argument: str, place: int | str | None = None) -> Poly:
        """A symbol as a polynomial.

        Args:
            argument: the argument that it belongs to.
            place: its index or name there.
        """
        return self.power(SYMBOL, (argument, place))

    def of_symbol(self, symbol: Symbol) -> Poly:
        """A symbol, given as a pair of argument and place."""
        return self.symbol(*symbol)

    def sin(self, x: Poly | Number) -> Poly | Number:
        """Sine of an angle in radians; sums of coordinates are expanded."""
        return self._wave(x)[1]

    def cos(self, x: Poly | Number) -> Poly | Number:
        """Cosine of an angle in radians; sums of coordinates are expanded."""
        return self._wave(x)[0]

    def sqrt(self, x: Poly | Number) -> Poly | Number:
        """Square root, as a generator unless x is a number."""
        return self.function("sqrt", x)

    def function(self, name: str, *x: Poly | Number) -> Poly | Number:
        """Any function of `functions.ARITY`.

        Args:
            name: of the function.
            x: its arguments.
        """
        if not any(isinstance(part, Poly) for part in x):
            return of_numbers(name, *(part for part in x if not isinstance(part, Poly)))
        if name in ("sin", "cos"):
            return self.sin(x[0]) if name == "sin" else self.cos(x[0])
        given = tuple(frozen(self.poly(part)) for part in x)
        if name == "sqrt":
            return self.power(ROOT, given[0])
        return self.power(FUNCTION, (name, given))

    def poly(self, x: Poly | Number) -> Poly:
        """A number as a polynomial; polynomials are returned unchanged."""
        if isinstance(x, Poly):
            return x
        x = readable(x)
        self.inexact = self.inexact or isinstance(x, float)
        return Poly(self, {0: x} if x else {})

    def _wave(self, x: Poly | Number) -> tuple[Poly | Number, Poly | Number]:
        """Cosine and sine of an angle."""
        if not isinstance(x, Poly):
            return of_numbers("cos", x), of_numbers("sin", x)
        if not x.terms:
            return 1, 0
        cosine: Poly | Number = 1
        sine: Poly | Number = 0
        for terms, times in self._parts(x):
            if terms == (0,):
                c, s = of_numbers("cos", times), of_numbers("sin", times)
                turned: Any = (c, s)
            else:
                turned = self._multiple(self._angle(terms), int(times))
            c, s = turned
            cosine, sine = cosine * c - sine * s, sine * c + cosine * s
        return cosine, sine

    def _parts(self, x: Poly) -> list[tuple[Any, Number]]:
        """An angle as a sum of multiples: of single coordinates if possible, else of itself."""
        whole = frozen(x)
        of_coordinates = all(
            isinstance(times, int) and abs(times) <= MOST_ANGLES and self._is_coordinate(term)
            for term, times in whole
            if term
        )
        if of_coordinates and len(whole) <= MOST_ANGLES:
            return [(((t, 1),), k) if t else ((0,), k) for t, k in whole]
        first = whole[0][1]
        if first < 0:
            return [(tuple((term, -times) for term, times in whole), -1)]
        return [(whole, 1)]

    def _is_coordinate(self, term: int) -> bool:
        found = self.exponents(term)
        if len(found) != 1 or found[0][1] != 1:
            return False
        generator = self.generators[found[0][0]]
        return generator.kind == SYMBOL and generator.content[0] == COORDINATES

    def _angle(self, terms: Frozen) -> int:
        if terms not in self.angles:
            self.angles.append(terms)
        return self.angles.index(terms)

    def _multiple(self, angle: int, times: int) -> tuple[Poly, Poly]:
        """Cosine and sine of a multiple of an angle."""
        cosine, sine = self.power(COS, ((angle, 1),)), self.power(SIN, ((angle, 1),))
        c, s = cosine, sine
        for _ in range(abs(times) - 1):
            c, s = c * cosine - s * sine, s * cosine + c * sine
        return c, (s if times > 0 else -s)

    # -- arithmetic of terms

    def spend(self, work: int) -> None:
        """Count work on terms.

        Raises:
            Swollen: the budget is used up.
        """
        self.work += work
        if self.work > self.budget:
            raise Swollen

    def product(self, p: Terms, q: Terms) -> Terms:
        """The product of two polynomials, with squares replaced.

        Args:
            p: the terms of one.
            q: the terms of the other.

        Raises:
            Swollen: the budget is used up, or an exponent is too large.
        """
        if len(p) > len(q):
            p, q = q, p
        self.spend(len(p) * len(q))
        found: Terms = {}
        bias, watched = self._bias, self._watched | self._high
        for m1, k1 in p.items():
            for m2, k2 in q.items():
                m = m1 + m2
                if (m + bias) & watched:
                    for reduced, k in self.reduced(m).items():
                        gather(found, reduced, k * k1 * k2)
                else:
                    gather(found, m, k1 * k2)
        return found

    def quotient(self, p: Poly, q: Poly) -> Poly:
        """The quotient ``p / q``; a denominator that is a sum becomes a generator.

        Args:
            p: the numerator.
            q: the denominator.
        """
        if not q.terms:
            raise ZeroDivisionError("a quotient by zero")
        if len(q.terms) == 1:
            ((term, k),) = q.terms.items()
            return p * Poly(self, {-term: reciprocal(k)})
        if p.terms == q.terms:
            return self.poly(1)
        common, inner = self.primitive(q.terms)
        ((term, k),) = common.items()
        inverse = self.power(INVERSE, tuple(sorted(inner.items())))
        return p * Poly(self, {-term: reciprocal(k)}) * inverse

    def primitive(self, terms: Terms, *, clear: bool = True) -> tuple[Terms, Terms]:
        """A common factor of all terms, as one term, and the rest, whose first coefficient is 1.

        Args:
            terms: of a polynomial that is not zero.
            clear: whether the rest may have no negative exponents.
        """
        rows = [dict(self.exponents(term)) for term in terms]
        least: dict[int, int] = {}
        for place in sorted({place for row in rows for place in row}):
            found = [row.get(place, 0) for row in rows]
            least[place] = min(found) if clear else max(min(found), min(0, max(found)))
        common = sum(unit(place, exponent) for place, exponent in least.items())
        first = terms[min(terms)]
        inner = {term - common: k * reciprocal(first) for term, k in terms.items()}
        return {common: first}, {term: plain(k) for term, k in inner.items()}


class Poly:
    """A polynomial that calculates like a number.

    Attributes:
        ring: with its generators.
        terms: ``{term: coefficient}``.
    """

    __slots__ = ("ring", "terms")

    def __init__(self, ring: Ring, terms: Terms) -> None:
        """Only functions of a ring make polynomials."""
        self.ring = ring
        self.terms = terms

    def __neg__(self) -> Poly:
        return Poly(self.ring, {term: -k for term, k in self.terms.items()})

    def __add__(self, other: Poly | Number) -> Poly:
        terms = self.ring.poly(other).terms
        found = dict(self.terms)
        for term, k in terms.items():
            gather(found, term, k)
        return Poly(self.ring, found)

    __radd__ = __add__

    def __sub__(self, other: Poly | Number) -> Poly:
        return self + -other

    def __rsub__(self, other: Number) -> Poly:
        return -self + other

    def __mul__(self, other: Poly | Number) -> Poly:
        terms = self.ring.poly(other).terms
        return Poly(self.ring, self.ring.product(self.terms, terms))

    __rmul__ = __mul__

    def __truediv__(self, other: Poly | Number) -> Poly:
        return self.ring.quotient(self, self.ring.poly(other))

    def __rtruediv__(self, other: Number) -> Poly:
        return self.ring.quotient(self.ring.poly(other), self)

    def __pow__(self, exponent: int) -> Poly:
        found = self.ring.poly(1)
        for _ in range(exponent):
            found = found * self
        return found


def frozen(x: Poly) -> Frozen:
    """A polynomial's terms in ascending order: equal polynomials give equal tuples."""
    return tuple(sorted(x.terms.items()))
