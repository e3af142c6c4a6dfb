"""Emitted functions of operational space: the inertia that a frame has, and the forces that belong to it.

With J the Jacobian of a frame and M v̇ + h = Q, a force F on the frame, Q = Jᵀ F, moves it by

    Λ a + μ = F        Λ = (J M⁻¹ Jᵀ)⁻¹        μ = Λ (J M⁻¹ h - J̇ v)        J̄ = M⁻¹ Jᵀ Λ

With M = Lᵀ D L and y = L⁻ᵀ r of each right-hand side, J M⁻¹ Jᵀ and J M⁻¹ h are products of the y, so that
only the columns of J̄ are substituted back.
"""

from __future__ import annotations

import random
from typing import TYPE_CHECKING

from linegraph.algebra import Floats
from linegraph.errors import ModelError
from linegraph.expression import Node
from linegraph.factorization import Reduced, reduce, substituted
from linegraph.kinematic_programs import both, shortest
from linegraph.orthogonality import arms
from linegraph.parameters import resolver, sample_values
from linegraph.program import Argument, Call, Check, Program, Result, Routine
from linegraph.regularity import SINGULAR, sample_tree
from linegraph.tips import seat_of, tipped
from linegraph.twists import Outlook, columns, matrix

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.shared import Functions
    from linegraph.tips import NamedFrame
    from linegraph.vector import Scalar

DIRECTIONS = ("along x", "along y", "along z", "about x", "about y", "about z")


def operational_space(f: Functions) -> tuple[Program | Routine, ...]:
    """Λ, μ and J̄ of all six rows of each frame's Jacobian."""
    return tuple(_operational(f, frame, "operational_space", 6) for frame in f.frames)


def operational_position(f: Functions) -> tuple[Program | Routine, ...]:
    """The same of the three linear rows: what an arm of few joints can move."""
    return tuple(_operational(f, frame, "operational_position", 3) for frame in f.frames)


def _operational(f: Functions, frame: NamedFrame, function: str, rows: int) -> Program:
    _require_open(f, function)
    _require_rank(f, frame, function, rows)
    size = len(f.v)
    keys = [(result, frame.identifier) for result in ("jacobian", "jacobian_dot_v")]
    flat, rate = shortest(both(f, (frame,)), keys).values()
    J = [flat[i * size : (i + 1) * size] for i in range(rows)]
    call = _equations(f)
    h = [f.dag.symbol("h", i) for i in range(size)]
    M = [
        [f.dag.symbol("M", i * size + j) if used else 0 for j, used in enumerate(row)]
        for i, row in enumerate(f.pattern)
    ]
    f.dag.label = "M = L^T D L from the leaves to the root"
    outward = f.tree.outward
    reduced = reduce(M, [*J, h], outward)
    f.dag.label = "J M^-1 J^T and its inverse"
    products = [[_dot(a, b) for b in reduced.scaled] for a in reduced.rights[:rows]]
    inner = [row[:rows] for row in products]
    last_first = range(rows)[::-1]
    known = reduce(inner, _unit(rows), last_first)
    inverse = [substituted(known, column, last_first) for column in known.scaled]
    lam = [[inverse[max(i, j)][min(i, j)] for j in range(rows)] for i in range(rows)]
    f.dag.label = "forces at rest of the frame"
    pulls = [row[rows] - x for row, x in zip(products, rate[:rows], strict=True)]
    mu = [_dot(row, pulls) for row in lam]
    f.dag.label = "J M^-1, back from the root to the leaves"
    solved = [substituted(reduced, x, outward) for x in reduced.scaled[:rows]]
    bar = [[_dot([x[k] for x in solved], row) for row in lam] for k in range(size)]
    results = (
        Result("Lambda", (rows, rows), _flat(lam), f'inertia of "{frame.name}"'),
        Result("mu", (rows,), tuple(mu), "forces that keep it from accelerating without others"),
        Result("Jbar", (size, rows), _flat(bar), "inverse of J that inertia weighs"),
    )
    what = "the frame" if rows == 6 else "the origin of the frame"
    about = (
        f'Operational space of {what} "{frame.name}": Lambda = (J M^-1 J^T)^-1, '
        "mu = Lambda (J M^-1 h - Jdot_v), Jbar = M^-1 J^T Lambda; a force F on it has "
        "Lambda a + mu = F."
    )
    given = tuple(x for x in call.arguments if x not in f.head)
    name = f"frame_{frame.identifier}_{function}"
    checks = (*_checks_of_mass(f, reduced, M), *_checks_of_frame(f, frame, known, inner))
    return f.program(name, about, given, results, checks, (call,), status=True)


