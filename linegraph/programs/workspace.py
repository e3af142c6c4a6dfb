"""The equations of a model over one DAG, which all emitted functions share."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from linegraph.components.parameters import valued
from linegraph.dynamics import orthogonality
from linegraph.dynamics.applied_forces import efforts
from linegraph.dynamics.chords import equations
from linegraph.dynamics.composite_bias import bias_beside_mass
from linegraph.dynamics.equations import StateEquations
from linegraph.dynamics.network_state import ALL, NONE
from linegraph.ir.dag import Dag
from linegraph.ir.program import (
    UNGUARDED,
    Argument,
    Call,
    Guards,
    Program,
    Result,
    assemble,
    operations_of,
    reads,
)
from linegraph.kinematics.working_frames import shortened

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.applied_forces import Applied
    from linegraph.kinematics.frame_trees import NamedFrame
    from linegraph.numeric.derived import Derived

ORDER = ("q", "v", "u", "a", "lam", "loop", "ease")
"""The order of a function's arguments, after parameters and time."""

ARGUMENTS = {
    "p": "parameters",
    "t": "time (s)",
    "q": "coordinates",
    "v": "velocities",
    "a": "accelerations, the derivatives of v",
    "u": "inputs",
    "lam": "multipliers of the constraints",
    "loop": "unknowns of the algebraic loop",
    "ease": "resistance in series and conductance in parallel at each law of the loop; 0 at its solution",
}


LOOP_FUNCTION = "algebraic_loop"
"""The function that solves the algebraic loop of a network."""


