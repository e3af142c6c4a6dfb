"""Emitted derivatives of the dynamics, by differentiating the expressions of the program itself.

With r(q, v, a, u) = M a + h - Q, which is zero if a is the acceleration,

    ∂τ/∂x = ∂r/∂x        ∂a/∂x = -M^-1 ∂r/∂x, at the a of forward dynamics

so that M is factored once. Differentiating through the factors would repeat the elimination for every
x. Derivatives with respect to q are taken along the velocities (`tangent_space`): three columns for an
orientation, none for a quaternion's length. The second formula is also that of [Carpentier and Mansard
2018].
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.algebra.differentiation import substitution
from linegraph.algebra.factorization import factored, solve_many
from linegraph.errors import ModelError
from linegraph.ir.program import Guards, Listing, Quantity
from linegraph.kinematics import tangent_space as tangent
from linegraph.programs import loop_derivatives as closed_derivatives
from linegraph.programs import networks as network_programs
from linegraph.programs import pivots
from linegraph.programs.independent import independent
from linegraph.programs.slopes import Columns, matrix, of_motion, turned, variables

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.ir.program import Check, Program, Routine
    from linegraph.programs.workspace import Workspace

ALONG = "by changes of q along the velocities, dq = N(q) d"


def inverse_dynamics(f: Workspace) -> tuple[Program | Routine, ...]:
    """∂τ/∂q, ∂τ/∂v and ∂τ/∂a = M, each with one row per velocity."""
    changes, velocities, _ = variables(f)
    found = of_motion(f, f.passive, [0] * len(f.v), [*changes, *velocities])
    count = len(changes)
    results = (
        matrix("dtau_dq", found[:count], f"derivatives {ALONG}"),
        matrix("dtau_dv", found[count:], "derivatives by v"),
        matrix("dtau_da", turned(f.mass_matrix), "derivatives by a, which are M"),
    )
    about = "Derivatives of inverse dynamics tau = M(q) a + h(q, v)."
    return (f.program("inverse_dynamics_derivatives", about, ("q", "v", "a"), results),)


def forward_dynamics(f: Workspace) -> tuple[Program | Routine, ...]:
    """∂a/∂q, ∂a/∂v and ∂a/∂u, each with one row per velocity.

    Raises:
        ModelError: the model has constraints.
    """
    _require_open(f, "; linearize gives them in the independent coordinates")
    changes, velocities, inputs = variables(f)
    found, checks = _accelerations(f, [*changes, *velocities, *inputs])
    first, second = len(changes), len(changes) + len(velocities)
    results = (
        matrix("da_dq", found[:first], f"derivatives {ALONG}"),
        matrix("da_dv", found[first:second], "derivatives by v"),
        *([matrix("da_du", found[second:], "derivatives by u")] if inputs else []),
    )
    about = "Derivatives of forward dynamics a = M(q)^-1 (Q(u) - h(q, v))."
    return (
        f.program(
            "forward_dynamics_derivatives", about, _STATE, results, Guards(checks, status=True)
        ),
    )


def linearize(f: Workspace) -> tuple[Program | Routine, ...]:
    """A and B of ẋ = f(x, u) for small changes (d, dv) on the tangent space, at any state."""
    if f.tree.closed:
        return closed_derivatives.linearize(f)
    changes, velocities, inputs = variables(f)
    found, checks = _accelerations(f, [*changes, *velocities, *inputs])
    count = len(changes)
    adjoint = turned(tangent.adjoint(f.tree, f.v))
    unit = [[int(i == k) for i in range(count)] for k in range(len(velocities))]
    above = [[-entry for entry in column] for column in adjoint] + unit
    above += [[0] * count for _ in inputs]
    whole: Columns = [[*top, *column] for top, column in zip(above, found, strict=True)]
    size = count + len(velocities)
    results = (
        matrix("A", whole[:size], "derivatives of xdot by x"),
        *([matrix("B", whole[size:], "derivatives of xdot by u")] if inputs else []),
    )
    about = (
        "Linearisation at any state, at rest or moving: small changes follow dx' = A dx + B du with "
        "dx = (d, dv), d along the velocities: dq = N(q) d."
    )
    return (f.program("linearize", about, _STATE, results, Guards(checks, status=True)),)


def inverse_dynamics_by_parameters(f: Workspace) -> tuple[Program | Routine, ...]:
    """∂τ/∂p, one row per velocity and one column per parameter.

    Raises:
        ModelError: the functions take no parameters.
    """
    names = _parameters(f)
    results = (matrix("dtau_dp", of_motion(f, f.passive, [0] * len(f.v), names), _BY_PARAMETERS),)
    about = "Derivatives of inverse dynamics tau = M(q) a + h(q, v) by the parameters."
    given = ("q", "v", "a")
    return (f.program("inverse_dynamics_parameter_derivatives", about, given, results),)


def forward_dynamics_by_parameters(f: Workspace) -> tuple[Program | Routine, ...]:
    """∂a/∂p, one row per velocity and one column per parameter.

    Raises:
        ModelError: the model has constraints, or the functions take no parameters.
    """
    _require_open(f)
    names = _parameters(f)
    found, checks = _accelerations(f, names)
    results = (matrix("da_dp", found, _BY_PARAMETERS),)
    about = "Derivatives of forward dynamics a = M(q)^-1 (Q(u) - h(q, v)) by the parameters."
    name = "forward_dynamics_parameter_derivatives"
    return (f.program(name, about, _STATE, results, Guards(checks, status=True)),)


def counts(f: Workspace, chosen: Iterable[str]) -> tuple[tuple[str, int], ...]:
    """The number NT of changes of q, if a function with such derivatives is made.

    Args:
        f: the shared equations.
        chosen: keys of the functions that are made.
    """
    if not {"linearize", "inverse_dynamics_derivatives", "forward_dynamics_derivatives"} & {
        *chosen
    }:
        return ()
    count = len(tangent.changes(f.tree))
    return (("NT", count),)


def listings(f: Workspace, chosen: Iterable[str]) -> tuple[Listing, ...]:
    """The entries of dx: changes d of position, then of velocities, under the names of these.

    Args:
        f: the shared equations.
        chosen: keys of the functions that are made.
    """
    if "linearize" not in chosen:
        return ()
    moved, rates = list(range(len(tangent.changes(f.tree)))), list(range(len(f.v)))
    if f.tree.closed:
        moved = closed_derivatives.free_changes(f)
        rates = [v for _, v in independent(f)]
    names = network_programs.state_listing(f.tree).quantities[len(f.q) :]
    positions = {quantity.name: quantity for quantity in f.tree.positions}
    found = []
    for k in moved:
        velocity = f.tree.velocities[k]
        plain = positions.get(velocity.name)
        about = f"change along {velocity.name}"
        unit = velocity.unit.removesuffix("/s")
        found.append(plain or Quantity(f"d_{velocity.name}", unit, about))
    quantities = (*found, *(names[k] for k in rates))
    heading = "changes that linearize speaks of"
    return (Listing("dx", "NDX", heading, quantities),)


_STATE = ("q", "v", "u")
_BY_PARAMETERS = "derivatives by the parameters, in their order"


def _parameters(f: Workspace) -> list[Symbol]:
    """The parameters that functions take as arguments, in order."""
    if "p" not in f.head:
        problem = "its functions take no parameters, so there are no derivatives by them"
        raise ModelError(f'model "{f.tree.system.name}"', f"{problem}; keep them symbolic")
    return [("p", p.name) for p in f.tree.system.parameters.values() if not p.derived]


def _require_open(f: Workspace, instead: str = "") -> None:
    """Refuse constraints: the solver for a and lam branches at run time, which cannot be differentiated."""
    if f.tree.closed:
        problem = "it has constraints, through whose solution accelerations are not differentiated"
        raise ModelError(f'model "{f.tree.system.name}"', problem + instead)


def _accelerations(f: Workspace, by: Sequence[Symbol]) -> tuple[Columns, tuple[Check, ...]]:
    """The derivatives of a with respect to some symbols, with checks that no pivot is zero."""
    slopes = of_motion(f, f.carried, f.driving, by)
    f.dag.label = "right-hand side Q - h"
    right = [effort - h for effort, h in zip(f.driving, f.held, strict=True)]
    (a,), found_pivots = _solved(f, [right])
    at = substitution(f.dag, {("a", k): x for k, x in enumerate(a)})
    found, _ = _solved(f, [[-at(entry) for entry in column] for column in slopes])
    bounds = [pivots.bound(x, f.mass_matrix[i][i]) for i, x in enumerate(found_pivots)]
    return found, pivots.checks(f, found_pivots, bounds) + network_programs.checks(f)


def _solved(f: Workspace, rights: Columns) -> tuple[Columns, list[Scalar]]:
    """``M^-1`` times some columns, and the pivots; for unit columns, columns of the inverse are reused."""
    f.dag.label = "M = L^T D L from the leaves to the root, then back"
    if not f.symmetric:
        return solve_many(f.mass_matrix, rights, f.tree.outward, symmetric=False)
    factors = factored(f.mass_matrix, f.tree.outward)
    f.dag.label = "derivatives of a"
    places = [_place_of_one(right) for right in rights]
    ones = [place for place in places if place is not None]
    inverse = factors.inverse() if 2 * len(ones) > len(factors.pivots) else None
    found = [
        factors.solve(right) if place is None or inverse is None else inverse[place]
        for right, place in zip(rights, places, strict=True)
    ]
    return found, factors.pivots


def _place_of_one(column: Sequence[Scalar]) -> int | None:
    """The row of a unit column's only entry; None for other columns."""
    used = [k for k, x in enumerate(column) if x != 0]
    return used[0] if len(used) == 1 and column[used[0]] == 1 else None
