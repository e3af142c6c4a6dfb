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
    size = len(right)
    m = [list(row) for row in rows]
    x = list(right)
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
            x[i] = x[i] - factor[k][i] * x[k]
        x[k] = x[k] * inverse
    for k in outward:
        for i, entry in factor[k].items():
            x[k] = x[k] - entry * x[i]
    return Solution(x, pivots)


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
