"""Newton's and Euler's equations, body by body.

Each body has the mass given in the model. By d'Alembert's principle

    M = Σ Jᵀ I J        h = Σ Jᵀ (I v̇₀ + bias forces - gravity) - passive forces

where J (6 x n) gives the body's velocity for each entry of v, and v̇₀ is its acceleration at v̇ = 0. No
terms are regrouped: the emitted program lumps masses along the tree, this reference must not share that.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.dynamics.applied_forces import efforts
from linegraph.dynamics.network_state import DRIVEN, RESTING
from linegraph.spatial.vector import ZERO, add, is_zero, times

if TYPE_CHECKING:
    from linegraph.dynamics.applied_forces import Applied
    from linegraph.verification.golden.walk import Moved, Valued, Walk

    Array = Any

NOISE = 1e-3
"""Least size of an entry, relative to its largest neighbour of mechanics: below it may be rounding."""


class Heavy(NamedTuple):
    """Mass moments of a body about a reference point, in ground axes, and the point's motion.

    Attributes:
        mass: kg.
        first: 3, first moment of mass about the point (kg m).
        inertia: 3 x 3, inertia about the point (kg m^2).
        moved: motion of the point and of the body's axes.
    """

    mass: float
    first: Array
    inertia: Array
    moved: Moved


@dataclass(frozen=True)
class Bodies:
    """Newton's and Euler's equations of all bodies at a state.

    Attributes:
        walk: the motion of all links at that state.
    """

    walk: Walk

    @cached_property
    def heavy(self) -> list[Heavy]:
        """All bodies that move, in declared order; bodies welded to ground are left out."""
        moving = {body for body, (link, _) in self.walk.tree.bodies.items() if link >= 0}
        model = self.walk.tree.system
        return [self.heavy_of(body) for body in model.bodies if body in moving]

    def heavy_of(self, name: str) -> Heavy:
        """Return a body's moments about its mass centre or, if the model gives none, about its origin."""
        np, number, resolve = self.walk.np, self.walk.number, self.walk.numeric.resolve
        body = self.walk.tree.system.bodies[name]
        link, pose = self.walk.tree.bodies[name]
        about: Any = body.center or ZERO
        about = tuple(number(resolve(x)) for x in about)
        first = tuple(number(resolve(x)) for x in body.first or ZERO)
        xx, xy, xz, yy, yz, zz = (number(resolve(x)) for x in body.inertia)
        moved = self.walk.moved(link, add(pose.at, times(pose.rotation, about)), pose.rotation)
        turn = moved.rotation
        inertia = turn @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ turn.T
        return Heavy(number(resolve(body.mass)), turn @ first, inertia, moved)

    @cached_property
    def gravity(self) -> Array:
        """Acceleration of free fall in ground axes (m/s^2), 3."""
        return self.walk.np.array([self.walk.number(x) for x in self.walk.tree.gravity])

    @cached_property
    def mass_matrix(self) -> Valued:
        """M (n x n) of all bodies, plus the inertia that networks add; their laws are evaluated in floats."""
        np, n = self.walk.np, len(self.walk.v)
        # Sizes are those of the bodies' diagonals: |M_ij| <= sqrt(M_ii M_jj), so an off-diagonal entry may
        # be the rounding of its diagonals.
        total, diagonal = np.zeros((n, n), self.walk.number), np.zeros(n)
        for body in self.heavy:
            linear, angular = body.moved.linear[:, :-1], body.moved.angular[:, :-1]
            force, torque = self.needed(body, linear, angular)
            total += linear.T @ force + angular.T @ torque
            # A slender body has no inertia about its axis except the rounding of its other inertias.
            diagonal += np.linalg.norm(body.inertia) * np.square(np.abs(angular)).sum(axis=0)
            diagonal += abs(body.mass) * np.square(np.abs(linear)).sum(axis=0)
        for i, j, entry in self.walk.numeric.at(self.walk.q, self.walk.v).stored:
            total[i, j] += self.walk.number(entry)
        # A mass on an axis has no inertia about it except what the rounding of directions leaves.
        diagonal = np.maximum(diagonal, NOISE**2 * self._aside)
        diagonal = np.sqrt(np.maximum(diagonal, np.abs(np.diag(total))))
        return total, np.maximum(np.abs(total), np.outer(diagonal, diagonal))

    @cached_property
    def _aside(self) -> Array:
        """For each velocity an upper estimate of inertia: ``Σ m r² |ω|²``.

        r is the distance of the body's reference point from the origin of the link that the velocity moves.
        The sum is the inertia that the velocity would have if no mass lay on the axis.
        """
        np, found = self.walk.np, self.walk.np.zeros(len(self.walk.v))
        for body in self.heavy:
            arms = np.square(np.abs(body.moved.origin - self._origins)).sum(axis=1)
            turned = np.square(np.abs(body.moved.angular[:, :-1])).sum(axis=0)
            found += abs(body.mass) * arms * turned
        return found

    @cached_property
    def _origins(self) -> Array:
        """For each velocity, the origin of the link it moves, in ground axes (m), n x 3."""
        found = self.walk.np.zeros((len(self.walk.v), 3), self.walk.number)
        for k, link in enumerate(self.walk.tree.links):
            for freedom in link.velocities:
                found[freedom.index] = self.walk.moved(k).origin
        return found

    def needed(self, body: Heavy, linear: Array, angular: Array) -> tuple[Array, Array]:
        """Newton and Euler for a body momentarily at rest: ``f = m u + α x b``, ``n = I α + b x u``.

        With velocities in place of accelerations the same formula gives momentum.

        Args:
            body: the moments m, b, I about the body's reference point, in ground axes.
            linear: 3 x k, accelerations u of the reference point (m/s^2).
            angular: 3 x k, angular accelerations α (rad/s^2).

        Returns:
            The force (N) and the torque about the reference point (N m), each 3 x k, in ground axes.
        """
        cross = self.walk.np.cross
        arms = self.walk.np.broadcast_to(body.first[:, None], linear.shape)
        force = body.mass * linear + cross(angular, arms, axis=0)
        return force, body.inertia @ angular + cross(arms, linear, axis=0)

    def required(self, body: Heavy, pull: Array) -> tuple[Array, Array]:
        """Wrench that makes a body move as it does at v̇ = 0.

        To the wrench of `needed`, it adds ``ω x (ω x b)`` and ``ω x I ω``.

        Args:
            body: the moments about the body's reference point, with its motion.
            pull: 3, acceleration of that point; less gravity where the weight is to be counted (m/s^2).

        Returns:
            The force (N) and the torque about the reference point (N m), each 3, in ground axes.
        """
        cross, w = self.walk.np.cross, body.moved.angular[:, -1]
        force, torque = self.needed(body, pull[:, None], body.moved.spin[:, None])
        force = force[:, 0] + cross(w, cross(w, body.first))
        return force, torque[:, 0] + cross(w, body.inertia @ w)

    @cached_property
    def bias(self) -> Valued:
        """Bias h (n): generalised force that bodies need at v̇ = 0, less passive forces; ``M v̇ + h = Q``."""
        np, n = self.walk.np, len(self.walk.v)
        total, size = np.zeros(n, self.walk.number), np.zeros(n)
        for body in self.heavy:
            moved, w = body.moved, body.moved.angular[:, -1]
            turned = body.inertia @ w
            force, torque = self.required(body, moved.pull - self.gravity)
            total += moved.linear[:, :-1].T @ force + moved.angular[:, :-1].T @ torque
            weight = abs(body.mass) * np.linalg.norm(self.gravity) + np.linalg.norm(force)
            spin = np.linalg.norm(torque) + np.linalg.norm(w) * np.linalg.norm(turned)
            size += np.linalg.norm(moved.linear[:, :-1], axis=0) * weight
            size += np.linalg.norm(moved.angular[:, :-1], axis=0) * spin
        acting, parts = self._along(
            self.walk.numeric.applied(self.walk.q, self.walk.v, driven=False)
        )
        size, first = size + parts, self.walk.tree.layout.mechanical
        # Only among the entries of mechanics: forces on states of networks may be of any other size.
        size[:first] = self._with_noise(size[:first])
        size[first:] += self._loop_noise() + self._of_laws(RESTING)
        return total - acting, size

    def _of_laws(self, what: str) -> Array:
        """Sizes of the terms that make up the forces on the states of networks."""
        np, number = self.walk.np, self.walk.number
        exchange = self.walk.numeric.exchange(self.walk.q, self.walk.v)
        if exchange is None:
            return np.zeros(0)
        rows = exchange.network.part_sizes[what][: len(exchange.network.states)]
        return np.abs([number(exchange.still(x)) for x in rows])

    def _loop_noise(self) -> Array:
        """Effect of the tolerance of an algebraic loop's unknowns on the forces F of the network's states.

        The unknowns are as exact as the terms of the loop's equations, ``K dx = dr``. A small current
        computed from the difference of two voltages is less exact than its own digits.
        """
        np, number = self.walk.np, self.walk.number
        exchange = self.walk.numeric.exchange(self.walk.q, self.walk.v)
        if exchange is None or not exchange.network.loop:
            return np.zeros(len(self.walk.v) - self.walk.tree.layout.mechanical)
        network, still = exchange.network, exchange.still
        count = len(network.states)
        K, slopes = (
            np.array([[number(still(x)) for x in row] for row in rows])
            for rows in (network.loop_jacobian, network.force_slopes[:count])
        )
        terms = np.array([number(still(x)) for x in network.loop_sizes])
        return np.abs(slopes.reshape(count, -1)) @ np.abs(np.linalg.inv(K)) @ np.abs(terms)

    def _with_noise(self, size: Array) -> Array:
        """Raise sizes of forces along v so that none is far below its largest neighbour at unit inertia.

        A force in newtons and a torque in newton metres, of a planet and of a ship, have no common size.
        But ``|M_ij| <= sqrt(M_ii M_jj)``, so that fraction of one may be rounding in the other.
        """
        np = self.walk.np
        inertia = np.maximum(np.diag(self.mass_matrix[1]), self._aside)
        roots = np.sqrt(inertia[: len(size)])
        roots = np.where(roots > 0, roots, roots.max(initial=0.0) or 1.0)
        return np.maximum(size, NOISE * roots * (size / roots).max(initial=0.0))

    def _along(self, acting: Applied | None) -> Valued:
        """Project wrenches on links and efforts along joints onto v."""
        np, number, n = self.walk.np, self.walk.number, len(self.walk.v)
        total = np.zeros(n, number)
        if acting is None:
            return total, np.zeros(n)
        total += np.array([number(x) for x in acting.efforts])
        size = np.abs(total)
        for link, (force, torque) in enumerate(acting.wrenches):
            if is_zero(force) and is_zero(torque):
                continue
            moved = self.walk.moved(link)
            f, m = (moved.rotation @ np.array([number(x) for x in w]) for w in (force, torque))
            total += moved.linear[:, :-1].T @ f + moved.angular[:, :-1].T @ m
            size += np.abs(moved.linear[:, :-1]).T @ np.abs(f)
            size += np.abs(moved.angular[:, :-1]).T @ np.abs(m)
        return total, size

    @cached_property
    def forces(self) -> Valued:
        """Q (n): generalised forces of the inputs, joint efforts among them; ``M v̇ + h = Q``."""
        np, numeric = self.walk.np, self.walk.numeric
        driven, size = self._along(numeric.applied(self.walk.q, self.walk.v, driven=True))
        chords = numeric.chords(self.walk.q, self.walk.v)
        nothing = [0.0] * len(self.walk.v)
        pushed = efforts(chords, nothing)
        pushed = np.array([self.walk.number(x) for x in pushed])
        size = size + np.abs(pushed)
        size[self.walk.tree.layout.mechanical :] += self._of_laws(DRIVEN)
        return driven + pushed, size

    @cached_property
    def energy(self) -> Valued:
        """Kinetic energy, potential energy with that of springs, and the energy stored in networks (J).

        The last entry is missing in models without networks.
        """
        np = self.walk.np
        kinetic = moving = potential = size = 0.0
        for body in self.heavy:
            moved = body.moved
            u, w = moved.linear[:, -1:], moved.angular[:, -1:]
            force, torque = self.needed(body, u, w)
            kinetic += float((u.T @ force + w.T @ torque)[0, 0]) / 2
            moving += self._moving(body)
            height = self.gravity @ (body.mass * moved.origin + body.first)
            potential -= float(height)
            size += abs(float(height))
        acting = self.walk.numeric.applied(self.walk.q, self.walk.v, driven=False)
        springs = float(acting.potential)
        exchange = self.walk.numeric.exchange(self.walk.q, self.walk.v)
        stored = [] if exchange is None else [float(exchange.energy())]
        found = np.array([kinetic, potential + springs, *stored])
        size += abs(springs)
        return found, np.array([moving, max(size, NOISE * moving), *map(abs, stored)])

    def _moving(self, body: Heavy) -> float:
        """Kinetic energy of a body if the velocities that the entries of v give it all had one direction."""
        np, moved = self.walk.np, body.moved

        def most(along: Array) -> float:
            parts = along[:, :-1] * np.array(self.walk.v)
            driven = along[:, -1] - parts.sum(axis=1)
            return float(np.linalg.norm(parts, axis=0).sum() + np.linalg.norm(driven))

        u, w = most(moved.linear), most(moved.angular)
        arm, inertia = np.linalg.norm(body.first), np.linalg.norm(body.inertia)
        return float(abs(body.mass) * u * u + 2 * arm * u * w + inertia * w * w) / 2
