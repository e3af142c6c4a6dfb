"""Elimination with complete pivoting over floats, as emitted code does it."""

from __future__ import annotations

from typing import Any

from linegraph.tolerance import DEPENDENT

Array = Any


def free_motions(J: Array, rank: int) -> Array:
    """T, N x (N - rank): the motions that J in pure numbers allows, one for each velocity it leaves free.

    Unlike orthogonal vectors these do not mix the motions of light bodies with those of heavy ones.
    """
    import numpy as np

    n = J.shape[1]
    A, rank, rows, columns = _eliminated(J, rank)
    T = np.zeros((n, n - rank))
    T[columns[rank:], np.arange(n - rank)] = 1.0
    U = np.triu(A[np.ix_(rows[:rank], columns[:rank])])
    beside = A[np.ix_(rows[:rank], columns[rank:])]
    if rank:
        T[columns[:rank]] = -np.linalg.solve(U, beside)
    return T


def _eliminated(J: Array, most: int) -> tuple[Array, int, list[int], list[int]]:
    """P J Q = L U in one array, its rank, and where rows and columns come from."""
    import numpy as np

    A = np.array(J, float)
    rows, columns = list(range(A.shape[0])), list(range(A.shape[1]))
    for rank in range(most):
        rest = np.abs(A[np.ix_(rows[rank:], columns[rank:])])
        i, j = np.unravel_index(np.argmax(rest), rest.shape)
        if not rest[i, j] > DEPENDENT:
            return A, rank, rows, columns
        rows[rank], rows[rank + i] = rows[rank + i], rows[rank]
        columns[rank], columns[rank + j] = columns[rank + j], columns[rank]
        pivot, column, after = rows[rank], columns[rank], columns[rank + 1 :]
        for k in rows[rank + 1 :]:
            A[k, column] /= A[pivot, column]
            A[k, after] -= A[k, column] * A[pivot, after]
    return A, most, rows, columns


def without_inertia(M: Array, T: Array, rounding: float) -> list[Array]:
    """Combinations of the motions T that move no inertia of M; without them T^T M T is regular.

    A pivot of T^T M T is zero if it is a smaller part than `rounding` of what it was made of.
    """
    import numpy as np

    R, made_of = T.T @ M @ T, np.diag(np.abs(T).T @ np.abs(M) @ np.abs(T))
    found: list[Array] = []
    kept: list[int] = []
    for k in range(len(R)):
        before = R[np.ix_(kept, kept)]
        # scaled, since light and heavy bodies stand side by side
        scale = 1 / np.sqrt(np.diag(before))
        share = np.linalg.solve(before * scale * scale[:, None], R[kept, k] * scale) * scale
        if R[k, k] - R[kept, k] @ share > rounding * made_of[k]:
            kept.append(k)
        else:
            found.append(T[:, k] - T[:, kept] @ share)
    return found