class Workspace(StateEquations):
    """The equations over one DAG, in the shortest working frames, and the functions made from them."""

    def __init__(
        self,
        derivation: Derived,
        folded: bool,
        frames: Iterable[NamedFrame] = (),
        asked: Iterable[str] = (),
    ) -> None:
        """Build the tree over the DAG; quantities are derived when a function needs them.

        Args:
            derivation: the model with its graph and trees.
            folded: whether parameters become numbers.
            frames: the frames whose kinematics are needed.
            asked: keys of the requested functions.
        """
        self.frames = tuple(frames)
        self.asked = frozenset(asked)
        self.dag = Dag()
        self.derivation = derivation
        self.model = derivation.system
        self.head = ["p"] if not folded else []
        self.head += ["t"] if derivation.system.depends_on_time else []
        values = valued(
            derivation.system.parameters.values(),
            self.dag,
            lambda p: p.value if folded else self.dag.symbol("p", p.name),
        )
        tree = derivation.tree(self.dag, values)
        self.dag.label = "moments of links, regrouped"
        self.shortened = shortened(tree)
        self.dag.label = ""
        self.sizes = {
            "q": len(tree.positions),
            "v": len(tree.velocities),
            "a": len(tree.velocities),
            "u": len(tree.inputs),
            "lam": len(equations(tree)),
            "loop": len(tree.network.loop) if tree.network else 0,
            "ease": 2,
        }
        self.texts = ARGUMENTS
        q, v = map(self.symbols, ("q", "v"))
        super().__init__(tree, q, v, self.shortened, self._solution_in_symbols)

    def _solution_in_symbols(self) -> tuple[list[Scalar], list[Scalar]]:
        return self.symbols("a"), self.symbols("lam")

    def symbols(self, name: str) -> list[Scalar]:
        """The symbols of all entries of an argument."""
        return [self.dag.symbol(name, i) for i in range(self.sizes[name])]

    def program(
        self,
        name: str,
        about: str,
        arguments: tuple[str, ...],
        results: tuple[Result, ...],
        guards: Guards = UNGUARDED,
    ) -> Program:
        """Assemble a function; its arguments come in the order ``p, t, q, v, u, a``.

        Parameters and time are arguments exactly if the model has them, inputs if the results need
        them.

        Args:
            name: of the function.
            about: its description.
            arguments: names of arguments that it takes in any case.
            results: its results.
            guards: checks and calls that come before its results.
        """
        loop = reads("loop", results) and "loop" not in arguments
        if loop:
            needed = self.loop_arguments[:-1]
            arguments = (*(a for a in needed if a not in arguments), *arguments)
        for more in ("v", "u"):
            if more not in arguments and reads(more, results):
                arguments = (*arguments, more)
        arguments = tuple(sorted(arguments, key=ORDER.index))
        if loop:
            solved = Argument("loop", self.sizes["loop"], ARGUMENTS["loop"])
            given_names = (*self.head, *needed)
            call = Call(LOOP_FUNCTION, given_names, (solved,))
            guards = guards._replace(calls=(call, *guards.calls))
        given = tuple(
            Argument(argument, self.sizes.get(argument), ARGUMENTS[argument])
            for argument in (*self.head, *arguments)
        )
        return assemble(name, about, given, results, guards)

    @cached_property
    def loop_arguments(self) -> tuple[str, ...]:
        """Arguments of the algebraic loop: always the state, and the inputs if it depends on them."""
        assert self.networks is not None
        network = self.networks.network
        rows = (*network.eased, *(e for row in network.eased_jacobian for e in row))
        results = (Result("r", (), tuple(self.networks.still(r) for r in rows), ""),)
        return ("q", "v", "u", "loop") if reads("u", results) else ("q", "v", "loop")

    @cached_property
    def affine(self) -> bool:
        """Whether h and Q can be added without losing digits: forces of inputs are proportional to them."""
        return self.tree.network is None or self.tree.network.affine

    @cached_property
    def carried(self) -> Applied:
        """Applied forces in the bias; all of the networks' if h and Q cannot be added."""
        return self.passive if self.affine else self.applied(driven=False, network=ALL)

    @cached_property
    def driving(self) -> list[Scalar]:
        """Generalised forces besides the bias: efforts, and elements that inputs drive."""
        if self.affine:
            return self.forces
        forces = self.along(self.applied(driven=True, network=NONE))
        return efforts(self.chords, forces)

    @cached_property
    def held(self) -> list[Scalar]:
        """Generalised forces at v̇ = 0 with the forces of `carried`: h, if Q can be added to it."""
        if self.affine:
            return list(self.bias_beside_mass.entries)
        return orthogonality.inverse_dynamics(self.working, None, self.rehoused(self.carried))

    @cached_property
    def mass_result(self) -> Result:
        """M as the result of a function."""
        rows = self.mass_matrix
        entries = tuple(entry for row in rows for entry in row)
        return Result("M", (len(rows), len(rows)), entries, "mass matrix, both triangles")

    @cached_property
    def symmetric(self) -> bool:
        """Whether the mass matrix is symmetric, with the entries of networks."""
        return self.tree.network is None or self.tree.network.symmetric

    @cached_property
    def armatures(self) -> dict[int, Scalar] | None:
        """Inertia that networks add to each velocity of mechanics; None if they couple several velocities."""
        first = self.tree.layout.mechanical
        found: dict[int, Scalar] = {}
        for i, j, entry in self.stored:
            if i != j and min(i, j) < first:
                return None
            if i < first:
                found[i] = found.get(i, 0) + entry
        return found

    @cached_property
    def pattern(self) -> list[list[bool]]:
        """The entries of M that are not identically zero."""
        size = len(self.v)
        used = [entry != 0 for entry in self.mass_result.entries]
        return [used[i * size : (i + 1) * size] for i in range(size)]

    @cached_property
    def driven_constraints(self) -> bool:
        """Whether constraints depend on inputs, through motions prescribed by input."""
        results = (Result("J", (), (*self.constraints, *self.constraint_rates), ""),)
        return reads("u", results)

    @cached_property
    def bias_result(self) -> Result:
        """The bias h as the only result of a function."""
        return _bias_result(self.bias)

    @cached_property
    def bias_beside_mass(self) -> Result:
        """The bias h as a result beside M: from composites or from single links, whichever costs less."""
        if self.working.tree.levelled:
            return self.bias_result
        acting = self.rehoused(self.passive)
        entries = bias_beside_mass(self.working, acting)
        either = (_bias_result(entries), self.bias_result)
        return min(either, key=lambda bias: operations_of((self.mass_result, bias)))


def _bias_result(entries: list[Scalar]) -> Result:
    return Result("h", (len(entries),), tuple(entries), "bias vector")
