"""All velocities from the constraints and some of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.ir.algorithms.constrained import pure_rows
from linegraph.ir.algorithms.elimination import backward, eliminate, smallest_pivot
from linegraph.ir.algorithms.language import ints, ratio, reals, small

if TYPE_CHECKING:
    from linegraph.ir.algorithms.language import ModuleAtState, Places, Reals


def determined(
    module: ModuleAtState,
    m: int,
    J: Reals,
    of_phi: Reals,
    of_v: Reals,
    count: int,
    at: Places,
    sides: int,
    B: Reals,
    margin: Reals,
) -> bool:
    """Solve J x = right for velocities x of which `count` are given, x[at] = given; whether that is enough.

    The first m constraints count. The columns of B are several right-hand sides, m entries of right and
    then the given velocities; x replaces them, unless it is not determined. In margin is the smallest
    pivot.
    """
    N = module.NV
    C = module.NC
    A = reals((C + N) * N)
    size = reals(C + N)
    b = reals(C + N)
    x = reals(N)
    g = reals(N)
    rows = ints(C + N)
    columns = ints(N)
    pure_rows(module, m, J, of_phi, of_v, A, size)
    for i in range(count):
        size[m + i] = of_v[at[i]]
        for j in range(N):
            A[(m + i) * N + j] = 1.0 if j == at[i] else 0.0
    rank = eliminate(m + count, N, N, A, rows, columns, small.rank)
    margin[0] = smallest_pivot(N, rank, A, rows, columns)
    if rank < N:
        return False
    for side in range(sides):
        for i in range(m + count):
            b[i] = ratio(B[i * sides + side], size[i])
        backward(N, N, A, rows, columns, b, g, x)
        for i in range(N):
            B[i * sides + side] = x[i] * of_v[i]
    return True
