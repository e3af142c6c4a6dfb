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
    rows: Sequence[Sequence[Scalar]], right: Sequence[Scalar], outward: Sequence[int]
) -> Solution:
    """Solve ``M x = r``.

    Args:
        rows: M, of which one triangle is read.
        right: r.
        outward: the coordinates in an order from the root to the leaves.
    """
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
