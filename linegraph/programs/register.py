"""The register of emitted functions: the derivation over the expression DAG, cut into functions."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from linegraph.algebra.factorization import Solution, solve
from linegraph.dynamics.articulated import forward_dynamics
from linegraph.dynamics.potentials import unknown
from linegraph.dynamics.regularity import is_solid
from linegraph.errors import ModelError
from linegraph.ir.program import Argument, Call, Guards, Module, Program, Quantity, Result, Routine
from linegraph.ir.prologue import COUNT, with_prologue
from linegraph.ir.sums import with_sums_collected
from linegraph.programs import derivatives as derivative_programs
from linegraph.programs import division, extents, loop_routines, pivots
from linegraph.programs import edges as edge_programs
from linegraph.programs import identification as parameter_programs
from linegraph.programs import kinematics as kinematic_programs
from linegraph.programs import loop_remarks as closed_remarks
from linegraph.programs import loops as closed_programs
from linegraph.programs import networks as network_programs
from linegraph.programs import operational_space as operational_programs
from linegraph.programs.family import Family
from linegraph.programs.request import Request
from linegraph.programs.workspace import ARGUMENTS, Workspace

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from linegraph.algebra.scalar import Scalar
    from linegraph.model.system import System
    from linegraph.networks import Network
    from linegraph.numeric.derived import Derived
    from linegraph.programs.division import Made


EVERYTHING = Request()
"""All functions that are made by default, with parameters as symbols."""


def module_of(
    derivation: Derived,
    name: str,
    request: Request = EVERYTHING,
    about: Iterable[str] = (),
) -> Module:
    """All requested functions of a model, with names, counts and remarks for their file.

    Args:
        derivation: the model with its graph and trees.
        name: prefix of everything emitted; an identifier.
        request: which functions, and in which form.
        about: paragraphs for the head of the file.

    Raises:
        ModelError: a parameter has no value, a closed model cannot be assembled, or a requested
            function does not exist for the model.
    """
    parameters = parameters_of(derivation)
    asked = _asked(request)
    functions = Workspace(derivation, request.folded or not parameters, request.frames, asked)
    made, omitted = _made(functions, [key for key in PROGRAMS if key in asked])
    _require_made(derivation, dict.fromkeys((*request.only, *request.wanted)), made)
    chosen = [key for key in PROGRAMS if key in made]
    programs = tuple(program for key in chosen for program in made[key])
    functions.dag.release()
    hoisted = request.prologue and "p" in functions.head
    programs, constants = with_prologue(programs) if hoisted else (with_sums_collected(programs), 0)
    tree = functions.tree
    module = Module(
        name=name,
        about=(
            *about,
            *(x for family in FAMILIES for x in family.remarks(functions, chosen)),
            *division.remarks(functions, omitted),
        ),
        positions=tree.positions,
        velocities=tree.velocities,
        inputs=tree.inputs,
        parameters=() if request.folded else parameters,
        time=derivation.system.depends_on_time,
        programs=programs,
        listings=tuple(x for family in FAMILIES for x in family.listings(functions, chosen)),
        counts=(
            *(x for family in FAMILIES for x in family.counts(functions, chosen)),
            *([(COUNT, constants)] if constants else []),
        ),
        omitted=omitted,
    )
    return extents.named(module)


def _require_made(derivation: Derived, keys: Iterable[str], made: Mapping[str, Made]) -> None:
    """Refuse functions that are requested by name but cannot be made.

    Raises:
        ModelError: some divide by M, which is singular; or the model has nothing of the kind.
    """
    keys = list(keys)
    divided = [key for key in keys if key not in made]
    if divided:
        raise derivation.no_inverse(divided)
    for key in keys:
        if not made[key]:
            frame = "; name a frame (--frame)" * (key in OF_FRAMES)
            problem = f"is none of this model: it has nothing of the kind{frame}"
            raise ModelError(f'function "{key}"', problem)


def _asked(request: Request) -> tuple[str, ...]:
    """The keys of `PROGRAMS` that are requested."""
    wanted, only, frames = request.wanted, request.only, request.frames
    if not only:
        asked = (*(set(PROGRAMS) - set(ON_REQUEST)), *wanted)
        return (*asked, *kinematic_programs.besides(asked, frames))
    asked = (*only, *wanted)
    if frames and not {"kinematics", *OF_FRAMES} & set(asked):
        problem = f"nothing of it is asked for: {', '.join(OF_FRAMES)} or kinematics would be"
        raise ModelError(f'frame "{frames[0].name}"', problem)
    return asked


def _made(functions: Workspace, keys: Iterable[str]) -> tuple[dict[str, Made], tuple[str, ...]]:
    """The functions for some keys of `PROGRAMS` and for those that they call; then the keys left out.

    A key that has lost all of its functions is missing from the result.
    """
    keys = list(keys)
    barred = division.barred(functions)
    made = {key: PROGRAMS[key](functions) for key in keys if key not in barred}
    omitted = [key for key in keys if key in barred]
    while True:
        programs = [program for found in made.values() for program in found]
        called = {name for program in programs for name in division.called(program)}
        missing = called - {program.name for program in programs}
        if not missing:
            return made, tuple(dict.fromkeys(omitted))
        if barred & missing:
            made, lost = division.without(made, barred)
            omitted += lost
            barred |= {*lost, *(key for key in keys if key not in made)}
            continue
        others = [key for key in PROGRAMS if key not in made and key not in (*ON_REQUEST, *barred)]
        for key in [key for key in others if key in missing] or others:
            found = PROGRAMS[key](functions)
            if missing & {program.name for program in found}:
                made[key] = found
                break
        else:
            raise LookupError(f"no function of the register makes {', '.join(sorted(missing))}")


def _mass_matrix(f: Workspace) -> Program:
    return f.program("mass_matrix", "Mass matrix M(q).", ("q",), (f.mass_result,))


def _bias(f: Workspace) -> Program:
    about = "Bias h(q, v): gravity, Coriolis and centrifugal terms."
    return f.program("bias", about, ("q", "v"), (f.bias_result,))


def _equations(f: Workspace) -> Program:
    about = "Mass matrix M(q) and bias h(q, v) at once, sharing work."
    return f.program("equations", about, ("q", "v"), (f.mass_result, f.bias_beside_mass))


def _inverse_dynamics(f: Workspace) -> Program:
    tau = f.inverse_dynamics(f.symbols("a"))
    result = Result("tau", (len(tau),), tuple(tau), "generalised forces along v")
    about = "Inverse dynamics tau = M(q) a + h(q, v), without forming M."
    return f.program("inverse_dynamics", about, ("q", "v", "a"), (result,))


def _forward_dynamics(f: Workspace) -> Program:
    """Forward dynamics by a factored mass matrix or by articulated inertias, whichever is cheaper.

    If all bodies are solid, M cannot become singular, so articulated inertias need no scale to judge
    pivots by. If some link is not solid at the default parameters, only the factors of M can judge.
    """
    solid = all(map(is_solid, f.derivation.sample.links))
    if f.armatures is None or f.tree.coupled or f.tree.levelled or not solid:
        return _factored(f)
    articulated = _articulated(f)
    if not f.tree.links or articulated.operations < _factored_cost(f):
        return articulated
    return _factored(f)


def _articulated(f: Workspace) -> Program:
    """Links by articulated inertias, networks by their own block of the mass matrix."""
    total = [effort + load for effort, load in zip(f.driving, f.along(f.carried), strict=True)]
    solution = forward_dynamics(f.working, total, f.armatures or {})
    first, size = f.tree.layout.mechanical, len(f.v) - f.tree.layout.mechanical
    rows: list[list[Scalar]] = [[0] * size for _ in range(size)]
    for i, j, entry in f.stored:
        if i >= first:
            rows[i - first][j - first] = rows[i - first][j - first] + entry
    f.dag.label = "network, rates of its states"
    beside = solve(rows, total[first:], range(size), symmetric=f.symmetric)
    whole = Solution(
        [*solution.unknowns[:first], *beside.unknowns],
        [*solution.pivots[:first], *beside.pivots],
    )
    bounds: list[Scalar] = [0] * first
    bounds += [pivots.bound(pivot, rows[k][k]) for k, pivot in enumerate(beside.pivots)]
    return _solved(f, whole, bounds, ())


def _factored(f: Workspace) -> Program:
    """Call `equations` for M and h, then factor M = Lᵀ D L in straight-line code.

    Eliminating from the leaves keeps the zeros of M [Featherstone 2008, sec. 6.5]. If adding h and Q
    would lose digits, only M is called for.
    """
    size = len(f.v)
    f.dag.label = "right-hand side Q - h"
    held = [f.dag.symbol("h", i) for i in range(size)] if f.affine else f.held
    right = [effort - h for effort, h in zip(f.driving, held, strict=True)]
    f.dag.label = "M = L^T D L from the leaves to the root, then back"
    rows = [
        [f.dag.symbol("M", i * size + j) if used else 0 for j, used in enumerate(row)]
        for i, row in enumerate(f.pattern)
    ]
    solution = solve(rows, right, f.tree.outward, symmetric=f.symmetric)
    local = (Argument("M", size * size, "mass matrix"), Argument("h", size, "bias vector"))
    called = _equations(f) if f.affine else _mass_matrix(f)
    names = tuple(argument.name for argument in called.arguments)
    bounds = [pivots.bound(pivot, rows[i][i]) for i, pivot in enumerate(solution.pivots)]
    call = Call(called.name, names, local[: len(called.results)])
    return _solved(f, solution, bounds, (call,))


def _factored_cost(f: Workspace) -> int:
    """Operations of `equations` and of `_factored`: p(p+1) + 5p + 3 for p couplings towards the root."""
    place = {k: n for n, k in enumerate(f.tree.outward)}
    inward = [
        sum(used and place[j] < place[i] for j, used in enumerate(row))
        for i, row in enumerate(f.pattern)
    ]
    return _equations(f).operations + sum(p * (p + 1) + 5 * p + 3 for p in inward)


def _solved(
    f: Workspace, solution: Solution, bounds: list[Scalar], calls: tuple[Call, ...]
) -> Program:
    accelerations = tuple(solution.unknowns)
    result = Result("a", (len(accelerations),), accelerations, ARGUMENTS["a"])
    about = "Forward dynamics a = M(q)^-1 (Q(u) - h(q, v))."
    given = ("q", "v", "u")
    checks = pivots.checks(f, solution.pivots, bounds) + network_programs.checks(f)
    return f.program(
        "forward_dynamics", about, given, (result,), Guards(checks, calls, status=True)
    )


def _coordinate_rates(f: Workspace) -> Program:
    rates = f.coordinate_rates
    result = Result("qdot", (len(rates),), tuple(rates), "derivatives of q")
    about = "Coordinate rates qdot = N(q) v."
    return f.program("coordinate_rates", about, ("q", "v"), (result,))


def energy_remark(system: System, network: Network | None) -> str:
    """Which elements and components store energy that is unknown, and why; "" if there are none.

    Args:
        system: has the force elements.
        network: the scalar networks; None if there are none.
    """
    found = [f"{who} ({why})" for who, why in unknown(system).items()]
    if network is not None:
        names = [b.component for b in network.branches if b.component.name in network.unknown]
        found += [f"{c.kind} {c.name}" for c in dict.fromkeys(names)]
    return f" Not known, and left out: the energy of {'; '.join(found)}." if found else ""


def _energy(f: Workspace) -> Program:
    entries = f.energy
    about = (
        "Kinetic and potential energy (gravity and springs) of all that moves; that of gravity is zero "
        "at the origin of ground."
    )
    if f.networks is not None:
        about += " The third is what scalar networks store, heat left out."
    about += energy_remark(f.tree.system, f.tree.network)
    result = Result("E", (len(entries),), entries, "kinetic and potential energy (J)")
    return f.program("energy", about, ("q", "v"), (result,))


Maker = Callable[[Workspace], tuple[Program | Routine, ...]]

PROGRAMS: dict[str, Maker] = {
    "algebraic_loop": network_programs.algebraic_loop,
    "mass_matrix": lambda f: (_mass_matrix(f),),
    "bias": lambda f: (_bias(f),),
    "equations": lambda f: (_equations(f),),
    "inverse_dynamics": lambda f: (_inverse_dynamics(f),),
    "constraints": closed_programs.constraints,
    "forward_dynamics": lambda f: (
        loop_routines.forward_dynamics(f) if f.tree.closed else (_forward_dynamics(f),)
    ),
    "coordinate_rates": lambda f: (_coordinate_rates(f),),
    "energy": lambda f: (_energy(f),),
    "rhs": network_programs.rhs,
    "project": loop_routines.project,
    "reduction": loop_routines.reduction,
    "across": edge_programs.across,
    "reactions": edge_programs.reactions,
    "drives": edge_programs.drives,
    "power": edge_programs.power,
    "outputs": edge_programs.outputs,
    "linearize": derivative_programs.linearize,
    "inverse_dynamics_derivatives": derivative_programs.inverse_dynamics,
    "forward_dynamics_derivatives": derivative_programs.forward_dynamics,
    "inverse_dynamics_parameter_derivatives": derivative_programs.inverse_dynamics_by_parameters,
    "forward_dynamics_parameter_derivatives": derivative_programs.forward_dynamics_by_parameters,
    "frames": kinematic_programs.frames,
    **{key: kinematic_programs.whole(key) for key in kinematic_programs.WHOLE},
    "kinematics": kinematic_programs.kinematics,
    "operational_space": operational_programs.operational_space,
    "operational_position": operational_programs.operational_position,
    "regressor": parameter_programs.regressor_program,
    "inertial_parameters": parameter_programs.values_program,
}
"""All functions that can be requested, in emitted order, each with its maker."""

FAMILIES = (
    Family(network_programs.listings),
    Family(closed_programs.listings, closed_programs.counts, closed_remarks.remarks),
    Family(remarks=network_programs.remarks),
    Family(edge_programs.listings),
    Family(parameter_programs.listings),
    Family(derivative_programs.listings, derivative_programs.counts),
    Family(remarks=operational_programs.remarks),
)
"""Additions of families of functions to a file, in the order of the file."""

OF_FRAMES = ("frames", "operational_space", "operational_position")
"""Functions that exist for frames only."""

ON_REQUEST = (
    "power",
    "linearize",
    "inverse_dynamics_derivatives",
    "forward_dynamics_derivatives",
    "inverse_dynamics_parameter_derivatives",
    "forward_dynamics_parameter_derivatives",
    *OF_FRAMES,
    *kinematic_programs.WHOLE,
    "kinematics",
    "regressor",
    "inertial_parameters",
)
"""Functions that are emitted only if requested."""


def parameters_of(derivation: Derived) -> tuple[Quantity, ...]:
    """The independent parameters with their defaults; derived ones are computed from them.

    Raises:
        ModelError: a parameter has no value.
    """
    found = []
    for p in derivation.system.parameters.values():
        if p.derived:
            continue
        if p.value is None:
            raise ModelError(f'parameter "{p.name}"', "has no value, so no default can be emitted")
        found.append(Quantity(p.name, p.unit, p.about, float(p.value)))
    return tuple(found)
