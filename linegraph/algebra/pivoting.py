"""Elimination with complete pivoting over floats, as emitted code does it, and columns far from dependent."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.tolerance import DEPENDENT

if TYPE_CHECKING:
    from collections.abc import Sequence

Array = Any


def free_motions(J: Array, rank: int) -> Array:
    """T, N x (N - rank): the motions that J in pure numbers allows, one for each velocity it leaves free.

    Unlike orthogonal vectors these do not mix the motions of light bodies with those of heavy ones.
    """
    import numpy as np

    n = J.shape[1]
    A, rank, columns = _eliminated(J, rank)
    T = np.zeros((n, n - rank))
    T[columns[rank:], np.arange(n - rank)] = 1.0
    if rank:
        T[columns[:rank]] = -np.linalg.solve(np.triu(A[:rank, :rank]), A[:rank, rank:])
    return T


def _eliminated(J: Array, most: int) -> tuple[Array, int, Array]:
    """P J Q = L U in one array, its rank, and where its columns come from."""
    import numpy as np

    A = np.array(J, float)
    columns = np.arange(A.shape[1])
    for k in range(most):
        rest = np.abs(A[k:, k:])
        i, j = (k + int(x) for x in np.unravel_index(np.argmax(rest), rest.shape))
        if not abs(A[i, j]) > DEPENDENT:
            return A, k, columns
        A[[k, i]] = A[[i, k]]
        A[:, [k, j]] = A[:, [j, k]]
        columns[[k, j]] = columns[[j, k]]
        A[k + 1 :, k] /= A[k, k]
        A[k + 1 :, k + 1 :] -= A[k + 1 :, k, None] * A[k, k + 1 :]
    return A, most, columns


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


def apart_columns(J: Array, order: Sequence[int], most: int, apart: float) -> list[int]:
    """Columns of J, the first in an order of which the least singular value stays above a bound.

    Columns taken so far are Q R with Q orthonormal. As R grows by a column, so does its inverse, and the
    least singular value lies between 1 and sqrt(n) over Frobenius' norm of that; itself it is asked for only
    where these two do not decide.

    Args:
        J: in pure numbers.
        order: in which columns are tried.
        most: how many are taken.
        apart: the bound.
    """
    import numpy as np

    taken: list[int] = []
    Q, inverse = np.zeros((len(J), most)), np.zeros((most, most))
    for k in order:
        n = len(taken)
        if n == most:
            break
        rest, along = J[:, k], np.zeros(n)
        for _ in range(2):  # the second time takes away what the first has left by rounding
            more = Q[:, :n].T @ rest
            rest, along = rest - Q[:, :n] @ more, along + more
        distance = float(np.linalg.norm(rest))
        if not distance > apart:
            continue  # the least singular value is no greater than this
        column = -inverse[:n, :n] @ along / distance
        size = np.sqrt((inverse[:n, :n] ** 2).sum() + column @ column + distance**-2)
        if apart * size >= 1:
            if apart * size > np.sqrt(n + 1):
                continue
            if not np.linalg.svd(J[:, [*taken, k]], compute_uv=False).min() > apart:
                continue
        Q[:, n], inverse[:n, n], inverse[n, n] = rest / distance, column, 1 / distance
        taken.append(k)
    return taken
