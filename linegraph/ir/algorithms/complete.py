"""All positions and velocities from the independent ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.ir.algorithms.determined import determined
from linegraph.ir.algorithms.language import Failed, infinity, reals, small
from linegraph.ir.algorithms.sizes import largest_of, too_large, unit
from linegraph.ir.statuses import NOT_CLOSED, NOT_DETERMINED, NOT_FINITE

if TYPE_CHECKING:
    from linegraph.ir.algorithms.language import ModuleAtState, Reals


def complete(module: ModuleAtState, q: Reals, s: Reals, w: Reals, q_on: Reals, v_on: Reals) -> None:
    """Find q with the independent coordinates s, near a guess q, then v with their rates w."""
    NV = module.NV
    NC = module.NC
    NI = module.NI
    own = module.w_at
    place = module.s_at
    zero = reals(NV)
    J = reals(NC * NV)
    rates = reals(NC)
    B = reals(NV + NC + NI)
    of_phi = reals(NC)
    of_v = reals(NV)
    margin = reals(1)
    module.constraint_sizes(of_phi, of_v)
    for i in range(module.NQ):
        q_on[i] = q[i]
    if len(module.quaternions) > 0:
        unit(module, q_on)
    for i in range(NI):
        q_on[place[i]] = s[i]
    if module.NP > 0:
        assemble(module, of_phi, of_v, q_on)
    module.constraint_jacobian(J, q=q_on)
    module.constraint_rates(rates, q=q_on, v=zero)
    if too_large(NC * NV, J) + too_large(NC, rates) > 0:
        raise Failed(NOT_FINITE)
    for i in range(NC):
        B[i] = -rates[i]
    for i in range(NI):
        B[NC + i] = w[i]
    if not determined(module, NC, J, of_phi, of_v, NI, own, 1, B, margin):
        raise Failed(NOT_DETERMINED)
    for i in range(NV):
        v_on[i] = B[i]


def assemble(module: ModuleAtState, of_phi: Reals, of_v: Reals, at: Reals) -> None:
    """Close all loops by Newton's method, the independent coordinates held.

    A step moves no coordinate by more than half of its size, so that a guess leads to the assembly beside it.
    """
    NV = module.NV
    NC = module.NC
    NP = module.NP
    NI = module.NI
    own = module.w_at
    phi = reals(NP)
    J = reals(NC * NV)
    B = reals(NV + NC + NI)
    slope = reals(module.NQ)
    margin = reals(1)
    gap = infinity
    for _ in range(60):
        module.constraints(phi, q=at)
        module.constraint_jacobian(J, q=at)
        for i in range(NC + NI):
            B[i] = -phi[i] if i < NP else 0.0
        gap = largest_of(NP, phi, of_phi)
        if not gap < small.large or too_large(NC * NV, J) > 0:
            raise Failed(NOT_CLOSED)
        if not determined(module, NC, J, of_phi, of_v, NI, own, 1, B, margin):
            raise Failed(NOT_DETERMINED)
        largest = largest_of(NV, B, of_v)
        limit = 1.0
        if largest > 0.5:
            limit = 0.5 / largest
        for i in range(NV):
            B[i] *= limit
        module.coordinate_rates(slope, q=at, v=B)
        for i in range(module.NQ):
            at[i] += slope[i]
        if len(module.quaternions) > 0:
            unit(module, at)
        if not largest > small.step:
            break
    if not gap < small.closed:
        raise Failed(NOT_CLOSED)
