"""From a model to equations: the pipeline, stage by stage.

    Model ──graph()──→ SystemGraph ──mechanical_topology──→ Topology
          ──kinematic_tree──→ KinematicTree ──orthogonality──→ M, h, ... over any algebra
          ──programs──→ Module ──codegen.render──→ files

Each arrow is one pure function.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph import orthogonality
from linegraph.algebra import Algebra, Floats
from linegraph.errors import ModelError, SourceError
from linegraph.kinematics import KinematicTree, kinematic_tree, mechanical_topology
from linegraph.mass_matrix import mass_matrix
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

    def numeric(self, parameters: Mapping[str, float] | None = None) -> Numeric:
        """The numeric reference: the same derivation over floats.

        Raises:
            ModelError: a parameter has no value.
        """
        values = {**default_values(self.model), **(parameters or {})}
        for name in self.model.parameters:
            if name not in values:
                raise ModelError(f'parameter "{name}"', "has no value")
        return Numeric(self.tree(Floats(), values))

    @cached_property
    def symbolic(self) -> Any:
        """The closed forms: the same derivation over sympy (`symbols.Symbolic`)."""
        from linegraph.symbols import Symbolic

        return Symbolic(self)


@dataclass(frozen=True)
class Numeric:
    """The derivation run over floats: one state at a time, slow, exact to rounding."""

    tree: KinematicTree

    def mass_matrix(self, q: Sequence[float]) -> list[list[float]]:
        """M(q)."""
        crossed = orthogonality.arms(self.tree, Floats(), q, [0.0] * len(self.tree.velocities))
        return mass_matrix(self.tree, Floats(), crossed)

    def bias(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """h(q, v)."""
        return self.inverse_dynamics(q, v, None)

    def inverse_dynamics(
        self, q: Sequence[float], v: Sequence[float], a: Sequence[float] | None
    ) -> list[float]:
        """M a + h."""
        crossed = orthogonality.arms(self.tree, Floats(), q, v)
        return orthogonality.inverse_dynamics(self.tree, Floats(), crossed, a)

    def energy(self, q: Sequence[float], v: Sequence[float]) -> tuple[float, float]:
        """Kinetic and potential energy."""
        crossed = orthogonality.arms(self.tree, Floats(), q, v)
        return orthogonality.energy(self.tree, Floats(), crossed)


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


def default_values(model: Model) -> dict[str, float]:
    """Every parameter's value; one without stays out."""
    return {p.name: p.value for p in model.parameters.values() if p.value is not None}
