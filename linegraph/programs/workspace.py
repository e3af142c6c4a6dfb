"""What the emitted functions of a model share: one DAG, the tree over it, M and h."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

from linegraph.components.parameters import valued
from linegraph.dynamics import orthogonality
from linegraph.dynamics.applied_forces import Applied, applied, efforts
from linegraph.dynamics.chords import Chords, equations
from linegraph.dynamics.composite_bias import bias_beside_mass
from linegraph.dynamics.edge_variables import InverseScheme
from linegraph.dynamics.law_names import relations
from linegraph.dynamics.network_state import ALL, NONE
from linegraph.dynamics.whole_system import (
    exchange_at,
    network_entries,
    united_inverse_dynamics,
    united_mass_matrix,
)
from linegraph.ir.dag import Dag
from linegraph.ir.program import (
    Argument,
    Call,
    Check,
    Program,
    Result,
    assemble,
    operations_of,
    reads,
)
from linegraph.kinematics.arms import Arm, arms, coordinate_rates
from linegraph.kinematics.working_frames import shortened

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.network_state import Exchange
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


class Functions:
    """What several functions share: the DAG, the tree over it, M and h."""

    def __init__(
        self,
        derivation: Derived,
        folded: bool,
        frames: Iterable[NamedFrame] = (),
        asked: Iterable[str] = (),
    ) -> None:
        """Nothing is derived before a function asks for it.

        Args:
            derivation: the model with its graph and its tree.
            folded: whether parameters become numbers.
            frames: those whose kinematics are asked for.
            asked: the functions that are, by their keys.
        """
        self.frames = tuple(frames)
        self.asked = frozenset(asked)
        self.dag = Dag()
        self.derivation = derivation
        self.model = derivation.system
        self.head = ["p"] if not folded else []
        self.head += ["t"] if derivation.system.depends_on_time else []
        self.values = valued(
            derivation.system.parameters.values(),
            self.dag,
            lambda p: p.value if folded else self.dag.symbol("p", p.name),
        )
        self.tree = derivation.tree(self.dag, self.values)
        self.dag.label = "moments of links, regrouped"
        self.shortened = shortened(self.tree)
        self.dag.label = "equations of constraints"
        self.short = self.shortened.tree
        self.equations = equations(self.tree)
        self.dag.label = ""
        self.sizes = {
            "q": len(self.tree.positions),
            "v": len(self.tree.velocities),
            "a": len(self.tree.velocities),
            "u": len(self.tree.inputs),
            "lam": len(self.equations),
            "loop": len(self.tree.network.loop) if self.tree.network else 0,
            "ease": 2,
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
            calls = (call, *calls)
        given = tuple(
            Argument(argument, self.sizes.get(argument), ARGUMENTS[argument])
            for argument in (*self.head, *arguments)
        )
        return assemble(name, about, given, results, checks, calls, status=status)

    @cached_property
    def loop_arguments(self) -> tuple[str, ...]:
        """What the algebraic loop depends on: always the state, inputs where they are in it."""
        assert self.exchange is not None
        network = self.exchange.network
        rows = (*network.eased, *(e for row in network.eased_jacobian for e in row))
        results = (Result("r", (), tuple(self.exchange.still(r) for r in rows), ""),)
        return ("q", "v", "u", "loop") if reads("u", results) else ("q", "v", "loop")

    @cached_property
    def passive(self) -> Applied:
        """Springs, dampers and loads that no input drives: part of the bias."""
        return self._applied(driven=False)

    @cached_property
    def active(self) -> Applied:
        """Elements and loads that inputs drive: part of Q."""
        return self._applied(driven=True)

    def _applied(self, *, driven: bool, network: str | None = None) -> Applied:
        state = (tuple(self.q), tuple(self.v))
        return applied(
            self.model,
            self.tree,
            self.dag,
            self.values,
            self.arms,
            *state,
            driven=driven,
            network=network,
        )

    @cached_property
    def affine(self) -> bool:
        """Whether h and Q can be added without losing digits: what inputs drive is in proportion to them."""
        return self.tree.network is None or self.tree.network.affine

    @cached_property
    def carried(self) -> Applied:
        """What acts at v̇ = 0, all of networks with it where h and Q cannot be added."""
        return self.passive if self.affine else self._applied(driven=False, network=ALL)

    @cached_property
    def driving(self) -> list[Scalar]:
        """What acts beside that: efforts and what inputs drive."""
        if self.affine:
            return self.efforts
        forces = self.along(self._applied(driven=True, network=NONE))
        return efforts(self.tree, self.dag, self.chords, forces)

    @cached_property
    def held(self) -> list[Scalar]:
        """What v̇ = 0 takes of `carried`: h, where Q can be added to it."""
        if self.affine:
            return list(self.bias_beside_mass.entries)
        return orthogonality.inverse_dynamics(
            self.short, self.dag, self.crossed, applied=self.rehoused(self.carried)
        )

    @cached_property
    def inverse_dynamics(self) -> list[Scalar]:
        """``M a + h`` for accelerations as symbols, without M."""
        return self.required_by(self.passive)

    def required_by(self, acting: Applied) -> list[Scalar]:
        """``M a + h``, h with what is `acting`, for accelerations as symbols."""
        a = self.symbols("a")
        return united_inverse_dynamics(
            self.short, self.dag, self.crossed, self.entries, a, self.rehoused(acting)
        )

    @cached_property
    def arms(self) -> list[Arm]:
        """The joints' motions at (q, v), in the frames of the walk."""
        return arms(self.tree, self.dag, self.q, self.v)

    @cached_property
    def crossed(self) -> list[Arm]:
        """The same in the shortest frames: for M and h."""
        return arms(self.short, self.dag, self.q, self.v)

    def along(self, acting: Applied) -> list[Scalar]:
        """What forces do along v."""
        return orthogonality.generalised_forces(
            self.short, self.dag, self.crossed, self.rehoused(acting)
        )

    def rehoused(self, acting: Applied) -> Applied:
        """Forces given in the frames of the walk, in the shortest ones."""
        return replace(acting, wrenches=self.shortened.rehoused(acting.wrenches, self.crossed))

    @cached_property
    def mass_matrix(self) -> Result:
        """M as a result."""
        rows = self.mass_rows
        entries = tuple(entry for row in rows for entry in row)
        return Result("M", (len(rows), len(rows)), entries, "mass matrix, both triangles")

    @cached_property
    def mass_rows(self) -> list[list[Scalar]]:
        """M."""
        return united_mass_matrix(self.short, self.dag, self.crossed, self.entries)

    @cached_property
    def exchange(self) -> Exchange | None:
        """The networks at (q, v)."""
        state = (tuple(self.q), tuple(self.v))
        chords = Chords(self.tree, self.dag, self.arms, self.values)
        return exchange_at(self.model, self.tree, self.dag, self.values, chords, state)

    @cached_property
    def entries(self) -> list[tuple[int, int, Scalar]]:
        """What the networks add to the mass matrix."""
        return network_entries(self.exchange, self.dag)

    @cached_property
    def symmetric(self) -> bool:
        """Whether the mass matrix is, whatever the networks add."""
        return self.tree.network is None or self.tree.network.symmetric

    @cached_property
    def armatures(self) -> dict[int, Scalar] | None:
        """What networks add along each velocity of mechanics; None if they tie several to each other."""
        first = self.tree.layout.mechanical
        found: dict[int, Scalar] = {}
        for i, j, entry in self.entries:
            if i != j and min(i, j) < first:
                return None
            if i < first:
                found[i] = found.get(i, 0) + entry
        return found

    @cached_property
    def pattern(self) -> list[list[bool]]:
        """Where M has entries that are not zero everywhere."""
        size = len(self.v)
        used = [entry != 0 for entry in self.mass_matrix.entries]
        return [used[i * size : (i + 1) * size] for i in range(size)]

    @cached_property
    def chords(self) -> Chords:
        """The constraints at (q, v)."""
        rates = coordinate_rates(self.tree, self.dag, self.q, self.v)
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
        return efforts(self.tree, self.dag, self.chords, self.along(self.active))

    @cached_property
    def bias(self) -> Result:
        """The bias h as a result, where it is wanted alone."""
        return _bias_result(
            orthogonality.inverse_dynamics(
                self.short, self.dag, self.crossed, applied=self.rehoused(self.passive)
            )
        )

    @cached_property
    def bias_beside_mass(self) -> Result:
        """The same where M is wanted with it: from composites or from single links, by count."""
        if self.short.levelled:
            return self.bias
        acting = self.rehoused(self.passive)
        entries = bias_beside_mass(self.short, self.dag, self.crossed, acting)
        either = (_bias_result(entries), self.bias)
        return min(either, key=lambda bias: operations_of((self.mass_matrix, bias)))


def _bias_result(entries: list[Scalar]) -> Result:
    return Result("h", (len(entries),), tuple(entries), "bias vector")
