"""Functions of systems with constraints that iterate: dynamics, projection, independent coordinates."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.errors import ModelError
from linegraph.ir.program import Argument, Result, Routine, reads
from linegraph.ir.statuses import (
    CONTRADICTION,
    NO_VELOCITY,
    NOT_CLOSED,
    NOT_DETERMINED,
    SINGULAR_INERTIA,
    SINGULAR_POSITION,
)
from linegraph.programs.independent import assembly, independent

if TYPE_CHECKING:
    from linegraph.ir.program import Program, Status
    from linegraph.programs.workspace import Workspace


def forward_dynamics(f: Workspace) -> tuple[Routine, ...]:
    """v̇ and λ, by elimination of J with complete pivoting, which leaves redundant constraints out."""
    if not f.symmetric:
        problem = (
            "its controlled sources make the mass matrix unsymmetric, which cannot be solved together "
            "with closed loops yet"
        )
        raise ModelError(f'model "{f.tree.system.name}"', problem)
    results = (
        Result("a", (len(f.v),), (), "accelerations, the derivatives of v"),
        Result(
            "lam",
            (len(f.constraint_equations),),
            (),
            "multipliers; where not unique, those of least norm",
        ),
    )
    about = (
        "Forward dynamics with constraints: M a + h = Q(u) + J^T lam, J a = gam."
        f"{_baumgarte_text(f)}"
    )
    statuses = (SINGULAR_POSITION, SINGULAR_INERTIA, CONTRADICTION)
    calls = (
        "constrained_equations",
        *_phi_calls(f),
        "constraint_rates",
        "constraint_bias",
        "constraint_sizes",
        "coordinate_rates",
    )
    return (
        routine(
            f,
            "forward_dynamics",
            about,
            ("q", "v", "u"),
            results,
            Algorithm("constrained_dynamics", statuses, calls),
        ),
    )


def project(f: Workspace) -> tuple[Program | Routine, ...]:
    """The function that projects q and v onto the constraints."""
    if not f.tree.closed:
        return ()
    results = (
        Result("q_on", (len(f.q),), (), "coordinates that satisfy the constraints"),
        Result("v_on", (len(f.v),), (), "velocities that satisfy them"),
    )
    about = (
        "Bring q and v onto the constraints by Newton's method, along the directions that take the least "
        "kinetic energy; quaternions get length 1."
    )
    calls = (
        "mass_matrix",
        *_phi_calls(f),
        "constraint_jacobian",
        "constraint_rates",
        "constraint_sizes",
    )
    return (
        routine(
            f,
            "project",
            about,
            ("q", "v"),
            results,
            Algorithm("project", (NOT_CLOSED, NO_VELOCITY), (*calls, "coordinate_rates")),
        ),
    )


def reduction(f: Workspace) -> tuple[Program | Routine, ...]:
    """Functions in the independent coordinates: completion, the tangent map T, and reduced equations."""
    chosen = independent(f) if f.tree.closed else None
    if not chosen or f.tree.network is not None:
        return ()  # states of networks cannot be eliminated with the coordinates
    return _complete(f), _tangent(f, len(chosen)), _reduced(f, len(chosen))


def _complete(f: Workspace) -> Routine:
    """The function that completes q and v from the independent ones."""
    guess = "q, a guess of all coordinates near the position wanted, "
    calls = (
        *_phi_calls(f),
        "constraint_jacobian",
        "constraint_rates",
        "constraint_sizes",
        "coordinate_rates",
    )
    return routine(
        f,
        "complete",
        f"All of q and v from the independent coordinates s and their rates w: Newton from {guess}"
        "which decides between several ways to assemble.",
        ("q", "s", "w"),
        (
            Result("q_on", (len(f.q),), (), "coordinates"),
            Result("v_on", (len(f.v),), (), "velocities"),
        ),
        Algorithm("complete", (NOT_CLOSED, NOT_DETERMINED), calls),
    )


def _tangent(f: Workspace, count: int) -> Routine:
    """The function for T and rest: velocities and accelerations from the independent ones."""
    calls = (
        *_phi_calls(f),
        "constraint_jacobian",
        "constraint_rates",
        "constraint_bias",
        "constraint_sizes",
        "coordinate_rates",
    )
    return routine(
        f,
        "reduction",
        "Velocities and accelerations from the independent ones: v = T w (+ what is prescribed), "
        "vdot = T wdot + rest.",
        ("q", "v"),
        (
            Result("T", (len(f.v), count), (), "all velocities for unit w"),
            Result("rest", (len(f.v),), (), "vdot at wdot = 0"),
        ),
        Algorithm("reduction", (NOT_DETERMINED,), calls),
    )


def _reduced(f: Workspace, count: int) -> Routine:
    """The function for the equations of motion in the independent coordinates."""
    return routine(
        f,
        "reduced_equations",
        "Equations of motion in the independent coordinates, Mr wdot + hr = T^T Q: Mr = T^T M T, "
        "hr = T^T (h + M rest).",
        ("q", "v"),
        (
            Result("Mr", (count, count), (), "reduced mass matrix"),
            Result("hr", (count,), (), "reduced bias"),
        ),
        Algorithm("reduced_equations", (NOT_DETERMINED,), ("equations", "reduction")),
    )


class Algorithm(NamedTuple):
    """The algorithm of a function that iterates or branches.

    Attributes:
        name: of the algorithm.
        statuses: the status codes it may return.
        calls: the functions it calls.
    """

    name: str
    statuses: tuple[Status, ...]
    calls: tuple[str, ...]


def routine(
    f: Workspace,
    name: str,
    about: str,
    arguments: tuple[str, ...],
    results: tuple[Result, ...],
    algorithm: Algorithm,
) -> Routine:
    """A function that iterates or branches; it takes the inputs too if a function that it calls does.

    Args:
        f: the shared equations.
        name: of the function.
        about: its description.
        arguments: names of its arguments after parameters and time.
        results: its results.
        algorithm: its algorithm.
    """
    # motions prescribed by input enter M and h
    moved = (
        (f.mass_result, f.bias_result) if {"mass_matrix", "equations"} & {*algorithm.calls} else ()
    )
    if (f.driven_constraints or reads("u", moved)) and "u" not in arguments:
        place = sum(argument in ("q", "v", "s", "w") for argument in arguments)
        arguments = (*arguments[:place], "u", *arguments[place:])
    chosen = independent(f)
    sizes = {**f.sizes, "s": len(chosen), "w": len(chosen)}
    texts = {"s": "independent coordinates", "w": "their rates"}
    given = tuple(
        Argument(argument, sizes.get(argument), texts.get(argument) or f.texts[argument])
        for argument in (*f.head, *arguments)
    )
    details = (
        ("quaternions", tuple(places[0] for places in f.tree.quaternions)),
        ("mechanical", f.tree.layout.mechanical),
        ("baumgarte", f.tree.system.choices.baumgarte is not None),
        ("position_rank", assembly(f).position_rank),
        ("s_at", tuple(q for q, _ in chosen)),
        ("w_at", tuple(v for _, v in chosen)),
    )
    return Routine(name, about, given, results, *algorithm, details)


def _phi_calls(f: Workspace) -> tuple[str, ...]:
    holonomic = any(equation.holonomic for equation in f.constraint_equations)
    return ("constraints",) if holonomic else ()


def _baumgarte_text(f: Workspace) -> str:
    if f.tree.system.choices.baumgarte is None:
        return ""
    return " Errors of position and velocity die out: Baumgarte's terms are part of gam."
