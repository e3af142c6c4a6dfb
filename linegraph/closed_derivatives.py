"""Emitted linearisation of a mechanism in its independent coordinates.

A motion that keeps the constraints is known by the independent coordinates s and their rates w, and so are
its small changes: d = T ds, dv = T dw + S ds, where S keeps the constraints of velocity,
J S = -∂(J v - b)/∂q T. With these put into the derivative of M a - f - J^T lam = 0, J a = gam,

    M da - J^T dlam = -∂(M a - f - J^T lam)        J da = -∂(J a - gam)

which is solved as the equations of motion are. So ds' = dw, and dw' are the independent entries of da.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.closed_programs import (
    CONTRADICTION,
    NO_INERTIA,
    SINGULAR,
    independent,
    routine,
)
from linegraph.errors import ModelError
from linegraph.program import Program, Result, Routine
from linegraph.slopes import columns, matrix, of_motion, variables

if TYPE_CHECKING:
    from linegraph.shared import Functions


def linearize(f: Functions) -> tuple[Program | Routine, ...]:
    """A and B in the independent coordinates.

    Raises:
        ModelError: the mechanism has none, constraints follow inputs, or are of velocity alone.
    """
    who = f'model "{f.model.name}"'
    if f.tree.network is not None or not independent(f):
        problem = (
            "it is not reduced to independent coordinates, in which alone loops are linearised"
        )
        raise ModelError(who, problem)
    if not all(equation.holonomic for equation in f.equations):
        problem = (
            "some of its constraints are of velocity alone, so that more positions than velocities are "
            "independent; it is not linearised yet"
        )
        raise ModelError(who, problem)
    if f.driven_constraints:
        raise ModelError(who, "its constraints follow inputs, by which they cannot be linearised")
    size, inputs = 2 * len(independent(f)), f.sizes["u"]
    results = [Result("A", (size, size), (), "derivatives of xdot by x")]
    if inputs:
        results.append(Result("B", (size, inputs), (), "derivatives of xdot by u"))
    about = (
        "Linearisation in the independent coordinates s and their rates w, at any state that satisfies the "
        "constraints: small changes follow dx' = A dx + B du with x = (s, w)."
    )
    calls = ("forward_dynamics", "constrained_equations", "constrained_slopes", "reduction")
    given = ("q", "v", "u")
    statuses = (SINGULAR, NO_INERTIA, CONTRADICTION)
    made = routine(f, "linearize", about, given, tuple(results), "linearization", statuses, calls)
    return (_slopes(f), made)


def _slopes(f: Functions) -> Program:
    """What is left of the equations at given a and lam, differentiated by changes of q, by v and by u."""
    jacobian, a, lam = f.jacobian, f.symbols("a"), f.symbols("lam")
    less = list(f.driving)
    for row, multiplier in zip(jacobian, lam, strict=True):
        less = [x + entry * multiplier for x, entry in zip(less, row, strict=True)]
    motion = [
        sum((entry * x for entry, x in zip(row, a, strict=True)), 0) - gam
        for row, gam in zip(jacobian, f.chords.bias(), strict=True)
    ]
    changes, velocities, inputs = variables(f)
    by = [*changes, *velocities, *inputs]
    results = (
        matrix("slopes_f", of_motion(f, f.carried, less, by), "of M a - f - J^T lam"),
        matrix("slopes_gam", columns(f, motion, by), "of J a - gam"),
        matrix("slopes_rates", columns(f, f.chords.rates(f.v), changes), "of J v - b"),
    )
    about = (
        "Derivatives of what is zero at the accelerations a and multipliers lam: by changes d of q along the "
        "velocities, dq = N(q) d, by v and by u."
    )
    return f.program("constrained_slopes", about, ("q", "v", "u", "a", "lam"), results)
