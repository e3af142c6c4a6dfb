"""Scalars with their values at sample parameters and bounds of the errors: linear algebra with symbols.

Elimination has to know which entries are zero. A `Traced` scalar has its expression, a node of a DAG or a
number, and its values at a few random parameters, each with a bound of its error. A scalar that is zero
within that bound at all samples becomes the number 0, one that is the same integer everywhere becomes that
integer: sums of squares of sine and cosine become 1, and terms that cancel vanish. Exact residues would not
do, since they take the rounded numbers of a geometry for exact ones.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from linegraph.algebra.scalar import Scalar

EPS = 2.3e-16
"""Machine epsilon of doubles, 2^-52, rounded up."""

LOOSE = 16
"""The factor by which an error may exceed its bound."""

LARGEST = 64
"""Larger values are not compared with integers."""

WEAK = 0.2
"""An entry smaller than this fraction of comparable ones in its row is a pivot only if there is no other."""

Row = list[Any]


class Traced:
    """A scalar with its values at sample parameters.

    Attributes:
        node: its expression.
        values: one number for each sample.
        errors: bounds of their absolute errors.

    Example:
        >>> c, s = given(0.8, [0.8], 0.0), given(0.6, [0.6], 0.0)
        >>> c * c + s * s, c * s - s * c
        (1, 0)
    """

    __slots__ = ("errors", "node", "values")

    def __init__(self, node: Any, values: Sequence[float], errors: Sequence[float]) -> None:
        """Keep the three as they are; `traced` replaces scalars that are integers by numbers first."""
        self.node = node
        self.values = tuple(values)
        self.errors = tuple(errors)

    def __neg__(self) -> Scalar:
        return Traced(-self.node, [-x for x in self.values], self.errors)

    def __add__(self, other: Scalar) -> Scalar:
        other = self._like(other)
        if other is None:
            return self
        pairs = zip(self.values, other.values, strict=True)
        values = [x + y for x, y in pairs]
        sizes = zip(self.errors, other.errors, values, strict=True)
        return traced(self.node + other.node, values, [a + b + EPS * abs(x) for a, b, x in sizes])

    __radd__ = __add__

    def __sub__(self, other: Scalar) -> Scalar:
        return self + -other

    def __rsub__(self, other: Scalar) -> Scalar:
        return -self + other

    def __mul__(self, other: Scalar) -> Scalar:
        other = self._like(other)
        if other is None:
            return 0
        pairs = list(zip(self.values, other.values, strict=True))
        errors = zip(self.errors, other.errors, strict=True)
        bounds = [
            abs(x) * b + abs(y) * a + EPS * abs(x * y)
            for (x, y), (a, b) in zip(pairs, errors, strict=True)
        ]
        return traced(self.node * other.node, [x * y for x, y in pairs], bounds)

    __rmul__ = __mul__

    def __truediv__(self, other: Scalar) -> Scalar:
        if not isinstance(other, Traced):
            return self * (1 / Fraction(other))
        return self * _inverse(other)

    def __rtruediv__(self, other: Scalar) -> Scalar:
        return _inverse(self) * other

    def _like(self, other: Scalar) -> Traced | None:
        """A number as a traced scalar; None for zero."""
        if isinstance(other, Traced):
            return other
        if other == 0:
            return None
        count = len(self.values)
        node = int(other) if other == int(other) else other
        return Traced(node, [float(other)] * count, [0.0] * count)


def _inverse(x: Traced) -> Traced:
    errors = [e / (v * v) + EPS / abs(v) for v, e in zip(x.values, x.errors, strict=True)]
    return Traced(1 / x.node, [1 / v for v in x.values], errors)


def traced(node: Any, values: Sequence[float], errors: Sequence[float]) -> Scalar:
    """A scalar with its values, or the integer that these agree on.

    Args:
        node: its expression.
        values: at the samples.
        errors: bounds of their absolute errors; `LOOSE` times as much is allowed.
    """
    # the first sample proposes the integer, all of them have to agree
    nearest = round(values[0]) if abs(values[0]) < LARGEST else 0
    if all(abs(v - nearest) <= LOOSE * e for v, e in zip(values, errors, strict=True)):
        return nearest
    return Traced(node, values, errors)


def given(node: Any, values: Sequence[float], within: float) -> Scalar:
    """A scalar of a model, exact to rounding of its own size and to `within`.

    Args:
        node: its expression; integers and fractions are returned as they are.
        values: at the samples.
        within: an absolute error that comes on top of rounding.
    """
    if isinstance(node, (int, Fraction)):
        return node
    return traced(node, values, [EPS * abs(v) + within for v in values])


def size(x: Scalar) -> float:
    """The absolute value at the first sample."""
    return abs(x.values[0]) if isinstance(x, Traced) else abs(float(x))


def _rank(x: Scalar) -> tuple[int, float]:
    """The order of preference of a pivot: ±1, another number, a constant, any scalar; then by size."""
    if not isinstance(x, Traced):
        return (0, 0.0) if x in (1, -1) else (1, 0.0)
    return (2 if isinstance(x.node, float) else 3, -size(x))


def reduced(
    rows: Sequence[Row], order: Sequence[int] | None = None, kinds: Sequence[Any] = ()
) -> tuple[list[Row], list[int]]:
    """Rows in reduced echelon form, and the column of each row's pivot.

    Args:
        rows: not modified.
        order: the columns in which pivots are looked for, first ones first; by default the best pivot
            anywhere.
        kinds: for each column a key; entries of columns with the same key are comparable in size.

    Raises:
        AssertionError: a row has entries in columns outside `order` only.
    """
    left = [list(row) for row in rows]
    done: list[Row] = []
    pivots: list[int] = []
    while True:
        left = [row for row in left if any(x != 0 for x in row)]
        if not left:
            return done, pivots
        found = _best(left) if order is None else _first(left, order, kinds)
        row = left.pop(found[0])
        pivot = row[found[1]]
        row = [
            0 if x == 0 else x / pivot if isinstance(x, Traced) else _over(x, pivot) for x in row
        ]
        row[found[1]] = 1
        for others in (left, done):
            for k, other in enumerate(others):
                others[k] = _less(other, row, found[1])
        done.append(row)
        pivots.append(found[1])


def _over(x: Any, pivot: Scalar) -> Scalar:
    """A number divided by a pivot; exact if both are numbers."""
    if isinstance(pivot, Traced):
        return x / pivot
    quotient = Fraction(x) / Fraction(pivot)
    return int(quotient) if quotient.denominator == 1 else quotient


def _less(row: Row, pivot_row: Row, column: int) -> Row:
    """A row less the multiple of the pivot row that clears a column."""
    factor = row[column]
    if factor == 0:
        return row
    found = [x if y == 0 else x - factor * y for x, y in zip(row, pivot_row, strict=True)]
    found[column] = 0
    return found


def _best(rows: Sequence[Row]) -> tuple[int, int]:
    """The place of the best pivot."""
    places = ((i, k) for i, row in enumerate(rows) for k, x in enumerate(row) if x != 0)
    return min(places, key=lambda place: (_rank(rows[place[0]][place[1]]), place))


def _first(rows: Sequence[Row], order: Sequence[int], kinds: Sequence[Any]) -> tuple[int, int]:
    """The best pivot in the first column with an entry that is not weak."""
    for least in (WEAK, 0.0):
        for k in order:
            alike = [n for n, kind in enumerate(kinds) if kind == kinds[k]] or [k]
            good = [
                i
                for i, row in enumerate(rows)
                if row[k] != 0 and size(row[k]) > least * max(size(row[n]) for n in alike)
            ]
            if good:
                return min(good, key=lambda i: (_rank(rows[i][k]), i)), k
    raise AssertionError("a row without entries in these columns")


def kernel(rows: Sequence[Row], count: int) -> list[Row]:
    """A basis of all x with ``rows x = 0``.

    Args:
        rows: the matrix by rows.
        count: the number of entries of x.

    Example:
        >>> kernel([[1, 2, 0]], 3)
        [[-2, 1, 0], [0, 0, 1]]
    """
    done, pivots = reduced(rows)
    found = []
    for free in range(count):
        if free in pivots:
            continue
        x: Row = [0] * count
        x[free] = 1
        for row, pivot in zip(done, pivots, strict=True):
            x[pivot] = -row[free]
        found.append(x)
    return found


def closed(rows: Sequence[Row], action: Callable[[Row], Row]) -> list[Row]:
    """A basis of the smallest space that contains some rows and is invariant under a linear map.

    Args:
        rows: vectors of the space.
        action: the map.

    Example:
        >>> closed([[1, 0, 0]], lambda row: [-row[1], row[0], 0])
        [[1, 0, 0], [0, 1, 0]]
    """
    basis, _ = reduced(rows)
    while True:
        more, _ = reduced([*basis, *map(action, basis)])
        if len(more) == len(basis):
            return basis
        basis = more
