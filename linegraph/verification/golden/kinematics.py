"""Kinematics from where the bodies are: frames as places on them, the whole as their sum.

A frame is a place on a body, whose derivatives along the motion say how it moves. Momentum is that of every
body, and its rate what the bodies need without gravity. Nothing is carried from joint to joint.
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
    """Frames of a model, and all of it, at a state.

    Attributes:
        walk: how everything moves there.
        bodies: what has mass.
    """

    walk: Walk
    bodies: Bodies

    # -- of a frame

    def frame(self, name: str) -> Moved:
        """How it moves: a body, a frame of one, or its mass centre."""
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
        """Where a body's mass centre is, in the body's own frame."""
        model, resolve = self.walk.tree.system, self.walk.numeric.resolve
        assert model is not None
        body = model.bodies[name]
        if body.first is None:
            return tuple(float(resolve(x)) for x in body.center or ZERO)
        mass = float(resolve(body.mass))
        return tuple(float(resolve(x)) / mass if mass else 0.0 for x in body.first)

    def position(self, frame: str) -> Valued:
        """Its origin."""
        return _alike(self.walk.np, self.frame(frame).origin)

    def rotation(self, frame: str) -> Valued:
        """Its axes, in columns."""
        turn = self.frame(frame).rotation
        return turn, self.walk.np.ones((3, 3))

    def velocity(self, frame: str) -> Valued:
        """Of its origin, and angular."""
        J, _ = self.jacobian(frame)
        moved = self.frame(frame)
        found = self.walk.np.concatenate([moved.linear[:, -1], moved.angular[:, -1]])
        return self._in_halves(found, self.walk.np.abs(J) @ self.walk.np.abs(self.walk.v))

    def jacobian(self, frame: str) -> Valued:
        """The same for every unit velocity; a half column is judged by its length."""
        moved = self.frame(frame)
        return self._columns(moved.linear[:, :-1], moved.angular[:, :-1])

    def jacobian_dot_v(self, frame: str) -> Valued:
        """Their rates at v̇ = 0; at speeds v of the size of J v², of which much may cancel."""
        np, v = self.walk.np, self.walk.np.abs(self.walk.v)
        J, moved = np.abs(self.jacobian(frame)[0]), self.frame(frame)
        found = np.concatenate([moved.pull, moved.spin])
        return self._in_halves(found, J @ v * self._turning)

    @property
    def _turning(self) -> float:
        """How fast anything turns at most."""
        return float(self.walk.np.abs(self.walk.v).sum())

    # -- of the whole

    @cached_property
    def _whole(self) -> tuple[float, Array]:
        """Mass, and centre of mass."""
        np = self.walk.np
        heavy = self.bodies.heavy
        mass = sum(body.mass for body in heavy)
        firsts = [body.mass * body.moved.origin + body.first for body in heavy]
        return mass, np.sum(firsts, axis=0) / mass

    def _summed(self, forces: Iterable[tuple[Array, Array]]) -> Valued:
        """Sums of what each body has, a force and a torque about its own point, about the mass centre.

        Returns:
            6 x k, the torques last; a half of a column is judged by the lengths of what it is the sum of.
        """
        np, (_, center) = self.walk.np, self._whole
        found = size = 0.0
        for body, (force, torque) in zip(self.bodies.heavy, forces, strict=True):
            arm = body.moved.origin - center
            arms = np.broadcast_to(arm[:, None], force.shape)
            found = found + np.vstack([force, torque + np.cross(arms, force, axis=0)])
            # about the mass centre what forces do about ground's origin may cancel
            pull = np.linalg.norm(force, axis=0)
            reach = np.linalg.norm(arm) + np.linalg.norm(center)
            size = size + np.vstack([pull, np.linalg.norm(torque, axis=0) + reach * pull])
        return found, np.repeat(size, 3, axis=0)

    @cached_property
    def _momenta(self) -> Valued:
        """Momentum for unit velocities, then that of the state."""
        heavy, needed = self.bodies.heavy, self.bodies.needed
        return self._summed([needed(x, x.moved.linear, x.moved.angular) for x in heavy])

    @property
    def com(self) -> Valued:
        """Centre of mass."""
        np, (mass, center) = self.walk.np, self._whole
        size = sum(
            np.abs(body.mass * body.moved.origin) + np.abs(body.first) for body in self.bodies.heavy
        )
        return center, np.full(3, np.max(size) / mass)

    @property
    def com_velocity(self) -> Valued:
        """Its velocity: momentum by mass."""
        (found, size), mass = self.momentum, self._whole[0]
        return found[:3] / mass, size[:3] / mass

    @property
    def com_jacobian(self) -> Valued:
        """The same for every unit velocity."""
        (found, size), mass = self.momentum_matrix, self._whole[0]
        return found[:3] / mass, size[:3] / mass

    @property
    def momentum(self) -> Valued:
        """Linear, and angular about the centre of mass."""
        (found, size), np = self._momenta, self.walk.np
        return found[:, -1], np.maximum(size[:, -1], size[:, :-1] @ np.abs(self.walk.v))

    @property
    def momentum_matrix(self) -> Valued:
        """The same for every unit velocity."""
        found, size = self._momenta
        return found[:, :-1], size[:, :-1]

    @property
    def momentum_rate(self) -> Valued:
        """What the bodies need at v̇ = 0 without gravity; of the size of momentum that turns."""
        np = self.walk.np
        forces = [self.bodies.required(body, body.moved.pull) for body in self.bodies.heavy]
        found, size = self._summed([(x[:, None], y[:, None]) for x, y in forces])
        return found[:, 0], np.maximum(size[:, 0], self.momentum[1] * self._turning)

    # -- what entries are made of

    def _columns(self, linear: Array, angular: Array) -> Valued:
        """Rows of motion and of turning; each half of a column is judged by its length."""
        np = self.walk.np
        lengths = [np.linalg.norm(half, axis=0) for half in (linear, angular)]
        return np.vstack([linear, angular]), np.repeat(lengths, 3, axis=0)

    def _in_halves(self, found: Array, size: Array) -> Valued:
        """Each half is judged by the largest of it."""
        np = self.walk.np
        size = np.maximum(np.abs(found), size)
        return found, np.repeat([size[:3].max(), size[3:].max()], 3)


def _alike(np: Any, found: Array) -> Valued:
    """A vector whose entries are judged by its length."""
    return found, np.full(found.shape, np.linalg.norm(found))
