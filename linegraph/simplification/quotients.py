"""Quotients of polynomials of a ring: linear equations solved without fractions, and common factors removed.

    rows X = rights  ──cleared──→ polynomials ──eliminated──→ minors ──cancelled──→ X

The elimination is Bareiss': every number in it is a minor of the matrix, so that each division comes out even
and nothing grows beyond the answer. Generators are independent symbols to it; what ties them (``cos^2 = 1 -
sin^2``, the square of a root) is put in once, in the result. That is right wherever the pivots do not vanish,
which is judged by their values at a random point.
"""

from __future__ import annotations

import random
from collections import Counter
from fractions import Fraction
from functools import reduce
from math import lcm
from typing import TYPE_CHECKING, Any, NamedTuple

import sympy
from sympy.polys.rings import PolyRing

from linegraph.simplification.numbers import Terms, gather
from linegraph.simplification.polynomial import COS, INVERSE, ROOT, Poly, Ring, unit

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.simplification.proof import Point

Element: Any = Any
"""A polynomial of sympy's, over the integers."""

ZERO = 1e-25
"""What is left of numbers with fifty digits, beside the terms of its sum, where it is zero ..."""
ROUNDED = 1e-9
"""... and where some numbers are floats."""

PRIME = 2**61 - 1

AGAIN = 4
"""How often ties between generators are put in, which may leave a common factor."""


class Quotient(NamedTuple):
    """A polynomial over another, without common factors; coefficients are whole."""

    above: Terms
    below: Terms


class Singular(Exception):
    """Equations do not determine their unknowns; `rows` are those that are left."""

    def __init__(self, rows: Sequence[int]) -> None:
        """Keep the rows."""
        super().__init__(rows)
        self.rows = rows


