"""A state and the reference quantities at it, from which references read their results.

`walk` computes the motion of links, `bodies` Newton's and Euler's equations, `constraints` φ, J and γ.
Accelerations and multipliers are solved for by NumPy, not by the emitted elimination.
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
    """Indices of the independent variables under constraints.

    Attributes:
        coordinates: places in q of the independent coordinates s.
        velocities: places in v of the independent rates w.
        changes: places in v of the independent changes of position.
    """

    coordinates: tuple[int, ...] = ()
    velocities: tuple[int, ...] = ()
    changes: tuple[int, ...] = ()


NOTHING = Kept()


@dataclass(frozen=True)
class Point:
    """A state with all arguments that functions take there, and the reference quantities at it.

    Results are pairs of an array and its sizes (`walk.Valued`).

    Attributes:
        derivation: the model.
        t: time (s).
        u: inputs.
        q, v: coordinates and velocities, which obey the constraints.
        a: arbitrary accelerations, for functions that take some.
        q_off, v_off: coordinates near q that close no loop, and velocities that violate the constraints.
        kept: indices of the independent variables.
        p: values of parameters that differ from the model's own.
        lam: arbitrary multipliers, for functions that take some.
        loud: whether steep laws dominate here more than at other states; then sizes are those of this
            state.
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
        """The independent coordinates, taken from q."""
        return [self.q[k] for k in self.kept.coordinates]

    @property
    def w(self) -> list[float]:
        """The independent rates, taken from v."""
        return [self.v[k] for k in self.kept.velocities]

    @property
    def x(self) -> list[float]:
        """The whole state: q, then v."""
        return [*self.q, *self.v]

    @property
    def q_near(self) -> list[float]:
        """Coordinates near q as a starting guess; q itself if some constraints are on velocities only.

        These leave more positions than velocities, so completing the position from a guess is not unique.
        """
        found = equations(self.walk.tree)
        return self.q_off if all(e.holonomic for e in found) else self.q

    def at(self, q: Sequence[float], v: Sequence[float]) -> Walk:
        """The motion of all links at other q and v, with this point's time, inputs and parameters.

        Args:
            q: nq coordinates.
            v: n velocities.
        """
        return Walk(self.derivation.numeric(self.p, self.t, self.u), q, v)

    @cached_property
    def walk(self) -> Walk:
        """The motion of all links at q, v."""
        return self.at(self.q, self.v)

    @cached_property
    def beside(self) -> Point:
        """The same point with q and v that violate the constraints."""
        return replace(self, q=self.q_off, v=self.v_off)

    @cached_property
    def bodies(self) -> Bodies:
        """Newton's and Euler's equations of all bodies at q, v."""
        return Bodies(self.walk)

    @cached_property
    def closed(self) -> Constraints:
        """The constraints at q, v."""
        return Constraints(self.walk)

    def seen(self, view: Callable[[Point], View]) -> View:
        """Another view of this state, created once.

        `derivatives.Derivatives` imports this file, so this file cannot import it and have it as a
        property.

        Args:
            view: a class or function of a point; also the key under which the view is kept.
        """
        if view not in self._views:
            self._views[view] = view(self)
        return self._views[view]  # type: ignore[no-any-return]

    @cached_property
    def _views(self) -> dict[Any, Any]:
        return {}

    @cached_property
    def kinematics(self) -> KinematicReference:
        """Motion of frames and of the whole system."""
        return KinematicReference(self.walk, self.bodies)

    @cached_property
    def parameters(self) -> Parameters:
        """Regressor and standard parameters at the accelerations a."""
        return Parameters(self.walk, self.bodies, self.walk.np.array(self.a), self.inverse)

    @cached_property
    def edges(self) -> Edges:
        """Variables of all edges for the inputs: at the v̇ and λ that follow from them."""
        return self._edges(*self.motion)

    @cached_property
    def edges_at(self) -> Edges:
        """Variables of all edges at the given accelerations a and multipliers lam."""
        np = self.walk.np
        given = (np.array(x, float) for x in (self.a, self.lam))
        a, lam = ((x, np.zeros(len(x))) for x in given)
        return self._edges(a, lam)

    def _edges(self, a: Valued, lam: Valued) -> Edges:
        return Edges(Cuts(self.derivation, self.walk, self.bodies, self.kinematics, a, lam))

    @cached_property
    def outputs(self) -> Valued:
        """Outputs that the model defines by name."""
        return Outputs(self.edges).values

    @cached_property
    def force(self) -> Valued:
        """Generalised force ``Q - h``, n."""
        (Q, of_Q), (h, of_h) = self.bodies.forces, self.bodies.bias
        return Q - h, of_Q + of_h

    @cached_property
    def stabilised(self) -> Valued:
        """γ of the constraints, with Baumgarte's terms if the model has some [Baumgarte 1972].

        ``γ - 2 α (J v - b) - β² φ``; constraints on velocities have no φ and no last term.
        """
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
        """v̇ (n) and λ (c) of ``M v̇ = Q - h + Jᵀ λ``, ``J v̇ = γ``.

        Λ of least norm where it is not unique.
        """
        none = self.walk.np.zeros(0)
        right = self.stabilised if self.walk.tree.closed else (none, none)
        return self._saddle(self.bodies.mass_matrix, self._rows, self.force, right)

    @cached_property
    def _rows(self) -> Valued:
        """J, with no rows in models without constraints."""
        if self.walk.tree.closed:
            return self.closed.jacobian
        none = self.walk.np.zeros((0, len(self.v)))
        return none, none

    @cached_property
    def rank(self) -> int:
        """Number of independent constraints, with the scaling of J and the threshold of the assembly."""
        np, J = self.walk.np, self._rows[0]
        if not len(J):
            return 0
        values = np.linalg.svd(pure(J, self.walk.numeric.sizes), compute_uv=False)
        return int((values > DEPENDENT).sum())

    @cached_property
    def projected(self) -> Valued:
        """Velocities that obey the constraints, reached from v_off by the change of least kinetic energy."""
        np, off = self.walk.np, self.at(self.q, self.v_off)
        zero, v = np.zeros(len(self.v)), np.array(self.v_off)
        rates, of_rates = Constraints(off).rates
        masses = Bodies(off).mass_matrix
        (step, size), _ = self._saddle(masses, self._rows, (zero, zero), (-rates, of_rates))
        return v + step, np.abs(v) + size

    def _saddle(
        self, masses: Valued, rows: Valued, force: Valued, right: Valued
    ) -> tuple[Valued, Valued]:
        """Solve ``M x = force + Jᵀ y``, ``J x = right``; y of least norm where it is not unique.

        The system is scaled first (`scale`), solved by a generalised inverse and refined once. Sizes are
        first-order bounds of the effect of rounding in M, J and the right-hand side.
        """
        np, n = self.walk.np, len(self.v)
        (M, of_M), (J, of_J) = masses, rows
        (upper, of_upper), (lower, of_lower) = force, right
        whole, size = np.concatenate([upper, lower]), np.concatenate([of_upper, of_lower])
        scale = np.concatenate(self.scale(of_M, of_J))
        # Multipliers act on the head of a chord: they are on the right of M x = force + Jᵀ y.
        given = np.block([[M, -J.T], [J, np.zeros((len(J), len(J)))]])
        scaled, whole, size = given * scale * scale[:, None], whole * scale, size * scale
        inverse = self._inverse(scaled, n)
        found = inverse @ whole
        # One step of iterative refinement reduces the rounding error of the generalised inverse.
        found += inverse @ (whole - scaled @ found)
        # First-order bound on errors of the rows and the right-hand side, in undetermined directions as
        # well.
        free = np.abs(np.eye(len(scaled)) - inverse @ scaled) * bool(len(J))
        parts = np.abs(inverse) @ (size + np.abs(scaled) @ np.abs(found))
        parts += free @ (np.abs(scaled.T) @ np.abs(inverse.T @ found))
        found, parts = found * scale, parts * scale
        # Least norm: remove components that have no effect along v, to the last digit.
        left = np.linalg.svd(J * scale[n:, None] * scale[:n], full_matrices=False)[0]
        left = left[:, : self.rank]
        lam, of_lam = left @ (left.T @ found[n:]), parts[n:]
        # Multipliers that act out of the plane of a planar mechanism are rounding.
        of_lam = np.maximum(of_lam, NOISE * of_lam.max(initial=0.0))
        return (found[:n], parts[:n]), (lam, of_lam)

    def _inverse(self, scaled: Any, n: int) -> Any:
        """A generalised inverse of M and J together, from the null space and range of J."""
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
        """Scales of x and y in `_saddle` that make the rank independent of units.

        Velocities are scaled to unit inertia. All multipliers get one common scale, from the largest entry
        of J, so that a least norm remains a least norm.

        Args:
            of_M: n x n, sizes of M.
            of_J: c x n, sizes of J; no rows without constraints.

        Returns:
            n factors for velocities and c equal ones for multipliers.
        """
        np = self.walk.np
        inertia = np.diag(of_M)
        across = 1 / np.sqrt(np.where(inertia > 0, inertia, inertia.max(initial=0.0) or 1.0))
        down = np.full(len(of_J), 1 / ((of_J * across).max(initial=0.0) or 1.0))
        return across, down

    @cached_property
    def inverse(self) -> Valued:
        """Inverse dynamics: ``M a + h``, n, for the arbitrary a."""
        np = self.walk.np
        (M, _), (h, size) = self.bodies.mass_matrix, self.bodies.bias
        return M @ self.a + h, np.abs(M) @ np.abs(self.a) + size

    @cached_property
    def whole(self) -> Valued:
        """q̇ (nq), then v̇ (n)."""
        np = self.walk.np
        pair = zip(self.walk.rates, self.motion[0], strict=True)
        rates, sizes = (np.concatenate(both) for both in pair)
        return rates, sizes

    @cached_property
    def reduction(self) -> tuple[Valued, Valued]:
        """T (n x m) and rest (n) of ``v̇ = T ẇ + rest``, solved from the constraints."""
        np, n = self.walk.np, len(self.v)
        (J, of_J), (bias, of_bias) = self.closed.jacobian, self.closed.bias
        kept = list(self.kept.velocities)
        others = [k for k in range(n) if k not in kept]
        measures = self.walk.numeric.sizes
        down, of_v = of_rows(J, measures), np.array(measures.velocities, float)[others]
        # Redundant constraints leave J rank-deficient; scaling and threshold are those of the assembly, so
        # that both find the same rank.
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
        """Equations of motion in w: ``Tᵀ M T`` (m x m) and ``Tᵀ (h + M rest)`` (m)."""
        np = self.walk.np
        (T, of_T), (rest, of_rest) = self.reduction
        (M, of_M), (h, of_h) = self.bodies.mass_matrix, self.bodies.bias
        of_force = of_h + of_M @ of_rest
        whole = np.abs(of_T.T) @ of_M @ of_T, of_T.T @ of_force
        return (T.T @ M @ T, whole[0]), (T.T @ (h + M @ rest), whole[1])


def _padded(np: Any, entries: Any, size: int) -> Any:
    return np.concatenate([entries, np.zeros(size - len(entries))])
