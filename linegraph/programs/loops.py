"""Emitted functions of systems with constraints: φ, J and γ, separately and with M and h."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.components.parameters import resolver
from linegraph.dynamics.circuit_lengths import sizes
from linegraph.ir.program import (
    Guards,
    Listing,
    Program,
    Quantity,
    Result,
    Routine,
)
from linegraph.numeric.loop_closure import at_some_time
from linegraph.programs import networks as network_programs
from linegraph.programs.independent import assembly, independent

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.programs.workspace import Workspace


def constraints(f: Workspace) -> tuple[Program | Routine, ...]:
    """Functions for φ, J, J v - b and γ, separately and together with M and h."""
    if not f.tree.closed:
        return ()
    programs: list[Program | Routine] = []
    if _positions(f):
        about = "Constraints phi(q), zero where all loops are closed."
        programs.append(f.program("constraints", about, ("q",), (_phi(f),)))
    programs += [
        f.program(
            "constraint_jacobian",
            "Jacobian J of the constraints: J v is what they fix.",
            ("q",),
            (_jacobian(f),),
        ),
        f.program(
            "constraint_rates",
            "Rates J v - b of the constraints, zero where v is allowed.",
            ("q", "v"),
            (_column("rates", f.constraint_rates, "rates of the constraints"),),
        ),
        f.program(
            "constraint_bias",
            "Right-hand side gam of the constraints of acceleration, J vdot = gam.",
            ("q", "v"),
            (_column("gam", f.constraint_bias, "what J vdot must be"),),
        ),
        _whole(f),
        _sizes(f),
    ]
    return tuple(programs)


def _sizes(f: Workspace) -> Program:
    """The function that returns the sizes by which J becomes a matrix of pure numbers."""
    f.dag.label = "lengths of loops"
    numeric = at_some_time(f.derivation)
    found = sizes(f.tree, numeric.tree)
    about = (
        "Sizes that make J a matrix of pure numbers, J_ij of_v_j / of_phi_i: lengths L of the loops (m) for "
        "forces and translations, 1 for torques and rotations, 0 for relations."
    )
    results = (
        Result(
            "of_phi",
            (len(f.constraint_equations),),
            tuple(found.constraints),
            "of constraints",
            ("NC",),
        ),
        Result("of_v", (len(f.v),), tuple(found.velocities), "of velocities", ("NV",)),
    )
    return f.program("constraint_sizes", about, (), results)


def _whole(f: Workspace) -> Program:
    force = [effort - h for effort, h in zip(f.driving, f.held, strict=True)]
    about = (
        "All of M vdot = f + J^T lam, J vdot = gam, sharing work: M, f = Q(u) - h, J and gam"
        f"{', stabilised by Baumgarte' * (f.tree.system.choices.baumgarte is not None)}."
    )
    results = (
        f.mass_result,
        _column("f", force, "generalised forces Q - h"),
        _jacobian(f),
        _column("gam", _stabilised(f), "what J vdot must be"),
    )
    checks = network_programs.checks(f)
    return f.program("constrained_equations", about, ("q", "v"), results, Guards(checks))


def listings(f: Workspace, chosen: Sequence[str]) -> tuple[Listing, ...]:
    """Constraints with their multipliers, and the independent coordinates.

    Args:
        f: the shared equations.
        chosen: keys of the functions that are made; not used.
    """
    if not f.tree.closed:
        return ()
    unique = assembly(f).unique
    multipliers = tuple(
        Quantity(
            e.multiplier.name, e.multiplier.unit, e.multiplier.about + "; not unique" * (not one)
        )
        for e, one in zip(f.constraint_equations, unique, strict=True)
    )
    heading = "constraints, those of position first, and of their multipliers"
    constraints_ = Listing("constraint", "NC", heading, multipliers, ("lam", "gam", "rates"))
    if f.tree.network is not None:
        return (constraints_,)
    free = tuple(f.tree.velocities[v] for _, v in independent(f))
    return (
        constraints_,
        Listing("independent", "NI", "independent velocities", free, ("w",)),
    )


def counts(f: Workspace, chosen: Sequence[str]) -> tuple[tuple[str, int], ...]:
    """The number NP of holonomic constraints, and the rank of all.

    Args:
        f: the shared equations.
        chosen: keys of the functions that are made; not used.
    """
    if not f.tree.closed:
        return ()
    return (("NP", _positions(f)), ("RANK", assembly(f).rank))


def _positions(f: Workspace) -> int:
    return sum(equation.holonomic for equation in f.constraint_equations)


def _phi(f: Workspace) -> Result:
    return _column("phi", f.constraints, "constraints of position")


def _jacobian(f: Workspace) -> Result:
    rows = f.jacobian
    entries = tuple(entry for row in rows for entry in row)
    return Result("J", (len(rows), len(f.v)), entries, "Jacobian of the constraints")


def _stabilised(f: Workspace) -> list[Scalar]:
    """γ with Baumgarte's terms: ``γ - 2 α (J v - b) - β² φ`` [Baumgarte 1972]."""
    bias = f.constraint_bias
    if f.tree.system.choices.baumgarte is None:
        return bias
    resolve = resolver(f.dag, f.tree.parameters)
    alpha, beta = (resolve(x) for x in f.tree.system.choices.baumgarte)
    position = f.constraints
    phi = [*position, *(0 for _ in range(len(bias) - len(position)))]
    return [
        g - (2 * alpha * rate + beta * beta * x)
        for g, rate, x in zip(bias, f.constraint_rates, phi, strict=True)
    ]


def _column(name: str, entries: Iterable[Scalar], about: str) -> Result:
    found = tuple(entries)
    return Result(name, (len(found),), found, about)
