"""A particle on a curve as algorithms see a module: few lines, and closed forms to compare with."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from linegraph.ir.algorithms.dynamics import constrained_dynamics
from linegraph.ir.algorithms.language import reals
from linegraph.ir.algorithms.reduction import reduction

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.ir.algorithms.language import Reals

ALPHA, BETA = 3.0, 5.0


def filled(target: Reals, values: Iterable[float]) -> None:
    """Write results into an array of the algorithms."""
    for place, value in enumerate(np.asarray(values, float).ravel()):
        target[place] = float(value)


class Particle:
    """A particle in the plane; two masses, as if each direction had its own, a force u along x and a weight.

    Its curve is the circle ``(x² + y² - 1)/2 = 0``, or near its singular point the cross ``x y = 0``. The
    constraint may be there twice.
    """

    NQ = NV = mechanical = NT = NDX = 2
    NU = NI = position_rank = RANK = 1
    quaternions: tuple[int, ...] = ()
    s_at = w_at = d_at = (0,)
    weight = 4.0

    def __init__(
        self,
        q: Any,
        v: Any,
        u: float = 0.7,
        *,
        cross: bool = False,
        twice: bool = False,
        baumgarte: bool = False,
    ) -> None:
        """At a state."""
        self.q, self.v, self.u = np.array(q, float), np.array(v, float), u
        self.evaluations = 0
        self.cross, self.twice, self.baumgarte = cross, twice, baumgarte
        self.NC = self.NP = 2 if twice else 1
        self.M = np.diag([2.0, 3.0])

    # ---- the curve

    def at(self, q: Any = None, v: Any = None) -> tuple[Any, Any]:
        """Positions and velocities, unless others are given."""
        q = self.q if q is None else np.array([q[0], q[1]])
        return q, self.v if v is None else np.array([v[0], v[1]])

    def rows(self, values: Any) -> Any:
        """The constraint once, or twice, the second time with a factor."""
        return np.array([values, 2.0 * np.asarray(values)]) if self.twice else np.array([values])

    def gap(self, q: Any) -> float:
        return q[0] * q[1] if self.cross else (q @ q - 1) / 2

    def normal(self, q: Any) -> Any:
        return np.array([q[1], q[0]]) if self.cross else q

    def bend(self, v: Any) -> float:
        """J a on the curve."""
        return -2 * v[0] * v[1] if self.cross else -(v @ v)

    # ---- emitted functions

    def coordinate_rates(self, qdot: Reals, **given: Any) -> None:
        filled(qdot, self.at(**given)[1])

    def mass_matrix(self, M: Reals, **given: Any) -> None:
        filled(M, self.M)

    def equations(self, M: Reals, h: Reals, **given: Any) -> None:
        filled(M, self.M)
        filled(h, [0.0, self.weight])

    def constraints(self, phi: Reals, **given: Any) -> None:
        filled(phi, self.rows(self.gap(self.at(**given)[0])))

    def constraint_jacobian(self, J: Reals, **given: Any) -> None:
        filled(J, self.rows(self.normal(self.at(**given)[0])))

    def constraint_rates(self, rates: Reals, **given: Any) -> None:
        q, v = self.at(**given)
        filled(rates, self.rows(self.normal(q) @ v))

    def constraint_bias(self, gam: Reals, **given: Any) -> None:
        filled(gam, self.rows(self.bend(self.at(**given)[1])))

    def constraint_sizes(self, of_phi: Reals, of_v: Reals) -> None:
        filled(of_phi, self.rows(1.0))
        filled(of_v, [1.0, 1.0])

    def constrained_equations(self, M: Reals, f: Reals, J: Reals, gam: Reals, **given: Any) -> None:
        q, v = self.at(**given)
        self.evaluations += 1
        back = 2 * ALPHA * (self.normal(q) @ v) + BETA**2 * self.gap(q)
        filled(M, self.M)
        filled(f, self.force)
        filled(J, self.rows(self.normal(q)))
        filled(gam, self.rows(self.bend(v) - self.baumgarte * back))

    def forward_dynamics(self, a: Reals, lam: Reals) -> None:
        constrained_dynamics(self, self.list(self.q), self.list(self.v), a, lam)  # type: ignore[arg-type]

    def reduction(self, T: Reals, rest: Reals) -> None:
        reduction(self, self.list(self.q), self.list(self.v), T, rest)  # type: ignore[arg-type]

    def constrained_slopes(
        self, slopes_f: Reals, slopes_gam: Reals, slopes_rates: Reals, drift: Reals, **given: Any
    ) -> None:
        """Of the circle, of M a - f - J^T lam by q, v and u, and so on."""
        a, lam = (np.array([given[x][i] for i in range(len(given[x]))]) for x in ("a", "lam"))
        pull = lam @ self.rows(1.0)
        filled(slopes_f, [[-pull, 0, 0, 0, -1], [0, -pull, 0, 0, 0]])
        filled(slopes_gam, self.rows([*a, *(2 * self.v), 0.0]))
        filled(slopes_rates, self.rows(self.v))
        filled(drift, np.zeros((2, 2)))

    # ---- closed forms

    @property
    def force(self) -> Any:
        return np.array([self.u, -self.weight])

    @staticmethod
    def list(values: Any) -> Reals:
        """An array of the algorithms."""
        made = reals(len(values))
        filled(made, values)
        return made

    def expected(self) -> tuple[Any, float]:
        """Accelerations and the multiplier of the constraint written once."""
        J = self.normal(self.q)
        whole = np.block([[self.M, -J[:, None]], [J[None, :], np.zeros((1, 1))]])
        found = np.linalg.solve(whole, [*self.force, self.bend(self.v)])
        return found[:2], found[2]


def on_circle(angle: float, speed: float, **options: Any) -> Particle:
    """A particle that moves on the circle."""
    q = np.array([math.cos(angle), math.sin(angle)])
    return Particle(q, speed * np.array([-q[1], q[0]]), **options)


class Bead(Particle):
    """The same on a curve in space, coordinates (z, x, y): ``(x² + y² - 1)/2 = 0`` and ``z = x y/2``.

    Its mass matrix is full, and nothing has the size 1, so that no size can be left out.
    """

    NQ = NV = mechanical = NT = 3
    position_rank = RANK = NC = NP = 2
    s_at = w_at = d_at = (1,)

    def __init__(self, angle: float, speed: float, u: float = 0.7) -> None:
        """At an angle of the circle."""
        x, y = math.cos(angle), math.sin(angle)
        vx, vy = -speed * y, speed * x
        super().__init__((x * y / 2, x, y), ((vx * y + x * vy) / 2, vx, vy), u)
        self.NC = self.NP = 2
        self.M = np.array([[2.0, 0.3, -0.4], [0.3, 3.0, 0.5], [-0.4, 0.5, 1.7]])

    def at(self, q: Any = None, v: Any = None) -> tuple[Any, Any]:
        q = self.q if q is None else np.array([q[0], q[1], q[2]])
        return q, self.v if v is None else np.array([v[0], v[1], v[2]])

    def rows(self, values: Any) -> Any:
        return np.asarray(values)

    def gap(self, q: Any) -> Any:
        z, x, y = q
        return np.array([(x * x + y * y - 1) / 2, z - x * y / 2])

    def normal(self, q: Any) -> Any:
        _, x, y = q
        return np.array([[0.0, x, y], [1.0, -y / 2, -x / 2]])

    def bend(self, v: Any) -> Any:
        _, vx, vy = v
        return np.array([-(vx * vx) - vy * vy, vx * vy])

    def equations(self, M: Reals, h: Reals, **given: Any) -> None:
        filled(M, self.M)
        filled(h, [self.weight, 0.0, -0.3])

    def constraint_sizes(self, of_phi: Reals, of_v: Reals) -> None:
        filled(of_phi, [0.8, 1.3])
        filled(of_v, [1.5, 0.7, 2.0])

    def constrained_slopes(
        self, slopes_f: Reals, slopes_gam: Reals, slopes_rates: Reals, drift: Reals, **given: Any
    ) -> None:
        (_, ax, ay), (one, two) = (
            [given[x][i] for i in range(len(given[x]))] for x in ("a", "lam")
        )
        _, vx, vy = self.v
        none = [0.0] * 3
        filled(
            slopes_f,
            [
                [*none, *none, 0],
                [0, -one, two / 2, *none, -1],
                [0, two / 2, -one, *none, 0],
            ],
        )
        filled(
            slopes_gam,
            [[0, ax, ay, 0, 2 * vx, 2 * vy, 0], [0, -ay / 2, -ax / 2, 0, -vy, -vx, 0]],
        )
        filled(slopes_rates, [[0, vx, vy], [0, -vy / 2, -vx / 2]])
        filled(drift, np.zeros((3, 3)))

    @property
    def force(self) -> Any:
        return np.array([-self.weight, self.u, 0.3])

    def expected(self) -> tuple[Any, Any]:
        J = self.normal(self.q)
        whole = np.block([[self.M, -J.T], [J, np.zeros((2, 2))]])
        found = np.linalg.solve(whole, [*self.force, *self.bend(self.v)])
        return found[:3], found[3:]

    def tangent(self) -> Any:
        """All velocities for a unit velocity of x."""
        whole = np.vstack([self.normal(self.q), [0.0, 1.0, 0.0]])
        return np.linalg.solve(whole, [0.0, 0.0, 1.0])


class Sheet(Bead):
    """A particle on the surface ``z = x y/2``: two motions are free."""

    position_rank = RANK = 1
    NI, NDX = 2, 4
    s_at = w_at = d_at = (1, 2)

    def __init__(self, q: Any, v: Any, u: float = 0.7) -> None:
        """At x, y and their rates."""
        super().__init__(0.0, 0.0, u)
        (x, y), (vx, vy) = q, v
        self.q = np.array([x * y / 2, x, y])
        self.v = np.array([(vx * y + x * vy) / 2, vx, vy])
        self.NC = self.NP = 1

    def gap(self, q: Any) -> Any:
        return super().gap(q)[1:]

    def normal(self, q: Any) -> Any:
        return super().normal(q)[1:]

    def bend(self, v: Any) -> Any:
        return super().bend(v)[1:]

    def constraint_sizes(self, of_phi: Reals, of_v: Reals) -> None:
        filled(of_phi, [1.3])
        filled(of_v, [1.5, 0.7, 2.0])

    def constrained_slopes(
        self, slopes_f: Reals, slopes_gam: Reals, slopes_rates: Reals, drift: Reals, **given: Any
    ) -> None:
        whole = [reals(21), reals(14), reals(6), reals(9)]
        super().constrained_slopes(*whole, a=given["a"], lam=[0.0, given["lam"][0]])
        for target, source, start in zip(
            (slopes_f, slopes_gam, slopes_rates, drift), whole, (0, 7, 3, 0), strict=True
        ):
            filled(target, [source[i] for i in range(start, len(source))])

    def expected(self) -> tuple[Any, Any]:
        J = self.normal(self.q)
        whole = np.block([[self.M, -J.T], [J, np.zeros((1, 1))]])
        found = np.linalg.solve(whole, [*self.force, *self.bend(self.v)])
        return found[:3], found[3:]

    def tangent(self) -> Any:
        whole = np.vstack([self.normal(self.q), np.eye(3)[1:]])
        return np.linalg.solve(whole, np.vstack([np.zeros((1, 2)), np.eye(2)]))
