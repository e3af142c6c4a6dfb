"""Newton's method for the algebraic loop of a network.

A step is halved until the largest residual falls in proportion to what is left of it. That is enough for
most loops, but not where a law is flat, as a saturation is and a dead zone, or has a kink that the step
would have to cross. Then every law of the loop gets a resistance in series and a conductance in parallel
(`ease`), which vanish level by level; each level starts at the solution of the one before. Laws that rise,
together with them, rise strictly and not too steeply: each level has exactly one solution, and it moves to
that of the loop itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.ir.algorithms.elimination import backward, eliminate
from linegraph.ir.algorithms.language import Failed, infinity, ints, larger, ratio, reals
from linegraph.ir.algorithms.sizes import is_rounding, size_of
from linegraph.ir.statuses import NO_LOOP_SOLUTION

if TYPE_CHECKING:
    from linegraph.ir.algorithms.language import ModuleAtState, Reals

MOST_STEPS = 200
MOST_HALVINGS = 40
DECREASE = 1e-4
"""The part of what a step promises by which the residual has to fall."""

BEGINS = (0.0, 1.0, -1.0)
RESISTANCES = (1.0, 1e3, 1e-3)
"""The resistance (ohm, or the unit of the domain) by which currents are compared with voltages."""

NEAR = 0.01
NEARER = 12
"""Where the search with resistances begins: not at zero, where roots are steep and powers flat; at a tenth of
that, up to so many times, if exponentials overflow."""

LEVELS = 24
FIRST = 0.5
SOFTER = 0.31622776601683794
"""The first level's resistances, and by how much they shrink from level to level."""

LEVEL_STEPS = 50
LEVEL_GAP = 1e-9
"""A level is solved when its residual has fallen to this part of what it was."""

MISSED = 1e-3
MOST_MISSED = 3
"""A level is missed if more than this part of its residual is left, and that is more than rounding; so many
in turn end the search."""

PROBE_EASE = 1e-8
PROBE = 1e-6
"""The resistances that make a singular Jacobian regular, and how far along its flattest direction another
solution is looked for."""


def newton(module: ModuleAtState, loop: Reals) -> None:
    """Solve the algebraic loop; it must have one solution and no other beside it."""
    if not search(module, loop):
        raise Failed(NO_LOOP_SOLUTION)
    if not is_only(module, loop):
        raise Failed(NO_LOOP_SOLUTION)


def search(module: ModuleAtState, at: Reals) -> bool:
    """Look for a solution from several starts, then with resistances; whether one was found."""
    N = module.size
    begins = BEGINS
    resistances = RESISTANCES
    for begin in range(len(begins)):
        for i in range(N):
            at[i] = begins[begin]
        if descend(module, 0.0, 0.0, at):
            return True
    for k in range(len(resistances)):  # noqa: SIM110
        if follow(module, resistances[k], at):
            return True
    return False


def follow(module: ModuleAtState, resistance: float, at: Reals) -> bool:
    """Follow the solution while resistances vanish level by level; whether that ends at one."""
    soft = FIRST
    missed = 0
    begin_near(module, soft * resistance, soft / resistance, at)
    for _ in range(LEVELS):
        if descend(module, soft * resistance, soft / resistance, at):
            missed = 0
        else:
            missed += 1
        if missed == MOST_MISSED:
            return False
        soft *= SOFTER
    return descend(module, 0.0, 0.0, at)


def begin_near(module: ModuleAtState, series: float, parallel: float, at: Reals) -> None:
    """A place near zero where the residual is finite: nearer if exponentials overflow."""
    N = module.size
    r = reals(N)
    K = reals(N * N)
    s = reals(N)
    ease = reals(2)
    ease[0] = series
    ease[1] = parallel
    for i in range(N):
        at[i] = NEAR * (1.0 + 0.125 * float(i))
    for _ in range(NEARER):
        module.loop_equations(r, K, s, loop=at, ease=ease)
        if size_of(N, r) < infinity:
            break
        for i in range(N):
            at[i] *= 0.1


