"""A system with its chosen trees: the input of every later stage."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from linegraph.algebra.protocol import Floats
from linegraph.components.parameters import sample_values, valued
from linegraph.errors import ModelError
from linegraph.ir.dag import Dag
from linegraph.kinematics.tree import kinematic_tree, under_inputs

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.formulation.formulate import Formulation
    from linegraph.graph.forest import Topology
    from linegraph.graph.multigraph import SystemGraph
    from linegraph.kinematics.links import KinematicTree
    from linegraph.model.system import System


@dataclass(frozen=True, repr=False)
class Formulated:
    """A system with its graph and the chosen trees.

    Attributes:
        system: the frozen system: bodies, joints, elements, networks.
        graph: the system graph, all terminal graphs united.
        formulation: the chosen trees, and with them the coordinates.
    """

    system: System
    graph: SystemGraph
    formulation: Formulation

    @property
    def topology(self) -> Topology:
        """The chosen tree of the translational projection; the rotational one mostly has the same edges."""
        return self.formulation.translation

    def tree(self, algebra: Algebra, parameters: Mapping[str, Scalar]) -> KinematicTree:
        """The kinematic tree over an algebra.

        Args:
            algebra: where its scalars live: floats, SymPy expressions or nodes of a DAG.
            parameters: the parameters' scalars in that algebra, by name.

        Raises:
            ModelError: a coupling or a prescribed motion is impossible.
        """
        return kinematic_tree(self.system, self.formulation, algebra, parameters)

    @cached_property
    def sample(self) -> KinematicTree:
        """The kinematic tree in numbers: default values of parameters, drawn ones where there is none.

        The time is one at which motions are defined, and inputs are arbitrary. Whatever is judged on
        this tree (zero moments, parallel axes, rank) must not depend on them.
        """
        anywhere = Floats(t=self.system.bounds.sometime, u=_Anything())
        return self.tree(anywhere, sample_values(self.system.parameters.values(), anywhere))

    def in_numbers(self, algebra: Floats, parameters: Mapping[str, float]) -> KinematicTree:
        """The kinematic tree over floats, reusing the links of `sample` if the parameters are the same.

        Args:
            algebra: floats with the time and the inputs.
            parameters: values by name.

        Raises:
            ModelError: a prescribed motion has no value or no derivative there.
        """
        if self.valued:
            try:
                known = self.sample
            except ModelError:
                known = None  # a motion undefined at the sample time may be defined at this one
            if known is not None and known.parameters == parameters:
                return under_inputs(known, self.formulation, algebra)
        return self.tree(algebra, parameters)

    @cached_property
    def structure(self) -> KinematicTree:
        """The kinematic tree with every parameter and input a symbol: for counting and naming."""
        dag = Dag()
        parameters = self.system.parameters.values()
        return self.tree(dag, valued(parameters, dag, lambda p: dag.symbol("p", p.name)))

    def circuit_of(self, chord: str) -> list[str]:
        """The joints and constraints of the fundamental circuit of a chord, the chord last."""
        circuit = self.topology.circuit
        names = {*(joint.name for joint in self.system.joints), *self.topology_names}
        if chord not in circuit.rows:
            return [chord]
        row = circuit.entries[circuit.rows.index(chord)]
        return [*(n for j in row if (n := circuit.columns[j]) in names), chord]

    @property
    def valued(self) -> bool:
        """Whether every parameter has a value."""
        return all(p.value is not None for p in self.system.parameters.values())

    @property
    def topology_names(self) -> tuple[str, ...]:
        """The inertia edges that are branches of the tree by choice, as ``body/inertia``."""
        return tuple(f"{body}/inertia" for body in self.formulation.absolute)


class _Anything:
    """Arbitrary inputs: prescribed motions may need some, but nothing judged there depends on them."""

    def __getitem__(self, place: int) -> float:
        return 0.1 + 0.07 * place
