"""Emitted functions of systems with constraints: φ, J, γ, and what solves for motion and multipliers."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.components.parameters import resolver
from linegraph.dynamics.circuit_lengths import sizes
from linegraph.errors import ModelError
from linegraph.ir.program import (
    Argument,
    Guards,
    Listing,
    Program,
    Quantity,
    Result,
    Routine,
    reads,
)
from linegraph.ir.statuses import (
    CONTRADICTION,
    NO_VELOCITY,
    NOT_CLOSED,
    NOT_DETERMINED,
    SINGULAR_INERTIA,
    SINGULAR_POSITION,
)
from linegraph.kinematics.state_layout import has_plain_rates
from linegraph.numeric.loop_closure import at_some_time
from linegraph.programs import networks as network_programs

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.ir.program import Status
    from linegraph.numeric.assembly import Assembly
    from linegraph.programs.workspace import Workspace


def constraints(f: Workspace) -> tuple[Program | Routine, ...]:
    """φ, J, J v - b, γ, and everything at once."""
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
    """What makes J a matrix of pure numbers."""
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


def forward_dynamics(f: Workspace) -> tuple[Routine, ...]:
    """v̇ and λ, by elimination of J with complete pivoting: redundant constraints drop out."""
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
    """Q and v onto the constraints."""
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
    """The mechanism in its independent coordinates alone."""
    chosen = independent(f) if f.tree.closed else None
    if not chosen or f.tree.network is not None:
        return ()  # states of networks are no coordinates to reduce to
    n, k = len(f.v), len(chosen)
    guess = "q, a guess of all coordinates near the position wanted, "
    complete = routine(
        f,
        "complete",
        f"All of q and v from the independent coordinates s and their rates w: Newton from {guess}"
        "which decides between several ways to assemble.",
        ("q", "s", "w"),
        (
            Result("q_on", (len(f.q),), (), "coordinates"),
            Result("v_on", (n,), (), "velocities"),
        ),
        Algorithm(
            "complete",
            (NOT_CLOSED, NOT_DETERMINED),
            (
                *_phi_calls(f),
                "constraint_jacobian",
                "constraint_rates",
                "constraint_sizes",
                "coordinate_rates",
            ),
        ),
    )
    tangent = routine(
        f,
        "reduction",
        "Velocities and accelerations from the independent ones: v = T w (+ what is prescribed), "
        "vdot = T wdot + rest.",
        ("q", "v"),
        (
            Result("T", (n, k), (), "all velocities for unit w"),
            Result("rest", (n,), (), "vdot at wdot = 0"),
        ),
        Algorithm(
            "reduction",
            (NOT_DETERMINED,),
            (
                *_phi_calls(f),
                "constraint_jacobian",
                "constraint_rates",
                "constraint_bias",
                "constraint_sizes",
                "coordinate_rates",
            ),
        ),
    )
    reduced = routine(
        f,
        "reduced_equations",
        "Equations of motion in the independent coordinates, Mr wdot + hr = T^T Q: Mr = T^T M T, "
        "hr = T^T (h + M rest).",
        ("q", "v"),
        (Result("Mr", (k, k), (), "reduced mass matrix"), Result("hr", (k,), (), "reduced bias")),
        Algorithm("reduced_equations", (NOT_DETERMINED,), ("equations", "reduction")),
    )
    return complete, tangent, reduced


def _phi_calls(f: Workspace) -> tuple[str, ...]:
    return ("constraints",) if _positions(f) else ()


def independent(f: Workspace) -> list[tuple[int, int]]:
    """(position, velocity) of each independent coordinate, as chosen or as the assembly found them.

    Raises:
        ModelError: a chosen one does not exist, or is none whose rate is its velocity.
    """
    wanted = f.tree.system.choices.independent
    pairs = _plain_pairs(f)
    if wanted is None:
        found = assembly(f).independent
        chosen = [(pairs[v], v) for v in found if v in pairs]
        return chosen if len(chosen) == assembly(f).freedoms else []
    names = {quantity.name: k for k, quantity in enumerate(f.tree.velocities)}
    for name in wanted:
        if name not in names or names[name] not in pairs:
            known = ", ".join(n for n, k in names.items() if k in pairs)
            problem = (
                f'independent: "{name}" is no coordinate of this tree with its rate as velocity; '
                f"known: {known}"
            )
            raise ModelError("formulation", problem)
    for name in wanted:
        if wanted.count(name) > 1:
            raise ModelError("formulation", f'independent: "{name}" is named twice')
    if len(wanted) != assembly(f).freedoms:
        problem = (
            f"independent: {len(wanted)} coordinates for {assembly(f).freedoms} degrees of freedom"
        )
        raise ModelError("formulation", problem)
    return [(pairs[names[name]], names[name]) for name in wanted]


def _plain_pairs(f: Workspace) -> dict[int, int]:
    """The position of each velocity that is its derivative."""
    return {
        v.index: q.index
        for link in f.tree.links
        if has_plain_rates(link.joint)
        for q, v in zip(link.place.positions, link.velocities, strict=True)
        if q.ratio == 1 and q.offset == 0
    }


def assembly(f: Workspace) -> Assembly:
    """What the constraints are worth: found once for all functions."""
    return f.derivation.assembled


def listings(f: Workspace, chosen: Sequence[str]) -> tuple[Listing, ...]:
    """Constraints with their multipliers, and the independent coordinates."""
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
    """How many constraints are of position, and how many are independent."""
    if not f.tree.closed:
        return ()
    return (("NP", _positions(f)), ("RANK", assembly(f).rank))


class Algorithm(NamedTuple):
    """How a function that iterates or decides works.

    Attributes:
        name: of its algorithm.
        statuses: what it may report.
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
    """A routine; it takes the inputs too where what it calls does."""
    # a motion prescribed by input is in M and h
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
        ("quaternions", _quaternions(f)),
        ("mechanical", f.tree.layout.mechanical),
        ("baumgarte", f.tree.system.choices.baumgarte is not None),
        ("position_rank", assembly(f).position_rank),
        ("s_at", tuple(q for q, _ in chosen)),
        ("w_at", tuple(v for _, v in chosen)),
    )
    return Routine(name, about, given, results, *algorithm, details)


def _quaternions(f: Workspace) -> tuple[int, ...]:
    """Where quaternions begin in q."""
    return tuple(places[0] for places in f.tree.quaternions)


def _positions(f: Workspace) -> int:
    return sum(equation.holonomic for equation in f.constraint_equations)


def _phi(f: Workspace) -> Result:
    return _column("phi", f.constraints, "constraints of position")


def _jacobian(f: Workspace) -> Result:
    rows = f.jacobian
    entries = tuple(entry for row in rows for entry in row)
    return Result("J", (len(rows), len(f.v)), entries, "Jacobian of the constraints")


def _stabilised(f: Workspace) -> list[Scalar]:
    """γ, less what brings errors of position and velocity back: 2 alpha (J v - b) + beta² φ."""
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


def _baumgarte_text(f: Workspace) -> str:
    if f.tree.system.choices.baumgarte is None:
        return ""
    return " Errors of position and velocity die out: Baumgarte's terms are part of gam."


def _column(name: str, entries: Iterable[Scalar], about: str) -> Result:
    found = tuple(entries)
    return Result(name, (len(found),), found, about)