def descend(module: ModuleAtState, series: float, parallel: float, at: Reals) -> bool:
    """Newton's method from `at`, as far as it leads.

    Returned is whether that is a solution; with resistances, which are only on the way to one, whether most
    of the residual is gone.
    """
    N = module.size
    r = reals(N)
    K = reals(N * N)
    s = reals(N)
    ease = reals(2)
    eased = series > 0.0
    ease[0] = series
    ease[1] = parallel
    module.loop_equations(r, K, s, loop=at, ease=ease)
    start = size_of(N, r)
    gap = start
    solved = is_rounding(N, r, s)
    enough = 0.0
    most = MOST_STEPS
    if eased:
        enough = LEVEL_GAP * start
        most = LEVEL_STEPS
    going = gap > enough and gap < infinity
    for _ in range(most):
        if not going:
            break
        after = advance(module, ease, eased or solved, gap, r, K, s, at)
        # once the residual is rounding, go on while that still becomes less
        going = after < infinity and after > enough
        if solved and not eased:
            going = going and after <= 0.5 * gap
        if after < infinity:
            gap = after
            solved = is_rounding(N, r, s)
    if eased:
        return solved or gap <= MISSED * start
    return gap < infinity and (solved or not gap > 0.0)


def advance(
    module: ModuleAtState,
    ease: Reals,
    strict: bool,
    gap: float,
    r: Reals,
    K: Reals,
    s: Reals,
    at: Reals,
) -> float:
    """Take one step of Newton's method, halved until the residual falls; infinite if it never does.

    Returned is the largest residual at the new `at`; r, K and s are those of that point, too. Unless
    `strict`, a point at which all residuals become rounding is taken though the largest one does not fall:
    rows have roundings of their own.
    """
    N = module.size
    g = reals(N)
    step = reals(N)
    ahead = reals(N)
    rows = ints(N)
    columns = ints(N)
    if eliminate(N, N, N, K, rows, columns, 0.0) < N:
        return infinity
    backward(N, N, K, rows, columns, r, g, step)
    length = -1.0
    for _ in range(MOST_HALVINGS):
        for i in range(N):
            ahead[i] = at[i] + length * step[i]
        module.loop_equations(r, K, s, loop=ahead, ease=ease)
        after = size_of(N, r)
        # where a slope is infinite, no step leads on
        nearer = after <= (1.0 + DECREASE * length) * gap and size_of(N * N, K) < infinity
        if not strict and after < infinity and not nearer:
            nearer = is_rounding(N, r, s) or not after > 0.0
        if nearer:
            for i in range(N):
                at[i] = ahead[i]
            return after
        length *= 0.5
    return infinity


def is_only(module: ModuleAtState, at: Reals) -> bool:
    """Whether a solution is the only one near it.

    Where the Jacobian is singular, as at the zero of ``x abs(x)`` and within a dead zone, the next points
    in the direction in which the residual changes least tell these two apart.
    """
    N = module.size
    r = reals(N)
    K = reals(N * N)
    s = reals(N)
    g = reals(N)
    step = reals(N)
    ahead = reals(N)
    ease = reals(2)
    rows = ints(N)
    columns = ints(N)
    reach = 0.0
    module.loop_equations(r, K, s, loop=at, ease=ease)
    if not size_of(N * N, K) < infinity:
        return True
    if eliminate(N, N, N, K, rows, columns, 0.0) == N:
        return True
    ease[0] = PROBE_EASE
    ease[1] = PROBE_EASE
    module.loop_equations(r, K, s, loop=at, ease=ease)
    for i in range(N):
        r[i] = s[i] if s[i] > 0.0 else 1.0
    if eliminate(N, N, N, K, rows, columns, 0.0) < N:
        return False
    backward(N, N, K, rows, columns, r, g, step)
    for i in range(N):
        reach = larger(reach, abs(step[i]) / (1.0 + abs(at[i])))
    ease[0] = 0.0
    ease[1] = 0.0
    for way in range(-1, 2, 2):
        for i in range(N):
            ahead[i] = at[i] + PROBE * float(way) * ratio(step[i], reach)
        module.loop_equations(r, K, s, loop=ahead, ease=ease)
        gap = size_of(N, r)
        if gap < infinity and (is_rounding(N, r, s) or not gap > 0.0):
            return False
    return True
