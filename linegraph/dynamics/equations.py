"""The equations of motion of a tree at a state, composed once for all algebras.

Emitted programs, closed forms and the float reference only choose the algebra and the state. Every
quantity is derived when it is first needed, and kept.

    M(q) v̇ + h(q, v) = Q + Jᵀ λ        J v̇ = γ        φ(q, t) = 0        J v = b

This is the only place where a new term of the equations is entered.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

from linegraph.dynamics import orthogonality
from linegraph.dynamics.applied_forces import Applied, applied, efforts
from linegraph.dynamics.chords import ChordEquation, Chords
from linegraph.dynamics.edge_variables import InverseScheme
from linegraph.dynamics.force_laws import ForceLaws
from linegraph.dynamics.outputs import observed
from linegraph.dynamics.whole_system import (
    network_entries,
    united_inverse_dynamics,
    united_mass_matrix,
)
from linegraph.kinematics.arms import coordinate_rates
from linegraph.kinematics.tree_state import TreeState

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.network_state import Exchange
    from linegraph.dynamics.whole_system import Entries
    from linegraph.kinematics.links import KinematicTree
    from linegraph.kinematics.working_frames import Shortened

    Solution = tuple[Sequence[Scalar], Sequence[Scalar]]


class StateEquations:
    """The equations of motion at one state, over the algebra of its tree.

    Args:
        tree: the links of the walk.
        q: the coordinates, one per `tree.positions`.
        v: the velocities, one per `tree.velocities`.
        shortest: the same links in working frames in which M and h take fewer operations; if None,
            those of the walk are used.
        solution: returns v̇ and λ, which through variables of edges need; called only if these are
            requested.
    """

    def __init__(
        self,
        tree: KinematicTree,
        q: Sequence[Scalar],
        v: Sequence[Scalar],
        shortest: Shortened | None = None,
        solution: Callable[[], Solution] | None = None,
    ) -> None:
        """Keep the arguments; quantities are derived when they are first needed."""
        self.tree = tree
        self.q = q
        self.v = v
        self._shortest = shortest
        self._solution = solution

    # -- kinematics

    @cached_property
    def state(self) -> TreeState:
        """The tree at the state, in the working frames of the walk."""
        return TreeState(self.tree, self.q, self.v)

    @cached_property
    def working(self) -> TreeState:
        """The tree at the state, in the working frames in which M and h are derived."""
        if self._shortest is None:
            return self.state
        return TreeState(self._shortest.tree, self.q, self.v)

    @cached_property
    def coordinate_rates(self) -> list[Scalar]:
        """Rates of the coordinates, ``q̇ = N(q) v``."""
        return coordinate_rates(self.tree, self.q, self.v)

    # -- the tree

    @cached_property
    def networks(self) -> Exchange | None:
        """The scalar networks at the state; None if there are none."""
        chords = self.chords
        return None if self.tree.network is None else ForceLaws(chords).exchange

    @cached_property
    def stored(self) -> Entries:
        """Entries that the networks add to the mass matrix: row, column, value."""
        return network_entries(self.networks)

    @cached_property
    def mass_matrix(self) -> list[list[Scalar]]:
        """M, n x n, symmetric unless networks have controlled sources (kg m² or kg in mechanics)."""
        return united_mass_matrix(self.working, self.stored)

    @cached_property
    def bias(self) -> list[Scalar]:
        """h, on the left of M v̇ + h = Q: Coriolis, centrifugal and gravity terms less passive forces."""
        return orthogonality.inverse_dynamics(self.working, None, self.rehoused(self.passive))

    def inverse_dynamics(self, a: Sequence[Scalar]) -> list[Scalar]:
        """Generalised forces ``M a + h`` for the accelerations a, without forming M."""
        return self.required_by(self.passive, a)

    def required_by(self, acting: Applied, a: Sequence[Scalar]) -> list[Scalar]:
        """Generalised forces ``M a + h`` with h for the given applied forces instead of the passive ones.

        Args:
            acting: applied forces, in the frames of the walk.
            a: accelerations v̇ (rad/s², m/s²).
        """
        return united_inverse_dynamics(self.working, self.stored, a, self.rehoused(acting))

    @cached_property
    def passive(self) -> Applied:
        """Springs, dampers and loads that no input drives: part of the bias h."""
        return self.applied(driven=False)

    @cached_property
    def active(self) -> Applied:
        """Elements and loads that inputs drive: part of Q."""
        return self.applied(driven=True)

    def applied(self, *, driven: bool, network: str | None = None) -> Applied:
        """Forces of elements and loads that inputs drive, or of those that none drives.

        Args:
            driven: which of the two.
            network: the part of the networks' forces to include; see `applied_forces.applied`.
        """
        return applied(self.chords, driven=driven, network=network)

    def along(self, acting: Applied) -> list[Scalar]:
        """Generalised forces of applied forces, one per velocity (N m or N)."""
        return orthogonality.generalised_forces(self.working, self.rehoused(acting))

    def rehoused(self, acting: Applied) -> Applied:
        """Applied forces transformed from the frames of the walk to the working ones."""
        if self._shortest is None:
            return acting
        wrenches = self._shortest.rehoused(acting.wrenches, self.working.arms)
        return replace(acting, wrenches=wrenches)

    @cached_property
    def forces(self) -> list[Scalar]:
        """Q: the joints' efforts, and elements and loads that inputs drive."""
        return efforts(self.chords, self.along(self.active))

    @cached_property
    def energy(self) -> tuple[Scalar, ...]:
        """Kinetic and potential energy (J), springs included; then the networks' energy, if there are any."""
        kinetic, potential = orthogonality.energy(self.state)
        found = (kinetic, potential + self.passive.potential)
        return found if self.networks is None else (*found, self.networks.energy())

    # -- the constraints

    @cached_property
    def chords(self) -> Chords:
        """The constraints, with the motion of both ends of every joint."""
        return Chords(self.state)

    @property
    def constraint_equations(self) -> list[ChordEquation]:
        """The constraints in the order of J's rows."""
        return self.chords.equations

    @cached_property
    def constraints(self) -> list[Scalar]:
        """Residuals φ(q, t), one per holonomic constraint."""
        return self.chords.position()

    @cached_property
    def jacobian(self) -> list[list[Scalar]]:
        """J(q, t), constraints x velocities."""
        return self.chords.jacobian()

    @cached_property
    def constraint_rates(self) -> list[Scalar]:
        """Residuals ``J v - b``: zero for admissible v."""
        return self.chords.rates()

    @cached_property
    def constraint_bias(self) -> list[Scalar]:
        """Right-hand side γ of ``J v̇ = γ``."""
        return self.chords.bias()

    # -- the edges

    @cached_property
    def edges(self) -> InverseScheme:
        """Across and through variables of every edge of the system graph, with the model's own masses."""
        if self._solution is None:
            return InverseScheme(self.chords)
        return InverseScheme(self.chords, *self._solution())

    @cached_property
    def outputs(self) -> tuple[list[Scalar], bool]:
        """The model's outputs, and whether one of them depends on accelerations."""
        return observed(self.edges)
