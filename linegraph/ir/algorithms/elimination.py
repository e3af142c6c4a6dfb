"""Gaussian elimination with complete pivoting, and solutions by its factors."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linegraph.ir.algorithms.language import Ints, Reals


def eliminate(m: int, n: int, most: int, A: Reals, rows: Ints, columns: Ints, least: float) -> int:
    """Factorise an m x n matrix in place, P A Q = L U, with complete pivoting; return the rank.

    The rank is `most` at most, and entries up to `least` are zero. rows and columns say where row i and
    column j of P A Q come from. A should hold pure numbers, so that pivots can be told from rounding.
    """
    side = m if m < n else n
    last = most if most < side else side
    for i in range(m):
        rows[i] = i
    for j in range(n):
        columns[j] = j
    for rank in range(last):
        best = 0.0
        row = rank
        column = rank
        for i in range(rank, m):
            start = rows[i] * n
            for j in range(rank, n):
                size = abs(A[start + columns[j]])
                if size > best:
                    best = size
                    row = i
                    column = j
        if not best > least:
            return rank
        pivot_row = rows[row]
        pivot_column = columns[column]
        pivot = pivot_row * n
        rows[row] = rows[rank]
        rows[rank] = pivot_row
        columns[column] = columns[rank]
        columns[rank] = pivot_column
        for i in range(rank + 1, m):
            below = rows[i] * n
            factor = A[below + pivot_column] / A[pivot + pivot_column]
            A[below + pivot_column] = factor
            for j in range(rank + 1, n):
                A[below + columns[j]] -= factor * A[pivot + columns[j]]
    return last


def backward(
    n: int, rank: int, A: Reals, rows: Ints, columns: Ints, b: Reals, g: Reals, x: Reals
) -> None:
    """Solve A x = b by the factors of A that `eliminate` left, n entries a row.

    Entries of x without a pivot stay as they are; g is work space for `rank` numbers.
    """
    for i in range(rank):
        start = rows[i] * n
        total = b[rows[i]]
        for k in range(i):
            total -= A[start + columns[k]] * g[k]
        g[i] = total
    for i in range(rank - 1, -1, -1):
        start = rows[i] * n
        total = g[i]
        for k in range(i + 1, rank):
            total -= A[start + columns[k]] * x[columns[k]]
        x[columns[i]] = total / A[start + columns[i]]


def smallest_pivot(n: int, rank: int, A: Reals, rows: Ints, columns: Ints) -> float:
    """The smallest pivot of an eliminated matrix with n entries a row, 1 at most."""
    smallest = 1.0
    for i in range(rank):
        pivot = abs(A[rows[i] * n + columns[i]])
        if pivot < smallest:
            smallest = pivot
    return smallest