def _equations(f: Functions) -> Call:
    """The call for M and h."""
    size = len(f.v)
    local = (Argument("M", size * size, "mass matrix"), Argument("h", size, "bias"))
    made = f.program("equations", "", ("q", "v"), (f.mass_matrix, f.bias_beside_mass))
    return Call("equations", tuple(argument.name for argument in made.arguments), local)


def _checks_of_mass(f: Functions, reduced: Reduced, M: list[list[Scalar]]) -> list[Check]:
    checks = []
    for i, pivot in enumerate(reduced.pivots):
        # what a network stores may be negative; inertia may not
        stored = i >= f.tree.layout.mechanical
        size = f.dag.function("abs", pivot) if stored else pivot
        if isinstance(size, Node):
            bound = 0 if stored or pivot is M[i][i] else SINGULAR * M[i][i]
            about = f"the mass matrix is singular at {f.tree.velocities[i].name}"
            checks.append(Check(size, bound, i + 1, about))
    return checks


def _checks_of_frame(
    f: Functions, frame: NamedFrame, known: Reduced, inner: list[list[Scalar]]
) -> list[Check]:
    checks = []
    for i, pivot in enumerate(known.pivots):
        if isinstance(pivot, Node):
            bound = SINGULAR * inner[i][i]
            about = f'the frame "{frame.name}" cannot move {DIRECTIONS[i]} by itself here'
            checks.append(Check(pivot, bound, len(f.v) + i + 1, about))
    return checks


def _require_open(f: Functions, function: str) -> None:
    """Refuse where M alone does not say how a frame is moved.

    Raises:
        ModelError: there are constraints, or the mass matrix is not symmetric.
    """
    problem = ""
    if f.tree.closed:
        problem = (
            "the inertia of a frame depends on its loops and constraints, which are left out there"
        )
    if not f.symmetric:
        problem = "its controlled sources make the mass matrix unsymmetric"
    if problem:
        raise ModelError(
            f'model "{f.model.name}"', f"{problem}: {function} cannot be emitted for it"
        )


def _require_rank(f: Functions, frame: NamedFrame, function: str, rows: int) -> None:
    """Refuse a frame that cannot move in all directions wherever it is, judged at random states.

    Raises:
        ModelError: names the first direction that depends on those before it.
    """
    algebra = Floats(t=0.37, u=[0.1 + 0.07 * i for i in range(len(f.tree.inputs))])
    tree = sample_tree(f.model, f.derivation.formulation)
    values = sample_values(f.model.parameters.values(), algebra)
    seat = seat_of(f.model, tree, resolver(algebra, values), frame.name)
    way = tipped(tree, [seat], masses=False)
    failures: list[int] = []
    for seed in (1, 2):
        draw = random.Random(seed)
        q = [draw.uniform(-1, 1) for _ in tree.positions]
        tree.normalise(q)
        rest = [0.0] * len(tree.velocities)
        view = Outlook(way.tree, algebra, arms(way.tree, algebra, q, rest))
        row = _dependent(matrix(columns(view, way.tips[0]), len(rest))[:rows])
        if row is None:
            return
        failures.append(row)
    fewer = "; operational_position may do" * (rows == 6)
    problem = (
        f"cannot move {DIRECTIONS[max(failures)]} by itself at any position: {function} has no "
        f"inverse{fewer}"
    )
    raise ModelError(f'frame "{frame.name}"', problem)


def _dependent(rows: Sequence[Sequence[float]]) -> int | None:
    """The first row that depends on those before it; None if there is none."""
    kept: list[list[float]] = []
    for i, row in enumerate(rows):
        rest = [float(x) for x in row]
        for unit in (*kept, *kept):
            along = _dot(rest, unit)
            rest = [x - along * y for x, y in zip(rest, unit, strict=True)]
        length = _dot(rest, rest) ** 0.5
        if not length > 1e-9 * max(1e-9, _dot(row, row) ** 0.5):
            return i
        kept.append([x / length for x in rest])
    return None


def _dot(a: Sequence[Scalar], b: Sequence[Scalar]) -> Scalar:
    found: Scalar = 0
    for x, y in zip(a, b, strict=True):
        found = found + x * y
    return found


def _unit(size: int) -> list[list[Scalar]]:
    return [[int(i == j) for j in range(size)] for i in range(size)]


def _flat(rows: Sequence[Sequence[Scalar]]) -> tuple[Scalar, ...]:
    return tuple(x for row in rows for x in row)
