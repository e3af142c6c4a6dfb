"""From a model to equations: the pipeline, stage by stage.

    Model ──graph()──→ SystemGraph ──formulate──→ Formulation
          ──kinematic_tree──→ KinematicTree ──orthogonality, closure──→ M, h, J, ... over any algebra
          ──programs──→ Module ──codegen.render──→ files

Each arrow is one pure function.
"""

from __future__ import annotations

import random
from copy import copy, deepcopy
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.algebra.factorization import singular
from linegraph.algebra.protocol import Algebra, Floats
from linegraph.components.parameters import Parameter, valued
from linegraph.derivation import Face
from linegraph.dynamics.law_names import require_linear
from linegraph.dynamics.potentials import require_energies
from linegraph.dynamics.regularity import Idle, massless, refusal, require_motion, sample_tree
from linegraph.dynamics.symbol_names import symbol_names
from linegraph.dynamics.whole_system import network_entries
from linegraph.errors import ModelError, SourceError
from linegraph.formulation.formulate import Formulation, formulate
from linegraph.ir.dag import Dag
from linegraph.kinematics.tree import kinematic_tree
from linegraph.model.choices import Choices
from linegraph.model.name_register import declared, require_distinct, require_own
from linegraph.numeric.assembly import Assembly, assemble
from linegraph.numeric.between_trees import transfer
from linegraph.numeric.reference import Numeric

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.graph.forest import Topology
    from linegraph.graph.multigraph import SystemGraph
    from linegraph.kinematics.links import KinematicTree
    from linegraph.model.builder import Model


