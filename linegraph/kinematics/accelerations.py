"""Circuit equations of velocity and acceleration: Hᵀ, from the root to the leaves.

The point r of a link, from the link's origin and in its working axes, has the acceleration a + U r with
U = [ε x] + [ω x][ω x]. All links are computed in one pass outward and all inertia forces in one pass
over the links: the first half of the recursive Newton-Euler algorithm [Featherstone 2008, sec. 5.3].
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
"""Force (N), and torque about the link's origin (N m), in the link's working axes."""


class Spin(NamedTuple):
    """Motion of a link relative to ground, in the link's working axes.

    Attributes:
        velocity: angular velocity ω (rad/s).
        angular: angular acceleration ε (rad/s²).
        linear: acceleration of the link's origin (m/s²), less that of free fall if gravity is included.
    """

    velocity: Vector
    angular: Vector
    linear: Vector


def resting(gravity: Vector) -> Spin:
    """Motion of ground with gravity as its acceleration -g, so that every link's weight is an inertia force.

    Accelerating ground by -g costs nothing per link; adding m g to every link's force would.
    """
    return Spin(ZERO, ZERO, vector.negate(gravity))


def spins(
    state: TreeState, acceleration: Iterable[Scalar] | None = None, gravity: Vector | None = None
) -> list[Spin]:
    """Angular velocity and accelerations of every link: the circuit equations, root to leaves.

    Args:
        state: the tree at (q, v).
        acceleration: v̇, one entry per velocity (rad/s², m/s²); zero if None.
        gravity: free fall in ground axes (m/s²); the tree's own if None. It enters as the acceleration
            -g of ground.

    Returns:
        One `Spin` per link, in the order of the tree's links, each in its link's working axes.
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
    """Contribution of one joint to the motion of the link beyond it, at v̇ = 0.

    All vectors are in the far link's working axes, or in the axes given to `crossed_with`.

    Attributes:
        before: the near link's angular velocity (rad/s).
        turning: angular velocity of the far link relative to the near one (rad/s).
        angular: the joint's part of the angular acceleration (rad/s²), without ``before x turning``.
        linear: its part of the acceleration of the far link's origin (m/s²), Coriolis term included.
    """

    before: Vector
    turning: Vector
    angular: Vector
    linear: Vector

    @property
    def velocity(self) -> Vector:
        """The far link's angular velocity relative to ground (rad/s)."""
        return add(self.before, self.turning)

    @property
    def spin(self) -> Vector:
        """The joint's part of the angular acceleration, ``before x turning`` included (rad/s²)."""
        return add(cross(self.before, self.turning), self.angular)


def crossing(arm: Arm, near: Vector) -> Crossing:
    """Contribution of a joint to the motion beyond it, in the far link's working axes.

    Args:
        arm: the joint at the state.
        near: the near link's angular velocity (rad/s), in the near link's working axes.

    Returns:
        The contribution at v̇ = 0. A link whose orientation is measured from ground does not turn with
            the near link, so ``before`` is zero for it.
    """
    if arm.level:
        # joints measured from ground do not translate: the origin moves with the near link alone
        w = vector.combine(arm.rates, arm.motion.angular)
        return Crossing(ZERO, w, arm.motion.angular_bias, ZERO)
    return crossed_with(arm, arm.motion, arm.rotation.into(near))


def crossed_with(arm: Arm, motion: Motion, before: Vector) -> Crossing:
    """The same as `crossing`, in any common set of axes.

    Args:
        arm: the joint at the state; its rates and prescribed accelerations are used.
        motion: the joint's motion in the chosen axes.
        before: the near link's angular velocity in these axes (rad/s).
    """
    w = vector.combine(arm.rates, motion.angular)
    u = vector.combine(arm.rates, motion.linear)
    angular = motion.angular_bias
    # Coriolis: u is carried round by the near link (twice ω) and by the joint's own turning (once w)
    linear = add(cross(add(add(before, w), before), u), motion.linear_bias)
    if arm.prescribed:
        angular = add(angular, vector.combine(arm.prescribed, motion.angular))
        linear = add(linear, vector.combine(arm.prescribed, motion.linear))
    return Crossing(before, w, angular, linear)


def seen_near(arm: Arm) -> Motion:
    """A joint's motion with its unit twists and biases turned into the near link's working axes."""
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
    """Force and torque that each link's motion requires: d'Alembert's wrench with the sign of m a.

    Args:
        state: the tree at (q, v).
        acceleration: v̇ (rad/s², m/s²); zero if None.
        gravity: free fall in ground axes (m/s²); the tree's own if None.

    Returns:
        One wrench (N, N m) per link, about the link's origin and in its working axes; weight is
            included.
    """
    found = []
    motions = spins(state, acceleration, gravity)
    for link, arm, spin in zip(state.tree.links, state.arms, motions, strict=True):
        set_label(state.algebra, f"forces, {link.caption}")
        found.append(d_alembert(arm.moments, spin))
    return found


def d_alembert(moments: Moments, spin: Spin) -> Wrench:
    """Force and torque that the motion of a rigid body requires, about its origin.

        f = m a + U b        n = b x a + axial(U S)        U = [ε x] + [ω x][ω x]

    with b and S the first and second moments of mass about the origin. The usual J ε + ω x J ω is not
    used: the entries of U are computed for the force and the arms anyway, and the DAG shares them.

    Args:
        moments: the body's mass (kg), first moment (kg m) and second moments (kg m²) about its origin.
        spin: its motion, in the same axes.

    Returns:
        Force (N) and torque about the origin (N m), in these axes.
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
    """The sum of two wrenches about the same point.

    Args:
        a: force (N) and torque (N m).
        b: the same, about the same point and in the same axes.
    """
    return add(a[0], b[0]), add(a[1], b[1])


def _twisted(a: Scalar, b: Scalar, both: Scalar, turn: Scalar) -> Scalar:
    """``a (both + turn) - b (both - turn)``; with neither zero, the form by sum and difference is cheaper."""
    if a == 0 or b == 0:
        return a * (both + turn) - b * (both - turn)
    return (a + b) * turn + (a - b) * both


def accelerated(spin: Spin, r: Vector) -> Vector:
    """Acceleration of a point of a link less that of its origin: ``U r`` with U = [ε x] + [ω x][ω x].

    Args:
        spin: the link's motion.
        r: the point, from the link's origin and in the same axes (m).
    """
    xx, xy, xz, yy, yz, zz = _products(spin.velocity)
    x, y, z = spin.angular
    return (
        (xy - z) * r[1] + (xz + y) * r[2] - (yy + zz) * r[0],
        (xy + z) * r[0] + (yz - x) * r[2] - (xx + zz) * r[1],
        (xz - y) * r[0] + (yz + x) * r[1] - (xx + yy) * r[2],
    )


def _products(w: Vector) -> Inertia:
    """``ω ωᵀ`` as six entries: computed once, since the DAG shares them between all uses."""
    x, y, z = w
    return (x * x, x * y, x * z, y * y, y * z, z * z)
