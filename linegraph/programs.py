"""Stage 5: the derivation run over the expression DAG, cut into the functions we promise."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

from linegraph import closed_programs, edge_programs, orthogonality
from linegraph.articulated import forward_dynamics
from linegraph.closure import Chords, equations
from linegraph.errors import ModelError
from linegraph.expression import Dag, Node
from linegraph.factorization import Solution, solve
from linegraph.inverse_scheme import InverseScheme
from linegraph.loads import Applied, applied, efforts
from linegraph.mass_matrix import mass_matrix
from linegraph.parameters import valued
from linegraph.program import (
    Argument,
    Call,
    Check,
    Module,
    Program,
    Quantity,
    Result,
    Routine,
    assemble,
    reads,
)
from linegraph.regularity import SINGULAR, is_solid
from linegraph.scope import relations

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.derive import Derivation
    from linegraph.vector import Scalar


def module_of(
    derivation: Derivation,
    name: str,
    *,
    folded: bool,
    about: Iterable[str],
    wanted: Iterable[str] = (),
    only: Iterable[str] | None = None,
) -> Module:
    """All functions of a model.

    Args:
        derivation: the model with its graph and its tree.
        name: prefix of everything emitted; an identifier.
        folded: whether parameters become numbers.
        about: paragraphs for the head of the file.
        wanted: further functions to emit, of `ON_REQUEST`.
        only: nothing but these of `PROGRAMS`; default all.

    Raises:
        ModelError: a parameter has no value, or a closed model cannot be assembled.
    """
    parameters = _parameters(derivation)
    functions = Functions(derivation, folded or not parameters)
    asked = (*only,) if only is not None else (*(set(PROGRAMS) - set(ON_REQUEST)), *wanted)
    chosen = [key for key in PROGRAMS if key in asked]
    programs = tuple(program for key in chosen for program in PROGRAMS[key](functions))
    functions.dag.release()
    tree = functions.tree
    closed = closed_programs.listings(functions) if tree.closed else ()
    return Module(
        name=name,
        about=(*about, *closed_programs.remarks(functions)),
        positions=tree.positions,
        velocities=tree.velocities,
        inputs=tree.inputs,
        parameters=() if folded else parameters,
        time=derivation.model.depends_on_time,
        programs=programs,
        listings=(*closed, *edge_programs.listings(functions, chosen)),
        counts=closed_programs.counts(functions) if tree.closed else (),
    )


class Functions:
    """What several functions share: the DAG, the tree over it, M and h."""

    def __init__(self, derivation: Derivation, folded: bool) -> None:
        """Nothing is derived before a function asks for it."""
        self.dag = Dag()
        self.derivation = derivation
        self.model = derivation.model
        self.head = ["p"] if not folded else []
        self.head += ["t"] if derivation.model.depends_on_time else []
        self.values = valued(
            derivation.model.parameters.values(),
            self.dag,
            lambda p: p.value if folded else self.dag.symbol("p", p.name),
        )
        self.tree = derivation.tree(self.dag, self.values)
        self.short = self.tree.regrouped()
        self.equations = equations(self.tree)
        self.sizes = {
            "q": len(self.tree.positions),
            "v": len(self.tree.velocities),
            "a": len(self.tree.velocities),
            "u": len(self.tree.inputs),
            "lam": len(self.equations),
        }
        self.texts = ARGUMENTS
        self.q = self.symbols("q")
        self.v = self.symbols("v")

    def symbols(self, name: str) -> list[Scalar]:
        """The entries of an argument."""
        return [self.dag.symbol(name, i) for i in range(self.sizes[name])]

    def program(
        self,
        name: str,
        about: str,
        arguments: tuple[str, ...],
        results: tuple[Result, ...],
        checks: tuple[Check, ...] = (),
        calls: tuple[Call, ...] = (),
        *,
        status: bool = False,
    ) -> Program:
        """Assemble a function; the arguments follow the contract's order ``p, t, q, v, u, a``.

        Parameters and time are there exactly when the model has them, inputs when the results need them.
        """
        if "u" not in arguments and reads("u", results):
            place = sum(argument in ("q", "v") for argument in arguments)
            arguments = (*arguments[:place], "u", *arguments[place:])
        given = tuple(
            Argument(argument, self.sizes.get(argument), ARGUMENTS[argument])
            for argument in (*self.head, *arguments)
        )
        return assemble(name, about, given, results, checks, calls, status=status)

    @cached_property
    def passive(self) -> Applied:
        """Springs, dampers and loads that no input drives: part of the bias."""
        return self._applied(driven=False)

    @cached_property
    def active(self) -> Applied:
        """Elements and loads that inputs drive: part of Q."""
        return self._applied(driven=True)

    def _applied(self, *, driven: bool) -> Applied:
        state = (tuple(self.q), tuple(self.v))
        return applied(
            self.model, self.short, self.dag, self.values, self.arms, *state, driven=driven
        )

    @cached_property
    def arms(self) -> list[orthogonality.Arm]:
        """The joints' motions at (q, v)."""
        return orthogonality.arms(self.short, self.dag, self.q, self.v)

    @cached_property
    def mass_matrix(self) -> Result:
        """M as a result."""
        rows = mass_matrix(self.short, self.dag, self.arms)
        entries = tuple(entry for row in rows for entry in row)
        return Result("M", (len(rows), len(rows)), entries, "mass matrix, both triangles")

    @cached_property
    def pattern(self) -> list[list[bool]]:
        """Where M has entries that are not zero everywhere."""
        size = len(self.v)
        used = [entry != 0 for entry in self.mass_matrix.entries]
        return [used[i * size : (i + 1) * size] for i in range(size)]

    @cached_property
    def chords(self) -> Chords:
        """The constraints at (q, v)."""
        rates = orthogonality.coordinate_rates(self.tree, self.dag, self.q, self.v)
        state = (tuple(self.q), tuple(self.v))
        found = relations(self.model, self.tree, self.dag, self.values, state, rates)
        return Chords(self.tree, self.dag, self.arms, self.values, found)

    @cached_property
    def jacobian(self) -> list[list[Scalar]]:
        """J."""
        return self.chords.jacobian()

    @cached_property
    def driven_constraints(self) -> bool:
        """Whether constraints depend on inputs: on motions prescribed by some."""
        results = (Result("J", (), (*self.chords.position(), *self.chords.rates(self.v)), ""),)
        return reads("u", results)

    @cached_property
    def scheme(self) -> InverseScheme:
        """Every variable of every edge, v̇ and λ as symbols; masses are the model's own."""
        return InverseScheme(
            self.derivation,
            self.tree,
            self.dag,
            self.values,
            self.arms,
            self.chords,
            (tuple(self.q), tuple(self.v)),
            self.symbols("a"),
            list(zip(self.equations, self.symbols("lam"), strict=True)),
        )

    @cached_property
    def efforts(self) -> list[Scalar]:
        """Q: joint efforts at their velocities, and what driven elements do."""
        active = orthogonality.generalised_forces(self.short, self.dag, self.arms, self.active)
        return efforts(self.short, self.dag, self.chords, active)

    @cached_property
    def bias(self) -> Result:
        """The bias h as a result."""
        entries = orthogonality.inverse_dynamics(
            self.short, self.dag, self.arms, applied=self.passive
        )
        return Result("h", (len(entries),), tuple(entries), "bias vector")