@dataclass(frozen=True, repr=False)
class Derivation(Face):
    """A model with its graph, its topology and the equations that follow.

    Attributes:
        model: what was said, as it was then.
        graph: the united terminal graph.
        formulation: the chosen trees.
    """

    model: Model
    graph: SystemGraph
    formulation: Formulation

    @property
    def topology(self) -> Topology:
        """The chosen tree of the translational projection; the rotational one mostly has the same edges."""
        return self.formulation.translation

    def __repr__(self) -> str:
        """Its name and size."""
        tree = self.structure
        sizes = f"{len(tree.positions)} q, {len(tree.velocities)} v, {len(tree.inputs)} u"
        return f"<Derivation of {self.model.name}: {sizes}>"

    def tree(self, algebra: Algebra, parameters: Mapping[str, Scalar]) -> KinematicTree:
        """The links over an algebra, parameters as given."""
        return kinematic_tree(self.model, self.formulation, algebra, parameters)

    @cached_property
    def structure(self) -> KinematicTree:
        """The links with every parameter and input a symbol: for counting and naming."""
        dag = Dag()
        parameters = self.model.parameters.values()
        return self.tree(dag, valued(parameters, dag, lambda p: dag.symbol("p", p.name)))

    @cached_property
    def symbol_names(self) -> dict[str, tuple[str, ...]]:
        """What the symbols of closed forms are called, by argument; see `symbol_names`."""
        return symbol_names(self)

    def numeric(
        self,
        parameters: Mapping[str, float] | None = None,
        t: float = 0.0,
        u: Sequence[float] | None = None,
    ) -> Numeric:
        """The numeric reference: the same derivation over floats, at a time and for inputs.

        Args:
            parameters: values in place of the model's own.
            t: the time (s).
            u: the inputs; all zero if left out.

        Raises:
            ModelError: a parameter has no value, or there are more or fewer inputs.
        """
        chosen = parameters or {}
        count = len(self.structure.inputs)
        inputs = [0.0] * count if u is None else list(u)
        if len(inputs) != count:
            raise ModelError("u", f"{count} inputs are needed, got {len(inputs)}")

        def given(parameter: Parameter) -> float:
            value = chosen.get(parameter.name, parameter.value)
            if value is None:
                raise ModelError(f'parameter "{parameter.name}"', "has no value")
            return float(value)

        algebra = Floats(t=t, u=inputs)
        values = valued(self.model.parameters.values(), algebra, given)
        return Numeric(self.tree(algebra, values), self.model, algebra, values, self)

    def circuit_of(self, chord: str) -> list[str]:
        """The joints and constraints of the circuit that a chord closes, the chord last."""
        circuit = self.topology.circuit
        names = {*(joint.name for joint in self.model.joints), *self.topology_names}
        if chord not in circuit.rows:
            return [chord]
        row = circuit.entries[circuit.rows.index(chord)]
        return [*(n for j in row if (n := circuit.columns[j]) in names), chord]

    def require_relations(self) -> None:
        """Refuse relations that are no constraints of velocity."""
        if self.model.relations:
            numeric = self.numeric(t=self.model.bounds.sometime)
            require_linear(
                self.model, numeric.tree, numeric.algebra, numeric.parameters, random.Random(0)
            )

    @property
    def valued(self) -> bool:
        """Whether every parameter has a value."""
        return all(p.value is not None for p in self.model.parameters.values())

    @cached_property
    def idle(self) -> tuple[Idle, ...]:
        """Along what nothing is accelerated at the parameters' own values: joints first, then stores.

        Raises:
            ModelError: a mass or an inertia is negative, or the loops cannot be closed.
        """
        if not self.structure.closed:
            tree = sample_tree(self.model, self.formulation)
            return massless(tree, self._added) + self._empty_stores
        joints = self.assembled.massless if self.valued else ()
        return joints + self._empty_stores

    def no_inverse(self, functions: Sequence[str], *, asked: bool = True) -> ModelError:
        """What to tell of functions that divide by a singular M, with its place in the model's file."""
        closed = self.structure.closed
        return placed(refusal(self.idle, functions, closed=closed, asked=asked), self.model)

    def require_inverse(self, what: str) -> None:
        """Refuse what divides by M where M is singular.

        Raises:
            ModelError: names all joints that move no inertia.
        """
        if self.idle:
            raise self.no_inverse([what])

    def _added(self) -> list[tuple[int, int, float]]:
        """What networks add to M at a random state; nothing where they are not defined there."""
        if self.formulation.network is None or not self.valued:
            return []
        return self._network_entries() or []

    def _network_entries(self) -> list[tuple[int, int, float]] | None:
        draw = random.Random(0)
        u = [draw.uniform(0.5, 1) for _ in self.structure.inputs]
        numeric = self.numeric(t=self.model.bounds.sometime, u=u)
        q = [draw.uniform(-1, 1) for _ in numeric.tree.positions]
        numeric.tree.normalise(q)
        v = [draw.uniform(-1, 1) for _ in numeric.tree.velocities]
        try:
            return [
                (i, j, float(x))
                for i, j, x in network_entries(numeric.exchange(q, v), numeric.algebra)
            ]
        except (ModelError, ArithmeticError):
            return None  # no state like any other: what is wrong there is said at run time

    @cached_property
    def _empty_stores(self) -> tuple[Idle, ...]:
        """The components of networks whose stores hold nothing at the parameters' own values."""
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
        """The assembly from the model's own start values, which are those of joints."""
        start = None
        if self.formulation.absolute or self.formulation.level:
            tree = tuple(x for x in self.model.choices.tree if not x.endswith("/inertia"))
            joints = derive(variant(self.model, tree=tree))
            at_rest = [0.0] * len(joints.structure.velocities)
            found = joints.assembly().q
            start, _ = transfer(joints.numeric(), found, at_rest, self.numeric())
        return assemble(self, start=start)

    @property
    def topology_names(self) -> tuple[str, ...]:
        """Inertia edges that are branches by choice."""
        return tuple(f"{body}/inertia" for body in self.formulation.absolute)

    def placed_assembly(self, hold: Mapping[str, float]) -> Assembly:
        """The assembly with some coordinates held, errors with their place in the model's file.

        Raises:
            ModelError: there is none.
        """
        try:
            return self.assembly(hold, start=self.assembled.q)
        except ModelError as error:
            raise placed(error, self.model) from None

    def assembly(
        self,
        hold: Mapping[str, float] | None = None,
        seed: int = 0,
        start: Sequence[float] | None = None,
    ) -> Assembly:
        """A position that closes all loops, and what the constraints are worth there; see `assembly`."""
        return assemble(self, hold, seed, start)

    @property
    def _derivation(self) -> Derivation:
        return self


def derive(model: Model) -> Derivation:
    """Unite the terminal graphs, choose the tree, check that equations of motion exist.

    The derivation is a snapshot: it keeps a copy of the model, which later changes do not reach.

    Raises:
        ModelError: the model cannot be derived; the message names the component.

    Example:
        >>> from linegraph import Model
        >>> model = Model("pendulum")
        >>> bob = model.body("bob", mass=2.0, mass_center=(0, 0, -0.5))
        >>> _ = model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
        >>> derive(model).numeric().mass_matrix([0.3])
        [[0.5]]
    """
    model = deepcopy(model)
    try:
        graph = model.graph()
        owners = require_distinct(declared(model), model.places)
        require_own(model, owners, model.places)
        formulation = formulate(model, graph)
        derivation = Derivation(model, graph, formulation)
        require_motion(model, derivation.structure)
        _ = derivation.symbol_names
        if derivation.structure.closed and derivation.valued:
            derivation.require_relations()
        _ = derivation.idle
        require_energies(model)
    except ModelError as error:
        raise placed(error, model) from None
    return derivation


def variant(model: Model, **choices: Any) -> Model:
    """The same model with other choices of the formulation: what is not named is as by default."""
    twin = copy(model)
    twin.choices = replace(Choices(), **choices)
    return twin


def placed(error: ModelError, model: Model) -> ModelError:
    """Give an error the place in the file that the model was read from."""
    if model.source is None:
        return error
    return SourceError(model.source, model.places.get(error.thing), error.thing, error.problem)
