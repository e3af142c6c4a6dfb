"""Derivatives of the equations of motion, each column by one complex step (`steps`).

Steps go along q̇ = N d for changes of position d, and along v, u or a parameter. The residual is zero:

    r = M v̇ + h - Q = 0        ∂v̇/∂x = -M⁻¹ ∂r/∂x

With constraints, v̇ is solved for in the independent coordinates, entirely at the shifted state. A change
of position d is transported by the motion itself: d' = dv + [bracket] d, with the Lie bracket of the two
motions.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.dynamics.chords import equations
from linegraph.verification.golden.bodies import Bodies
from linegraph.verification.golden.constraints import Constraints
from linegraph.verification.golden.steps import STEP, Beside, Complexes, stepped
from linegraph.verification.golden.walk import Walk, coordinate_rates

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.verification.golden.point import Point
    from linegraph.verification.golden.walk import Valued

    Array = Any


IDLE = 1e-2
"""Lower bound on a derivative's size, relative to those by other variables of its kind."""


class _Slopes(NamedTuple):
    """Derivatives of M (n x n x k), h and Q (n x k) with respect to k variables.

    `terms` are the sizes of the terms of ∂h - ∂Q. A diode's own slope and its slope through the voltage
    that follows may cancel.
    """

    mass: Array
    bias: Array
    forces: Array
    terms: Array


