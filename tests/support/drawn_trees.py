"""Random trees at a random state, for the Newton-Euler oracle and as links over floats or a DAG."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from oracles import newton_euler as oracle
from support.chains import formulated, walked
from support.dag_values import values
from support.spec_models import model_of
from systems import random_trees as trees

from linegraph.ir.dag import Dag
from linegraph.kinematics.tree import kinematic_tree
from linegraph.kinematics.tree_state import TreeState

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import linegraph as lg

KINDS: dict[str, tuple[str, ...]] = {
    "revolute": ("revolute",),
    "prismatic": ("prismatic", "revolute"),
    "planar": ("planar", "revolute"),
    "free": ("free", "revolute"),
    "any": trees.KINDS,
}
"""The joints that a tree is drawn from; the first one is among them."""


class Drawn(NamedTuple):
    """A tree of four bodies and a state.

    Attributes:
        spec: what the oracle reads.
        model: the same as a model.
        q, v, a: a state and accelerations, from the same seed.
    """

    spec: trees.Tree
    model: lg.Model
    q: Any
    v: Any
    a: Any

    def over_floats(self) -> TreeState:
        """The links at the state."""
        return TreeState(walked(self.model), self.q.tolist(), self.v.tolist())

    def over_dag(self, function: Callable[[TreeState], Sequence[Any]]) -> Any:
        """The values of a function of the links at a state of symbols."""
        dag = Dag()
        tree = kinematic_tree(self.model.system(), formulated(self.model), dag, {})
        q = [dag.symbol("q", k) for k in range(len(self.q))]
        v = [dag.symbol("v", k) for k in range(len(self.v))]
        found = function(TreeState(tree, q, v))
        return np.array(values(list(found), {"q": self.q, "v": self.v}), float)


def drawn(seed: int, kinds: str = "any", **options: Any) -> Drawn:
    """The tree of a seed, from joints of `KINDS`; `options` are those of `random_tree`."""
    rng = np.random.default_rng(seed)
    while True:
        spec = trees.random_tree(rng, bodies=4, kinds=KINDS[kinds], **options)
        if kinds == "any" or kinds in {joint.kind for joint in spec.active}:
            break
    q, v = trees.random_state(rng, spec)
    return Drawn(spec, model_of(spec), q, v, rng.normal(size=spec.nv))


def differences(drawn: Drawn, function: Callable[..., Any], step: float = 1e-3) -> Any:
    """The derivatives of a function of q along every velocity, by differences of fourth order.

    The state moves along one velocity at a time: of an orientation that is a turn about the body's axes.
    """
    columns = []
    for unit in np.eye(drawn.spec.nv):
        column = 0.0
        for shift, weight in ((-2, 1), (-1, -8), (1, 8), (2, -1)):
            q, _ = oracle.advance(drawn.spec, drawn.q, unit, 0 * unit, shift * step)
            column = column + weight * np.asarray(function(q)) / (12 * step)
        columns.append(column)
    return np.moveaxis(np.array(columns), 0, -1)
