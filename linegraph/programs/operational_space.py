"""Emitted functions of operational space: the inertia of a frame, and the forces on it [Khatib 1987].

With J the Jacobian of a frame and M v̇ + h = Q, a force F on the frame, Q = Jᵀ F, moves it by

    Λ a + μ = F        Λ = (J M⁻¹ Jᵀ)⁻¹        μ = Λ (J M⁻¹ h - J̇ v)        J̄ = M⁻¹ Jᵀ Λ

With M = Lᵀ D L and y = L⁻ᵀ r for each right-hand side r, J M⁻¹ Jᵀ and J M⁻¹ h are products of the y, so
that only the columns of J̄ are substituted back. With constraints, everything is written in independent
velocities w, v = T w: J T replaces J, TᵀMT replaces M, and J̄ returns to v by T.
"""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, NamedTuple

from linegraph.algebra.factorization import Factors, factored
from linegraph.dynamics.regularity import SINGULAR
from linegraph.errors import ModelError
from linegraph.ir.dag import Node
from linegraph.ir.program import Argument, Call, Check, Guards, Program, Result, Routine
from linegraph.ir.statuses import counted
from linegraph.kinematics.frame_trees import seat_of, tipped
from linegraph.kinematics.tree_state import TreeState
from linegraph.kinematics.twists import Outlook, columns, matrix
from linegraph.programs import independent as independents
from linegraph.programs import loop_routines, pivots
from linegraph.programs.kinematics import both, shortest

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.frame_trees import NamedFrame
    from linegraph.programs.workspace import Workspace

BAR = "inverse of J, weighted by inertia"
ROWS = {"operational_space": 6, "operational_position": 3}
"""Number of rows of the Jacobian that are used: all, or the linear ones."""

DIRECTIONS = ("along x", "along y", "along z", "about x", "about y", "about z")


def operational_space(f: Workspace) -> tuple[Program | Routine, ...]:
    """Λ, μ and J̄ for all six rows of the Jacobian of each frame that can move in all directions."""
    return _of_frames(f, "operational_space")


def operational_position(f: Workspace) -> tuple[Program | Routine, ...]:
    """Λ, μ and J̄ for the three linear rows: enough for arms with fewer than six joints."""
    return _of_frames(f, "operational_position")


def remarks(f: Workspace, chosen: Iterable[str]) -> tuple[str, ...]:
    """Remarks in the head of a file about frames that lack requested functions.

    Args:
        f: the shared equations.
        chosen: keys of the functions that are made.
    """
    chosen = set(chosen)
    return tuple(
        f'There is no {function} of the frame "{frame.name}": it {problem}.'
        for function in ROWS
        if function in chosen
        for frame in f.frames
        if (problem := _immobile(f, frame, ROWS[function]))
    )


def _of_frames(f: Workspace, function: str) -> tuple[Program, ...]:
    """One function for each frame that can move in all directions; remarks name the other frames.

    Raises:
        ModelError: no frame can, or the model has no such function.
    """
    if not f.frames:
        return ()
    dynamics = _closed(f, function) if f.tree.closed else _open(f, function)
    problems = {frame: _immobile(f, frame, ROWS[function]) for frame in f.frames}
    able = [frame for frame, problem in problems.items() if not problem]
    if not able:
        frame, problem = next(iter(problems.items()))
        fewer = "; operational_position may do" * (function == "operational_space")
        raise ModelError(f'frame "{frame.name}"', f"{problem}: no {function} of it{fewer}")
    return tuple(_operational(f, frame, function, dynamics) for frame in able)


class _Dynamics(NamedTuple):
    """M v̇ + h = Q in coordinates without constraints.

    Attributes:
        places: those of the velocities in v.
        mass, bias: M and h.
        outward: the velocities from the root to the leaves.
        calls: functions that compute M and h, and v from these velocities.
        spread: T of v = T w and the part of v̇ at ẇ = 0, if the velocities w are not all of v.
    """

    places: Sequence[int]
    mass: list[list[Scalar]]
    bias: list[Scalar]
    outward: Sequence[int]
    calls: tuple[Call, ...]
    spread: tuple[list[list[Scalar]], list[Scalar]] | None = None