class Quotients:
    """Solves linear equations between polynomials of a ring that may have quotients as coefficients.

    Args:
        ring: of the polynomials.
        point: whose values say what is zero.

    Example:
        >>> ring = Ring()
        >>> m, k = ring.symbol("p", "m"), ring.symbol("p", "k")
        >>> from linegraph.simplification.proof import Point
        >>> quotients = Quotients(ring, Point(ring, {}, 0))
        >>> [[x]], _ = quotients.solve([[m * m + m * k]], [[k * m]])
        >>> above, below = quotients.of(x)
        >>> above == k.terms, below == (m + k).terms
        (True, True)
    """

    def __init__(self, ring: Ring, point: Point) -> None:
        """Nothing is solved yet."""
        self._ring = ring
        self._point = point
        self._known: dict[frozenset[Any], Quotient] = {}

    @property
    def zero(self) -> float:
        """How small a sum is, beside its terms, to be zero."""
        return ROUNDED if self._ring.inexact else ZERO

    def vanishes(self, x: Poly) -> bool:
        """Whether a polynomial is zero, by its value."""
        value, scale = self._point.terms(x.terms)
        return bool(abs(value) <= self.zero * scale)

    def of(self, x: Poly) -> Quotient:
        """A polynomial with inverses as one quotient."""
        key = frozenset(x.terms.items())
        if key not in self._known:
            if self.vanishes(x):
                found = Quotient({}, {0: 1})
            else:
                space = _Space(self._ring, [x])
                above, below = space.cleared([x, self._ring.poly(1)])
                found = self._cancelled(space, above, below)
            self._known[key] = found
        return self._known[key]

    def poly(self, x: Quotient) -> Poly:
        """A quotient as a polynomial, its denominator as one generator."""
        found = Poly(self._ring, x.above) / Poly(self._ring, x.below)
        self._known[frozenset(found.terms.items())] = x
        return found

    def shared(self, parts: Sequence[Terms]) -> Terms:
        """The greatest common factor of polynomials, positive."""
        polys = [Poly(self._ring, part) for part in parts]
        space = _Space(self._ring, polys)
        found = None
        for x in sorted(space.cleared(polys), key=len):
            found = x if found is None else found.gcd(x)
            if found == 1:
                break
        return {} if found is None else space.terms(found)[0]

    def divided(self, terms: Terms, factor: Terms) -> Terms:
        """A polynomial over a factor of it."""
        if factor == {0: 1}:
            return terms
        return self.of(Poly(self._ring, terms) / Poly(self._ring, factor)).above

    def solve(
        self,
        rows: Sequence[Sequence[Poly]],
        rights: Sequence[Sequence[Poly]],
        through: Sequence[Sequence[Poly]] = (),
        direct: Sequence[Sequence[Poly]] = (),
    ) -> tuple[list[list[Poly]], list[list[Poly]]]:
        """X of rows X = rights, and Y = through X + direct.

        Y comes from the same elimination, so that what X has in denominators meets there and cancels.

        Raises:
            Singular: the matrix is not regular.
            Swollen: the budget is used up.
        """
        size = len(rows)
        given = [[*row, *right] for row, right in zip(rows, rights, strict=True)]
        given += [[-x for x in row] + list(y) for row, y in zip(through, direct, strict=True)]
        space = _Space(self._ring, [x for row in given for x in row])
        one = self._ring.poly(1)
        both = [space.cleared([*row, one]) for row in given]
        for row in both[:size]:
            row[-1] = space.zero
        values = [[self._point.terms(x.terms) for x in row] for row in rows]
        places = self._eliminated(both, values)
        found: list[list[Poly]] = [[] for _ in rows]
        for place, column in places:
            found[column] = self._row(space, both[place][size:-1], both[place][column])
        return found, [self._row(space, row[size:-1], row[-1]) for row in both[size:]]

    def _row(self, space: _Space, above: Sequence[Element], below: Element) -> list[Poly]:
        zero = self._ring.poly(0)
        return [self.poly(self._cancelled(space, x, below)) if x else zero for x in above]

    def _eliminated(self, rows: list[list[Element]], values: Any) -> list[tuple[int, int]]:
        """Leave one entry in each row of the matrix; the places of these.

        The pivot is the shortest entry that is not zero, of equals the one that fills the least, then the
        last: masses are eliminated from the leaves to the root.
        """
        size = len(values)
        mirror = _Numbers(values, self.zero)
        left, open_columns = list(range(size)), list(range(size))
        found: list[tuple[int, int]] = []
        before: Element = None
        while left:
            counts = Counter(j for i in left for j in open_columns if rows[i][j])
            filled = {i: sum(bool(rows[i][j]) for j in open_columns) for i in left}
            choice = min(
                (
                    (len(rows[i][j]), (filled[i] - 1) * (counts[j] - 1), i != j, -i, -j)
                    for i in left
                    for j in open_columns
                    if rows[i][j] and mirror.has(i, j)
                ),
                default=None,
            )
            if choice is None:
                raise Singular(left)
            row, column = -choice[3], -choice[4]
            self._step(rows, row, column, before)
            mirror.step(row, column, left, open_columns)
            before = rows[row][column]
            left.remove(row)
            open_columns.remove(column)
            found.append((row, column))
        return found

    def _step(self, rows: list[list[Element]], row: int, column: int, before: Element) -> None:
        """One step of Bareiss', in all other rows."""
        own, pivot = rows[row], rows[row][column]
        for i, other in enumerate(rows):
            if i == row:
                continue
            factor = other[column]
            self._ring.spend(
                len(pivot) * sum(map(len, other)) + len(factor) * sum(map(len, own))
            )
            new = [pivot * a - factor * b for a, b in zip(other, own, strict=True)]
            rows[i] = new if before is None else [x.exquo(before) if x else x for x in new]

    def _cancelled(self, space: _Space, above: Element, below: Element) -> Quotient:
        """Without common factors, what ties generators put in."""
        if not above:
            return Quotient({}, {0: 1})
        for _ in range(AGAIN):
            above, below = space.cancelled(above, below)
            parts = [space.terms(above), space.terms(below)]
            found = Quotient(*self._raised([part for part, _ in parts]))
            tied = any(changed for _, changed in parts) or found.below != parts[1][0]
            if not tied or not found.above:
                break
            polys = [Poly(self._ring, part) for part in found]
            space = _Space(self._ring, polys)
            above, below = space.cleared(polys)
        return found if found.above else Quotient({}, {0: 1})

    def _raised(self, parts: list[Terms]) -> list[Terms]:
        """Roots and cosines that divide the denominator put above it, where that is no longer."""
        above, below = parts
        if not below:
            raise ZeroDivisionError("a quotient by zero")
        shared = self._ring.primitive(below)[0]
        for place, exponent in self._ring.exponents(*shared):
            kind = self._ring.generators[place].kind
            if exponent != 1 or kind not in (ROOT, COS):
                continue
            times = {unit(place): 1}
            raised = [self._ring.product(part, times) for part in (above, below)]
            longer = sum(map(len, raised)) - len(above) - len(below)
            if longer < 0 or (kind == ROOT and longer == 0):
                above, below = raised
        return [above, below]


