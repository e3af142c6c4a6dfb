"""Accelerations and multipliers of M a = f + J^T lam, J a = gam."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.ir.algorithms.elimination import backward, eliminate, smallest_pivot
from linegraph.ir.algorithms.language import Failed, ints, larger, ratio, reals, small, sqrt
from linegraph.ir.algorithms.sizes import too_large
from linegraph.ir.statuses import (
    CONTRADICTION,
    NOT_FINITE,
    SINGULAR_INERTIA,
    SINGULAR_POSITION,
)

if TYPE_CHECKING:
    from linegraph.ir.algorithms.language import Ints, ModuleAtState, Reals

SOLVED = 0
RANK_TOO_LOW = 1
NO_INERTIA = 2
NO_SOLUTION = 3
TOO_LARGE = 4
"""What `constrained` returns."""


def constrained(
    module: ModuleAtState,
    m: int,
    independent: int,
    strict: bool,
    slack: float,
    still: float,
    M: Reals,
    f: Reals,
    J: Reals,
    gam: Reals,
    of_phi: Reals,
    of_v: Reals,
    a: Reals,
    multipliers: bool,
    lam: Reals,
    pure: Reals,
    margin: Reals,
) -> int:
    """Solve M a = f + J^T lam, J a = gam for the first m constraints, of which `independent` are.

    By elimination of J, and by M on the motions that are left free. If `multipliers`, also lam: where it is
    not unique that of least norm, and in pure that of which lam times the sizes of the rows has the least
    norm. In margin are the smallest pivots of J and of M, each relative to the terms that it is made of.

    It is refused if fewer constraints are independent and `strict` is set; if M is singular on the free
    motions; if constraints contradict each other by more than the fraction `slack` and than what is
    rounding of `still`; and if a number is not finite, or nearly so.
    """
    N = module.NV
    C = module.NC
    size = reals(C)
    A = reals(C * N)
    b = reals(C)
    g = reals(C)
    x = reals(N)
    T = reals(N * N)
    rows = ints(C)
    columns = ints(N)
    if too_large(N * N, M) + too_large(N, f) + too_large(m * N, J) + too_large(m, gam) > 0:
        return TOO_LARGE
    pure_rows(module, m, J, of_phi, of_v, A, size)
    rank = eliminate(m, N, independent, A, rows, columns, small.rank)
    margin[0] = smallest_pivot(N, rank, A, rows, columns)
    margin[1] = 1.0
    if strict and rank < independent:
        return RANK_TOO_LOW
    # one solution of J a = gam
    for i in range(m):
        b[i] = gam[i] / size[i]
    backward(N, rank, A, rows, columns, b, g, x)
    free_motions(module, rank, A, rows, columns, T)
    if not least_energy(module, N - rank, M, f, T, of_v, x, a, margin):
        return NO_INERTIA
    for j in range(N):
        a[j] = x[j] * of_v[j]
    if contradict(module, m, slack, still, J, gam, size, x, a):
        return NO_SOLUTION
    if multipliers:
        least_multipliers(module, m, rank, A, rows, columns, M, f, size, of_v, a, g, lam, pure)
    return SOLVED


def report(result: int) -> None:
    """End with the status of a result of `constrained` that is none."""
    if result == RANK_TOO_LOW:
        raise Failed(SINGULAR_POSITION)
    if result == NO_INERTIA:
        raise Failed(SINGULAR_INERTIA)
    if result == NO_SOLUTION:
        raise Failed(CONTRADICTION)
    if result == TOO_LARGE:
        raise Failed(NOT_FINITE)


def pure_rows(
    module: ModuleAtState, m: int, J: Reals, of_phi: Reals, of_v: Reals, A: Reals, size: Reals
) -> None:
    """J in pure numbers, A_ij = J_ij of_v_j / size_i, of the first m constraints.

    The size of a row is of_phi; that of a relation, which has none, is its largest coefficient.
    """
    N = module.NV
    for i in range(m):
        own = 0.0
        for j in range(N):
            entry = J[i * N + j] * of_v[j]
            A[i * N + j] = entry
            if not abs(entry) <= own:
                own = abs(entry)
        size[i] = own if own > 0.0 else 1.0
        if of_phi[i] > 0.0:
            size[i] = of_phi[i]
        for j in range(N):
            A[i * N + j] /= size[i]


def free_motions(
    module: ModuleAtState, rank: int, A: Reals, rows: Ints, columns: Ints, T: Reals
) -> None:
    """The motions left free, A T = 0: a column of T for each column of A without a pivot."""
    N = module.NV
    for k in range(N - rank):
        T[columns[rank + k] * N + k] = 1.0
        for i in range(rank - 1, -1, -1):
            start = rows[i] * N
            total = -A[start + columns[rank + k]]
            for j in range(i + 1, rank):
                total -= A[start + columns[j]] * T[columns[j] * N + k]
            T[columns[i] * N + k] = total / A[start + columns[i]]


def least_energy(
    module: ModuleAtState,
    left: int,
    M: Reals,
    f: Reals,
    T: Reals,
    of_v: Reals,
    x: Reals,
    z: Reals,
    margin: Reals,
) -> bool:
    """Add to x the free motions T z that solve T^T (M x - f) = 0; whether M is regular there.

    By Cholesky's factors R of T^T M T. Velocities are divided by their sizes of_v; margin[1] becomes the
    smallest pivot, relative to the terms that it is the sum of.
    """
    N = module.NV
    R = reals(N * N)
    whole = reals(N)
    project_inertia(module, left, M, f, T, of_v, x, R, whole, z)
    for k in range(left):
        for i in range(k + 1):
            for j in range(i):
                R[k * N + i] -= R[k * N + j] * R[i * N + j]
            if i < k:
                R[k * N + i] /= R[i * N + i]
        if not R[k * N + k] > small.pivot * whole[k]:
            return False
        if R[k * N + k] < margin[1] * whole[k]:
            margin[1] = R[k * N + k] / whole[k]
        R[k * N + k] = sqrt(R[k * N + k])
        for j in range(k):
            z[k] -= R[k * N + j] * z[j]
        z[k] /= R[k * N + k]
    for k in range(left - 1, -1, -1):
        for j in range(k + 1, left):
            z[k] -= R[j * N + k] * z[j]
        z[k] /= R[k * N + k]
    for j in range(N):
        for k in range(left):
            x[j] += T[j * N + k] * z[k]
    return True


def project_inertia(
    module: ModuleAtState,
    left: int,
    M: Reals,
    f: Reals,
    T: Reals,
    of_v: Reals,
    x: Reals,
    R: Reals,
    whole: Reals,
    z: Reals,
) -> None:
    """R = T^T M T, the lower triangle, and z = T^T (f - M x); in whole the sizes of the diagonal's terms."""
    N = module.NV
    y = reals(N)
    column = reals(N)
    for i in range(N):
        y[i] = f[i] * of_v[i]
        for j in range(N):
            y[i] -= of_v[i] * M[i * N + j] * of_v[j] * x[j]
    for k in range(left):
        whole[k] = 0.0
        for i in range(N):
            column[i] = 0.0
            for j in range(N):
                part = of_v[i] * M[i * N + j] * of_v[j] * T[j * N + k]
                column[i] += part
                whole[k] += abs(T[i * N + k] * part)
        for i in range(k + 1):
            R[k * N + i] = 0.0
            for j in range(N):
                R[k * N + i] += T[j * N + i] * column[j]
        z[k] = 0.0
        for j in range(N):
            z[k] += T[j * N + k] * y[j]