def _operational(f: Workspace, frame: NamedFrame, function: str, dynamics: _Dynamics) -> Program:
    rows = ROWS[function]
    J, rate = _motion(f, frame, rows, dynamics)
    size = len(dynamics.bias)
    f.dag.label = "M = L^T D L from the leaves to the root"
    factors = factored(dynamics.mass, dynamics.outward)
    reduced = [factors.reduced(right) for right in (*J, dynamics.bias)]
    scaled = [factors.scaled(y) for y in reduced]
    f.dag.label = "J M^-1 J^T and its inverse"
    products = [[_dot(a, b) for b in scaled] for a in reduced[:rows]]
    inner = [row[:rows] for row in products]
    # eliminated row by row, translation first: a zero pivot is the first direction that depends on others
    last_first = range(rows)[::-1]
    known = factored(inner, last_first)
    lam = known.inverse()
    f.dag.label = "forces that keep the frame's velocity"
    pulls = [row[rows] - x for row, x in zip(products, rate, strict=True)]
    mu = [_dot(row, pulls) for row in lam]
    f.dag.label = "M^-1 J^T, back from the root to the leaves"
    solved = [factors.substituted(x) for x in scaled[:rows]]
    bar = [[_dot([x[k] for x in solved], row) for row in lam] for k in range(size)]
    if dynamics.spread is not None:
        bar = _product(dynamics.spread[0], bar)
    results = (
        Result("Lambda", (rows, rows), _flat(lam), f'inertia of "{frame.name}"'),
        Result("mu", (rows,), tuple(mu), "the force on it under which its velocity stays"),
        Result("Jbar", (len(f.v), rows), _flat(bar), BAR, ("NV", "")),
    )
    bounds = [pivots.bound(x, dynamics.mass[i][i]) for i, x in enumerate(factors.pivots)]
    checks = (
        *pivots.checks(f, factors.pivots, bounds, dynamics.places),
        *_checks_of_frame(f, frame, known, inner),
    )
    given = [x for call in dynamics.calls for x in call.arguments if x not in f.head]
    name = f"frame_{frame.identifier}_{function}"
    about = _about(frame, rows, closed=f.tree.closed)
    arguments = tuple(dict.fromkeys(given))
    return f.program(name, about, arguments, results, Guards(checks, dynamics.calls, status=True))


def _about(frame: NamedFrame, rows: int, *, closed: bool) -> str:
    """The description of an emitted function."""
    what = "the frame" if rows == 6 else "the origin of the frame"
    text = (
        f'Operational space of {what} "{frame.name}": Lambda = (J M^-1 J^T)^-1, '
        "mu = Lambda (J M^-1 h - Jdot_v), Jbar = M^-1 J^T Lambda; a force F on it has "
        "Lambda a + mu = F."
    )
    loops = (
        " All on the motions that the constraints allow: J stands for J T, M and h for Mr and hr."
    )
    return text + loops * closed


def _motion(
    f: Workspace, frame: NamedFrame, rows: int, dynamics: _Dynamics
) -> tuple[list[list[Scalar]], list[Scalar]]:
    """J in the coordinates of `dynamics`, and the rate of the frame's velocity at constant w."""
    size = len(f.v)
    keys = [(result, frame.identifier) for result in ("jacobian", "jacobian_dot_v")]
    flat, rate = shortest(both(f, (frame,)), keys).values()
    J = [list(flat[i * size : (i + 1) * size]) for i in range(rows)]
    if dynamics.spread is None:
        return J, list(rate[:rows])
    T, rest = dynamics.spread
    return _product(J, T), [x + _dot(row, rest) for x, row in zip(rate[:rows], J, strict=True)]


def _open(f: Workspace, function: str) -> _Dynamics:
    """M and h of a tree, from `equations`.

    Raises:
        ModelError: the mass matrix is not symmetric.
    """
    if not f.symmetric:
        raise _refused(f, function, "its controlled sources make the mass matrix unsymmetric")
    size = len(f.v)
    local = (Argument("M", size * size, "mass matrix"), Argument("h", size, "bias"))
    made = f.program("equations", "", ("q", "v"), (f.mass_result, f.bias_beside_mass))
    call = Call("equations", tuple(argument.name for argument in made.arguments), local)
    mass: list[list[Scalar]] = [
        [f.dag.symbol("M", i * size + j) if used else 0 for j, used in enumerate(row)]
        for i, row in enumerate(f.pattern)
    ]
    bias = _vector(f, "h", size)
    return _Dynamics(range(size), mass, bias, f.tree.outward, (call,))


