"""The linearised equations of a mechanism with loops, in independent coordinates and velocities."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.ir.algorithms.constrained import constrained, report
from linegraph.ir.algorithms.determined import determined
from linegraph.ir.algorithms.language import Failed, reals, small
from linegraph.ir.algorithms.sizes import largest_of, too_large
from linegraph.ir.statuses import NOT_DETERMINED, NOT_FINITE

if TYPE_CHECKING:
    from linegraph.ir.algorithms.language import ModuleAtState, Reals


def linearization(module: ModuleAtState, v: Reals, A: Reals, B: Reals) -> None:
    """A and B of dx' = A dx + B du.

    dx are changes of the free positions, then of the independent velocities.
    """
    NV = module.NV
    NC = module.NC
    NT = module.NT
    NI = module.NI
    FREE = len(module.d_at)
    SIDES = module.NDX + module.NU
    WIDTH = NT + NV + module.NU
    a = reals(NV)
    lam = reals(NC)
    rest = reals(NV)
    of_phi = reals(NC)
    of_v = reals(NV)
    M = reals(NV * NV)
    f = reals(NV)
    J = reals(NC * NV)
    gam = reals(NC)
    slopes_f = reals(NV * WIDTH)
    slopes_gam = reals(NC * WIDTH)
    slopes_rates = reals(NC * NT)
    drift = reals(NT * NT)
    T = reals(NV * NI)
    D = reals((NV + NC + FREE) * FREE)
    S = reals((NV + NC + NI) * FREE)
    found = reals(NI * SIDES)
    module.forward_dynamics(a, lam)
    module.reduction(T, rest)
    module.constraint_sizes(of_phi, of_v)
    most = largest_of(module.mechanical, v, of_v)
    still = most * most + largest_of(module.mechanical, a, of_v)
    module.constrained_equations(M, f, J, gam)
    module.constrained_slopes(slopes_f, slopes_gam, slopes_rates, drift, a=a, lam=lam)
    if (
        too_large(NV * WIDTH, slopes_f)
        + too_large(NC * WIDTH, slopes_gam)
        + too_large(NC * NT, slopes_rates)
        + too_large(NT * NT, drift)
        > 0
    ):
        raise Failed(NOT_FINITE)
    free_changes(module, J, of_phi, of_v, slopes_rates, D, S)
    responses(
        *(module, still, M, J, of_phi, of_v, slopes_f, slopes_gam, T, D, S, found),
    )
    state_matrix(module, T, drift, D, S, found, A)
    if module.NU > 0:
        input_matrix(module, found, B)


def free_changes(
    module: ModuleAtState,
    J: Reals,
    of_phi: Reals,
    of_v: Reals,
    slopes_rates: Reals,
    D: Reals,
    S: Reals,
) -> None:
    """In the columns of D all changes of position that follow from the free ones.

    In those of S, the changes of v that keep the constraints of velocity there.
    """
    NC = module.NC
    NP = module.NP
    NT = module.NT
    NI = module.NI
    FREE = len(module.d_at)
    free = module.d_at
    own = module.w_at
    margin = reals(1)
    for k in range(FREE):
        D[(NP + k) * FREE + k] = 1.0
    if not determined(module, NP, J, of_phi, of_v, FREE, free, FREE, D, margin):
        raise Failed(NOT_DETERMINED)
    for i in range(NC):
        for k in range(FREE):
            for j in range(NT):
                S[i * FREE + k] -= slopes_rates[i * NT + j] * D[j * FREE + k]
    if not determined(module, NC, J, of_phi, of_v, NI, own, FREE, S, margin):
        raise Failed(NOT_DETERMINED)


def responses(
    module: ModuleAtState,
    still: float,
    M: Reals,
    J: Reals,
    of_phi: Reals,
    of_v: Reals,
    slopes_f: Reals,
    slopes_gam: Reals,
    T: Reals,
    D: Reals,
    S: Reals,
    found: Reals,
) -> None:
    """What the independent accelerations change by: a column for each entry of the state and each input."""
    NV = module.NV
    NC = module.NC
    NT = module.NT
    NI = module.NI
    FREE = len(module.d_at)
    SIDES = module.NDX + module.NU
    WIDTH = NT + NV + module.NU
    own = module.w_at
    change = reals(WIDTH)
    force = reals(NV)
    motion = reals(NC)
    x = reals(NV)
    unused = reals(NC)
    margin = reals(2)
    for k in range(SIDES):
        for j in range(WIDTH):
            change[j] = 0.0
        if k >= module.NDX:
            change[NT + NV + k - module.NDX] = 1.0
        elif k >= FREE:
            for j in range(NV):
                change[NT + j] = T[j * NI + k - FREE]
        else:
            for j in range(NV):
                change[j] = D[j * FREE + k]
                change[NT + j] = S[j * FREE + k]
        for i in range(NV):
            force[i] = 0.0
            for j in range(WIDTH):
                force[i] -= slopes_f[i * WIDTH + j] * change[j]
        for i in range(NC):
            motion[i] = 0.0
            for j in range(WIDTH):
                motion[i] -= slopes_gam[i * WIDTH + j] * change[j]
        result = constrained(
            *(module, NC, module.RANK, True, small.slack, still, M, force, J, motion, of_phi, of_v),
            *(x, False, unused, unused, margin),
        )
        report(result)
        for i in range(NI):
            found[i * SIDES + k] = x[own[i]]


def state_matrix(
    module: ModuleAtState, T: Reals, drift: Reals, D: Reals, S: Reals, found: Reals, A: Reals
) -> None:
    """A: how the free changes of position change, above the responses of the independent velocities."""
    NT = module.NT
    NI = module.NI
    NDX = module.NDX
    FREE = len(module.d_at)
    SIDES = NDX + module.NU
    free = module.d_at
    for i in range(FREE):
        for k in range(FREE):
            total = S[free[i] * FREE + k]
            for j in range(NT):
                total += drift[free[i] * NT + j] * D[j * FREE + k]
            A[i * NDX + k] = total
        for k in range(NI):
            A[i * NDX + FREE + k] = T[free[i] * NI + k]
    for i in range(NI):
        for k in range(NDX):
            A[(i + FREE) * NDX + k] = found[i * SIDES + k]


def input_matrix(module: ModuleAtState, found: Reals, B: Reals) -> None:
    """B: inputs change no position at once, and the independent velocities as was found."""
    NU = module.NU
    NDX = module.NDX
    FREE = len(module.d_at)
    SIDES = NDX + NU
    for k in range(NU):
        for i in range(FREE):
            B[i * NU + k] = 0.0
        for i in range(module.NI):
            B[(i + FREE) * NU + k] = found[i * SIDES + NDX + k]
