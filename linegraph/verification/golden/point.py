"""A state, and what is known there: everything that references are read from.

`walk` says how everything moves, `bodies` what that takes, `constraints` what is closed. What solves for
accelerations is NumPy's.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from linegraph.dynamics.chords import equations
from linegraph.dynamics.circuit_lengths import of_rows, pure
from linegraph.tolerance import DEPENDENT
from linegraph.verification.golden.bodies import NOISE, Bodies
from linegraph.verification.golden.constraints import Constraints
from linegraph.verification.golden.cuts import Cuts
from linegraph.verification.golden.edges import Edges
from linegraph.verification.golden.kinematics import KinematicReference
from linegraph.verification.golden.outputs import Outputs
from linegraph.verification.golden.parameters import Parameters
from linegraph.verification.golden.walk import Walk

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.numeric.derived import Derived
    from linegraph.verification.golden.walk import Valued

    Array = Any

View = TypeVar("View")


class Kept(NamedTuple):
    """What is independent under constraints: places of coordinates, of velocities, of changes of position."""

    coordinates: tuple[int, ...] = ()
    velocities: tuple[int, ...] = ()
    changes: tuple[int, ...] = ()


NOTHING = Kept()


@dataclass(frozen=True)
class Point:
    """A state with all that functions are given there, and what is known of it.

    Attributes:
        derivation: the model.
        t: the time.
        u: the inputs.
        q, v, a: the state and accelerations, which are any.
        q_off, v_off: coordinates beside q that close no loop, and velocities that need not be allowed.
        kept: what is independent.
        p: values of parameters that are not the model's own.
        lam: multipliers, which are any.
        loud: whether steep laws act far more here than at other states; then it has a scale of its own.
    """

    derivation: Derived
    t: float
    u: list[float]
    q: list[float]
    v: list[float]
    a: list[float]
    q_off: list[float]
    v_off: list[float]
    kept: Kept = NOTHING
    p: Mapping[str, float] = field(default_factory=dict)
    lam: list[float] = field(default_factory=list)
    loud: bool = False

    @property
    def s(self) -> list[float]:
        """The independent coordinates."""
        return [self.q[k] for k in self.kept.coordinates]

    @property
    def w(self) -> list[float]:
        """Their rates."""
        return [self.v[k] for k in self.kept.velocities]

    @property
    def x(self) -> list[float]:
        """The whole state."""
        return [*self.q, *self.v]

    @property
    def q_near(self) -> list[float]:
        """A guess beside q; q itself where constraints of velocity leave more positions than velocities."""
        found = equations(self.walk.tree)
        return self.q_off if all(e.holonomic for e in found) else self.q

    def at(self, q: Sequence[float], v: Sequence[float]) -> Walk:
        """How everything moves at a state."""
        return Walk(self.derivation.numeric(self.p, self.t, self.u), q, v)

    @cached_property
    def walk(self) -> Walk:
        """How everything moves here."""
        return self.at(self.q, self.v)

    @cached_property
    def beside(self) -> Point:
        """The same where loops are not closed, at any velocities."""
        return replace(self, q=self.q_off, v=self.v_off)

    @cached_property
    def bodies(self) -> Bodies:
        """What that takes."""
        return Bodies(self.walk)

    @cached_property
    def closed(self) -> Constraints:
        """What is closed."""
        return Constraints(self.walk)

    def seen(self, view: Callable[[Point], View]) -> View:
        """Another view of this state, made once: `derivatives.Derivatives` stands above this file."""
        if view not in self._views:
            self._views[view] = view(self)
        return self._views[view]  # type: ignore[no-any-return]

    @cached_property
    def _views(self) -> dict[Any, Any]:
        return {}

    @cached_property
    def kinematics(self) -> KinematicReference:
        """Frames, and the whole."""
        return KinematicReference(self.walk, self.bodies)

    @cached_property
    def parameters(self) -> Parameters:
        """What identification asks for."""
        return Parameters(self.walk, self.bodies, self.walk.np.array(self.a), self.inverse)

    @cached_property
    def edges(self) -> Edges:
        """Every edge, under the inputs."""
        return self._edges(*self.motion)

    @cached_property
    def edges_at(self) -> Edges:
        """Every edge, at any accelerations and multipliers."""
        np = self.walk.np
        given = (np.array(x, float) for x in (self.a, self.lam))
        a, lam = ((x, np.zeros(len(x))) for x in given)
        return self._edges(a, lam)

    def _edges(self, a: Valued, lam: Valued) -> Edges:
        return Edges(Cuts(self.derivation, self.walk, self.bodies, self.kinematics, a, lam))

    @cached_property
    def outputs(self) -> Valued:
        """What the model asks for by name."""
        return Outputs(self.edges).values

    @cached_property
    def force(self) -> Valued:
        """Q - h."""
        (Q, of_Q), (h, of_h) = self.bodies.forces, self.bodies.bias
        return Q - h, of_Q + of_h

    @cached_property
    def stabilised(self) -> Valued:
        """γ, with Baumgarte's terms if the model asks for them."""
        bias, size = self.closed.bias
        chosen = self.derivation.system.choices.baumgarte
        if chosen is None:
            return bias, size
        alpha, beta = (float(self.walk.numeric.resolve(x)) for x in chosen)
        rates, of_rates = self.closed.rates
        phi, of_phi = (_padded(self.walk.np, x, len(bias)) for x in self.closed.position)
        parts = 2 * abs(alpha) * of_rates + beta * beta * of_phi
        return bias - (2 * alpha * rates + beta * beta * phi), size + parts

    @cached_property
    def motion(self) -> tuple[Valued, Valued]:
        """v̇ and λ of ``M v̇ = Q - h + Jᵀ λ``, ``J v̇ = γ``, λ of least norm where it is not unique."""
        none = self.walk.np.zeros(0)
        right = self.stabilised if self.walk.tree.closed else (none, none)
        return self._saddle(self.bodies.mass_matrix, self._rows, self.force, right)

    @cached_property
    def _rows(self) -> Valued:
        """J, empty without constraints."""
        if self.walk.tree.closed:
            return self.closed.jacobian
        none = self.walk.np.zeros((0, len(self.v)))
        return none, none

    @cached_property
    def rank(self) -> int:
        """How many constraints are independent, by what the assembly measures J with, and its threshold."""
        np, J = self.walk.np, self._rows[0]
        if not len(J):
            return 0
        values = np.linalg.svd(pure(J, self.walk.numeric.sizes), compute_uv=False)
        return int((values > DEPENDENT).sum())

    @cached_property
    def projected(self) -> Valued:
        """Velocities that obey the constraints: from any, by the change of least kinetic energy."""
        np, off = self.walk.np, self.at(self.q, self.v_off)
        zero, v = np.zeros(len(self.v)), np.array(self.v_off)
        rates, of_rates = Constraints(off).rates
        masses = Bodies(off).mass_matrix
        (step, size), _ = self._saddle(masses, self._rows, (zero, zero), (-rates, of_rates))
        return v + step, np.abs(v) + size

    def _saddle(
        self, masses: Valued, rows: Valued, force: Valued, right: Valued
    ) -> tuple[Valued, Valued]:
        """Both unknowns of ``M x = force + Jᵀ y``, ``J x = right``, y of least norm if not unique."""
        np, n = self.walk.np, len(self.v)
        (M, of_M), (J, of_J) = masses, rows
        (upper, of_upper), (lower, of_lower) = force, right
        whole, size = np.concatenate([upper, lower]), np.concatenate([of_upper, of_lower])
        scale = np.concatenate(self.scale(of_M, of_J))
        given = np.block([[M, -J.T], [J, np.zeros((len(J), len(J)))]])
        scaled, whole, size = given * scale * scale[:, None], whole * scale, size * scale
        inverse = self._inverse(scaled, n)
        found = inverse @ whole
        found += inverse @ (whole - scaled @ found)
        # first order: how far errors in the rows and on the right carry, into what is not determined too
        free = np.abs(np.eye(len(scaled)) - inverse @ scaled) * bool(len(J))
        parts = np.abs(inverse) @ (size + np.abs(scaled) @ np.abs(found))
        parts += free @ (np.abs(scaled.T) @ np.abs(inverse.T @ found))
        found, parts = found * scale, parts * scale
        # of least norm: what does nothing along v is none of it, to the last digit
        left = np.linalg.svd(J * scale[n:, None] * scale[:n], full_matrices=False)[0]
        left = left[:, : self.rank]
        lam, of_lam = left @ (left.T @ found[n:]), parts[n:]
        # what a plane mechanism does not need out of its plane is rounding
        of_lam = np.maximum(of_lam, NOISE * of_lam.max(initial=0.0))
        return (found[:n], parts[:n]), (lam, of_lam)

    def _inverse(self, scaled: Any, n: int) -> Any:
        """A generalised inverse of M and J together, by what J leaves free and what it determines."""
        np = self.walk.np
        if len(scaled) == n:
            return np.linalg.inv(scaled)
        M, J = scaled[:n, :n], scaled[n:, :n]
        left, sizes, right = np.linalg.svd(J)
        rank = self.rank
        held, free = right[:rank].T, right[rank:].T
        across = held / sizes[:rank] @ left[:, :rank].T
        moved = free @ np.linalg.inv(free.T @ M @ free) @ free.T
        down = np.eye(n) - M @ moved
        upper = [moved, across - moved @ M @ across]
        lower = [-across.T @ down, across.T @ down @ M @ across]
        return np.block([upper, lower])

    def scale(self, of_M: Any, of_J: Any) -> tuple[Any, Any]:
        """What makes rank decide and not units.

        Velocities are scaled to unit inertia, and all multipliers alike, by the largest that directions and
        lever arms make: the least norm stays theirs.
        """
        np = self.walk.np
        inertia = np.diag(of_M)
        across = 1 / np.sqrt(np.where(inertia > 0, inertia, inertia.max(initial=0.0) or 1.0))
        down = np.full(len(of_J), 1 / ((of_J * across).max(initial=0.0) or 1.0))
        return across, down

    @cached_property
    def inverse(self) -> Valued:
        """M a + h for any a."""
        np = self.walk.np
        (M, _), (h, size) = self.bodies.mass_matrix, self.bodies.bias
        return M @ self.a + h, np.abs(M) @ np.abs(self.a) + size

    @cached_property
    def whole(self) -> Valued:
        """q̇ and v̇."""
        np = self.walk.np
        pair = zip(self.walk.rates, self.motion[0], strict=True)
        rates, sizes = (np.concatenate(both) for both in pair)
        return rates, sizes

    @cached_property
    def reduction(self) -> tuple[Valued, Valued]:
        """T and v̇ at ẇ = 0: what the constraints leave to the velocities that are not kept."""
        np, n = self.walk.np, len(self.v)
        (J, of_J), (bias, of_bias) = self.closed.jacobian, self.closed.bias
        kept = list(self.kept.velocities)
        others = [k for k in range(n) if k not in kept]
        measures = self.walk.numeric.sizes
        down, of_v = of_rows(J, measures), np.array(measures.velocities, float)[others]
        inverse = np.linalg.pinv(pure(J, measures)[:, others], rcond=DEPENDENT)
        inverse = of_v[:, None] * inverse / down
        T, rest = np.zeros((n, len(kept))), np.zeros(n)
        T[kept, range(len(kept))] = 1.0
        T[others] = -inverse @ J[:, kept]
        rest[others] = inverse @ bias
        of_T, of_rest = np.abs(T), np.abs(rest)
        of_T[others] = np.abs(inverse) @ of_J @ np.abs(T)
        of_rest[others] = np.abs(inverse) @ (of_bias + of_J @ np.abs(rest))
        return (T, of_T), (rest, of_rest)

    @cached_property
    def reduced(self) -> tuple[Valued, Valued]:
        """``Tᵀ M T`` and ``Tᵀ (h + M rest)``."""
        np = self.walk.np
        (T, of_T), (rest, of_rest) = self.reduction
        (M, of_M), (h, of_h) = self.bodies.mass_matrix, self.bodies.bias
        of_force = of_h + of_M @ of_rest
        whole = np.abs(of_T.T) @ of_M @ of_T, of_T.T @ of_force
        return (T.T @ M @ T, whole[0]), (T.T @ (h + M @ rest), whole[1])


def _padded(np: Any, entries: Any, size: int) -> Any:
    return np.concatenate([entries, np.zeros(size - len(entries))])