@dataclass(frozen=True)
class Derivatives:
    """Derivatives of the equations of motion at a state.

    Each result is an array and the size of its entries. Changes of position are expressed in velocities, on
    the tangent space: δq = N d.

    Attributes:
        point: the state and the reference quantities at it.
    """

    point: Point

    # -- along what

    @property
    def _motions(self) -> Array:
        """N (nq x n): change of q for unit changes of position."""
        return self.point.walk.rates_by_direction[:, : self._count]

    @property
    def _count(self) -> int:
        """Number of changes of position: one for each velocity of mechanics."""
        return int(self.point.walk.tree.layout.mechanical)

    def _beside(
        self,
        dq: Sequence[float] = (),
        dv: Sequence[float] = (),
        du: Sequence[float] = (),
        parameters: Mapping[str, complex] | None = None,
        *,
        held: bool = False,
    ) -> Walk:
        """The motion at a state shifted by i h along a direction.

        Args:
            dq: nq, direction in q; empty for none.
            dv: n, direction in v; empty for none.
            du: nu, direction in u; empty for none.
            parameters: complex values in place of the state's own.
            held: whether unknowns of algebraic loops keep their values instead of following.
        """
        point = self.point
        q, v = _moved(point.q, dq), _moved(point.v, dv)
        u = _moved(point.u, du) if len(du) else None
        numeric = stepped(point.walk.numeric, Beside(q, v, u, parameters=parameters), held=held)
        return Walk(numeric, q, v)

    @property
    def _follows(self) -> bool:
        """Whether there are unknowns of an algebraic loop."""
        network = self.point.walk.tree.network
        return network is not None and bool(network.loop)

    def _slopes(
        self, steps: Sequence[Mapping[str, Any]], *, mass: bool = True, bias: bool = True
    ) -> _Slopes:
        """Derivatives along each of some steps.

        Args:
            steps: keyword arguments of `_beside`, one entry for each variable.
            mass: False where M is known not to depend on the variables.
            bias: False where h is known not to depend on them.
        """
        np, n, k = self.point.walk.np, len(self.point.v), len(steps)
        found = _Slopes(np.zeros((n, n, k)), *(np.zeros((n, k)) for _ in range(3)))
        for i, step in enumerate(steps):
            bodies = Bodies(self._beside(**step))
            if mass:
                found.mass[:, :, i] = bodies.mass_matrix[0].imag / STEP
            if bias:
                found.bias[:, i] = bodies.bias[0].imag / STEP
            found.forces[:, i] = bodies.forces[0].imag / STEP
            if self._follows:
                alone = Bodies(self._beside(**step, held=True))
                own = (alone.bias[0] - alone.forces[0]).imag / STEP
                whole = found.bias[:, i] - found.forces[:, i]
                found.terms[:, i] = np.abs(own) + np.abs(whole - own)
        return found

    @cached_property
    def _by_changes(self) -> _Slopes:
        return self._slopes([{"dq": dq} for dq in self._motions.T])

    @cached_property
    def _by_velocities(self) -> _Slopes:
        units = self.point.walk.np.eye(len(self.point.v))
        # M depends on velocities only through the stores of networks, whose states are among v.
        mass = self.point.walk.tree.network is not None
        return self._slopes([{"dv": dv} for dv in units], mass=mass)

    @cached_property
    def _by_inputs(self) -> _Slopes:
        units = self.point.walk.np.eye(len(self.point.u))
        # M and h depend on inputs that prescribe motions or enter laws, and not on efforts.
        tree = self.point.walk.tree
        driven = any(link.place.drive for link in tree.links) or any(c.drive for c in tree.closures)
        moving = driven or bool(tree.layout.named_inputs)
        return self._slopes([{"du": du} for du in units], mass=moving, bias=moving)

    @cached_property
    def _by_parameters(self) -> _Slopes:
        values = self.point.walk.numeric.parameters
        names = [p.name for p in self.point.derivation.system.parameters.values() if not p.derived]
        steps = [{name: complex(values[name], STEP)} for name in names]
        return self._slopes([{"parameters": step} for step in steps])

    # -- of tau

    def _of_tau(self, by: _Slopes, unit: Any = 1.0) -> Valued:
        """∂(M a + h)/∂x for any a."""
        np = self.point.walk.np
        found = np.einsum("ijk,j->ik", by.mass, self.point.a) + by.bias
        return found, np.maximum(self._sizes(found, self.point.inverse[1], unit), by.terms)

    @property
    def tau_by_changes(self) -> Valued:
        """∂τ/∂q on the tangent space, n x n: the derivative of τ = M a + h along δq = N d."""
        return self._of_tau(self._by_changes)

    @property
    def tau_by_velocities(self) -> Valued:
        """∂τ/∂v, n x n, of τ = M a + h."""
        return self._of_tau(self._by_velocities, self._velocity_units)

    @property
    def tau_by_parameters(self) -> Valued:
        """∂τ/∂p, n x np, of τ = M a + h."""
        return self._of_tau(self._by_parameters, self._parameter_units)

    @cached_property
    def _velocity_units(self) -> Array:
        """For each velocity, the reciprocal of its largest allowed value, at most 1."""
        point = self.point
        bounds = point.derivation.system.bounds.velocities
        names = [x.name for x in point.walk.tree.velocities]
        most = [max(map(abs, bounds.get(name, (1.0,)))) for name in names]
        return point.walk.np.array([1 / max(1.0, x) for x in most])

    @cached_property
    def _parameter_units(self) -> Array:
        """For each parameter, the reciprocal of its value: derivatives are judged by relative changes."""
        np, model = self.point.walk.np, self.point.derivation.system
        values = self.point.walk.numeric.parameters
        own = [abs(float(values[p.name])) for p in model.parameters.values() if not p.derived]
        return np.array([1 / x if x else 0.0 for x in own])

    def _sizes(self, found: Array, sizes: Array, unit: Any = 1.0) -> Array:
        """Sizes of derivatives: for each variable its largest effect, each row in its own measure.

        A zero derivative may be the remainder of large terms that cancel. Its size is therefore at least a
        fraction of the largest effect of mechanics, and of the effect of one unit, because states and
        shifts are of that size. Parameters are not, and inputs act beside forces of any size; there `unit`
        is given for each, or 0.
        """
        np = self.point.walk.np
        measure = np.where(sizes > 0, sizes, np.inf)[:, None]
        most = (np.abs(found) / measure).max(axis=0, initial=0.0)
        alike = most[: self._count].max(initial=0.0) if len(most) == self._count else 0.0
        most = np.maximum(most, IDLE * np.maximum(alike, unit))
        return np.maximum(np.abs(found), sizes[:, None] * most)

    # -- of v̇

    def _of_motion(self, by: _Slopes, unit: Any = 1.0) -> Valued:
        """∂v̇/∂x = -M⁻¹ ∂r/∂x at the v̇ of the state."""
        np, (M, of_M) = self.point.walk.np, self.point.bodies.mass_matrix
        a, of_a = self.point.motion[0]
        scale = self.point.scale(of_M, of_M[:0])[0]
        # Scaled to unit inertia, so that units and masses of very different size do not spoil the inverse.
        inverse = np.linalg.inv(M * scale * scale[:, None]) * scale * scale[:, None]
        slopes = np.einsum("ijk,j->ik", by.mass, a) + by.bias - by.forces
        found = -inverse @ slopes
        size = self.point.force[1] + np.abs(M) @ np.abs(a)
        of_slopes = np.maximum(self._sizes(slopes, size, unit), by.terms)
        parts = np.abs(inverse) @ (of_slopes + of_M @ np.abs(found))
        return found, np.maximum(parts, self._sizes(found, of_a, unit))

    @cached_property
    def motion_by_changes(self) -> Valued:
        """∂v̇/∂q on the tangent space, n x n: the derivative of v̇ along δq = N d."""
        return self._of_motion(self._by_changes)

    @cached_property
    def motion_by_velocities(self) -> Valued:
        """∂v̇/∂v, n x n, without constraints."""
        return self._of_motion(self._by_velocities, self._velocity_units)

    @cached_property
    def motion_by_inputs(self) -> Valued:
        """∂v̇/∂u, n x nu, without constraints."""
        return self._of_motion(self._by_inputs, 0.0)

    @cached_property
    def motion_by_parameters(self) -> Valued:
        """∂v̇/∂p, n x np, without constraints."""
        return self._of_motion(self._by_parameters, self._parameter_units)

    # -- of the state

    @cached_property
    def _bracket(self) -> Array:
        """The bracket in ``d' = dv + [bracket] d``.

        It follows from δq = N d, whose rate is both ``N d' + Ṅ d`` and ``∂(N v) δq + N dv``.
        """
        np, point = self.point.walk.np, self.point
        motions, algebra, tree = self._motions, Complexes(), point.walk.tree
        units, v = np.eye(len(point.v))[: self._count], list(point.v)

        def rates(along: Array, velocities: Sequence[float]) -> Array:
            moved = coordinate_rates(tree, algebra, _moved(point.q, along), velocities)
            return np.array([complex(x).imag / STEP for x in moved])

        own = motions @ np.array(v[: self._count])
        columns = [
            rates(motion, v) - rates(own, list(unit))
            for motion, unit in zip(motions.T, units, strict=True)
        ]
        gaps = np.array(columns).reshape(self._count, len(point.q)).T
        # N has full column rank, and the gaps keep quaternions normalised, so they lie in its range.
        return np.linalg.pinv(motions) @ gaps

    @cached_property
    def state_by_state(self) -> Valued:
        """A of ``δx' = A δx + B δu`` with δx = (changes of position, δv).

        With constraints δx are the independent changes and rates only.
        """
        np = self.point.walk.np
        if self.point.walk.tree.closed:
            return self._on_constraints
        n, count = len(self.point.v), self._count
        above = np.hstack([self._bracket, np.eye(count, n)])
        (by_q, of_q), (by_v, of_v) = self.motion_by_changes, self.motion_by_velocities
        found = np.vstack([above, np.hstack([by_q, by_v])])
        # Each entry of the bracket is a velocity or the remainder of several that cancel.
        fastest = np.abs(self.point.v[:count]).max(initial=0.0)
        of_above = np.maximum(np.abs(above), fastest)
        return found, np.vstack([of_above, np.hstack([of_q, of_v])])

    @cached_property
    def state_by_inputs(self) -> Valued:
        """B of ``δx' = A δx + B δu``; zero in the rows of position."""
        np = self.point.walk.np
        if self.point.walk.tree.closed:
            return self._by_inputs_on_constraints
        (below, of_below), above = self.motion_by_inputs, np.zeros((self._count, len(self.point.u)))
        return np.vstack([above, below]), np.vstack([above, of_below])

    # -- of the independent coordinates

    @cached_property
    def _others(self) -> list[int]:
        """Indices of the velocities that the constraints determine."""
        kept = self.point.kept.velocities
        return [k for k in range(len(self.point.v)) if k not in kept]

    @cached_property
    def _basis(self) -> Array:
        """Independent combinations of the constraints; redundant ones count once."""
        rows = self.point.closed.jacobian[0][:, self._others]
        return self.point.walk.np.linalg.svd(rows, full_matrices=False)[0].T

    def _determined(self, J: Array, right: Array) -> Array:
        """Solve ``J_others x = right`` for the dependent velocities."""
        return self.point.walk.np.linalg.solve(
            self._basis @ J[:, self._others], self._basis @ right
        )

    def _motion(self, walk: Walk) -> tuple[Array, Array]:
        """V and ẇ at a shifted state, whose velocities are first completed from w by the constraints."""
        np, kept = walk.np, list(self.point.kept.velocities)
        start = Constraints(walk)
        J, rates = start.jacobian[0], start.rates[0]
        v = np.array(walk.v, complex)
        v[self._others] -= self._determined(J, rates)
        walk = Walk(walk.numeric, walk.q, list(map(walk.number, v)))
        bodies, closed = Bodies(walk), Constraints(walk)
        T, rest = np.zeros((len(v), len(kept)), complex), np.zeros(len(v), complex)
        T[kept, range(len(kept))] = 1.0
        T[self._others] = -self._determined(J, J[:, kept])
        rest[self._others] = self._determined(J, closed.bias[0])
        M = bodies.mass_matrix[0]
        force = bodies.forces[0] - bodies.bias[0] - M @ rest
        return v.imag / STEP, np.linalg.solve(T.T @ M @ T, T.T @ force).imag / STEP

    def _of_independent(
        self, steps: Sequence[Mapping[str, Any]], unit: Any = 1.0
    ) -> tuple[Array, Valued]:
        """Derivatives of v and of ẇ."""
        np, kept = self.point.walk.np, list(self.point.kept.velocities)
        columns = [self._motion(self._beside(**step)) for step in steps]
        moved = np.array([v for v, _ in columns]).reshape(len(steps), len(self.point.v)).T
        found = np.array([x for _, x in columns]).reshape(len(steps), len(kept)).T
        size = self._sizes(found, self.point.motion[0][1][kept], unit)
        if self._follows:
            alone = [self._motion(self._beside(**step, held=True))[1] for step in steps]
            own = np.array(alone).reshape(len(steps), len(kept)).T
            size = np.maximum(size, np.abs(own) + np.abs(found - own))
        return moved, (found, size)

    @cached_property
    def _positions(self) -> Array:
        """Changes of all positions for unit changes of the free ones, from the constraints on position."""
        np, free = self.point.walk.np, list(self.point.kept.changes)
        count = sum(e.holonomic for e in equations(self.point.walk.tree))
        rows = np.vstack([self.point.closed.jacobian[0][:count], np.eye(len(self.point.v))[free]])
        right = np.vstack([np.zeros((count, len(free))), np.eye(len(free))])
        return np.linalg.lstsq(rows, right, rcond=None)[0]

    @cached_property
    def _on_constraints(self) -> Valued:
        """A for changes that obey the constraints: of the free positions, and of w alone."""
        np, T, D = self.point.walk.np, self.point.reduction[0][0], self._positions
        free = list(self.point.kept.changes)
        along = self._motions @ D[: self._count]
        steps = [*({"dq": dq} for dq in along.T), *({"dv": dv} for dv in T.T)]
        moved, (below, of_below) = self._of_independent(steps)
        moved[: self._count, : len(free)] += self._bracket @ D[: self._count]
        above = moved[free]
        # Zeros are remainders of velocities, and of their components along unit changes.
        fastest = max(1.0, np.abs(self.point.v[: self._count]).max(initial=0.0))
        of_above = np.maximum(np.abs(above), fastest)
        return np.vstack([above, below]), np.vstack([of_above, of_below])

    @cached_property
    def _by_inputs_on_constraints(self) -> Valued:
        np = self.point.walk.np
        units = np.eye(len(self.point.u))
        _, (below, of_below) = self._of_independent([{"du": du} for du in units], 0.0)
        # A force along a locked velocity has the effect that the rounding of the locking constraint leaves.
        of_T, inertia = self.point.reduction[0][1], self.point.reduced[0][0]
        parts = np.abs(np.linalg.inv(inertia)) @ of_T.T @ np.abs(self._by_inputs.forces)
        of_below = np.maximum(of_below, parts)
        above = np.zeros((len(self.point.kept.changes), len(units)))
        return np.vstack([above, below]), np.vstack([above, of_below])


def _moved(x: Sequence[float], along: Sequence[float]) -> list[Any]:
    """Shift numbers by i h along a direction; unshifted complex numbers where the direction is empty."""
    if not len(along):
        return [complex(a) for a in x]
    return [complex(a, STEP * b) for a, b in zip(x, along, strict=True)]
