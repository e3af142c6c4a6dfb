"""Newton's and Euler's equations, body by body.

Each body has the mass the model gives it, and by d'Alembert's principle

    M = Σ Jᵀ I J        h = Σ Jᵀ (I v̇₀ + bias forces - gravity) - what acts

with J the body's velocity by each of v, and v̇₀ its acceleration at v̇ = 0. Nothing is regrouped.
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
"""What an entry of mechanics is made of is at least this fraction of its largest neighbour's: rounding."""


class Heavy(NamedTuple):
    """A body: mass, first moment and inertia about a point, in ground axes, and how that point moves."""

    mass: float
    first: Array
    inertia: Array
    moved: Moved


@dataclass(frozen=True)
class Bodies:
    """The bodies of a model at a state.

    Attributes:
        walk: how everything moves there.
    """

    walk: Walk

    @cached_property
    def heavy(self) -> list[Heavy]:
        """Every body that moves."""
        moving = {body for body, (link, _) in self.walk.tree.bodies.items() if link >= 0}
        model = self.walk.tree.system
        return [self.heavy_of(body) for body in model.bodies if body in moving]

    def heavy_of(self, name: str) -> Heavy:
        """A body about its mass centre or, where none is given, its origin."""
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
        """Acceleration of free fall, in ground axes."""
        return self.walk.np.array([self.walk.number(x) for x in self.walk.tree.gravity])

    @cached_property
    def mass_matrix(self) -> Valued:
        """M, with what networks store; networks by their laws in numbers."""
        np, n = self.walk.np, len(self.walk.v)
        total, diagonal = np.zeros((n, n), self.walk.number), np.zeros(n)
        for body in self.heavy:
            linear, angular = body.moved.linear[:, :-1], body.moved.angular[:, :-1]
            force, torque = self.needed(body, linear, angular)
            total += linear.T @ force + angular.T @ torque
            # a slender body has none about its axis, but for the rounding of the rest
            diagonal += np.linalg.norm(body.inertia) * np.square(np.abs(angular)).sum(axis=0)
            diagonal += abs(body.mass) * np.square(np.abs(linear)).sum(axis=0)
        for i, j, entry in self.walk.numeric.at(self.walk.q, self.walk.v).stored:
            total[i, j] += self.walk.number(entry)
        # a mass on an axis has none about it, but for the rounding of directions
        diagonal = np.maximum(diagonal, NOISE**2 * self._aside)
        diagonal = np.sqrt(np.maximum(diagonal, np.abs(np.diag(total))))
        return total, np.maximum(np.abs(total), np.outer(diagonal, diagonal))

    @cached_property
    def _aside(self) -> Array:
        """By velocity, the inertia of all masses if they stood aside of what they turn about."""
        np, found = self.walk.np, self.walk.np.zeros(len(self.walk.v))
        for body in self.heavy:
            arms = np.square(np.abs(body.moved.origin - self._origins)).sum(axis=1)
            turned = np.square(np.abs(body.moved.angular[:, :-1])).sum(axis=0)
            found += abs(body.mass) * arms * turned
        return found

    @cached_property
    def _origins(self) -> Array:
        """Of each velocity where the link stands that it moves, in ground axes."""
        found = self.walk.np.zeros((len(self.walk.v), 3), self.walk.number)
        for k, link in enumerate(self.walk.tree.links):
            for freedom in link.velocities:
                found[freedom.index] = self.walk.moved(k).origin
        return found

    def needed(self, body: Heavy, linear: Array, angular: Array) -> tuple[Array, Array]:
        """The force and torque for accelerations of a body at rest, by direction."""
        cross = self.walk.np.cross
        arms = self.walk.np.broadcast_to(body.first[:, None], linear.shape)
        force = body.mass * linear + cross(angular, arms, axis=0)
        return force, body.inertia @ angular + cross(arms, linear, axis=0)

    def required(self, body: Heavy, pull: Array) -> tuple[Array, Array]:
        """The force and torque, about its point, for a body to move as it does at v̇ = 0."""
        cross, w = self.walk.np.cross, body.moved.angular[:, -1]
        force, torque = self.needed(body, pull[:, None], body.moved.spin[:, None])
        force = force[:, 0] + cross(w, cross(w, body.first))
        return force, torque[:, 0] + cross(w, body.inertia @ w)

    @cached_property
    def bias(self) -> Valued:
        """h: what the bodies need at v̇ = 0, less what acts without inputs."""
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
        # of mechanics alone: what networks store may be of any size beside it
        size[:first] = self._with_noise(size[:first])
        size[first:] += self._loop_noise() + self._of_laws(RESTING)
        return total - acting, size

    def _of_laws(self, what: str) -> Array:
        """How large the terms are that the forces on states of networks are sums of."""
        np, number = self.walk.np, self.walk.number
        exchange = self.walk.numeric.exchange(self.walk.q, self.walk.v)
        if exchange is None:
            return np.zeros(0)
        rows = exchange.network.part_sizes[what][: len(exchange.network.states)]
        return np.abs([number(exchange.still(x)) for x in rows])

    def _loop_noise(self) -> Array:
        """How large the terms of an algebraic loop are in F of the network's states.

        The unknowns of a loop are as exact as the terms of its equations, K dx = dr; a small current that is
        told from the difference of two voltages is less exact than its own digits.
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
        """Sizes of forces along v, none much less than its largest neighbour for velocities of unit inertia.

        A force in newtons and a torque in newton metres, a planet's and a ship's, have no common size, but
        |M_ij| <= sqrt(M_ii M_jj): so much of one may be rounding in another.
        """
        np = self.walk.np
        inertia = np.maximum(np.diag(self.mass_matrix[1]), self._aside)
        roots = np.sqrt(inertia[: len(size)])
        roots = np.where(roots > 0, roots, roots.max(initial=0.0) or 1.0)
        return np.maximum(size, NOISE * roots * (size / roots).max(initial=0.0))

    def _along(self, acting: Applied | None) -> Valued:
        """What forces on links and along joints do along v."""
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
        """Q of the inputs."""
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
        """Kinetic and potential energy, that of springs included; what networks store."""
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
        """What a body's kinetic energy would be if nothing that moves it went against another."""
        np, moved = self.walk.np, body.moved

        def most(along: Array) -> float:
            parts = along[:, :-1] * np.array(self.walk.v)
            driven = along[:, -1] - parts.sum(axis=1)
            return float(np.linalg.norm(parts, axis=0).sum() + np.linalg.norm(driven))

        u, w = most(moved.linear), most(moved.angular)
        arm, inertia = np.linalg.norm(body.first), np.linalg.norm(body.inertia)
        return float(abs(body.mass) * u * u + 2 * arm * u * w + inertia * w * w) / 2
