"""Circuit equations of velocity and acceleration: Hᵀ, from the root to the leaves.

The accelerations of a link's points are a field x -> a + A x with A = [ε x] + [ω x][ω x].
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.algebra.protocol import set_label
from linegraph.spatial import vector
from linegraph.spatial.motion import Motion
from linegraph.spatial.vector import ZERO, Vector, add, cross

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.arms import Arm
    from linegraph.kinematics.tree_state import TreeState
    from linegraph.spatial.inertia import Moments
    from linegraph.spatial.rotation import Inertia


Wrench = tuple[Vector, Vector]
"""Force, and torque about a link's origin."""


class Spin(NamedTuple):
    """How a link moves: angular velocity and acceleration, and the acceleration of its origin."""

    velocity: Vector
    angular: Vector
    linear: Vector


def resting(gravity: Vector) -> Spin:
    """How ground moves: gravity enters as its acceleration -g."""
    return Spin(ZERO, ZERO, vector.negate(gravity))


def spins(
    state: TreeState, acceleration: Iterable[Scalar] | None = None, gravity: Vector | None = None
) -> list[Spin]:
    """How every link moves.

    Gravity enters as the acceleration -g of ground.
    """
    a = None if acceleration is None else tuple(acceleration)
    ground = resting(state.tree.gravity if gravity is None else gravity)
    found: list[Spin] = []
    for link, arm in zip(state.tree.links, state.arms, strict=True):
        set_label(state.algebra, f"motion, {link.caption}")
        near = found[link.parent] if link.parent >= 0 else ground
        here = crossing(arm, near.velocity)
        angular = here.spin if arm.level else add(arm.rotation.into(near.angular), here.spin)
        pull = add(near.linear, accelerated(near, arm.at))
        linear = add(arm.rotation.into(pull), here.linear)
        if a is not None and link.velocities:
            own = tuple(f.ratio * a[f.index] for f in link.velocities)
            angular = add(angular, vector.combine(own, arm.motion.angular))
            linear = add(linear, vector.combine(own, arm.motion.linear))
        found.append(Spin(here.velocity, angular, linear))
    return found


class Crossing(NamedTuple):
    """What a joint makes of its near link's angular velocity, with v̇ = 0 and in the far link's axes.

    Attributes:
        before: the near link's angular velocity.
        turning: the relative one.
        angular: what the joint adds to the angular acceleration, less ``before x turning``.
        linear: what it adds to the acceleration of the far link's origin.
    """

    before: Vector
    turning: Vector
    angular: Vector
    linear: Vector

    @property
    def velocity(self) -> Vector:
        """The far link's angular velocity."""
        return add(self.before, self.turning)

    @property
    def spin(self) -> Vector:
        """All that the joint adds to the angular acceleration."""
        return add(cross(self.before, self.turning), self.angular)


def crossing(arm: Arm, near: Vector) -> Crossing:
    """How a joint is crossed whose near link has this angular velocity, in the far link's axes."""
    if arm.level:
        # such joints have no shift: their origin moves with the near link alone
        w = vector.combine(arm.rates, arm.motion.angular)
        return Crossing(ZERO, w, arm.motion.angular_bias, ZERO)
    return crossed_with(arm, arm.motion, arm.rotation.into(near))


def crossed_with(arm: Arm, motion: Motion, before: Vector) -> Crossing:
    """The same with the joint's motion and the near link's angular velocity in any axes."""
    w = vector.combine(arm.rates, motion.angular)
    u = vector.combine(arm.rates, motion.linear)
    angular = motion.angular_bias
    # Coriolis: the relative velocity u turns with the near link (twice) and with the joint
    linear = add(cross(add(add(before, w), before), u), motion.linear_bias)
    if arm.prescribed:
        angular = add(angular, vector.combine(arm.prescribed, motion.angular))
        linear = add(linear, vector.combine(arm.prescribed, motion.linear))
    return Crossing(before, w, angular, linear)


def seen_near(arm: Arm) -> Motion:
    """A joint's motion in the near link's axes."""
    out, motion = arm.rotation.out, arm.motion
    return Motion(
        motion.rotation,
        motion.displacement,
        tuple(out(s) for s in motion.angular),
        tuple(out(u) for u in motion.linear),
        out(motion.angular_bias),
        out(motion.linear_bias),
    )


def inertia_forces(
    state: TreeState, acceleration: Iterable[Scalar] | None = None, gravity: Vector | None = None
) -> list[Wrench]:
    """Force and torque that each link's own motion asks for; with no v̇ given, at v̇ = 0."""
    found = []
    motions = spins(state, acceleration, gravity)
    for link, arm, spin in zip(state.tree.links, state.arms, motions, strict=True):
        set_label(state.algebra, f"forces, {link.caption}")
        found.append(d_alembert(arm.moments, spin))
    return found


def d_alembert(moments: Moments, spin: Spin) -> Wrench:
    """Force and torque that the motion of a link asks for, about its origin.

    f = m a + U b and n = b x a + the axial vector of U S, with b and S the first and second moments; it is
    written with the entries of U, which the force and the arms need anyway.
    """
    mass, first, second, _ = moments
    force = add(vector.scale(mass, spin.linear), accelerated(spin, first))
    xx, xy, xz, yy, yz, zz = _products(spin.velocity)
    x, y, z = spin.angular
    sxx, sxy, sxz, syy, syz, szz = second
    torque = (
        _twisted(syy, szz, yz, x) + (zz - yy) * syz + (xz - y) * sxy - (xy + z) * sxz,
        _twisted(szz, sxx, xz, y) + (xx - zz) * sxz + (xy - z) * syz - (yz + x) * sxy,
        _twisted(sxx, syy, xy, z) + (yy - xx) * sxy + (yz - x) * sxz - (xz + y) * syz,
    )
    return force, add(torque, cross(first, spin.linear))


def together(a: Wrench, b: Wrench) -> Wrench:
    """The sum of two wrenches about one point."""
    return add(a[0], b[0]), add(a[1], b[1])


def _twisted(a: Scalar, b: Scalar, both: Scalar, turn: Scalar) -> Scalar:
    """``a (both + turn) - b (both - turn)``; where neither is zero their sum and difference serve better."""
    if a == 0 or b == 0:
        return a * (both + turn) - b * (both - turn)
    return (a + b) * turn + (a - b) * both


def accelerated(spin: Spin, r: Vector) -> Vector:
    """``U r`` with U = [ε x] + [ω x][ω x]: acceleration of a point r of a link, less its origin's."""
    xx, xy, xz, yy, yz, zz = _products(spin.velocity)
    x, y, z = spin.angular
    return (
        (xy - z) * r[1] + (xz + y) * r[2] - (yy + zz) * r[0],
        (xy + z) * r[0] + (yz - x) * r[2] - (xx + zz) * r[1],
        (xz - y) * r[0] + (yz + x) * r[1] - (xx + yy) * r[2],
    )


def _products(w: Vector) -> Inertia:
    """ω ω^T: computed once, since the DAG shares it between all uses."""
    x, y, z = w
    return (x * x, x * y, x * z, y * y, y * z, z * z)
