"""Velocities and accelerations from the independent ones, and the equations of motion in these."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.ir.algorithms.beside import move, overshoot
from linegraph.ir.algorithms.constrained import pure_rows
from linegraph.ir.algorithms.determined import determined
from linegraph.ir.algorithms.language import Failed, larger, ratio, reals, small
from linegraph.ir.algorithms.sizes import largest_of, too_large
from linegraph.ir.statuses import NOT_DETERMINED, NOT_FINITE

if TYPE_CHECKING:
    from linegraph.ir.algorithms.language import ModuleAtState, Reals


def reduction(module: ModuleAtState, q: Reals, v: Reals, T: Reals, rest: Reals) -> None:
    """T and rest of v = T w, vdot = T wdot + rest; refused where their estimated error is too large."""
    NV = module.NV
    NC = module.NC
    NI = module.NI
    SIDES = NI + 1
    J = reals(NC * NV)
    A = reals(NC * NV)
    rates = reals(NC)
    phi = reals(NC)
    of_phi = reals(NC)
    of_row = reals(NC)
    of_v = reals(NV)
    margin = reals(1)
    B = reals((NV + NC + NI) * SIDES)
    gap = 0.0
    module.constraint_sizes(of_phi, of_v)
    module.constraint_jacobian(J)
    module.constraint_bias(rates)
    tangent(module, J, rates, of_phi, of_v, B, margin)
    most = largest_of(module.mechanical, v, of_v)
    pure_rows(module, NC, J, of_phi, of_v, A, of_row)
    module.constraint_rates(rates)
    slip = largest_of(NC, rates, of_row)
    off = slip / larger(most, slip) if slip > 0.0 else 0.0
    if module.NP > 0:
        module.constraints(phi)
        gap = largest_of(module.NP, phi, of_row)
        off = larger(off, gap)
    reach = 4.0 / margin[0]
    within = small.accurate * larger(1.0, off / small.closed)
    certain = larger(off, small.rounding) * reach * reach * reach <= within
    if off < small.far and not certain:
        compare_tangents(
            *(module, q, v, J, of_phi, of_v, of_row, phi, rates, gap, slip, most, within, B),
        )
    for i in range(NV):
        for k in range(NI):
            T[i * NI + k] = B[i * SIDES + k]
        rest[i] = B[i * SIDES + NI]


def tangent(
    module: ModuleAtState,
    J: Reals,
    gam: Reals,
    of_phi: Reals,
    of_v: Reals,
    B: Reals,
    margin: Reals,
) -> None:
    """In the columns of B all velocities for unit independent ones, in the last one vdot for wdot = 0."""
    NV = module.NV
    NC = module.NC
    NI = module.NI
    SIDES = NI + 1
    own = module.w_at
    if too_large(NC * NV, J) + too_large(NC, gam) > 0:
        raise Failed(NOT_FINITE)
    for i in range(NC):
        B[i * SIDES + NI] = gam[i]
    for k in range(NI):
        B[(NC + k) * SIDES + k] = 1.0
    if not determined(module, NC, J, of_phi, of_v, NI, own, SIDES, B, margin):
        raise Failed(NOT_DETERMINED)


def compare_tangents(
    module: ModuleAtState,
    q: Reals,
    v: Reals,
    J: Reals,
    of_phi: Reals,
    of_v: Reals,
    of_row: Reals,
    phi: Reals,
    rates: Reals,
    gap: float,
    slip: float,
    most: float,
    within: float,
    B: Reals,
) -> None:
    """Refuse T and rest near a singular position that differ from those of a state beside it.

    That state is on the other side of the constraints: the given one is off by gap and slip, and so much is
    the error. J and rates become those of the other state.
    """
    NV = module.NV
    NC = module.NC
    NI = module.NI
    SIDES = NI + 1
    own = module.w_at
    beside = reals(module.NQ)
    step = reals(NV + NC + NI)
    gam = reals(NC)
    B_on = reals((NV + NC + NI) * SIDES)
    margin = reals(1)
    for i in range(module.NQ):
        beside[i] = q[i]
    if module.NP > 0:
        overshoot(module.NP, phi, larger(0.25 * gap, small.rounding), of_row, step)
        if not determined(module, NC, J, of_phi, of_v, NI, own, 1, step, margin):
            raise Failed(NOT_DETERMINED)
        move(module, step, beside)
        module.constraint_rates(rates, q=beside)
    overshoot(NC, rates, larger(0.25 * slip, small.rounding * most), of_row, step)
    for k in range(NI):
        step[NC + k] = 0.0
    if not determined(module, NC, J, of_phi, of_v, NI, own, 1, step, margin):
        raise Failed(NOT_DETERMINED)
    for i in range(NV):
        step[i] += v[i]
    module.constraint_jacobian(J, q=beside)
    module.constraint_bias(gam, q=beside, v=step)
    tangent(module, J, gam, of_phi, of_v, B_on, margin)
    if differ(module, most, within, of_v, B, B_on):
        raise Failed(NOT_DETERMINED)


def differ(
    module: ModuleAtState, most: float, within: float, of_v: Reals, B: Reals, B_on: Reals
) -> bool:
    """Whether a column of B_on differs from that of B by more than `within` of its size."""
    NV = module.NV
    NI = module.NI
    SIDES = NI + 1
    own = module.w_at
    bound = within if within < 0.1 else 0.1
    for k in range(SIDES):
        given = 1.0
        largest = 0.01 * most * most
        wrong = 0.0
        if k < NI:
            given = of_v[own[k]]
            largest = 0.0
        for i in range(NV):
            size = ratio(given, of_v[i])
            amiss = abs(B_on[i * SIDES + k] - B[i * SIDES + k]) * size
            largest = larger(largest, abs(B[i * SIDES + k]) * size)
            # a NaN is taken for the largest
            if not amiss <= wrong:
                wrong = amiss
        if not wrong <= bound * largest:
            return True
    return False


def reduced_equations(module: ModuleAtState, Mr: Reals, hr: Reals) -> None:
    """Mr = T^T M T and hr = T^T (h + M rest)."""
    NV = module.NV
    NI = module.NI
    M = reals(NV * NV)
    h = reals(NV)
    T = reals(NV * NI)
    rest = reals(NV)
    rows = reals(NI)
    module.reduction(T, rest)
    module.equations(M, h)
    for k in range(NI):
        hr[k] = 0.0
        for j in range(NI):
            Mr[k * NI + j] = 0.0
    for i in range(NV):
        total = h[i]
        for k in range(NI):
            rows[k] = 0.0
        for j in range(NV):
            total += M[i * NV + j] * rest[j]
            for k in range(NI):
                rows[k] += M[i * NV + j] * T[j * NI + k]
        for k in range(NI):
            hr[k] += T[i * NI + k] * total
            for j in range(NI):
                Mr[k * NI + j] += T[i * NI + k] * rows[j]
