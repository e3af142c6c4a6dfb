"""Numeric elimination with complete pivoting, as emitted code does it, and choice of independent columns."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.tolerance import DEPENDENT

if TYPE_CHECKING:
    from collections.abc import Sequence

Array = Any


def free_motions(J: Array, rank: int) -> Array:
    """A basis T of the motions that constraints J allow, J T = 0, with one column for each free velocity.

    From complete pivoting P J Q = L [U1 U2], T = Q [-U1⁻¹ U2; 1]. An orthonormal basis, as an SVD gives it,
    would mix the motions of light bodies with those of heavy ones, whose rounding errors hide the light ones
    in T^T M T.

    Args:
        J: constraints x N, made dimensionless by lengths and scales.
        rank: its rank at most; a pivot not above `DEPENDENT` ends the elimination earlier.

    Returns:
        T, N x (N - rank).
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
    """``P J Q = L U`` in one array, its rank, and the order of the columns."""
    import numpy as np

    A = np.array(J, float)
    columns = np.arange(A.shape[1])
    for k in range(most):
        rest = np.abs(A[k:, k:])
        i, j = (k + int(x) for x in np.unravel_index(np.argmax(rest), rest.shape))
        # not ">": a NaN ends the elimination, too
        if not abs(A[i, j]) > DEPENDENT:
            return A, k, columns
        A[[k, i]] = A[[i, k]]
        A[:, [k, j]] = A[:, [j, k]]
        columns[[k, j]] = columns[[j, k]]
        A[k + 1 :, k] /= A[k, k]
        A[k + 1 :, k + 1 :] -= A[k + 1 :, k, None] * A[k, k + 1 :]
    return A, most, columns


def without_inertia(M: Array, T: Array, rounding: float) -> list[Array]:
    """Combinations of the motions T without inertia; T^T M T of the others is regular.

    A pivot of T^T M T counts as zero if it is less than `rounding` times the sum of its terms' absolute
    values. An absolute bound would not do: M has light and heavy bodies, and entries in kg and in kg m².

    Args:
        M: mass matrix, N x N.
        T: motions as columns, N x n.
        rounding: relative size of a pivot that counts as zero.

    Returns:
        Vectors of N velocities, each with no kinetic energy.
    """
    import numpy as np

    R, made_of = T.T @ M @ T, np.diag(np.abs(T).T @ np.abs(M) @ np.abs(T))
    found: list[Array] = []
    kept: list[int] = []
    for k in range(len(R)):
        before = R[np.ix_(kept, kept)]
        # scaled to a unit diagonal, since light and heavy bodies occur side by side
        scale = 1 / np.sqrt(np.diag(before))
        share = np.linalg.solve(before * scale * scale[:, None], R[kept, k] * scale) * scale
        if R[k, k] - R[kept, k] @ share > rounding * made_of[k]:
            kept.append(k)
        else:
            found.append(T[:, k] - T[:, kept] @ share)
    return found


def apart_columns(J: Array, order: Sequence[int], most: int, apart: float) -> list[int]:
    """Indices of columns of J, taken in an order as long as their least singular value stays above a bound.

    The columns taken are Q R with Q orthonormal. R grows by a column at a time, and so does its inverse; the
    least singular value lies between 1 and sqrt(n) times 1 / ‖R⁻¹‖ in the Frobenius norm. An SVD is computed
    only where these two bounds do not decide.

    Args:
        J: rows x columns, dimensionless.
        order: in which columns are tried.
        most: how many columns are taken at most.
        apart: the bound, dimensionless.
    """
    import numpy as np

    taken: list[int] = []
    Q, inverse = np.zeros((len(J), most)), np.zeros((most, most))
    for k in order:
        n = len(taken)
        if n == most:
            break
        rest, along = J[:, k], np.zeros(n)
        # Gram-Schmidt twice: the second pass removes the components that rounding has left in the first
        for _ in range(2):
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