ARGUMENTS = {
    "p": "parameters",
    "t": "time (s)",
    "q": "coordinates",
    "v": "velocities",
    "a": "accelerations, the derivatives of v",
    "u": "inputs",
    "lam": "multipliers of the constraints",
}


def _mass_matrix(f: Functions) -> Program:
    return f.program("mass_matrix", "Mass matrix M(q).", ("q",), (f.mass_matrix,))


def _bias(f: Functions) -> Program:
    about = "Bias h(q, v): gravity, Coriolis and centrifugal terms."
    return f.program("bias", about, ("q", "v"), (f.bias,))


def _equations(f: Functions) -> Program:
    about = "Mass matrix M(q) and bias h(q, v) at once, sharing work."
    return f.program("equations", about, ("q", "v"), (f.mass_matrix, f.bias))


def _inverse_dynamics(f: Functions) -> Program:
    a = f.symbols("a")
    tau = orthogonality.inverse_dynamics(f.short, f.dag, f.arms, a, f.passive)
    result = Result("tau", (len(tau),), tuple(tau), "generalised forces along v")
    about = "Inverse dynamics tau = M(q) a + h(q, v), without forming M."
    return f.program("inverse_dynamics", about, ("q", "v", "a"), (result,))


def _forward_dynamics(f: Functions) -> Program:
    """By factored mass matrix or by articulated inertias, whichever takes fewer operations.

    With solid bodies M cannot become singular, so articulated inertias need no scale to judge pivots by;
    where some link is not solid, the factors do the judging.
    """
    if (
        f.tree.coupled
        or f.tree.levelled
        or not all(is_solid(link) for link in f.tree.links if link.numeric)
    ):
        return _factored(f)
    articulated = _articulated(f)
    return articulated if articulated.operations < _factored_cost(f) else _factored(f)


def _articulated(f: Functions) -> Program:
    passive = orthogonality.generalised_forces(f.short, f.dag, f.arms, f.passive)
    total = [effort + load for effort, load in zip(f.efforts, passive, strict=True)]
    solution = forward_dynamics(f.short, f.dag, f.arms, total)
    return _solved(f, solution, [0] * len(solution.pivots), ())


