"""Kinematics of frames from positions of bodies, and of the whole system as sums over bodies.

A frame is a place on a body; its velocity and acceleration are derivatives of the place along the motion.
Momentum is the sum over bodies, and its rate is the wrench that they need without gravity. Nothing is
propagated from joint to joint. Centroidal quantities: [Orin et al. 2013].
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.components.body import MASS_CENTER
from linegraph.model.terminal_graphs import terminals_of
from linegraph.spatial.vector import ZERO, add, times

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.verification.golden.bodies import Bodies
    from linegraph.verification.golden.walk import Moved, Valued, Walk

    Array = Any


@dataclass(frozen=True)
class KinematicReference:
    """Motion of frames and of the whole system at a state, in ground axes.

    Each result is an array with sizes.

    Attributes:
        walk: the motion of all links.
        bodies: the moments of all bodies.
    """

    walk: Walk
    bodies: Bodies

    # -- of a frame

    def frame(self, name: str) -> Moved:
        """Motion of a body, a frame of a body or a mass centre, in ground axes.

        Args:
            name: ``body``, ``body.frame`` or the body with the suffix of its mass centre.
        """
        model, resolve = self.walk.tree.system, self.walk.numeric.resolve
        assert model is not None
        terminals = terminals_of(model)
        if name in terminals:
            body, placement = terminals[name]
            at: Any = [float(resolve(x)) for x in placement.at]
            turn: Any = [[float(resolve(x)) for x in row] for row in placement.rotation]
        else:
            body = name.removesuffix(f".{MASS_CENTER}")
            at, turn = self._center(body), self.walk.np.eye(3)
        link, pose = self.walk.tree.bodies[body]
        rotation = self.walk.np.array(pose.rotation, float) @ turn
        origin = add(pose.at, times(pose.rotation, tuple(at)))
        return self.walk.moved(link, origin, tuple(map(tuple, rotation)))

    def _center(self, name: str) -> Any:
        """Position of a body's mass centre in the body's own frame (m)."""
        model, resolve = self.walk.tree.system, self.walk.numeric.resolve
        assert model is not None
        body = model.bodies[name]
        if body.first is None:
            return tuple(float(resolve(x)) for x in body.center or ZERO)
        mass = float(resolve(body.mass))
        return tuple(float(resolve(x)) / mass if mass else 0.0 for x in body.first)

    def position(self, frame: str) -> Valued:
        """Position of a frame's origin, 3, from ground's origin in ground axes (m)."""
        return _alike(self.walk.np, self.frame(frame).origin)

    def rotation(self, frame: str) -> Valued:
        """Rotation matrix, 3 x 3: the columns are the frame's axes in ground axes."""
        turn = self.frame(frame).rotation
        return turn, self.walk.np.ones((3, 3))

    def velocity(self, frame: str) -> Valued:
        """Velocity of a frame's origin (m/s), then angular velocity (rad/s), 6, in ground axes."""
        J, _ = self.jacobian(frame)
        moved = self.frame(frame)
        found = self.walk.np.concatenate([moved.linear[:, -1], moved.angular[:, -1]])
        return self._in_halves(found, self.walk.np.abs(J) @ self.walk.np.abs(self.walk.v))

    def jacobian(self, frame: str) -> Valued:
        """Jacobian of a frame, 6 x n: linear rows, then angular; the size of a half column is its length."""
        moved = self.frame(frame)
        return self._columns(moved.linear[:, :-1], moved.angular[:, :-1])

    def jacobian_dot_v(self, frame: str) -> Valued:
        """``J̇ v``, 6: acceleration of a frame at v̇ = 0, linear then angular, in ground axes.

        Sizes are ``|J| |v|`` times the fastest angular velocity, since much of it may cancel.
        """
        np, v = self.walk.np, self.walk.np.abs(self.walk.v)
        J, moved = np.abs(self.jacobian(frame)[0]), self.frame(frame)
        found = np.concatenate([moved.pull, moved.spin])
        return self._in_halves(found, J @ v * self._turning)

    @property
    def _turning(self) -> float:
        """Upper bound on the angular velocity of anything."""
        return float(self.walk.np.abs(self.walk.v).sum())

    # -- of the whole

    @cached_property
    def _whole(self) -> tuple[float, Array]:
        """Total mass (kg) and position of the mass centre in ground axes (m)."""
        np = self.walk.np
        heavy = self.bodies.heavy
        mass = sum(body.mass for body in heavy)
        firsts = [body.mass * body.moved.origin + body.first for body in heavy]
        return mass, np.sum(firsts, axis=0) / mass

    def _summed(self, forces: Iterable[tuple[Array, Array]]) -> Valued:
        """Sum wrenches of all bodies, each about its own reference point, about the total mass centre.

        Returns:
            6 x k, torques last; the size of half a column is the sum of the lengths of its terms.
        """
        np, (_, center) = self.walk.np, self._whole
        found = size = 0.0
        for body, (force, torque) in zip(self.bodies.heavy, forces, strict=True):
            arm = body.moved.origin - center
            arms = np.broadcast_to(arm[:, None], force.shape)
            found = found + np.vstack([force, torque + np.cross(arms, force, axis=0)])
            # Moments about ground's origin may cancel when taken about the mass centre.
            pull = np.linalg.norm(force, axis=0)
            reach = np.linalg.norm(arm) + np.linalg.norm(center)
            size = size + np.vstack([pull, np.linalg.norm(torque, axis=0) + reach * pull])
        return found, np.repeat(size, 3, axis=0)

    @cached_property
    def _momenta(self) -> Valued:
        """Momentum for unit velocities, then that of the state, 6 x (n + 1)."""
        heavy, needed = self.bodies.heavy, self.bodies.needed
        return self._summed([needed(x, x.moved.linear, x.moved.angular) for x in heavy])

    @property
    def com(self) -> Valued:
        """Position of the total mass centre, 3, in ground axes (m)."""
        np, (mass, center) = self.walk.np, self._whole
        size = sum(
            np.abs(body.mass * body.moved.origin) + np.abs(body.first) for body in self.bodies.heavy
        )
        return center, np.full(3, np.max(size) / mass)

    @property
    def com_velocity(self) -> Valued:
        """Velocity of the total mass centre, 3, in ground axes (m/s): linear momentum divided by mass."""
        (found, size), mass = self.momentum, self._whole[0]
        return found[:3] / mass, size[:3] / mass

    @property
    def com_jacobian(self) -> Valued:
        """Jacobian of the total mass centre, 3 x n, in ground axes."""
        (found, size), mass = self.momentum_matrix, self._whole[0]
        return found[:3] / mass, size[:3] / mass

    @property
    def momentum(self) -> Valued:
        """Linear momentum, then angular momentum about the total mass centre, 6, in ground axes."""
        (found, size), np = self._momenta, self.walk.np
        return found[:, -1], np.maximum(size[:, -1], size[:, :-1] @ np.abs(self.walk.v))

    @property
    def momentum_matrix(self) -> Valued:
        """Centroidal momentum matrix A_G, 6 x n, linear rows first; ``A_G v`` is the momentum.

        See [Orin et al. 2013].
        """
        found, size = self._momenta
        return found[:, :-1], size[:, :-1]

    @property
    def momentum_rate(self) -> Valued:
        """``Ȧ_G v``, 6: rate of momentum at v̇ = 0, from the bodies' wrenches without gravity (N, N m)."""
        np = self.walk.np
        forces = [self.bodies.required(body, body.moved.pull) for body in self.bodies.heavy]
        found, size = self._summed([(x[:, None], y[:, None]) for x, y in forces])
        return found[:, 0], np.maximum(size[:, 0], self.momentum[1] * self._turning)

    # -- what entries are made of

    def _columns(self, linear: Array, angular: Array) -> Valued:
        """Stack linear and angular rows; the size of half a column is its length."""
        np = self.walk.np
        lengths = [np.linalg.norm(half, axis=0) for half in (linear, angular)]
        return np.vstack([linear, angular]), np.repeat(lengths, 3, axis=0)

    def _in_halves(self, found: Array, size: Array) -> Valued:
        """Give each half of a vector the size of its largest entry."""
        np = self.walk.np
        size = np.maximum(np.abs(found), size)
        return found, np.repeat([size[:3].max(), size[3:].max()], 3)


def _alike(np: Any, found: Array) -> Valued:
    """Give all entries of a vector the vector's length as size."""
    return found, np.full(found.shape, np.linalg.norm(found))
