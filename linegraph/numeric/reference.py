"""The numeric reference: a derivation run over floats."""

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
    """The derivation run over floats: one state at a time, slow, exact to rounding.

    Args:
        tree: the links, in numbers; its algebra has the time and the inputs.
        derivation: what it is of; None for a tree that was made otherwise.
    """

    def __init__(self, tree: KinematicTree, derivation: Formulated | None = None) -> None:
        """Nothing is evaluated yet."""
        self.tree = tree
        self.derivation = derivation

    @property
    def algebra(self) -> Floats:
        """The time and the inputs."""
        return cast("Floats", self.tree.algebra)

    @property
    def parameters(self) -> Mapping[str, Scalar]:
        """The parameters' values."""
        return self.tree.parameters

    @property
    def t(self) -> float:
        """The time (s)."""
        return float(self.algebra.arguments.get("t", 0.0))

    def at_time(self, t: float) -> Numeric:
        """The same at another time (s)."""
        if self.derivation is None:
            return self
        return over_floats(self.derivation, self.parameters, t, self.algebra.arguments["u"])

    @property
    def resolve(self) -> Callable[[Any], Scalar]:
        """From model values to numbers."""
        return self.tree.resolve

    def at(self, q: Sequence[float], v: Sequence[float] | None = None) -> StateEquations:
        """The equations at a state; at rest where no v is given."""
        velocities = [0.0] * len(self.tree.velocities) if v is None else v
        return StateEquations(self.tree, q, velocities)

    @cached_property
    def sizes(self) -> ConstraintSizes:
        """What constraints and velocities are measured by."""
        return sizes(self.tree)

    def mass_matrix(self, q: Sequence[float], v: Sequence[float] | None = None) -> Rows:
        """M(q); of networks whose stores depend on their states M(q, v)."""
        return self.at(q, v).mass_matrix

    def mechanical_mass_matrix(self, q: Sequence[float]) -> Rows:
        """Its part of mechanics, without what networks add."""
        rows, size = mass_matrix(self.at(q).state), self.tree.layout.mechanical
        return [row[:size] for row in rows[:size]]

    def exchange(self, q: Sequence[float], v: Sequence[float]) -> Exchange | None:
        """The networks at a state."""
        return self.at(q, v).networks

    def bias(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """h(q, v)."""
        return self.at(q, v).bias

    def inverse_dynamics(
        self, q: Sequence[float], v: Sequence[float], a: Sequence[float]
    ) -> list[float]:
        """M a + h."""
        return self.at(q, v).inverse_dynamics(a)

    def forces(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """Q: joint efforts, and what inputs drive."""
        return self.at(q, v).forces

    def coordinate_rates(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """N(q) v."""
        return self.at(q, v).coordinate_rates

    def constraints(self, q: Sequence[float]) -> list[float]:
        """φ(q, t), one for each constraint with an equation of position."""
        return self.at(q).constraints

    def constraint_jacobian(self, q: Sequence[float]) -> Rows:
        """J(q, t)."""
        return self.at(q).jacobian

    def constraint_rates(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """J v - b, which is 0 where v is allowed."""
        return self.at(q, v).constraint_rates

    def constraint_bias(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """γ of J v̇ = γ."""
        return self.at(q, v).constraint_bias

    def chords(self, q: Sequence[float], v: Sequence[float]) -> Chords:
        """The constraints at a state."""
        return self.at(q, v).chords

    def energy(self, q: Sequence[float], v: Sequence[float]) -> tuple[float, ...]:
        """Kinetic and potential energy (J), that of springs included; then what networks store, if any."""
        return self.at(q, v).energy

    def applied(self, q: Sequence[float], v: Sequence[float], *, driven: bool) -> Applied:
        """What elements and loads do that depend on inputs (`driven`), or those that do not."""
        return self.at(q, v).applied(driven=driven)


def over_floats(
    formulated: Formulated,
    parameters: Mapping[str, float] | None = None,
    t: float = 0.0,
    u: Sequence[float] | None = None,
) -> Numeric:
    """A derivation over floats, at a time and for inputs.

    Args:
        formulated: the system and its trees.
        parameters: values in place of the system's own.
        t: the time (s).
        u: the inputs; all zero if left out.

    Raises:
        ModelError: a parameter has no value, or there are more or fewer inputs.
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
