"""Quotients of polynomials of a ring: fraction-free solution of linear equations, common factors removed.

    rows X = rights  ──cleared──→ polynomials ──eliminated──→ minors ──cancelled──→ X

The elimination is that of Bareiss: every intermediate is a minor of the matrix, so that each division
is exact and nothing grows beyond the result; elimination with quotients would have to cancel at every
step. Generators are treated as independent symbols; relations between them (``cos^2 = 1 - sin^2``, the
square of a root) are applied once, to the result. This is correct wherever the pivots do not vanish,
which is judged by their values at a random point.
"""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.symbolic.simplification.generators import COS, ROOT, unit
from linegraph.symbolic.simplification.polynomial import Poly, Ring
from linegraph.symbolic.simplification.spaces import Element, Space

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.symbolic.simplification.numbers import Terms
    from linegraph.symbolic.simplification.proof import SamplePoint

ZERO = 1e-25
"""Size of a number with fifty digits, relative to the terms of its sum, below which it is zero ..."""
ROUNDED = 1e-9
"""... and if some numbers are floats."""

AGAIN = 4
"""Rounds of applying relations between generators, which may create a common factor."""


class Quotient(NamedTuple):
    """A polynomial over another, without common factors; coefficients are integers."""

    above: Terms
    below: Terms


class Singular(Exception):
    """Equations do not determine their unknowns; `rows` are the remaining ones."""

    def __init__(self, rows: Sequence[int]) -> None:
        """Keep the remaining rows."""
        super().__init__(rows)
        self.rows = rows


