"""Solving M v̇ = r by M = L^T D L over any algebra, structural zeros skipped.

Eliminated from the leaves to the root, the factor of a tree's mass matrix has no more non-zeros than the
matrix itself: only ancestors of a joint are coupled with it (Featherstone 2005).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.vector import Scalar


class Solution(NamedTuple):
    """Solution of a symmetric positive definite system.

    Attributes:
        unknowns: v̇.
        pivots: the diagonal of D, by coordinate; all positive exactly when M is positive definite.
    """

    unknowns: list[Scalar]
    pivots: list[Scalar]


class Reduced(NamedTuple):
    """A factored matrix, and right-hand sides on the way to their solutions.

    Attributes:
        pivots: the diagonal of D.
        rights: the right-hand sides, reduced: L^-T r of a symmetric M = L^T D L.
        scaled: the same, divided by the pivots.
        factor: of every coordinate its row of L below the diagonal.
    """

    pivots: list[Scalar]
    rights: list[list[Scalar]]
    scaled: list[list[Scalar]]
    factor: list[dict[int, Scalar]]


def solve(
    rows: Sequence[Sequence[Scalar]],
    right: Sequence[Scalar],
    outward: Sequence[int],
    *,
    symmetric: bool = True,
) -> Solution:
    """Solve ``M x = r``.

    Args:
        rows: M, of which one triangle is read if it is symmetric.
        right: r.
        outward: the coordinates in an order from the root to the leaves.
        symmetric: whether M is; otherwise it is factored by ``M = U D L`` with the same pivots.
    """
    if not symmetric:
        return _general(rows, right, outward)
    reduced = reduce(rows, [right], outward)
    return Solution(substituted(reduced, reduced.scaled[0], outward), reduced.pivots)


def reduce(
    rows: Sequence[Sequence[Scalar]],
    rights: Sequence[Sequence[Scalar]],
    outward: Sequence[int],
) -> Reduced:
    """Factor a symmetric ``M = L^T D L`` and reduce right-hand sides.

    With y = L^-T r of two of them, ``r1 . M^-1 r2 = y1 . D^-1 y2``.
    """
    size = len(rows)
    m = [list(row) for row in rows]
    xs = [list(right) for right in rights]
    reduced: list[list[Scalar]] = [[0] * size for _ in xs]
    pivots: list[Scalar] = [0] * size
    factor: list[dict[int, Scalar]] = [{} for _ in range(size)]
    for place in reversed(range(size)):
        k = outward[place]
        pivots[k] = m[k][k]
        inverse = 1 / pivots[k]
        inner = [i for i in outward[:place] if m[k][i] != 0]
        for i in inner:
            factor[k][i] = m[k][i] * inverse
        for n, i in enumerate(inner):
            for j in inner[: n + 1]:
                m[i][j] = m[i][j] - factor[k][i] * m[k][j]
                m[j][i] = m[i][j]
            for x in xs:
                x[i] = x[i] - factor[k][i] * x[k]
        for x, y in zip(xs, reduced, strict=True):
            y[k] = x[k]
            x[k] = x[k] * inverse
    return Reduced(pivots, reduced, xs, factor)


def substituted(reduced: Reduced, scaled: Sequence[Scalar], outward: Sequence[int]) -> list[Scalar]:
    """The solution that belongs to a right-hand side that is reduced and divided by the pivots."""
    x = list(scaled)
    for k in outward:
        for i, entry in reduced.factor[k].items():
            x[k] = x[k] - entry * x[i]
    return x


def _general(
    rows: Sequence[Sequence[Scalar]], right: Sequence[Scalar], outward: Sequence[int]
) -> Solution:
    """The same for a matrix that is not symmetric."""
    m = [list(row) for row in rows]
    x = list(right)
    pivots: list[Scalar] = [0] * len(x)
    for place in reversed(range(len(x))):
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
            x[i] = x[i] - factor * x[k]
    for place, k in enumerate(outward):
        for j in outward[:place]:
            if m[k][j] != 0:
                x[k] = x[k] - m[k][j] * x[j]
        x[k] = x[k] / pivots[k]
    return Solution(x, pivots)


def singular(rows: Sequence[Sequence[float]], *, symmetric: bool) -> int | None:
    """The first unknown at which a matrix of numbers fails to be solved for; None if it is regular."""
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
