"""Results that a formulated system determines once: assembly, regularity of M, names of symbols."""

from __future__ import annotations

import random
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from linegraph.algebra.factorization import singular
from linegraph.dynamics.regularity import Idle, massless, refusal
from linegraph.dynamics.symbol_names import symbol_names
from linegraph.errors import ModelError
from linegraph.formulation.formulate import formulate
from linegraph.kinematics.formulated import Formulated
from linegraph.model.system import placed, variant
from linegraph.numeric.assembly import Assembly, assemble
from linegraph.numeric.between_trees import transfer
from linegraph.numeric.reference import Numeric, over_floats

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


@dataclass(frozen=True, repr=False)
class Derived(Formulated):
    """A system whose equations of motion exist, with everything that is derived once from it."""

    def __repr__(self) -> str:
        """The name of the system and its numbers of coordinates, velocities and inputs."""
        tree = self.structure
        sizes = f"{len(tree.positions)} q, {len(tree.velocities)} v, {len(tree.inputs)} u"
        return f"<Derivation of {self.system.name}: {sizes}>"

    @cached_property
    def symbol_names(self) -> dict[str, tuple[str, ...]]:
        """The names of all symbols in closed forms, by argument; see `symbol_names`."""
        return symbol_names(self)

    def numeric(
        self,
        parameters: Mapping[str, float] | None = None,
        t: float = 0.0,
        u: Sequence[float] | None = None,
    ) -> Numeric:
        """The equations over floats, at a time and for inputs: the numeric reference.

        Args:
            parameters: values instead of the model's own.
            t: the time (s).
            u: the inputs; all zero if omitted.

        Raises:
            ModelError: a parameter has no value, or the number of inputs is wrong.
        """
        return over_floats(self, parameters, t, u)

    @cached_property
    def idle(self) -> tuple[Idle, ...]:
        """Velocities that accelerate nothing at the default parameters: joints first, then empty stores.

        Raises:
            ModelError: a mass or an inertia is negative, or the loops cannot be closed.
        """
        if not self.structure.closed:
            return massless(self.sample, self._added) + self._empty_stores
        joints = self.assembled.massless if self.valued else ()
        return joints + self._empty_stores

    def no_inverse(self, functions: Sequence[str], *, asked: bool = True) -> ModelError:
        """The error for functions that divide by a singular M, with its place in the model's file.

        Args:
            functions: names of these functions.
            asked: whether they were requested by name.
        """
        closed = self.structure.closed
        return placed(refusal(self.idle, functions, closed=closed, asked=asked), self.system)

    def require_inverse(self, what: str) -> None:
        """Refuse a quantity that divides by M if M is singular.

        Raises:
            ModelError: names all joints that move no inertia.
        """
        if self.idle:
            raise self.no_inverse([what])

    def _added(self) -> list[tuple[int, int, float]]:
        """Entries that networks add to M at a random state; none if they are not defined there."""
        if self.formulation.network is None or not self.valued:
            return []
        return self._network_entries() or []

    def _network_entries(self) -> list[tuple[int, int, float]] | None:
        draw = random.Random(0)
        u = [draw.uniform(0.5, 1) for _ in self.structure.inputs]
        numeric = self.numeric(t=self.system.bounds.sometime, u=u)
        q = [draw.uniform(-1, 1) for _ in numeric.tree.positions]
        numeric.tree.normalise(q)
        v = [draw.uniform(-1, 1) for _ in numeric.tree.velocities]
        try:
            return [(i, j, float(x)) for i, j, x in numeric.at(q, v).stored]
        except (ModelError, ArithmeticError):
            return None  # undefined at a random state: the emitted function reports it at run time

    @cached_property
    def _empty_stores(self) -> tuple[Idle, ...]:
        """The components of networks whose stores hold nothing at the default parameters."""
        network = self.formulation.network
        if network is None or not network.states or not self.valued:
            return ()
        first = self.structure.layout.mechanical
        left = list(range(len(network.states)))
        rows = [[0.0] * len(left) for _ in left]
        for i, j, entry in self._network_entries() or ():
            if min(i, j) >= first:
                rows[i - first][j - first] += entry
        if self._network_entries() is None:
            return ()
        found = []
        while left:
            part = [[rows[i][j] for j in left] for i in left]
            place = singular(part, symmetric=network.symmetric)
            if place is None:
                break
            state = network.states[left.pop(place)]
            owner = network.owner(state)
            what = f"{state.quantity.name} ({state.quantity.about})"
            found.append(Idle(owner.kind, owner.name, what))
        return tuple(found)

    @cached_property
    def assembled(self) -> Assembly:
        """The assembly from the model's own start values, which are coordinates of joints."""
        start = None
        if self.formulation.absolute or self.formulation.level:
            tree = tuple(x for x in self.system.choices.tree if not x.endswith("/inertia"))
            twin = variant(self.system, tree=tree)
            joints = Derived(twin, self.graph, formulate(twin, self.graph))
            at_rest = [0.0] * len(joints.structure.velocities)
            start, _ = transfer(joints.numeric(), joints.assembled.q, at_rest, self.numeric())
        return assemble(self, start=start)

    def placed_assembly(self, hold: Mapping[str, float]) -> Assembly:
        """The assembly with some coordinates held; errors have their place in the model's file.

        Raises:
            ModelError: there is no such position.
        """
        try:
            return self.assembly(hold, start=self.assembled.q)
        except ModelError as error:
            raise placed(error, self.system) from None

    def assembly(
        self,
        hold: Mapping[str, float] | None = None,
        seed: int = 0,
        start: Sequence[float] | None = None,
    ) -> Assembly:
        """A position that closes all loops, with rank and redundancy of the constraints there.

        Args:
            hold: coordinates to keep at given values, by name (rad or m).
            seed: of the random places that are tried if the start fails.
            start: all coordinates to start from, instead of the joints' `start` values.

        Raises:
            ModelError: there is no such position, or prescribed motions contradict each other.
        """
        return assemble(self, hold, seed, start)