class _Numbers:
    """A matrix in numbers beside the one in letters, eliminated with it: which entries are zero."""

    def __init__(self, values: Any, zero: float) -> None:
        """Start with values and the sizes of their terms."""
        self._zero = zero
        self._rows = [
            [value if abs(value) > zero * scale else 0 for value, scale in row] for row in values
        ]

    def has(self, i: int, j: int) -> bool:
        """Whether an entry is not zero."""
        return bool(self._rows[i][j] != 0)

    def step(self, row: int, column: int, left: Iterable[int], columns: Iterable[int]) -> None:
        """Subtract a row from the others that are left."""
        own = self._rows[row]
        for i in left:
            other = self._rows[i]
            if i == row or not other[column]:
                continue
            factor = other[column] / own[column]
            for j in columns:
                product = factor * own[j]
                if product:
                    new = other[j] - product
                    other[j] = new if abs(new) > self._zero * abs(product) else 0


class _Space:
    """The polynomials of sympy's in all generators that some polynomials of a ring are made of."""

    def __init__(self, ring: Ring, given: Iterable[Poly]) -> None:
        """Find the generators, those in denominators too."""
        self._ring = ring
        places: set[int] = set()
        pending = [term for x in given for term in x.terms]
        seen: set[int] = set()
        while pending:
            for place, _ in ring.exponents(pending.pop()):
                if place in seen:
                    continue
                seen.add(place)
                kind, content = ring.generators[place]
                if kind == INVERSE:
                    pending += [term for term, _ in content]
                else:
                    places.add(place)
        self._places = sorted(places)
        self._index = {place: n for n, place in enumerate(self._places)}
        symbols = [sympy.Symbol(f"g{place}") for place in self._places]
        self._poly = PolyRing(symbols, sympy.ZZ)
        self._inverses: dict[int, tuple[Element, Element]] = {}

    @property
    def zero(self) -> Element:
        """Zero among them."""
        return self._poly.zero

    def cleared(self, row: Sequence[Poly]) -> list[Element]:
        """A row times whatever makes its entries polynomials with whole coefficients."""
        need: dict[tuple[int, bool], int] = {}
        for x in row:
            for term in x.terms:
                for place, exponent in self._ring.exponents(term):
                    inverse = self._ring.generators[place].kind == INVERSE
                    if exponent < 0 or inverse:
                        key = (place, exponent < 0)
                        need[key] = max(need.get(key, 0), abs(exponent))
        exact = [{t: _exact(k) for t, k in x.terms.items()} for x in row]
        scale = lcm(*(k.denominator for terms in exact for k in terms.values()))
        return [self._element(terms, need, scale) for terms in exact]

    def _element(
        self, terms: dict[int, Fraction], need: dict[tuple[int, bool], int], scale: int
    ) -> Element:
        groups: dict[tuple[tuple[int, int], ...], dict[tuple[int, ...], int]] = {}
        for term, k in terms.items():
            exponents = dict(self._ring.exponents(term))
            inverses = []
            for place, negative in need:
                kind = self._ring.generators[place].kind
                if kind != INVERSE:
                    exponents[place] = exponents.get(place, 0) + need[place, negative]
                elif not negative or (place, False) not in need:
                    inverses.append((place, exponents.pop(place, 0)))
            monomial = [0] * len(self._places)
            for place, exponent in exponents.items():
                monomial[self._index[place]] = exponent
            group = groups.setdefault(tuple(inverses), {})
            group[tuple(monomial)] = int(k * scale)
        return sum((self._times(*pair, need) for pair in groups.items()), self._poly.zero)

    def _times(
        self,
        inverses: tuple[tuple[int, int], ...],
        group: dict[tuple[int, ...], int],
        need: dict[tuple[int, bool], int],
    ) -> Element:
        """Terms with the same inverses, times the denominators that these leave."""
        found = self._poly.from_dict(group)
        for place, exponent in inverses:
            above, below = self._inverse(place)
            up, down = need.get((place, False), 0), need.get((place, True), 0)
            # the inverse is above/below
            for factor, power in ((below, up - exponent), (above, down + exponent)):
                if power and factor != 1:
                    factor = factor**power
                    self._ring.spend(len(found) * len(factor))
                    found = found * factor
        return found

    def _inverse(self, place: int) -> tuple[Element, Element]:
        """Numerator and denominator of an inverse."""
        if place not in self._inverses:
            inner = Poly(self._ring, dict(self._ring.generators[place].content))
            below, above = self.cleared([inner, self._ring.poly(1)])
            self._inverses[place] = (above, below)
        return self._inverses[place]

    def cancelled(self, above: Element, below: Element) -> tuple[Element, Element]:
        """Both without their common factor."""
        domain = self._poly.domain
        numbers = reduce(domain.gcd, [*above.values(), *below.values()])
        least = [min(exponents) for exponents in zip(*above, *below, strict=True)]
        above, below = (
            self._poly.from_dict(
                {
                    tuple(e - low for e, low in zip(monomial, least, strict=True)): k // numbers
                    for monomial, k in x.items()
                }
            )
            for x in (above, below)
        )
        if len(below) == 1 or coprime(above, below):
            return above, below
        self._ring.spend(len(above) * len(below))
        _, above, below = above.cofactors(below)
        return above, below

    def terms(self, x: Element) -> tuple[Terms, bool]:
        """As terms of the ring, and whether what ties generators changed them."""
        found: Terms = {}
        changed = False
        for monomial, k in x.items():
            term = sum(unit(p, e) for p, e in zip(self._places, monomial, strict=True) if e)
            for other, factor in self._ring.reduced(term).items():
                changed = changed or other != term
                gather(found, other, factor * int(k))
        return found, changed


