"""Polynomials over symbols, sines and cosines: the algebra in which terms that are equal meet.

An expression is a sum of terms, a term a number times powers of *generators*: symbols, the sine and the
cosine of each angle, and what cannot be multiplied out (roots, quotients by sums, other functions of
polynomials). With ``cos^2 = 1 - sin^2`` applied throughout, two polynomials in symbols and angles are equal
exactly if they have the same terms. Sums of angles of coordinates are taken apart.

The exponents of a term are the digits of one integer, so that multiplying terms is adding integers.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from linegraph.ir.dag import Number
from linegraph.ir.functions import of_numbers
from linegraph.symbolic.simplification.numbers import Terms, gather, plain, readable, reciprocal

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.differentiation import Symbol

Harmonic: TypeAlias = tuple[tuple[int, int], ...]
"""A sum of angles: (number of the angle, how many times it is taken), ascending."""

SYMBOL, SIN, COS, ROOT, INVERSE, FUNCTION = "symbol", "sin", "cos", "root", "inverse", "function"

BITS = 16
ZERO_DIGIT = 1 << (BITS - 2)
"""What is added to a digit so that exponents may be negative; they stay below it."""

MOST_ANGLES = 4
"""Sines of longer sums are not taken apart."""

COORDINATES = "q"


class Swollen(Exception):
    """An expression has more terms than the budget allows; `problem` says it."""

    problem = "has too many terms"


class TooHigh(Swollen):
    """A power is beyond what terms can hold."""

    problem = f"has a power above {ZERO_DIGIT - 1}, too high"


class Generator(NamedTuple):
    """What terms are powers of.

    Attributes:
        kind: SYMBOL, SIN, COS, ROOT, INVERSE or FUNCTION.
        content: a symbol's argument and place, an angle's `Harmonic`, a `Frozen` polynomial, or the name of a
            function and its arguments.
    """

    kind: str
    content: Any


Frozen: TypeAlias = tuple[tuple[int, Number], ...]
"""The terms of a polynomial, ascending."""


class Ring:
    """All polynomials that may meet; an `algebra.protocol.Algebra`.

    Args:
        budget: how many products of two terms may be formed.

    Attributes:
        generators: in order of first use.
        angles: what each angle is, as a polynomial.
        waves: the terms that are sine and cosine of an angle.
        work: products of two terms formed so far.
        inexact: whether a float has come in that is no whole number.

    Example:
        >>> ring = Ring()
        >>> x = ring.symbol("q", 0)
        >>> (ring.sin(x) ** 2 + ring.cos(x) ** 2).terms
        {0: 1}
    """

    def __init__(self, budget: float = float("inf")) -> None:
        """Start without generators."""
        self.budget = budget
        self.work = 0
        self.inexact = False
        self.generators: list[Generator] = []
        self.angles: list[Frozen] = []
        self.waves: dict[Harmonic, tuple[int, int]] = {}
        self._places: dict[Generator, int] = {}
        self._bias = 0
        self._high = 0
        self._watched = 0
        self._squares: list[tuple[int, int, Terms]] = []
        self._exponents: dict[int, tuple[tuple[int, int], ...]] = {}

    # -- generators

    def generator(self, kind: str, content: Any) -> int:
        """The place of a generator, registered at first use."""
        key = Generator(kind, content)
        if key not in self._places:
            place = self._places[key] = len(self.generators)
            self.generators.append(key)
            shift = BITS * place
            self._bias |= ZERO_DIGIT << shift
            self._high |= 1 << (shift + BITS - 1)
            if kind in (COS, ROOT):
                square: Terms = dict(content) if kind == ROOT else {0: 1}
                if kind == COS:
                    square[unit(self.generator(SIN, content), 2)] = -1
                self.replace_square(place, square)
        return self._places[key]

    def normalise(self, quaternion: Sequence[Symbol]) -> None:
        """Write 1 - x^2 - y^2 - z^2 for w^2 of a unit quaternion (x, y, z, w)."""
        *others, last = (self.generator(SYMBOL, symbol) for symbol in quaternion)
        square: Terms = {unit(place, 2): -1 for place in others}
        self.replace_square(last, {0: 1} | square)

    def replace_square(self, place: int, square: Terms) -> None:
        """From now on write other terms for the square of a generator."""
        shift = BITS * place
        mask = (ZERO_DIGIT - 2) << shift
        self._watched |= mask
        self._squares.append((mask, shift, square))

    def power(self, kind: str, content: Any, exponent: int = 1) -> Poly:
        """A generator to a power."""
        return Poly(self, {unit(self.generator(kind, content), exponent): 1})

    def is_wave(self, place: int) -> bool:
        """Whether a generator is a sine or a cosine."""
        return self.generators[place].kind in (SIN, COS)

    def exponents(self, term: int) -> tuple[tuple[int, int], ...]:
        """The generators in a term, by place, and their exponents."""
        found = self._exponents.get(term)
        if found is None:
            count = len(self.generators)
            digits = (term + self._bias).to_bytes(BITS // 8 * count, "little")
            found = tuple(
                (place, digit - ZERO_DIGIT)
                for place, digit in enumerate(struct.unpack(f"<{count}H", digits))
                if digit != ZERO_DIGIT
            )
            self._exponents[term] = found
        return found

    def exponent(self, term: int, place: int) -> int:
        """The exponent of one generator in a term."""
        digit: int = (term + self._bias) >> (BITS * place) & (2**BITS - 1)
        return digit - ZERO_DIGIT

    # -- an algebra

    def symbol(self, argument: str, place: int | str | None = None) -> Poly:
        """A symbol as a polynomial."""
        return self.power(SYMBOL, (argument, place))

    def of_symbol(self, symbol: Symbol) -> Poly:
        """The same, given its argument and place together."""
        return self.symbol(*symbol)

    def sin(self, x: Poly | Number) -> Poly | Number:
        """A sine; of coordinates' sums taken apart."""
        return self._wave(x)[1]

    def cos(self, x: Poly | Number) -> Poly | Number:
        """A cosine; of coordinates' sums taken apart."""
        return self._wave(x)[0]

    def sqrt(self, x: Poly | Number) -> Poly | Number:
        """The square root."""
        return self.function("sqrt", x)

    def function(self, name: str, *x: Poly | Number) -> Poly | Number:
        """Any function of `functions.ARITY`."""
        if not any(isinstance(part, Poly) for part in x):
            return of_numbers(name, *(part for part in x if not isinstance(part, Poly)))
        if name in ("sin", "cos"):
            return self.sin(x[0]) if name == "sin" else self.cos(x[0])
        given = tuple(frozen(self.poly(part)) for part in x)
        if name == "sqrt":
            return self.power(ROOT, given[0])
        return self.power(FUNCTION, (name, given))

    def poly(self, x: Poly | Number) -> Poly:
        """A number as a polynomial, a polynomial as it is."""
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
        """An angle as multiples of angles: those of coordinates, or itself."""
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
        """All products of a term of one with a term of the other, reduced.

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

    def reduced(self, term: int) -> Terms:
        """A term with no square left that is something else: of a cosine, of a root.

        Raises:
            Swollen: an exponent is too large.
        """
        found: Terms = {}
        pending: list[tuple[int, Number]] = [(term, 1)]
        while pending:
            term, k = pending.pop()
            biased = term + self._bias
            if biased < 0 or biased & self._high:
                raise TooHigh
            for mask, shift, square in self._squares:
                # an exponent below zero has these bits, too
                if biased & mask and (biased >> shift & (2**BITS - 1)) >= ZERO_DIGIT + 2:
                    rest = term - (2 << shift)
                    pending += [(rest + t, k * x) for t, x in square.items()]
                    break
            else:
                gather(found, term, k)
        return found

    def quotient(self, p: Poly, q: Poly) -> Poly:
        """``p / q``; a sum in the denominator becomes a generator."""
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
        """A common factor of all terms, of one term, and what is left: its first coefficient is 1.

        Args:
            terms: of a polynomial that is not zero.
            clear: whether nothing with a negative exponent is to be left.
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
    """A polynomial: ``{term: coefficient}``, calculating as a number does."""

    __slots__ = ("ring", "terms")

    def __init__(self, ring: Ring, terms: Terms) -> None:
        """Only a ring's functions make them."""
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


def unit(place: int, exponent: int = 1) -> int:
    """The term that is a power of one generator."""
    return exponent << (BITS * place) if exponent >= 0 else -(-exponent << (BITS * place))


def frozen(x: Poly) -> Frozen:
    """A polynomial's terms in ascending order: equal ones are equal."""
    return tuple(sorted(x.terms.items()))
