"""Positions and velocities brought onto the constraints, along the directions of least kinetic energy."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.ir.algorithms.constrained import SOLVED, constrained
from linegraph.ir.algorithms.language import Failed, reals, small
from linegraph.ir.algorithms.sizes import largest_of, unit
from linegraph.ir.statuses import NO_VELOCITY, NOT_CLOSED

if TYPE_CHECKING:
    from linegraph.ir.algorithms.language import ModuleAtState, Reals


def project(module: ModuleAtState, q: Reals, v: Reals, q_on: Reals, v_on: Reals) -> None:
    """Bring q onto the constraints of position, then v onto those of velocity."""
    NQ = module.NQ
    NV = module.NV
    NC = module.NC
    M = reals(NV * NV)
    J = reals(NC * NV)
    zero = reals(NV)
    step = reals(NV)
    rates = reals(NC)
    unused = reals(NC)
    of_phi = reals(NC)
    of_v = reals(NV)
    margin = reals(2)
    module.constraint_sizes(of_phi, of_v)
    for i in range(NQ):
        q_on[i] = q[i]
    if len(module.quaternions) > 0:
        unit(module, q_on)
    if module.NP > 0:
        close(module, of_phi, of_v, q_on)
    module.mass_matrix(M, q=q_on)
    module.constraint_jacobian(J, q=q_on)
    module.constraint_rates(rates, q=q_on)
    for i in range(NC):
        rates[i] = -rates[i]
    still = largest_of(NV, v, of_v)
    result = constrained(
        *(
            module,
            NC,
            module.RANK,
            False,
            small.slack,
            still,
            M,
            zero,
            J,
            rates,
            of_phi,
            of_v,
            step,
        ),
        *(False, unused, unused, margin),
    )
    if result != SOLVED:
        raise Failed(NO_VELOCITY)
    for i in range(NV):
        v_on[i] = v[i] + step[i]


def close(module: ModuleAtState, of_phi: Reals, of_v: Reals, at: Reals) -> None:
    """Bring positions onto their constraints by Newton's method with halved steps."""
    NV = module.NV
    NP = module.NP
    M = reals(NV * NV)
    J = reals(module.NC * NV)
    zero = reals(NV)
    step = reals(NV)
    phi = reals(NP)
    unused = reals(module.NC)
    margin = reals(2)
    module.constraints(phi, q=at)
    gap = largest_of(NP, phi, of_phi)
    going = gap > small.still
    for _ in range(60):
        if not going:
            break
        for i in range(NP):
            phi[i] = -phi[i]
        module.mass_matrix(M, q=at)
        module.constraint_jacobian(J, q=at)
        result = constrained(
            *(
                module,
                NP,
                module.position_rank,
                False,
                small.any,
                0.0,
                M,
                zero,
                J,
                phi,
                of_phi,
                of_v,
            ),
            *(step, False, unused, unused, margin),
        )
        if result != SOLVED:
            raise Failed(NOT_CLOSED)
        if not largest_of(NV, step, of_v) < small.reach:
            raise Failed(NOT_CLOSED)
        after = approach(module, gap, of_phi, step, phi, at)
        going = after < gap and after > small.still
        if largest_of(NV, step, of_v) < small.still:
            going = False
        gap = after
    if not gap < small.closed:
        raise Failed(NOT_CLOSED)


def approach(
    module: ModuleAtState, gap: float, of_phi: Reals, step: Reals, phi: Reals, at: Reals
) -> float:
    """Move positions along a step, halved until the gap falls; the same gap if it never does.

    Returned is the new gap; phi are the constraints there, and step is what was taken.
    """
    NQ = module.NQ
    NP = module.NP
    ahead = reals(NQ)
    slope = reals(NQ)
    module.coordinate_rates(slope, q=at, v=step)
    for _ in range(12):
        for i in range(NQ):
            ahead[i] = at[i] + slope[i]
        if len(module.quaternions) > 0:
            unit(module, ahead)
        module.constraints(phi, q=ahead)
        after = largest_of(NP, phi, of_phi)
        if after < gap:
            for i in range(NQ):
                at[i] = ahead[i]
            return after
        for i in range(NQ):
            slope[i] *= 0.5
        for i in range(module.NV):
            step[i] *= 0.5
    return gap
