"""A kinematic tree at a state (q, v), at which all equations of motion are evaluated."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from linegraph.kinematics.arms import arms, coordinate_rates

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.links import KinematicTree


class TreeState:
    """A tree at a state (q, v), over the tree's own algebra.

    Args:
        tree: the links.
        q: the coordinates, one per entry of `tree.positions` (rad, m; quaternions have length 1).
        v: the velocities, one per entry of `tree.velocities` (rad/s, m/s), states of networks included.
    """

    def __init__(self, tree: KinematicTree, q: Iterable[Scalar], v: Iterable[Scalar]) -> None:
        """Evaluate the joints' motions, from which everything else follows."""
        self.tree = tree
        self.q = tuple(q)
        self.v = tuple(v)
        self.arms = arms(tree, self.q, self.v)
        """Each link's motion relative to its parent, in the order of the tree's links."""

    @property
    def algebra(self) -> Algebra:
        """The algebra in which the state's scalars live."""
        return self.tree.algebra

    @cached_property
    def coordinate_rates(self) -> list[Scalar]:
        """Rates of the coordinates, ``q̇ = N(q) v``."""
        return coordinate_rates(self.tree, self.q, self.v)