def _closed(f: Workspace, function: str) -> _Dynamics:
    """M and h with constraints, from `reduction` and `reduced_equations`.

    Raises:
        ModelError: the equations are not reduced, or there are too few independent velocities.
    """
    made = {program.name: program for program in loop_routines.reduction(f)}
    if not made:
        problem = "it has constraints, and its equations are not reduced to independent coordinates"
        raise _refused(f, function, problem)
    places = [v for _, v in independents.independent(f)]
    k, n, rows = len(places), len(f.v), ROWS[function]
    if k < rows:
        left = "1 independent velocity" if k == 1 else f"{k} independent velocities"
        problem = f"its constraints leave {left}, fewer than the {rows} rows"
        raise _refused(f, function, problem)
    local = {
        "reduction": (Argument("T", n * k, "v for unit w"), Argument("rest", n, "rest of vdot")),
        "reduced_equations": (Argument("Mr", k * k, "mass matrix"), Argument("hr", k, "bias")),
    }
    calls = tuple(
        Call(name, tuple(argument.name for argument in made[name].arguments), arrays)
        for name, arrays in local.items()
    )
    spread = _matrix(f, "T", n, k), _vector(f, "rest", n)
    mass, bias = _matrix(f, "Mr", k, k), _vector(f, "hr", k)
    return _Dynamics(places, mass, bias, range(k), calls, spread)


def _refused(f: Workspace, function: str, problem: str) -> ModelError:
    return ModelError(
        f'model "{f.tree.system.name}"', f"{problem}: {function} cannot be emitted for it"
    )


def _checks_of_frame(
    f: Workspace, frame: NamedFrame, known: Factors, inner: list[list[Scalar]]
) -> list[Check]:
    checks = []
    for i, pivot in enumerate(known.pivots):
        if isinstance(pivot, Node):
            bound = pivots.bound(pivot, inner[i][i])
            about = f'the frame "{frame.name}" cannot move {DIRECTIONS[i]} by itself here'
            name = f"IMMOBILE_{frame.identifier}_{DIRECTIONS[i].replace(' ', '_')}"
            fraction = None if bound == 0 else SINGULAR
            number = counted(len(f.v) + 6 * f.frames.index(frame) + i)
            checks.append(Check(pivot, bound, number, about, name, fraction))
    return checks


def _immobile(f: Workspace, frame: NamedFrame, rows: int) -> str:
    """Why a frame cannot move in all directions at any state, judged at random states; "" if it can.

    The message names the first direction that depends on those before it.
    """
    tree = f.derivation.sample
    way = tipped(tree, [seat_of(tree, frame.name)], masses=False)
    failures: list[int] = []
    for seed in (1, 2):
        draw = random.Random(seed)
        q = [draw.uniform(-1, 1) for _ in tree.positions]
        tree.normalise(q)
        rest = [0.0] * len(tree.velocities)
        view = Outlook(TreeState(way.tree, q, rest))
        row = _dependent(matrix(columns(view, way.tips[0]), len(rest))[:rows])
        if row is None:
            return ""
        failures.append(row)
    return f"cannot move {DIRECTIONS[max(failures)]} by itself at any position"


def _dependent(rows: Sequence[Sequence[float]]) -> int | None:
    """The first row that depends on those before it, by Gram-Schmidt with reorthogonalisation; else None."""
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


def _product(a: Sequence[Sequence[Scalar]], b: Sequence[Sequence[Scalar]]) -> list[list[Scalar]]:
    columns = list(zip(*b, strict=True))
    return [[_dot(row, column) for column in columns] for row in a]


def _matrix(f: Workspace, name: str, rows: int, columns: int) -> list[list[Scalar]]:
    """A local array of a program, as rows."""
    return [[f.dag.symbol(name, i * columns + j) for j in range(columns)] for i in range(rows)]


def _vector(f: Workspace, name: str, size: int) -> list[Scalar]:
    return [f.dag.symbol(name, i) for i in range(size)]


def _flat(rows: Sequence[Sequence[Scalar]]) -> tuple[Scalar, ...]:
    return tuple(x for row in rows for x in row)
