"""Solution of M v̇ = r by M = L^T D L over any algebra, structural zeros skipped.

Eliminated from the leaves to the root, the mass matrix of a kinematic tree has factors without fill-in: L has
no more non-zeros than M itself, since only ancestors of a joint are coupled with it [Featherstone 2005;
Featherstone 2008, sec. 6.5]. The usual Cholesky factorisation eliminates from the root, and fills L where the
tree branches.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar


class Solution(NamedTuple):
    """Solution of ``M v̇ = r``.

    Attributes:
        unknowns: v̇.
        pivots: the diagonal of D, by coordinate; all are positive exactly if M is positive definite.
    """

    unknowns: list[Scalar]
    pivots: list[Scalar]


class Factors(NamedTuple):
    """The factors of ``M = L^T D L``, M symmetric.

    Attributes:
        pivots: the diagonal of D, by coordinate.
        inverses: their reciprocals.
        below: for each coordinate its row of L, {column: entry}, without the diagonal of ones.
        outward: the coordinates from the root to the leaves.
    """

    pivots: list[Scalar]
    inverses: list[Scalar]
    below: list[dict[int, Scalar]]
    outward: Sequence[int]

    def solve(self, right: Sequence[Scalar]) -> list[Scalar]:
        """The solution x of ``M x = r``."""
        return self.substituted(self.scaled(self.reduced(right)))

    def reduced(self, right: Sequence[Scalar]) -> list[Scalar]:
        """``y = L^-T r``, from the leaves to the root.

        Two such vectors give the product ``r1 . M^-1 r2 = y1 . D^-1 y2`` without the second substitution.
        """
        y = list(right)
        for k in reversed(self.outward):
            if y[k] != 0:
                for i, entry in self.below[k].items():
                    y[i] = y[i] - entry * y[k]
        return y

    def scaled(self, reduced: Sequence[Scalar]) -> list[Scalar]:
        """``D^-1 y``, by the reciprocals of the pivots."""
        return [y * inverse for y, inverse in zip(reduced, self.inverses, strict=True)]

    def substituted(self, scaled: Sequence[Scalar], until: int | None = None) -> list[Scalar]:
        """``x = L^-1 z``, from the root to the leaves.

        Args:
            scaled: z, by coordinate.
            until: the last coordinate that is needed; entries of coordinates further outward are left
                unsolved.
        """
        x = list(scaled)
        for k in self.outward:
            for i, entry in self.below[k].items():
                x[k] = x[k] - entry * x[i]
            if k == until:
                break
        return x

    def inverse(self) -> list[list[Scalar]]:
        """``M^-1`` by rows; each of the two equal entries is computed once."""
        size = len(self.pivots)
        rows: list[list[Scalar]] = [[0] * size for _ in range(size)]
        for place, k in enumerate(self.outward):
            unit = self.scaled(self.reduced([int(i == k) for i in range(size)]))
            column = self.substituted(unit, until=k)
            for i in self.outward[: place + 1]:
                rows[i][k] = rows[k][i] = column[i]
        return rows


def factored(rows: Sequence[Sequence[Scalar]], outward: Sequence[int]) -> Factors:
    """Factor a symmetric matrix ``M = L^T D L``, eliminating from the leaves to the root.

    Args:
        rows: M by rows; only entries m[k][i] with i further inward than k are read, and the diagonal.
        outward: the coordinates in an order from the root to the leaves.

    Returns:
        The factors. A zero pivot is a ZeroDivisionError over numbers and not noticed over symbols.
    """
    size = len(rows)
    m = [list(row) for row in rows]
    pivots: list[Scalar] = [0] * size
    inverses: list[Scalar] = [0] * size
    below: list[dict[int, Scalar]] = [{} for _ in range(size)]
    for place in reversed(range(size)):
        k = outward[place]
        pivots[k] = m[k][k]
        # one division for each pivot: all other quotients, also those of `solve`, become products
        inverses[k] = 1 / pivots[k]
        inner = [i for i in outward[:place] if m[k][i] != 0]
        for i in inner:
            below[k][i] = m[k][i] * inverses[k]
        for n, i in enumerate(inner):
            for j in inner[: n + 1]:
                m[i][j] = m[i][j] - below[k][i] * m[k][j]
                m[j][i] = m[i][j]
    return Factors(pivots, inverses, below, outward)


def solve(
    rows: Sequence[Sequence[Scalar]],
    right: Sequence[Scalar],
    outward: Sequence[int],
    *,
    symmetric: bool = True,
) -> Solution:
    """Solve ``M x = r``.

    Args:
        rows: M by rows; of a symmetric M only one triangle is read.
        right: r, by coordinate.
        outward: the coordinates in an order from the root to the leaves.
        symmetric: whether M is symmetric; otherwise it is factored as ``U D L`` with pivots in the same
            order.
    """
    (x,), pivots = solve_many(rows, [right], outward, symmetric=symmetric)
    return Solution(x, pivots)


def solve_many(
    rows: Sequence[Sequence[Scalar]],
    rights: Sequence[Sequence[Scalar]],
    outward: Sequence[int],
    *,
    symmetric: bool = True,
) -> tuple[list[list[Scalar]], list[Scalar]]:
    """Solve ``M x = r`` for several right-hand sides with one factorisation.

    Args:
        rows: M by rows; of a symmetric M only one triangle is read.
        rights: the vectors r.
        outward: the coordinates in an order from the root to the leaves.
        symmetric: whether M is symmetric.

    Returns:
        The solutions, and the pivots by coordinate.
    """
    if symmetric:
        factors = factored(rows, outward)
        return [factors.solve(right) for right in rights], factors.pivots
    return _general(rows, rights, outward)


def _general(
    rows: Sequence[Sequence[Scalar]], rights: Sequence[Sequence[Scalar]], outward: Sequence[int]
) -> tuple[list[list[Scalar]], list[Scalar]]:
    """Solve for several right-hand sides with a matrix that is not symmetric."""
    m = [list(row) for row in rows]
    found = [list(right) for right in rights]
    pivots: list[Scalar] = [0] * len(m)
    for place in reversed(range(len(m))):
        k = outward[place]
        pivots[k] = m[k][k]
        inverse = 1 / pivots[k]
        for i in outward[:place]:
            if m[i][k] == 0:
                continue
            factor = m[i][k] * inverse
            for j in outward[:place]:
                if m[k][j] != 0:
                    m[i][j] = m[i][j] - factor * m[k][j]
            for x in found:
                x[i] = x[i] - factor * x[k]
    for place, k in enumerate(outward):
        for x in found:
            for j in outward[:place]:
                if m[k][j] != 0:
                    x[k] = x[k] - m[k][j] * x[j]
            x[k] = x[k] / pivots[k]
    return found, pivots


def singular(rows: Sequence[Sequence[float]], *, symmetric: bool) -> int | None:
    """The first unknown at which the leading block of a matrix of numbers is singular; None if it is regular.

    Args:
        rows: a square matrix by rows.
        symmetric: whether it is symmetric, and only one triangle is to be read.
    """
    if _regular(rows, len(rows), symmetric):
        return None
    return next(k for k in range(len(rows)) if not _regular(rows, k + 1, symmetric))


def _regular(rows: Sequence[Sequence[float]], size: int, symmetric: bool) -> bool:
    part = [row[:size] for row in rows[:size]]
    try:
        pivots = solve(part, [0.0] * size, range(size), symmetric=symmetric).pivots
    except ZeroDivisionError:
        return False
    return all(abs(pivot) > 0 for pivot in pivots)