def coprime(a: Element, b: Element) -> bool:
    """Whether no factor with a variable is common: certain where true.

    Where all variables but one have values, a common factor stays one, unless the leading coefficient of what
    it divides vanishes. So it is looked for in one variable at a time, modulo a prime.
    """
    draw = random.Random(0)
    places = [draw.randrange(2, PRIME) for _ in a.ring.gens]
    for n, (e, f) in enumerate(zip(a.degrees(), b.degrees(), strict=True)):
        if not (e and f):
            continue
        images = [_image(x, n, places) for x in (a, b)]
        if len(images[0]) <= e or _common_degree(*images):
            return False
    return True


def _image(x: Element, kept: int, places: Sequence[int]) -> list[int]:
    """The coefficients of the powers of one variable, modulo a prime; the highest is not zero."""
    found = [0] * (x.degrees()[kept] + 1)
    for monomial, k in x.items():
        value = int(k)
        for n, exponent in enumerate(monomial):
            if exponent and n != kept:
                value = value * (places[n] if exponent == 1 else pow(places[n], exponent, PRIME)) % PRIME
        found[monomial[kept]] = (found[monomial[kept]] + value) % PRIME
    return _trimmed(found)


def _common_degree(a: list[int], b: list[int]) -> int:
    """The degree of the greatest common factor of two polynomials modulo a prime."""
    while b:
        inverse = pow(b[-1], -1, PRIME)
        rest = list(a)
        while len(rest) >= len(b):
            factor = rest[-1] * inverse % PRIME
            shift = len(rest) - len(b)
            for n, k in enumerate(b):
                rest[shift + n] = (rest[shift + n] - factor * k) % PRIME
            rest = _trimmed(rest)
        a, b = b, rest
    return len(a) - 1


def _trimmed(coefficients: list[int]) -> list[int]:
    while coefficients and not coefficients[-1]:
        coefficients.pop()
    return coefficients


def _exact(k: Any) -> Fraction:
    """A coefficient as a fraction; a float as the decimal that it is written as."""
    return Fraction(repr(k)) if isinstance(k, float) else Fraction(k)
