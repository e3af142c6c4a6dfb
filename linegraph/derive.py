"""From a model to equations: the pipeline, stage by stage.

    Model ──graph()──→ SystemGraph ──formulate──→ Formulation
          ──kinematic_tree──→ KinematicTree ──orthogonality, closure──→ M, h, J, ... over any algebra
          ──programs──→ Module ──codegen.render──→ files

Each arrow is one pure function.
"""

from __future__ import annotations

import random
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph import orthogonality
from linegraph.algebra import Algebra, Floats
from linegraph.assembly import Assembly, assemble
from linegraph.choices import Choices
from linegraph.closure import Chords
from linegraph.errors import ModelError, SourceError
from linegraph.expression import Dag
from linegraph.factorization import singular
from linegraph.formulation import Formulation, formulate
from linegraph.loads import Applied, applied
from linegraph.mass_matrix import mass_matrix
from linegraph.parameters import Parameter, resolver, valued
from linegraph.regularity import require_regular
from linegraph.scope import relations, require_linear
from linegraph.transfer import transfer
from linegraph.united import (
    exchange_at,
    network_entries,
    united_inverse_dynamics,
    united_mass_matrix,
)
from linegraph.walk import kinematic_tree

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.exchange import Exchange
    from linegraph.graph import SystemGraph
    from linegraph.kinematics import KinematicTree
    from linegraph.model import Model
    from linegraph.topology import Topology
    from linegraph.vector import Scalar


@dataclass(frozen=True)
class Derivation:
    """A model with its graph, its topology and the equations that follow.

    Attributes:
        model: what was said.
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

    def tree(self, algebra: Algebra, parameters: Mapping[str, Scalar]) -> KinematicTree:
        """The links over an algebra, parameters as given."""
        return kinematic_tree(self.model, self.formulation, algebra, parameters)

    @cached_property
    def structure(self) -> KinematicTree:
        """The links with every parameter and input a symbol: for counting and naming."""
        dag = Dag()
        parameters = self.model.parameters.values()
        return self.tree(dag, valued(parameters, dag, lambda p: dag.symbol("p", p.name)))

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
            numeric = self.numeric(t=0.37)
            require_linear(
                self.model, numeric.tree, numeric.algebra, numeric.parameters, random.Random(0)
            )

    def require_stores(self) -> None:
        """Refuse a network whose stores hold nothing at the parameters' own values."""
        network = self.formulation.network
        given = all(p.value is not None for p in self.model.parameters.values())
        if network is None or not network.states or not given:
            return
        draw = random.Random(0)
        u = [draw.uniform(0.5, 1) for _ in self.structure.inputs]
        numeric = self.numeric(t=0.37, u=u)
        q = [draw.uniform(-1, 1) for _ in numeric.tree.positions]
        numeric.tree.normalise(q)
        v = [draw.uniform(-1, 1) for _ in numeric.tree.velocities]
        first, size = numeric.tree.layout.mechanical, len(network.states)
        rows = [[0.0] * size for _ in range(size)]
        try:
            for i, j, entry in network_entries(numeric.exchange(q, v), numeric.algebra):
                if min(i, j) >= first:
                    rows[i - first][j - first] += entry
        except (ModelError, ArithmeticError):
            return  # no state like any other: what is wrong there is said at run time
        place = singular(rows, symmetric=network.symmetric)
        if place is not None:
            quantity = network.states[place].quantity
            problem = (
                f"{quantity.name} ({quantity.about}) has no rate: what stores it is zero for the parameters' "
                "values. Leave the component out, or give it a value"
            )
            owner = network.owner(network.states[place])
            raise ModelError(f'{owner.kind} "{owner.name}"', problem)

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

    @cached_property
    def symbolic(self) -> Any:
        """The closed forms: the same derivation over sympy (`symbols.Symbolic`)."""
        from linegraph.symbols import Symbolic

        return Symbolic(self)