class Quotients:
    """Solves linear equations between polynomials of a ring, which may contain quotients.

    Args:
        ring: of the polynomials.
        point: decides by its values which entries are zero.

    Example:
        >>> ring = Ring()
        >>> m, k = ring.symbol("p", "m"), ring.symbol("p", "k")
        >>> from linegraph.symbolic.simplification.proof import SamplePoint
        >>> quotients = Quotients(ring, SamplePoint(ring, {}, 0))
        >>> [[x]], _ = quotients.solve([[m * m + m * k]], [[k * m]])
        >>> above, below = quotients.of(x)
        >>> above == k.terms, below == (m + k).terms
        (True, True)
    """

    def __init__(self, ring: Ring, point: SamplePoint) -> None:
        """Keep the ring and the point."""
        self._ring = ring
        self._point = point
        self._known: dict[frozenset[Any], Quotient] = {}

    @property
    def zero(self) -> float:
        """The size, relative to the terms of a sum, below which it is zero."""
        return ROUNDED if self._ring.inexact else ZERO

    def vanishes(self, x: Poly) -> bool:
        """Whether a polynomial is zero, judged by its value at the point."""
        value, scale = self._point.terms(x.terms)
        return bool(abs(value) <= self.zero * scale)

    def of(self, x: Poly) -> Quotient:
        """A polynomial with inverses as one quotient."""
        key = frozenset(x.terms.items())
        if key not in self._known:
            if self.vanishes(x):
                found = Quotient({}, {0: 1})
            else:
                space = Space(self._ring, [x])
                above, below = space.cleared([x, self._ring.poly(1)])
                found = self._cancelled(space, above, below)
            self._known[key] = found
        return self._known[key]

    def poly(self, x: Quotient) -> Poly:
        """A quotient as a polynomial, with its denominator as one generator."""
        found = Poly(self._ring, x.above) / Poly(self._ring, x.below)
        self._known[frozenset(found.terms.items())] = x
        return found

    def shared(self, parts: Sequence[Terms]) -> Terms:
        """The greatest common factor of polynomials, with a positive sign."""
        polys = [Poly(self._ring, part) for part in parts]
        space = Space(self._ring, polys)
        found = None
        for x in sorted(space.cleared(polys), key=len):
            found = x if found is None else found.gcd(x)
            if found == 1:
                break
        return {} if found is None else space.terms(found)[0]

    def divided(self, terms: Terms, factor: Terms) -> Terms:
        """The quotient of a polynomial and one of its factors.

        Args:
            terms: the polynomial.
            factor: divides it without remainder.
        """
        if factor == {0: 1}:
            return terms
        above, below = self.of(Poly(self._ring, terms) / Poly(self._ring, factor))
        assert below == {0: 1}, "it is no factor"
        return above

    def solve(
        self,
        rows: Sequence[Sequence[Poly]],
        rights: Sequence[Sequence[Poly]],
        through: Sequence[Sequence[Poly]] = (),
        direct: Sequence[Sequence[Poly]] = (),
    ) -> tuple[list[list[Poly]], list[list[Poly]]]:
        """X of ``rows X = rights``, and ``Y = through X + direct``.

        Y comes from the same elimination, so that denominators of X cancel in it.

        Args:
            rows: a square matrix.
            rights: the right-hand sides, as columns of a matrix.
            through: rows that multiply X.
            direct: rows that are added to the products.

        Raises:
            Singular: the matrix is not regular.
            Swollen: the budget is used up.
        """
        size = len(rows)
        given = [[*row, *right] for row, right in zip(rows, rights, strict=True)]
        given += [[-x for x in row] + list(y) for row, y in zip(through, direct, strict=True)]
        space = Space(self._ring, [x for row in given for x in row])
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

    def _row(self, space: Space, above: Sequence[Element], below: Element) -> list[Poly]:
        zero = self._ring.poly(0)
        return [self.poly(self._cancelled(space, x, below)) if x else zero for x in above]

    def _eliminated(self, rows: list[list[Element]], values: Any) -> list[tuple[int, int]]:
        """Eliminate until each row of the matrix has one entry; the places of these.

        The pivot is the shortest non-zero entry, among equals the one with the least fill-in [Markowitz
        1957], then the last: masses are eliminated from the leaves to the root. With floats, large
        pivots take precedence over fill-in.
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
                    (
                        len(rows[i][j]),
                        mirror.smallness(i, j) if self._ring.inexact else 0,
                        (filled[i] - 1) * (counts[j] - 1),
                        i != j,
                        -i,
                        -j,
                    )
                    for i in left
                    for j in open_columns
                    if rows[i][j] and mirror.has(i, j)
                ),
                default=None,
            )
            if choice is None:
                raise Singular(left)
            row, column = -choice[-2], -choice[-1]
            self._step(rows, row, column, before)
            mirror.step(row, column, left, open_columns)
            before = rows[row][column]
            left.remove(row)
            open_columns.remove(column)
            found.append((row, column))
        return found

    def _step(self, rows: list[list[Element]], row: int, column: int, before: Element) -> None:
        """One step of Bareiss's elimination, in all other rows."""
        own, pivot = rows[row], rows[row][column]
        for i, other in enumerate(rows):
            if i == row:
                continue
            factor = other[column]
            self._ring.spend(len(pivot) * sum(map(len, other)) + len(factor) * sum(map(len, own)))
            new = [pivot * a - factor * b for a, b in zip(other, own, strict=True)]
            rows[i] = new if before is None else [x.exquo(before) if x else x for x in new]
            if before is not None:
                self._ring.spend(len(before) * sum(map(len, rows[i])))

    def _cancelled(self, space: Space, above: Element, below: Element) -> Quotient:
        """A quotient without common factors, with relations between generators applied."""
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
            space = Space(self._ring, polys)
            above, below = space.cleared(polys)
        if not found.above:
            return Quotient({}, {0: 1})
        sign = 1 if found.below[min(found.below)] > 0 else -1
        turned: list[Terms] = [{term: sign * k for term, k in part.items()} for part in found]
        return Quotient(*turned)

    def _raised(self, parts: list[Terms]) -> list[Terms]:
        """Move roots and cosines that divide the denominator to the numerator, if that gets no longer."""
        above, below = parts
        if not below:
            raise ZeroDivisionError("a quotient by zero")
        shared = self._ring.primitive(below)[0]
        for place, exponent in self._ring.exponents(*shared):
            kind = self._ring.generators[place].kind
            if exponent != 1 or kind not in (ROOT, COS):
                continue
            times: Terms = {unit(place): 1}
            raised = [self._ring.product(part, times) for part in (above, below)]
            longer = sum(map(len, raised)) - len(above) - len(below)
            if longer < 0 or (kind == ROOT and longer == 0):
                above, below = raised
        return [above, below]


class _Numbers:
    """A matrix in numbers, eliminated along with the one in letters, to decide which entries are zero."""

    def __init__(self, values: Any, zero: float) -> None:
        """Start from values with the sizes of their terms."""
        self._zero = zero
        self._rows = [
            [value if abs(value) > zero * scale else 0 for value, scale in row] for row in values
        ]

    def has(self, i: int, j: int) -> bool:
        """Whether an entry is non-zero."""
        return bool(self._rows[i][j] != 0)

    def smallness(self, i: int, j: int) -> int:
        """The number of decimals by which an entry is smaller than the largest of its row."""
        largest = max(abs(x) for x in self._rows[i])
        return int(math.log10(largest / abs(self._rows[i][j])))

    def step(self, row: int, column: int, left: Iterable[int], columns: Iterable[int]) -> None:
        """Subtract a row from the remaining ones."""
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
