"""From a model to equations: the pipeline, stage by stage.

    Model ──graph()──→ SystemGraph ──mechanical_topology──→ Topology
          ──kinematic_tree──→ KinematicTree ──orthogonality──→ M, h, ... over any algebra
          ──programs──→ Module ──codegen.render──→ files

Each arrow is one pure function.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph import orthogonality
from linegraph.algebra import Algebra, Floats
from linegraph.errors import ModelError, SourceError
from linegraph.expression import Dag
from linegraph.kinematics import KinematicTree, kinematic_tree, mechanical_topology
from linegraph.loads import Applied, applied
from linegraph.mass_matrix import mass_matrix
from linegraph.parameters import Parameter, valued
from linegraph.regularity import require_regular

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.graph import SystemGraph
    from linegraph.model import Model
    from linegraph.topology import Topology
    from linegraph.vector import Scalar


@dataclass(frozen=True)
class Derivation:
    """A model with its graph, its topology and the equations that follow.

    Attributes:
        model: what was said.
        graph: the united terminal graph.
        topology: the chosen tree of the translational projection; the rotational one has the same edges.
    """

    model: Model
    graph: SystemGraph
    topology: Topology

    def tree(self, algebra: Algebra, parameters: Mapping[str, Scalar]) -> KinematicTree:
        """The links over an algebra, parameters as given."""
        return kinematic_tree(self.model, self.topology, algebra, parameters)

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
        return Numeric(self.tree(algebra, values), self.model, algebra, values)

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
    """

    tree: KinematicTree
    model: Model | None = None
    algebra: Floats = field(default_factory=Floats)
    parameters: Mapping[str, Scalar] = field(default_factory=dict)

    def mass_matrix(self, q: Sequence[float]) -> list[list[float]]:
        """M(q)."""
        return mass_matrix(
            self.tree, self.algebra, self._arms(q, [0.0] * len(self.tree.velocities))
        )

    def bias(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """h(q, v)."""
        return self.inverse_dynamics(q, v, None)

    def inverse_dynamics(
        self, q: Sequence[float], v: Sequence[float], a: Sequence[float] | None
    ) -> list[float]:
        """M a + h."""
        crossed = self._arms(q, v)
        acting = self.applied(q, v, driven=False)
        return orthogonality.inverse_dynamics(self.tree, self.algebra, crossed, a, acting)

    def energy(self, q: Sequence[float], v: Sequence[float]) -> tuple[float, float]:
        """Kinetic and potential energy, that of springs included."""
        kinetic, potential = orthogonality.energy(self.tree, self.algebra, self._arms(q, v))
        acting = self.applied(q, v, driven=False)
        return kinetic, potential + (acting.potential if acting else 0)

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
        topology = mechanical_topology(model, graph)
        require_regular(model, topology)
    except ModelError as error:
        raise _placed(error, model) from None
    return Derivation(model, graph, topology)


def _placed(error: ModelError, model: Model) -> ModelError:
    """Give an error the place in the file that the model was read from."""
    if model.source is None:
        return error
    return SourceError(model.source, model.places.get(error.thing), error.thing, error.problem)