@dataclass(frozen=True)
class Numeric:
    """The derivation run over floats: one state at a time, slow, exact to rounding.

    Attributes:
        tree: the links, in numbers.
        model: what elements act; None to leave them out.
        algebra: the time and the inputs.
        parameters: their values.
        derivation: what it is of.
    """

    tree: KinematicTree
    model: Model | None = None
    algebra: Floats = field(default_factory=Floats)
    parameters: Mapping[str, Scalar] = field(default_factory=dict)
    derivation: Derivation | None = None

    @property
    def t(self) -> float:
        """The time."""
        return float(self.algebra.arguments.get("t", 0.0))

    def at(self, t: float) -> Numeric:
        """The same at another time."""
        if self.derivation is None:
            return self
        return self.derivation.numeric(self.parameters, t, self.algebra.arguments["u"])

    @property
    def resolve(self) -> Callable[[Any], Scalar]:
        """From model values to numbers."""
        return resolver(self.algebra, self.parameters)

    def mass_matrix(self, q: Sequence[float]) -> list[list[float]]:
        """M(q)."""
        return self.united_mass_matrix(q, [0.0] * len(self.tree.velocities))

    def mechanical_mass_matrix(self, q: Sequence[float]) -> list[list[float]]:
        """Its part of mechanics, without what networks add."""
        at_rest = [0.0] * len(self.tree.velocities)
        rows = mass_matrix(self.tree, self.algebra, self._arms(q, at_rest))
        return [row[: self.tree.layout.mechanical] for row in rows[: self.tree.layout.mechanical]]

    def united_mass_matrix(self, q: Sequence[float], v: Sequence[float]) -> list[list[float]]:
        """𝓜(q, v): the mass matrix where what networks store depends on their states."""
        entries = network_entries(self.exchange(q, v), self.algebra)
        return united_mass_matrix(self.tree, self.algebra, self._arms(q, v), entries)

    def exchange(self, q: Sequence[float], v: Sequence[float]) -> Exchange | None:
        """The networks at a state."""
        if self.model is None or self.tree.network is None:
            return None
        chords = Chords(self.tree, self.algebra, self._arms(q, v), self.parameters)
        state = (tuple(q), tuple(v))
        return exchange_at(self.model, self.tree, self.algebra, self.parameters, chords, state)

    def bias(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """h(q, v)."""
        return self.inverse_dynamics(q, v, None)

    def inverse_dynamics(
        self, q: Sequence[float], v: Sequence[float], a: Sequence[float] | None
    ) -> list[float]:
        """M a + h."""
        crossed = self._arms(q, v)
        acting = self.applied(q, v, driven=False)
        entries = network_entries(self.exchange(q, v), self.algebra) if a is not None else ()
        return united_inverse_dynamics(self.tree, self.algebra, crossed, entries, a, acting)

    def coordinate_rates(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """N(q) v."""
        return orthogonality.coordinate_rates(self.tree, self.algebra, q, v)

    def constraints(self, q: Sequence[float]) -> list[float]:
        """φ(q, t), one for each constraint with an equation of position."""
        return self.chords(q, [0.0] * len(self.tree.velocities)).position()

    def constraint_jacobian(self, q: Sequence[float]) -> list[list[float]]:
        """J(q, t)."""
        return self.chords(q, [0.0] * len(self.tree.velocities)).jacobian()

    def constraint_rates(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """J v - b, which is 0 where v is allowed."""
        return self.chords(q, v).rates(v)

    def constraint_bias(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """γ of J v̇ = γ."""
        return self.chords(q, v).bias()

    def chords(self, q: Sequence[float], v: Sequence[float]) -> Chords:
        """The constraints at a state."""
        assert self.model is not None
        state = (tuple(q), tuple(v))
        rates = self.coordinate_rates(q, v) if self.tree.relations else []
        found = relations(self.model, self.tree, self.algebra, self.parameters, state, rates)
        return Chords(self.tree, self.algebra, self._arms(q, v), self.parameters, found)

    def energy(self, q: Sequence[float], v: Sequence[float]) -> tuple[float, ...]:
        """Kinetic and potential energy, that of springs included; then what networks store, if any."""
        kinetic, potential = orthogonality.energy(self.tree, self.algebra, self._arms(q, v))
        acting = self.applied(q, v, driven=False)
        exchange = self.exchange(q, v)
        stored = () if exchange is None else (exchange.energy(),)
        return kinetic, potential + (acting.potential if acting else 0), *stored

    def applied(self, q: Sequence[float], v: Sequence[float], *, driven: bool) -> Applied | None:
        """What elements and loads do that depend on inputs (`driven`), or those that do not."""
        if self.model is None:
            return None
        state = (tuple(q), tuple(v))
        crossed = self._arms(q, v)
        return applied(
            self.model, self.tree, self.algebra, self.parameters, crossed, *state, driven=driven
        )

    def _arms(self, q: Sequence[float], v: Sequence[float]) -> list[orthogonality.Arm]:
        return orthogonality.arms(self.tree, self.algebra, q, v)


def derive(model: Model) -> Derivation:
    """Unite the terminal graphs, choose the tree, check that equations of motion exist.

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
    try:
        graph = model.graph()
        formulation = formulate(model, graph)
        require_regular(model, formulation)
        derivation = Derivation(model, graph, formulation)
        if derivation.structure.closed and all(
            p.value is not None for p in model.parameters.values()
        ):
            derivation.require_relations()
            _ = derivation.assembled
        derivation.require_stores()
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
