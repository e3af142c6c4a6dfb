"""Emitted linearisation of a mechanism with closed loops, in its independent coordinates.

A motion that satisfies the constraints is given by its independent velocities w and by as many changes
s of position as the holonomic constraints leave free: those along w, and more if there are constraints
of velocity alone (wheels, blades). So are its small changes,

    d = D ds        dv = T dw + S ds        J S = -∂(J v - b)/∂q D

where D satisfies the constraints of position, and T and S those of velocity. Put into the derivative of
M a - f - Jᵀ lam = 0, J a = gam, they give

    M da - Jᵀ dlam = -∂(M a - f - Jᵀ lam)        J da = -∂(J a - gam)

which is solved like the equations of motion. ds' are entries of d' = dv - (ad v) d, dw' those of da.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from linegraph.dynamics.circuit_lengths import pure
from linegraph.errors import ModelError
from linegraph.ir.program import Program, Result, Routine
from linegraph.ir.statuses import CONTRADICTION, NOT_DETERMINED, SINGULAR_INERTIA, SINGULAR_POSITION
from linegraph.kinematics import tangent_space as tangent
from linegraph.numeric.loop_closure import at_some_time
from linegraph.programs.independent import assembly, independent
from linegraph.programs.loop_routines import Algorithm, routine
from linegraph.programs.slopes import columns, matrix, of_motion, turned, variables

if TYPE_CHECKING:
    from linegraph.programs.workspace import Workspace

WELL_APART = 1e-4
"""Least singular value, in pure numbers, of columns of J that determine other changes."""


def linearize(f: Workspace) -> tuple[Program | Routine, ...]:
    """A and B in the independent coordinates and velocities.

    Raises:
        ModelError: there are no independent coordinates, or constraints follow inputs.
    """
    who = f'model "{f.tree.system.name}"'
    free = free_changes(f)
    if not free:
        problem = "is not reduced to independent coordinates, in which alone loops are linearised"
        raise ModelError(who, problem)
    if f.driven_constraints:
        raise ModelError(who, "has constraints that follow inputs: it cannot be linearised")
    size, inputs = len(free) + len(independent(f)), f.sizes["u"]
    results = [Result("A", (size, size), (), "derivatives of xdot by x")]
    if inputs:
        results.append(Result("B", (size, inputs), (), "derivatives of xdot by u"))
    about = (
        "Linearisation in independent coordinates and velocities, at any state that satisfies the "
        "constraints: small changes follow dx' = A dx + B du with the dx that are listed."
    )
    calls = (
        "forward_dynamics",
        "constrained_equations",
        "constrained_slopes",
        "reduction",
        "constraint_sizes",
    )
    given = ("q", "v", "u")
    statuses = (SINGULAR_POSITION, SINGULAR_INERTIA, CONTRADICTION, NOT_DETERMINED)
    made = routine(
        f, "linearize", about, given, tuple(results), Algorithm("linearization", statuses, calls)
    )
    return (_slopes(f), replace(made, details=(*made.details, ("d_at", tuple(free)))))


def free_changes(f: Workspace) -> list[int]:
    """The changes of position that determine all others: those along w, then more as needed."""
    if f.tree.network is not None or not independent(f):
        return []
    import numpy

    own = [v for _, v in independent(f)]
    others = [k for k in range(f.tree.layout.mechanical) if k not in own]
    count = sum(equation.holonomic for equation in f.constraint_equations)
    numeric = at_some_time(f.derivation)
    rows = numpy.array(numeric.constraint_jacobian(assembly(f).q), float)
    J = pure(rows.reshape(len(f.constraint_equations), len(f.v)), numeric.sizes)[:count]
    dependent: list[int] = []
    for k in [*reversed(others), *reversed(own)]:
        if len(dependent) == assembly(f).position_rank:
            return sorted({*own, *others} - {*dependent})
        found = numpy.linalg.svd(J[:, [*dependent, k]], compute_uv=False)
        if found.min() > WELL_APART and len(found) == len(dependent) + 1:
            dependent.append(k)
    return []


def _slopes(f: Workspace) -> Program:
    """Derivatives of the residuals of the equations, at given a and lam, by changes of q, by v and by u."""
    jacobian, a, lam = f.jacobian, f.symbols("a"), f.symbols("lam")
    less = list(f.driving)
    for row, multiplier in zip(jacobian, lam, strict=True):
        less = [x + entry * multiplier for x, entry in zip(less, row, strict=True)]
    motion = [
        sum((entry * x for entry, x in zip(row, a, strict=True)), 0) - gam
        for row, gam in zip(jacobian, f.constraint_bias, strict=True)
    ]
    changes, velocities, inputs = variables(f)
    by = [*changes, *velocities, *inputs]
    drift = [[-x for x in column] for column in turned(tangent.adjoint(f.tree, f.v))]
    results = (
        matrix("slopes_f", of_motion(f, f.carried, less, by), "of M a - f - J^T lam"),
        matrix("slopes_gam", columns(f, motion, by), "of J a - gam"),
        matrix("slopes_rates", columns(f, f.constraint_rates, changes), "of J v - b"),
        matrix("drift", drift, "of the rates of d by d, -(ad v)"),
    )
    about = (
        "Derivatives of what is zero at the accelerations a and multipliers lam: by changes d of q along the "
        "velocities, dq = N(q) d, by v and by u."
    )
    return f.program("constrained_slopes", about, ("q", "v", "u", "a", "lam"), results)
