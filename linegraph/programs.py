"""Stage 5: the derivation run over the expression DAG, cut into the functions we promise."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from linegraph import orthogonality
from linegraph.articulated import forward_dynamics
from linegraph.errors import ModelError
from linegraph.expression import Dag, Node
from linegraph.factorization import Solution, solve
from linegraph.mass_matrix import mass_matrix
from linegraph.program import Argument, Call, Check, Module, Program, Quantity, Result, assemble
from linegraph.regularity import SINGULAR, is_solid

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from linegraph.derive import Derivation
    from linegraph.kinematics import KinematicTree
    from linegraph.vector import Scalar

EFFORT_UNITS = {"rad/s": "N*m", "m/s": "N"}


def module_of(derivation: Derivation, name: str, *, folded: bool, about: Iterable[str]) -> Module:
    """All functions of a model.

    Args:
        derivation: the model with its graph and its tree.
        name: prefix of everything emitted; an identifier.
        folded: whether parameters become numbers.
        about: paragraphs for the head of the file.

    Raises:
        ModelError: a parameter has no value.
    """
    parameters = _parameters(derivation)
    functions = _Functions(derivation, folded or not parameters)
    programs = tuple(make(functions) for make in PROGRAMS)
    functions.dag.release()
    tree = functions.tree
    return Module(
        name=name,
        about=tuple(about),
        positions=tree.positions,
        velocities=tree.velocities,
        inputs=inputs_of(tree),
        parameters=() if folded else parameters,
        time=False,
        programs=programs,
    )


class _Functions:
    """What several functions share: the DAG, the tree over it, M and h."""

    def __init__(self, derivation: Derivation, folded: bool) -> None:
        self.dag = Dag()
        self._parameters = not folded
        values: dict[str, Scalar] = {
            p.name: p.value if folded else self.dag.symbol("p", p.name)
            for p in derivation.model.parameters.values()
        }
        self.tree = derivation.tree(self.dag, values)
        self.short = self.tree.regrouped()
        self.q = self._symbols("q", len(self.tree.positions))
        self.v = self._symbols("v", len(self.tree.velocities))

    def _symbols(self, name: str, size: int) -> list[Scalar]:
        return [self.dag.symbol(name, i) for i in range(size)]

    def arguments(self, *names: str) -> tuple[Argument, ...]:
        """The named arguments in the order of the contract, parameters first where there are any."""
        sizes = {"q": len(self.q), "v": len(self.v), "a": len(self.v), "u": len(self.tree.inputs)}
        given = [Argument(name, sizes[name], ARGUMENTS[name]) for name in names]
        if self._parameters:
            given.insert(0, Argument("p", None, ARGUMENTS["p"]))
        return tuple(given)

    def inputs(self, name: str, size: int) -> list[Scalar]:
        """The entries of another argument."""
        return self._symbols(name, size)

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
    def efforts(self) -> list[Scalar]:
        """Q: the inputs, each at its velocity."""
        efforts: list[Scalar] = [0] * len(self.v)
        for k, index in enumerate(self.tree.inputs):
            efforts[index] = self.dag.symbol("u", k)
        return efforts

    @cached_property
    def bias(self) -> Result:
        """The bias h as a result."""
        entries = orthogonality.inverse_dynamics(self.short, self.dag, self.arms)
        return Result("h", (len(entries),), tuple(entries), "bias vector")


ARGUMENTS = {
    "p": "parameters",
    "q": "coordinates",
    "v": "velocities",
    "a": "accelerations, the derivatives of v",
    "u": "inputs",
}


def _mass_matrix(f: _Functions) -> Program:
    return assemble("mass_matrix", "Mass matrix M(q).", f.arguments("q"), (f.mass_matrix,))


def _bias(f: _Functions) -> Program:
    about = "Bias h(q, v): gravity, Coriolis and centrifugal terms."
    return assemble("bias", about, f.arguments("q", "v"), (f.bias,))


def _equations(f: _Functions) -> Program:
    about = "Mass matrix M(q) and bias h(q, v) at once, sharing work."
    return assemble("equations", about, f.arguments("q", "v"), (f.mass_matrix, f.bias))


def _inverse_dynamics(f: _Functions) -> Program:
    a = f.inputs("a", len(f.v))
    tau = orthogonality.inverse_dynamics(f.short, f.dag, f.arms, a)
    result = Result("tau", (len(tau),), tuple(tau), "generalised forces along v")
    about = "Inverse dynamics tau = M(q) a + h(q, v), without forming M."
    return assemble("inverse_dynamics", about, f.arguments("q", "v", "a"), (result,))


def _forward_dynamics(f: _Functions) -> Program:
    """By factored mass matrix or by articulated inertias, whichever takes fewer operations.

    With solid bodies M cannot become singular, so articulated inertias need no scale to judge pivots by;
    where some link is not solid, the factors do the judging.
    """
    if f.tree.coupled or not all(is_solid(link) for link in f.tree.links if link.numeric):
        return _factored(f)
    articulated = _articulated(f)
    return articulated if articulated.operations < _factored_cost(f) else _factored(f)


def _articulated(f: _Functions) -> Program:
    solution = forward_dynamics(f.short, f.dag, f.arms, f.efforts)
    return _solved(f, solution, [0] * len(solution.pivots), ())


def _factored(f: _Functions) -> Program:
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
    names = tuple(argument.name for argument in f.arguments("q", "v"))
    bounds = [SINGULAR * rows[i][i] for i in range(size)]
    return _solved(f, solution, bounds, (Call("equations", names, local),))


def _factored_cost(f: _Functions) -> int:
    """Operations of `equations` and of what `_factored` adds: p(p+1) + 4p + 3 for p couplings inward."""
    place = {k: n for n, k in enumerate(f.tree.outward)}
    inward = [
        sum(used and place[j] < place[i] for j, used in enumerate(row))
        for i, row in enumerate(f.pattern)
    ]
    return _equations(f).operations + sum(p * (p + 1) + 4 * p + 3 for p in inward)


def _solved(
    f: _Functions, solution: Solution, bounds: list[Scalar], calls: tuple[Call, ...]
) -> Program:
    checks = tuple(
        Check(pivot, bound, i + 1, f"the mass matrix is singular at {f.tree.velocities[i].name}")
        for i, (pivot, bound) in enumerate(zip(solution.pivots, bounds, strict=True))
        if isinstance(pivot, Node)
    )
    accelerations = tuple(solution.unknowns)
    result = Result("a", (len(accelerations),), accelerations, ARGUMENTS["a"])
    about = "Forward dynamics a = M(q)^-1 (Q(u) - h(q, v))."
    given = f.arguments("q", "v", "u")
    return assemble("forward_dynamics", about, given, (result,), checks, calls, status=True)


def _coordinate_rates(f: _Functions) -> Program:
    rates = orthogonality.coordinate_rates(f.tree, f.dag, f.q, f.v)
    result = Result("qdot", (len(rates),), tuple(rates), "derivatives of q")
    about = "Coordinate rates qdot = N(q) v."
    return assemble("coordinate_rates", about, f.arguments("q", "v"), (result,))


def _energy(f: _Functions) -> Program:
    crossed = orthogonality.arms(f.tree, f.dag, f.q, f.v)
    entries = orthogonality.energy(f.tree, f.dag, crossed)
    about = (
        "Kinetic and potential energy of all that moves; potential zero at the origin of ground."
    )
    result = Result("E", (2,), entries, "kinetic and potential energy (J)")
    return assemble("energy", about, f.arguments("q", "v"), (result,))


PROGRAMS: tuple[Callable[[_Functions], Program], ...] = (
    _mass_matrix,
    _bias,
    _equations,
    _inverse_dynamics,
    _forward_dynamics,
    _coordinate_rates,
    _energy,
)
"""The register of emitted functions, in emitted order."""


def inputs_of(tree: KinematicTree) -> tuple[Quantity, ...]:
    """The efforts: one along each actuated velocity, of its name."""
    quantities = []
    for index in tree.inputs:
        velocity = tree.velocities[index]
        unit = EFFORT_UNITS[velocity.unit]
        quantities.append(Quantity(velocity.name, unit, f"effort along {velocity.name}"))
    return tuple(quantities)


def _parameters(derivation: Derivation) -> tuple[Quantity, ...]:
    found = []
    for p in derivation.model.parameters.values():
        if p.value is None:
            raise ModelError(f'parameter "{p.name}"', "has no value, so no default can be emitted")
        found.append(Quantity(p.name, p.unit, p.about, p.value))
    return tuple(found)
