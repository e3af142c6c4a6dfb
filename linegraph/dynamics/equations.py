"""The equations of motion of a tree at a state, put together once for all algebras.

Emitted programs, closed forms and the float reference are thin over this: they choose the algebra and the
state, and ask. Every quantity is derived when it is first asked for, and kept.

    M(q) v̇ + h(q, v) = Q + J^T λ        J v̇ = γ        φ(q, t) = 0        J v = b

A new term of the equations is entered here, and in nothing else.
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
        q: the coordinates.
        v: the velocities.
        shortest: the same links in working frames in which M and h take fewer operations; the walk's own
            where None.
        solution: gives v̇ and λ, which through variables of edges need; called when they are asked for.
    """

    def __init__(
        self,
        tree: KinematicTree,
        q: Sequence[Scalar],
        v: Sequence[Scalar],
        shortest: Shortened | None = None,
        solution: Callable[[], Solution] | None = None,
    ) -> None:
        """Nothing is derived yet."""
        self.tree = tree
        self.q = q
        self.v = v
        self._shortest = shortest
        self._solution = solution

    # -- what moves

    @cached_property
    def state(self) -> TreeState:
        """The links where they are, in the frames of the walk."""
        return TreeState(self.tree, self.q, self.v)

    @cached_property
    def working(self) -> TreeState:
        """The state in the frames that M and h are derived in."""
        if self._shortest is None:
            return self.state
        return TreeState(self._shortest.tree, self.q, self.v)

    @cached_property
    def coordinate_rates(self) -> list[Scalar]:
        """``q̇ = N(q) v``."""
        return coordinate_rates(self.tree, self.q, self.v)

    # -- the tree

    @cached_property
    def networks(self) -> Exchange | None:
        """The scalar networks at the state; None if there are none."""
        chords = self.chords
        return None if self.tree.network is None else ForceLaws(chords).exchange

    @cached_property
    def stored(self) -> Entries:
        """What the networks add to the mass matrix: row, column, entry."""
        return network_entries(self.networks)

    @cached_property
    def mass_matrix(self) -> list[list[Scalar]]:
        """M, symmetric without networks; in the units of v, forces over accelerations."""
        return united_mass_matrix(self.working, self.stored)

    @cached_property
    def bias(self) -> list[Scalar]:
        """h, with all that acts and no input drives."""
        return orthogonality.inverse_dynamics(self.working, None, self.rehoused(self.passive))

    def inverse_dynamics(self, a: Sequence[Scalar]) -> list[Scalar]:
        """``M a + h`` without forming M."""
        return self.required_by(self.passive, a)

    def required_by(self, acting: Applied, a: Sequence[Scalar]) -> list[Scalar]:
        """``M a + h`` where all that acts is `acting`."""
        return united_inverse_dynamics(self.working, self.stored, a, self.rehoused(acting))

    @cached_property
    def passive(self) -> Applied:
        """Springs, dampers and loads that no input drives: part of the bias."""
        return self.applied(driven=False)

    @cached_property
    def active(self) -> Applied:
        """Elements and loads that inputs drive: part of Q."""
        return self.applied(driven=True)

    def applied(self, *, driven: bool, network: str | None = None) -> Applied:
        """What elements and loads do that inputs drive (`driven`), or those that none drives."""
        return applied(self.chords, driven=driven, network=network)

    def along(self, acting: Applied) -> list[Scalar]:
        """What forces do along v."""
        return orthogonality.generalised_forces(self.working, self.rehoused(acting))

    def rehoused(self, acting: Applied) -> Applied:
        """Forces given in the frames of the walk, in the working ones."""
        if self._shortest is None:
            return acting
        wrenches = self._shortest.rehoused(acting.wrenches, self.working.arms)
        return replace(acting, wrenches=wrenches)

    @cached_property
    def forces(self) -> list[Scalar]:
        """Q: the joints' efforts, and what inputs drive."""
        return efforts(self.chords, self.along(self.active))

    @cached_property
    def energy(self) -> tuple[Scalar, ...]:
        """Kinetic and potential energy (J), that of springs included; then what networks store, if any."""
        kinetic, potential = orthogonality.energy(self.state)
        found = (kinetic, potential + self.passive.potential)
        return found if self.networks is None else (*found, self.networks.energy())

    # -- the constraints

    @cached_property
    def chords(self) -> Chords:
        """The constraints, and how the ends of every joint move."""
        return Chords(self.state)

    @property
    def constraint_equations(self) -> list[ChordEquation]:
        """What each constraint is of, in the order of J's rows."""
        return self.chords.equations

    @cached_property
    def constraints(self) -> list[Scalar]:
        """φ(q, t), one for each constraint with an equation of position."""
        return self.chords.position()

    @cached_property
    def jacobian(self) -> list[list[Scalar]]:
        """J(q, t), constraints x velocities."""
        return self.chords.jacobian()

    @cached_property
    def constraint_rates(self) -> list[Scalar]:
        """``J v - b``, which is 0 where v is allowed."""
        return self.chords.rates()

    @cached_property
    def constraint_bias(self) -> list[Scalar]:
        """γ of ``J v̇ = γ``."""
        return self.chords.bias()

    # -- the edges

    @cached_property
    def edges(self) -> InverseScheme:
        """Across and through variables of every edge of the system graph; masses are the model's own."""
        if self._solution is None:
            return InverseScheme(self.chords)
        return InverseScheme(self.chords, *self._solution())

    @cached_property
    def outputs(self) -> tuple[list[Scalar], bool]:
        """The outputs that the model names, and whether one of them takes accelerations."""
        return observed(self.edges)