def contradict(
    module: ModuleAtState,
    m: int,
    slack: float,
    still: float,
    J: Reals,
    gam: Reals,
    size: Reals,
    x: Reals,
    a: Reals,
) -> bool:
    """Whether constraints that were not needed for a do not hold: x are the accelerations by their sizes."""
    N = module.NV
    most = still
    largest = 0.0
    amiss = 0.0
    for j in range(N):
        if not abs(x[j]) <= most:
            most = abs(x[j])
    for i in range(m):
        total = 0.0
        part = abs(gam[i])
        for j in range(N):
            total += J[i * N + j] * a[j]
            part += abs(J[i * N + j] * a[j])
        part /= size[i]
        total = abs(total - gam[i]) / size[i]
        # a NaN is taken for the largest
        if not part <= largest:
            largest = part
        if not total <= amiss:
            amiss = total
    return not amiss <= slack * largest + small.rank * most


def least_multipliers(
    module: ModuleAtState,
    m: int,
    rank: int,
    A: Reals,
    rows: Ints,
    columns: Ints,
    M: Reals,
    f: Reals,
    size: Reals,
    of_v: Reals,
    a: Reals,
    z: Reals,
    lam: Reals,
    pure: Reals,
) -> None:
    """Multipliers of J^T lam = M a - f, by the independent rows, then of least norm; z is work space."""
    N = module.NV
    C = module.NC
    one = reals(C)
    for i in range(rank):
        at = columns[i]
        total = -f[at]
        for j in range(N):
            total += M[at * N + j] * a[j]
        total *= of_v[at]
        for k in range(i):
            total -= A[rows[k] * N + at] * z[k]
        z[i] = total / A[rows[i] * N + at]
    for i in range(rank - 1, -1, -1):
        for k in range(i + 1, rank):
            z[i] -= A[rows[k] * N + columns[i]] * z[k]
    for i in range(m):
        one[i] = 1.0
        pure[rows[i]] = z[i] if i < rank else 0.0
    least_norm(module, m, rank, A, one, rows, columns, pure)
    for i in range(m):
        lam[i] = pure[i] / size[i]
    least_norm(module, m, rank, A, size, rows, columns, lam)


