"""Emitted derivatives of the dynamics, by differentiating the program itself.

With r(q, v, a, u) = M a + h - Q, which is zero where a is the acceleration,

    ∂τ/∂x = ∂r/∂x        ∂a/∂x = -M^-1 ∂r/∂x, at the a of forward dynamics

so that M is factored once and nothing is differentiated through its factors. Derivatives by q are taken along
the velocities (`tangent`): three columns for an orientation, none for a quaternion's length.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph import network_programs, pivots, tangent
from linegraph.differentiation import Calculus, substitution
from linegraph.factorization import factored, solve_many
from linegraph.loop_slopes import loop_slopes
from linegraph.program import Program, Result, Routine, reads

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.differentiation import Symbol
    from linegraph.program import Check
    from linegraph.shared import Functions
    from linegraph.vector import Scalar

Columns = list[list["Scalar"]]
"""Derivatives: a column for each symbol, with an entry for each scalar that is differentiated."""

ALONG = "by changes of q along the velocities, dq = N(q) d"


def inverse_dynamics(f: Functions) -> tuple[Program | Routine, ...]:
    """∂τ/∂q, ∂τ/∂v and ∂τ/∂a = M."""
    changes, velocities, _ = _variables(f)
    found = _columns(f, f.inverse_dynamics, [*changes, *velocities])
    count = len(changes)
    results = (
        _matrix("dtau_dq", found[:count], f"derivatives {ALONG}"),
        _matrix("dtau_dv", found[count:], "derivatives by v"),
        _matrix("dtau_da", _turned(f.mass_rows), "derivatives by a, which are M"),
    )
    about = "Derivatives of inverse dynamics tau = M(q) a + h(q, v)."
    return (f.program("inverse_dynamics_derivatives", about, ("q", "v", "a"), results),)


def forward_dynamics(f: Functions) -> tuple[Program | Routine, ...]:
    """∂a/∂q, ∂a/∂v and ∂a/∂u."""
    if f.tree.closed:
        return ()
    changes, velocities, inputs = _variables(f)
    found, checks = _accelerations(f, [*changes, *velocities, *inputs])
    first, second = len(changes), len(changes) + len(velocities)
    results = (
        _matrix("da_dq", found[:first], f"derivatives {ALONG}"),
        _matrix("da_dv", found[first:second], "derivatives by v"),
        *([_matrix("da_du", found[second:], "derivatives by u")] if inputs else []),
    )
    about = "Derivatives of forward dynamics a = M(q)^-1 (Q(u) - h(q, v))."
    return (f.program("forward_dynamics_derivatives", about, _STATE, results, checks, status=True),)


def linearize(f: Functions) -> tuple[Program | Routine, ...]:
    """A and B of ẋ = f(x, u) on the tangent space."""
    if f.tree.closed:
        return ()
    changes, velocities, inputs = _variables(f)
    found, checks = _accelerations(f, [*changes, *velocities, *inputs])
    count = len(changes)
    adjoint = _turned(tangent.adjoint(f.tree, f.v))
    unit = [[int(i == k) for i in range(count)] for k in range(len(velocities))]
    above = [[-entry for entry in column] for column in adjoint] + unit
    above += [[0] * count for _ in inputs]
    whole: Columns = [[*top, *column] for top, column in zip(above, found, strict=True)]
    size = count + len(velocities)
    results = (
        _matrix("A", whole[:size], "derivatives of xdot by x"),
        *([_matrix("B", whole[size:], "derivatives of xdot by u")] if inputs else []),
    )
    about = (
        "Linearisation at any state, at rest or moving: small changes follow dx' = A dx + B du with "
        "dx = (d, dv), d along the velocities: dq = N(q) d."
    )
    return (f.program("linearize", about, _STATE, results, checks, status=True),)


def inverse_dynamics_by_parameters(f: Functions) -> tuple[Program | Routine, ...]:
    """∂τ/∂p."""
    names = _parameters(f)
    if not names:
        return ()
    results = (_matrix("dtau_dp", _columns(f, f.inverse_dynamics, names), _BY_PARAMETERS),)
    about = "Derivatives of inverse dynamics tau = M(q) a + h(q, v) by the parameters."
    given = ("q", "v", "a")
    return (f.program("inverse_dynamics_parameter_derivatives", about, given, results),)


def forward_dynamics_by_parameters(f: Functions) -> tuple[Program | Routine, ...]:
    """∂a/∂p."""
    names = _parameters(f)
    if not names or f.tree.closed:
        return ()
    found, checks = _accelerations(f, names)
    results = (_matrix("da_dp", found, _BY_PARAMETERS),)
    about = "Derivatives of forward dynamics a = M(q)^-1 (Q(u) - h(q, v)) by the parameters."
    name = "forward_dynamics_parameter_derivatives"
    return (f.program(name, about, _STATE, results, checks, status=True),)


def counts(f: Functions, chosen: Iterable[str]) -> tuple[tuple[str, int], ...]:
    """How many changes of q there are, and of the whole state; and how many parameters."""
    found: tuple[tuple[str, int], ...] = ()
    if {"linearize", "inverse_dynamics_derivatives", "forward_dynamics_derivatives"} & {*chosen}:
        count = len(tangent.changes(f.tree))
        found = (("NT", count), ("NX", count + len(f.v)))
    return found


_STATE = ("q", "v", "u")
_BY_PARAMETERS = "derivatives by the parameters, in their order"


def _variables(f: Functions) -> tuple[list[Symbol], list[Symbol], list[Symbol]]:
    """Changes of q, velocities and inputs."""
    velocities: list[Symbol] = [("v", k) for k in range(f.sizes["v"])]
    return tangent.changes(f.tree), velocities, [("u", k) for k in range(f.sizes["u"])]


def _parameters(f: Functions) -> list[Symbol]:
    """The parameters that functions are given, in order."""
    if "p" not in f.head:
        return []
    return [("p", p.name) for p in f.model.parameters.values() if not p.derived]


def _columns(f: Functions, given: Sequence[Scalar], by: Sequence[Symbol]) -> Columns:
    """The derivatives of some scalars by each of some symbols."""
    f.dag.label = "derivatives"
    chain = tangent.chain(f.tree, f.dag, f.q)
    if reads("loop", (Result("", (), tuple(given), ""),)):
        chain |= loop_slopes(f, chain)
    calculus = Calculus(f.dag, chain=chain)
    found = [calculus.gradient(x) for x in given]
    return [[slopes.get(symbol, 0) for slopes in found] for symbol in by]


def _accelerations(f: Functions, by: Sequence[Symbol]) -> tuple[Columns, tuple[Check, ...]]:
    """The derivatives of a by each of some symbols, and what must not be zero for that."""
    left = [need - effort for need, effort in zip(f.required, f.driving, strict=True)]
    slopes = _columns(f, left, by)
    f.dag.label = "right-hand side Q - h"
    right = [effort - h for effort, h in zip(f.driving, f.held, strict=True)]
    (a,), found_pivots = _solved(f, [right])
    at = substitution(f.dag, {("a", k): x for k, x in enumerate(a)})
    found, _ = _solved(f, [[-at(entry) for entry in column] for column in slopes])
    bounds = [pivots.bound(x, f.mass_rows[i][i]) for i, x in enumerate(found_pivots)]
    return found, pivots.checks(f, found_pivots, bounds) + network_programs.checks(f)


def _solved(f: Functions, rights: Columns) -> tuple[Columns, list[Scalar]]:
    """``M^-1`` times some columns, and the pivots; a column of one 1 is one of M^-1 itself."""
    f.dag.label = "M = L^T D L from the leaves to the root, then back"
    if not f.symmetric:
        return solve_many(f.mass_rows, rights, f.tree.outward, symmetric=False)
    factors = factored(f.mass_rows, f.tree.outward)
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
    """Where a column has its only entry, if that is 1."""
    used = [k for k, x in enumerate(column) if x != 0]
    return used[0] if len(used) == 1 and column[used[0]] == 1 else None


def _turned(rows: Sequence[Sequence[Scalar]]) -> Columns:
    """The columns of a matrix given by rows, or the other way round."""
    return [list(column) for column in zip(*rows, strict=True)]


def _matrix(name: str, columns: Columns, about: str) -> Result:
    rows = _turned(columns)
    entries = tuple(entry for row in rows for entry in row)
    return Result(name, (len(rows), len(columns)), entries, about)
