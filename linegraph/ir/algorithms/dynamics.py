"""Forward dynamics with constraints, and functions that follow the dynamics."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.ir.algorithms.beside import move, overshoot
from linegraph.ir.algorithms.constrained import constrained, pure_rows, report
from linegraph.ir.algorithms.language import Failed, larger, ratio, reals, small
from linegraph.ir.algorithms.sizes import largest_of, size_of
from linegraph.ir.statuses import SINGULAR_POSITION

if TYPE_CHECKING:
    from linegraph.ir.algorithms.language import ModuleAtState, Reals


def constrained_dynamics(module: ModuleAtState, q: Reals, v: Reals, a: Reals, lam: Reals) -> None:
    """Accelerations and multipliers; refused where their estimated error is too large.

    A gap or a velocity off the constraints by the fraction `off` changes accelerations by about off /
    pivot^3 near a singular position. Where that is more than is accepted, another state tells the error.
    """
    NV = module.NV
    NC = module.NC
    M = reals(NV * NV)
    f = reals(NV)
    J = reals(NC * NV)
    gam = reals(NC)
    pure = reals(NC)
    of_phi = reals(NC)
    of_v = reals(NV)
    of_row = reals(NC)
    A = reals(NC * NV)
    rates = reals(NC)
    phi = reals(NC)
    margin = reals(2)
    gap = 0.0
    module.constrained_equations(M, f, J, gam)
    module.constraint_sizes(of_phi, of_v)
    most = largest_of(module.mechanical, v, of_v)
    result = constrained(
        *(module, NC, module.RANK, True, small.slack, most * most, M, f, J, gam, of_phi, of_v, a),
        *(True, lam, pure, margin),
    )
    report(result)
    pure_rows(module, NC, J, of_phi, of_v, A, of_row)
    module.constraint_rates(rates)
    slip = largest_of(NC, rates, of_row)
    off = slip / larger(most, slip) if slip > 0.0 else 0.0
    if module.NP > 0:
        module.constraints(phi)
        gap = largest_of(module.NP, phi, of_row)
        off = larger(off, gap)
    size = larger(largest_of(module.mechanical, a, of_v), 0.01 * most * most)
    share = 1.0 + ratio(most * most, size) if most > 0.0 else 1.0
    reach = 4.0 / margin[0]
    error = share * larger(off, small.rounding) * reach * reach * reach
    within = small.accurate * larger(1.0, off / small.closed)
    certain = error <= within and small.rounding <= within * margin[1]
    if off < small.far and not certain:
        compare_accelerations(
            *(module, q, v, M, f, J, gam, of_phi, of_v, of_row, phi, rates, gap, slip, most, size),
            *(within, a, pure),
        )


def compare_accelerations(
    module: ModuleAtState,
    q: Reals,
    v: Reals,
    M: Reals,
    f: Reals,
    J: Reals,
    gam: Reals,
    of_phi: Reals,
    of_v: Reals,
    of_row: Reals,
    phi: Reals,
    rates: Reals,
    gap: float,
    slip: float,
    most: float,
    size: float,
    within: float,
    a: Reals,
    pure: Reals,
) -> None:
    """Refuse accelerations near a singular position that differ from those of a state beside it.

    M, f, J, gam and rates become those of the other state.
    """
    NC = module.NC
    a_on = reals(module.NV)
    lam_on = reals(NC)
    pure_on = reals(NC)
    margin = reals(2)
    q_on = reals(module.NQ)
    v_on = reals(module.NV)
    state_beside(
        *(module, q, v, M, J, of_phi, of_v, of_row, phi, rates, gap, slip, most, q_on, v_on)
    )
    force = 0.01 * largest_force(module, M, f, of_v, a)
    equations_beside(module, q_on, v_on, M, f, J, gam, rates)
    result = constrained(
        *(
            module,
            NC,
            module.RANK,
            True,
            small.slack,
            most * most,
            M,
            f,
            J,
            gam,
            of_phi,
            of_v,
            a_on,
        ),
        *(True, lam_on, pure_on, margin),
    )
    report(result)
    if accelerations_differ(module, within, size, force, of_v, a, pure, a_on, pure_on):
        raise Failed(SINGULAR_POSITION)


def equations_beside(
    module: ModuleAtState,
    q_on: Reals,
    v_on: Reals,
    M: Reals,
    f: Reals,
    J: Reals,
    gam: Reals,
    rates: Reals,
) -> None:
    """The equations at a state (q_on, v_on) beside; gam is that of the given state, and then of this one.

    What stabilises constraints stays that of the given state. M, f and J are outputs, rates are work
    space.
    """
    NC = module.NC
    stabilising = reals(NC)
    if module.baumgarte:
        module.constraint_bias(rates)
        for i in range(NC):
            stabilising[i] = gam[i] - rates[i]
    module.constrained_equations(M, f, J, gam, q=q_on, v=v_on)
    if module.baumgarte:
        for i in range(NC):
            gam[i] += stabilising[i]


def accelerations_differ(
    module: ModuleAtState,
    within: float,
    size: float,
    least: float,
    of_v: Reals,
    a: Reals,
    pure: Reals,
    a_on: Reals,
    pure_on: Reals,
) -> bool:
    """Whether accelerations, or multipliers times the sizes of rows, differ by more than `within` allows.

    That is a fraction of `size` and of the largest multiplier, at least of `least`; more than a tenth is
    never accepted. a_on and pure_on become the differences.
    """
    bound = within if within < 0.1 else 0.1
    force = least
    for i in range(module.NC):
        force = larger(force, abs(pure[i]))
        pure_on[i] -= pure[i]
    for i in range(module.NV):
        a_on[i] -= a[i]
    wrong_a = largest_of(module.mechanical, a_on, of_v)
    wrong_lam = size_of(module.NC, pure_on)
    return not (wrong_a <= bound * size and wrong_lam <= bound * force)


def state_beside(
    module: ModuleAtState,
    q: Reals,
    v: Reals,
    M: Reals,
    J: Reals,
    of_phi: Reals,
    of_v: Reals,
    of_row: Reals,
    phi: Reals,
    rates: Reals,
    gap: float,
    slip: float,
    most: float,
    q_on: Reals,
    v_on: Reals,
) -> None:
    """Positions and velocities on the other side of the constraints, in the directions of least energy.

    The given ones are off by gap and slip; these are off by a quarter of that, with the other sign, so that
    the difference is about the error of the given ones. Rates become those of the positions beside.
    """
    NV = module.NV
    NC = module.NC
    zero = reals(NV)
    wrong = reals(NC)
    step = reals(NV)
    unused = reals(NC)
    margin = reals(2)
    for i in range(module.NQ):
        q_on[i] = q[i]
    if module.NP > 0:
        overshoot(module.NP, phi, larger(0.25 * gap, small.rounding), of_row, wrong)
        of_position = constrained(
            *(module, module.NP, module.position_rank, False, small.any, 0.0, M, zero, J, wrong),
            *(of_phi, of_v, step, False, unused, unused, margin),
        )
        report(of_position)
        move(module, step, q_on)
        module.constraint_rates(rates, q=q_on)
    overshoot(NC, rates, larger(0.25 * slip, small.rounding * most), of_row, wrong)
    of_velocity = constrained(
        *(module, NC, module.RANK, False, small.any, 0.0, M, zero, J, wrong, of_phi, of_v, step),
        *(False, unused, unused, margin),
    )
    report(of_velocity)
    for i in range(NV):
        v_on[i] = v[i] + step[i]


def largest_force(module: ModuleAtState, M: Reals, f: Reals, of_v: Reals, a: Reals) -> float:
    """The largest entry of M a and of f, each times the size of its velocity."""
    NV = module.NV
    largest = 0.0
    for i in range(NV):
        total = 0.0
        for j in range(NV):
            total += M[i * NV + j] * a[j]
        largest = larger(largest, larger(abs(total), abs(f[i])) * of_v[i])
    return largest


def rhs(module: ModuleAtState, x: Reals, xdot: Reals) -> None:
    """Derivative of the whole state x = (q, v): coordinate rates, then accelerations."""
    NQ = module.NQ
    module.coordinate_rates(xdot[:NQ], q=x[:NQ], v=x[NQ:])
    if module.NC > 0:
        lam = reals(module.NC)
        module.forward_dynamics(xdot[NQ:], lam, q=x[:NQ], v=x[NQ:])
    else:
        module.forward_dynamics(xdot[NQ:], q=x[:NQ], v=x[NQ:])


def after_dynamics(module: ModuleAtState) -> None:
    """The accelerations, and another function at them."""
    # arrays of C have an entry, even where a model has no velocities
    a = reals(module.NV + 1)
    if module.NC > 0:
        lam = reals(module.NC)
        module.forward_dynamics(a, lam)
        module.then(a=a, lam=lam)
    else:
        module.forward_dynamics(a)
        module.then(a=a)