def least_norm(
    module: ModuleAtState,
    m: int,
    rank: int,
    A: Reals,
    size: Reals,
    rows: Ints,
    columns: Ints,
    lam: Reals,
) -> None:
    """Of all lam with the same J^T lam, leave the one of least norm.

    Its part along the null space of J^T is subtracted. That space has a vector for each row that the
    elimination did not need; these are made orthogonal to each other one after the other, twice, as once is
    not enough where they are nearly parallel.
    """
    C = module.NC
    kernel = reals(C * C)
    for k in range(m - rank):
        start = k * C
        null_vector(module, m, rank, k, A, size, rows, columns, kernel)
        for _ in range(2):
            for j in range(k):
                common = 0.0
                for i in range(m):
                    common += kernel[start + i] * kernel[j * C + i]
                for i in range(m):
                    kernel[start + i] -= common * kernel[j * C + i]
        length = 0.0
        along = 0.0
        for i in range(m):
            length += kernel[start + i] * kernel[start + i]
        length = sqrt(length)
        for i in range(m):
            kernel[start + i] /= length
            along += kernel[start + i] * lam[i]
        for i in range(m):
            lam[i] -= along * kernel[start + i]


def null_vector(
    module: ModuleAtState,
    m: int,
    rank: int,
    k: int,
    A: Reals,
    size: Reals,
    rows: Ints,
    columns: Ints,
    kernel: Reals,
) -> None:
    """Vector k of the null space of J^T, into row k of kernel: J is A with its rows times their sizes."""
    N = module.NV
    C = module.NC
    start = k * C
    row = rows[rank + k]
    largest = 0.0
    for i in range(m):
        kernel[start + i] = 0.0
    kernel[start + row] = 1.0
    for i in range(rank - 1, -1, -1):
        total = -A[row * N + columns[i]]
        for j in range(i + 1, rank):
            total -= A[rows[j] * N + columns[i]] * kernel[start + rows[j]]
        kernel[start + rows[i]] = total
    for i in range(m):
        largest = larger(largest, abs(ratio(kernel[start + i], size[i])))
    for i in range(m):
        kernel[start + i] = ratio(kernel[start + i], size[i] * largest)
