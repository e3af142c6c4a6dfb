"""The numeric reference: a derivation run over floats."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.algebra.protocol import Floats
from linegraph.components.parameters import Parameter, resolver, valued
from linegraph.dynamics import orthogonality
from linegraph.dynamics.applied_forces import Applied, applied
from linegraph.dynamics.chords import Chords, equations
from linegraph.dynamics.circuit_lengths import ConstraintSizes, Given, sizes
from linegraph.dynamics.law_names import relations
from linegraph.dynamics.mass_matrix import mass_matrix
from linegraph.dynamics.whole_system import (
    exchange_at,
    network_entries,
    united_inverse_dynamics,
    united_mass_matrix,
)
from linegraph.errors import ModelError
from linegraph.kinematics.arms import Arm, arms, coordinate_rates

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.network_state import Exchange
    from linegraph.kinematics.formulated import Formulated
    from linegraph.kinematics.links import KinematicTree
    from linegraph.model.system import System


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
    model: System | None = None
    algebra: Floats = field(default_factory=Floats)
    parameters: Mapping[str, Scalar] = field(default_factory=dict)
    derivation: Formulated | None = None

    @property
    def t(self) -> float:
        """The time."""
        return float(self.algebra.arguments.get("t", 0.0))

    def at(self, t: float) -> Numeric:
        """The same at another time."""
        if self.derivation is None:
            return self
        return over_floats(self.derivation, self.parameters, t, self.algebra.arguments["u"])

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

    @cached_property
    def sizes(self) -> ConstraintSizes:
        """What constraints and velocities are measured by."""
        given = Given(self.tree, self.algebra, self.parameters)
        return sizes(given, equations(self.tree))

    def coordinate_rates(self, q: Sequence[float], v: Sequence[float]) -> list[float]:
        """N(q) v."""
        return coordinate_rates(self.tree, self.algebra, q, v)

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

    def _arms(self, q: Sequence[float], v: Sequence[float]) -> list[Arm]:
        return arms(self.tree, self.algebra, q, v)


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
    return Numeric(formulated.tree(algebra, values), formulated.system, algebra, values, formulated)