def _factored(f: Functions) -> Program:
    """Call `equations` for M and h, then M = L^T D L in straight lines."""
    size = len(f.v)
    f.dag.label = "right-hand side Q - h"
    right = [effort - f.dag.symbol("h", i) for i, effort in enumerate(f.efforts)]
    f.dag.label = "M = L^T D L from the leaves to the root, then back"
    rows = [
        [f.dag.symbol("M", i * size + j) if used else 0 for j, used in enumerate(row)]
        for i, row in enumerate(f.pattern)
    ]
    solution = solve(rows, right, f.tree.outward)
    local = (Argument("M", size * size, "mass matrix"), Argument("h", size, "bias vector"))
    names = tuple(argument.name for argument in _equations(f).arguments)
    bounds = [SINGULAR * rows[i][i] for i in range(size)]
    return _solved(f, solution, bounds, (Call("equations", names, local),))


def _factored_cost(f: Functions) -> int:
    """Operations of `equations` and of what `_factored` adds: p(p+1) + 4p + 3 for p couplings inward."""
    place = {k: n for n, k in enumerate(f.tree.outward)}
    inward = [
        sum(used and place[j] < place[i] for j, used in enumerate(row))
        for i, row in enumerate(f.pattern)
    ]
    return _equations(f).operations + sum(p * (p + 1) + 4 * p + 3 for p in inward)


def _solved(
    f: Functions, solution: Solution, bounds: list[Scalar], calls: tuple[Call, ...]
) -> Program:
    checks = tuple(
        Check(pivot, bound, i + 1, f"the mass matrix is singular at {f.tree.velocities[i].name}")
        for i, (pivot, bound) in enumerate(zip(solution.pivots, bounds, strict=True))
        if isinstance(pivot, Node)
    )
    accelerations = tuple(solution.unknowns)
    result = Result("a", (len(accelerations),), accelerations, ARGUMENTS["a"])
    about = "Forward dynamics a = M(q)^-1 (Q(u) - h(q, v))."
    given = ("q", "v", "u")
    return f.program("forward_dynamics", about, given, (result,), checks, calls, status=True)


def _coordinate_rates(f: Functions) -> Program:
    rates = orthogonality.coordinate_rates(f.tree, f.dag, f.q, f.v)
    result = Result("qdot", (len(rates),), tuple(rates), "derivatives of q")
    about = "Coordinate rates qdot = N(q) v."
    return f.program("coordinate_rates", about, ("q", "v"), (result,))


def _energy(f: Functions) -> Program:
    crossed = orthogonality.arms(f.tree, f.dag, f.q, f.v)
    kinetic, potential = orthogonality.energy(f.tree, f.dag, crossed)
    stored = potential + f.passive.potential
    about = (
        "Kinetic and potential energy (gravity and springs) of all that moves; that of gravity is zero "
        "at the origin of ground."
    )
    result = Result("E", (2,), (kinetic, stored), "kinetic and potential energy (J)")
    return f.program("energy", about, ("q", "v"), (result,))


Maker = Callable[[Functions], tuple[Program | Routine, ...]]

PROGRAMS: dict[str, Maker] = {
    "mass_matrix": lambda f: (_mass_matrix(f),),
    "bias": lambda f: (_bias(f),),
    "equations": lambda f: (_equations(f),),
    "inverse_dynamics": lambda f: (_inverse_dynamics(f),),
    "constraints": closed_programs.constraints,
    "forward_dynamics": lambda f: (
        closed_programs.forward_dynamics(f) if f.tree.closed else (_forward_dynamics(f),)
    ),
    "coordinate_rates": lambda f: (_coordinate_rates(f),),
    "energy": lambda f: (_energy(f),),
    "project": closed_programs.project,
    "reduction": closed_programs.reduction,
    "across": edge_programs.across,
    "reactions": edge_programs.reactions,
    "drives": edge_programs.drives,
    "power": edge_programs.power,
    "outputs": edge_programs.outputs,
}
"""The register of emitted functions, in emitted order: what a user may ask for, and what makes them."""

ON_REQUEST = ("power",)
"""Emitted only where they are asked for."""


def _parameters(derivation: Derivation) -> tuple[Quantity, ...]:
    """The independent parameters; derived ones are computed from them."""
    found = []
    for p in derivation.model.parameters.values():
        if p.derived:
            continue
        if p.value is None:
            raise ModelError(f'parameter "{p.name}"', "has no value, so no default can be emitted")
        found.append(Quantity(p.name, p.unit, p.about, float(p.value)))
    return tuple(found)
