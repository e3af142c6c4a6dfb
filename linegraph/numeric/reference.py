"""The numeric reference: the equations of motion evaluated over floats."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

from linegraph.algebra.protocol import Floats
from linegraph.components.parameters import Parameter, valued
from linegraph.dynamics.circuit_lengths import ConstraintSizes, sizes
from linegraph.dynamics.equations import StateEquations
from linegraph.dynamics.mass_matrix import mass_matrix
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.applied_forces import Applied
    from linegraph.dynamics.chords import Chords
    from linegraph.dynamics.network_state import Exchange
    from linegraph.kinematics.formulated import Formulated
    from linegraph.kinematics.links import KinematicTree

Rows = list[list[float]]


class Numeric:
    """The equations of motion over floats: one state at a time, slow, exact up to rounding.

    Args:
        tree: the links in numbers; its algebra has the time and the inputs.
        derivation: the derivation that the tree belongs to; None for a tree made in another way.
    """

    def __init__(self, tree: KinematicTree, derivation: Formulated | None = None) -> None:
        """Keep the tree; equations are evaluated at a state."""
        self.tree = tree
        self.derivation = derivation

    @property
    def algebra(self) -> Floats:
        """The algebra of floats, with the time and the inputs."""
        return cast("Floats", self.tree.algebra)

    @property
    def parameters(self) -> Mapping[str, Scalar]:
        """The parameters' values, by name."""
        return self.tree.parameters

    @property
    def t(self) -> float:
        """The time at which everything is evaluated (s)."""
        return float(self.algebra.arguments.get("t", 0.0))

    def at_time(self, t: float) -> Numeric:
        """The equations at another time (s), with the same parameters and inputs."""
        if self.derivation is None:
            return self
        return over_floats(self.derivation, self.parameters, t, self.algebra.arguments["u"])

    @property
    def resolve(self) -> Callable[[Any], Scalar]:
        """Conversion of model values to numbers."""
        return self.tree.resolve

    def at(self, q: Sequence[float], v: Sequence[float] | None = None) -> StateEquations:
        """The equations at a state.

        Args:
            q: the coordinates, one per `tree.positions` (rad, m; quaternions x, y, z, w).
            v: the velocities, one per `tree.velocities` (rad/s, m/s); zero if omitted.
        """
        velocities = [0.0] * len(self.tree.velocities) if v is None else v
        return StateEquations(self.tree, q, velocities)

    @cached_property
    def sizes(self) -> ConstraintSizes:
        """The sizes by which constraints and velocities become pure numbers."""
        return sizes(self.tree)

    def mass_matrix(self, q: Sequence[float], v: Sequence[float] | None = None) -> Rows:
        """Mass matrix M(q), n x n; M(q, v) if stores of networks depend on their states.

        Args:
            q: the coordinates.
            v: the velocities; zero if omitted.
        """
        return self.at(q, v).mass_matrix

    def mechanical_mass_matrix(self, q: Sequence[float]) -> Rows:
        """The mass matrix of mechanics alone, without states of networks and their entries."""
        rows, size = mass_matrix(self.at(q).state), self.tree.layout.mechanical
        return [row[:size] for row in rows[:size]]

    def exchange(self, q: Sequence[float], v: Sequence[float]) -> Exchange | None:
        """The networks at a state; None if there are none.

        Args:
            q: the coordinates.
            v: the velocities.
        """
        return self.at(q, v).networks

    def bias(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """Bias h(q, v): generalised forces for v̇ = 0, gravity and passive forces included (N m or N).

        Args:
            q: the coordinates.
            v: the velocities.
        """
        return self.at(q, v).bias

    def inverse_dynamics(
        self, q: Sequence[float], v: Sequence[float], a: Sequence[float]
    ) -> list[float]:
        """Generalised forces ``M a + h`` (N m or N).

        Args:
            q: the coordinates.
            v: the velocities.
            a: the accelerations v̇.
        """
        return self.at(q, v).inverse_dynamics(a)

    def forces(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """Generalised forces Q: joint efforts, and elements and loads that inputs drive (N m or N).

        Args:
            q: the coordinates.
            v: the velocities.
        """
        return self.at(q, v).forces

    def coordinate_rates(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """Rates of the coordinates, ``q̇ = N(q) v``.

        Args:
            q: the coordinates.
            v: the velocities.
        """
        return self.at(q, v).coordinate_rates

    def constraints(self, q: Sequence[float]) -> list[float]:
        """Residuals φ(q, t), one per holonomic constraint (m or rad)."""
        return self.at(q).constraints

    def constraint_jacobian(self, q: Sequence[float]) -> Rows:
        """Jacobian J(q, t), constraints x velocities."""
        return self.at(q).jacobian

    def constraint_rates(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """Residuals ``J v - b`` of the constraints of velocity: zero for admissible v.

        Args:
            q: the coordinates.
            v: the velocities.
        """
        return self.at(q, v).constraint_rates

    def constraint_bias(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """Right-hand side γ of the constraints of acceleration, ``J v̇ = γ``.

        Args:
            q: the coordinates.
            v: the velocities.
        """
        return self.at(q, v).constraint_bias

    def chords(self, q: Sequence[float], v: Sequence[float]) -> Chords:
        """The constraints at a state, with the motion of all joint ends.

        Args:
            q: the coordinates.
            v: the velocities.
        """
        return self.at(q, v).chords

    def energy(self, q: Sequence[float], v: Sequence[float]) -> tuple[float, ...]:
        """Kinetic and potential energy (J), springs included; then the networks' energy, if there are any.

        Args:
            q: the coordinates.
            v: the velocities.
        """
        return self.at(q, v).energy

    def applied(self, q: Sequence[float], v: Sequence[float], *, driven: bool) -> Applied:
        """Forces of elements and loads that depend on inputs, or of those that do not.

        Args:
            q: the coordinates.
            v: the velocities.
            driven: True for laws that name inputs, False for the others.
        """
        return self.at(q, v).applied(driven=driven)


def over_floats(
    formulated: Formulated,
    parameters: Mapping[str, float] | None = None,
    t: float = 0.0,
    u: Sequence[float] | None = None,
) -> Numeric:
    """The equations of a formulated system over floats, at a time and for inputs.

    Args:
        formulated: the system and its trees.
        parameters: values instead of the system's own.
        t: the time (s).
        u: the inputs; all zero if omitted.

    Raises:
        ModelError: a parameter has no value, or the number of inputs is wrong.
    """
    chosen = parameters or {}
    count = len(formulated.structure.inputs)
    inputs = [0.0] * count if u is None else list(u)
    if len(inputs) != count:
        raise ModelError("u", f"{count} inputs are needed, got {len(inputs)}")

    def given(parameter: Parameter) -> float:
        value = chosen.get(parameter.name, parameter.value)
        if value is None:
            raise ModelError(f'parameter "{parameter.name}"', "has no value")
        return float(value)

    algebra = Floats(t=t, u=inputs)
    values = valued(formulated.system.parameters.values(), algebra, given)
    return Numeric(formulated.in_numbers(algebra, values), formulated)
