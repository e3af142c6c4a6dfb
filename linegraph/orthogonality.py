"""Stage 4: the equations of motion of a tree, from the principle of orthogonality.

Summed over all edges of all subspaces, through times across is zero, and stays so when the across
variables are varied. With the cutset equations the sum becomes d'Alembert's principle; with the circuit
and connecting equations all variations become those of the joint coordinates, and their coefficients are

    M(q) v̇ + h(q, v) = Q

In the paper's matrices (Boiadzhiev & Lilov 1993, (12)-(15)), with H = P^-1 and Λ = S x (H C) + K,

    M = (S H) I (S H)^T + Λ (H m H^T) Λ^T

Here H is applied, never multiplied out: H^T sums from the root to the leaves (circuit equations: motion),
H from the leaves to the root (cutset equations: forces). Each link's vectors are resolved in its own
working frame, its mass distribution taken about its joint.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph import vector
from linegraph.joints import Moments, Motion
from linegraph.layout import coordinates, own_rates
from linegraph.rotation import Full, Rotation
from linegraph.vector import ZERO, Scalar, Vector, add, cross, dot, subtract

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.algebra import Algebra
    from linegraph.kinematics import KinematicTree, Link
    from linegraph.loads import Applied
    from linegraph.rotation import Inertia


class Arm(NamedTuple):
    """A link's joint at a state, as the walk crosses it: near side to far side.

    Attributes:
        rotation: the link's working components to its parent's.
        at: the link's origin in its parent's working frame.
        motion: the joint's motion, turned round where its edge points to ground.
        rates: the joint's velocity coordinates.
        prescribed: their derivatives where the motion is prescribed; none where it is free.
        level: whether the link turns against ground and not against its parent: in rotation its inertia
            edge is the branch.
    """

    rotation: Rotation
    at: Vector
    motion: Motion
    rates: tuple[Scalar, ...]
    prescribed: tuple[Scalar, ...] = ()
    level: bool = False


class Spin(NamedTuple):
    """How a link moves: angular velocity and acceleration, and the acceleration of its origin."""

    velocity: Vector
    angular: Vector
    linear: Vector


def arms(
    tree: KinematicTree, algebra: Algebra, q: Iterable[Scalar], v: Iterable[Scalar]
) -> list[Arm]:
    """Every joint's motion at (q, v)."""
    q, v = tuple(q), tuple(v)
    found: list[Arm] = []
    for link in tree.links:
        set_label(algebra, f"joint {link.joint.name}")
        positions, rates = coordinates(link.place, q, v)
        if link.place.level:
            rates = own_rates(link.place, v)
        motion = link.joint.motion(algebra, positions, rates)
        if not link.forward:
            motion = reverse(motion)
        if link.in_space:
            rotation = _against_parent(tree, found, link, motion.rotation)
        else:
            rotation = link.rotation @ motion.rotation
        at = add(link.at, link.rotation.out(motion.displacement))
        prescribed = tuple(x.ddx for x in link.place.drive)
        found.append(Arm(rotation, at, motion, rates, prescribed, link.place.level))
    return found


def _against_parent(
    tree: KinematicTree, crossed: list[Arm], link: Link, absolute: Rotation
) -> Rotation:
    """The rotation to the parent's axes of a link whose rotation to ground axes is given."""
    outward: list[Rotation] = []
    i = link.parent
    while i >= 0:
        near = tree.links[i]
        outward.append(crossed[i].motion.rotation if near.in_space else crossed[i].rotation)
        i = -1 if near.in_space else near.parent
    matrix = absolute.matrix()
    for rotation in reversed(outward):
        matrix = vector.transpose(
            tuple(rotation.into(column) for column in vector.transpose(matrix))  # type: ignore[arg-type]
        )
    return Rotation((Full(matrix),))


def reverse(motion: Motion) -> Motion:
    """The motion of the tail as seen from the head: the joint crossed against its orientation."""
    r = motion.rotation
    at = vector.negate(r.into(motion.displacement))

    def moment(s: Vector, u: Vector) -> Vector:
        return r.out(vector.negate(add(cross(s, at), u)))

    return Motion(
        r.inverse(),
        at,
        tuple(r.out(vector.negate(s)) for s in motion.angular),
        tuple(moment(s, u) for s, u in zip(motion.angular, motion.linear, strict=True)),
        r.out(vector.negate(motion.angular_bias)),
        moment(motion.angular_bias, motion.linear_bias),
    )


def inverse_dynamics(
    tree: KinematicTree,
    algebra: Algebra,
    crossed: list[Arm],
    acceleration: Iterable[Scalar] | None = None,
    applied: Applied | None = None,
) -> list[Scalar]:
    """``M v̇ + h`` for given v̇, without M; with no v̇ the bias h itself: (14) of the paper.

    Motion runs from the root to the leaves (H^T), d'Alembert's forces and torques, less those `applied`,
    back (H).
    """
    spins = _spins(tree, algebra, crossed, acceleration)
    forces = [
        _d_alembert(link.moments, spin, algebra, link)
        for link, spin in zip(tree.links, spins, strict=True)
    ]
    total: list[Scalar] = [0] * len(tree.velocities)
    if applied is not None:
        forces = [
            (subtract(f, g), subtract(n, m))
            for (f, n), (g, m) in zip(forces, applied.wrenches, strict=True)
        ]
        total = [-effort for effort in applied.efforts]
    return _inward(tree, algebra, crossed, forces, total)


def generalised_forces(
    tree: KinematicTree, algebra: Algebra, crossed: list[Arm], applied: Applied
) -> list[Scalar]:
    """What applied forces do along v: H, and the projection on every joint."""
    return _inward(tree, algebra, crossed, list(applied.wrenches), list(applied.efforts))


def _inward(
    tree: KinematicTree,
    algebra: Algebra,
    crossed: list[Arm],
    forces: list[tuple[Vector, Vector]],
    total: list[Scalar],
) -> list[Scalar]:
    """Cutset equations: forces from the leaves to the root, projected on every freedom they pass."""
    for i in reversed(range(len(tree.links))):
        link = tree.links[i]
        set_label(algebra, f"forces, {caption(link)}")
        force, torque = forces[i]
        for a, freedom in enumerate(link.velocities):
            entry = projection(crossed[i].motion, a, force, torque)
            total[freedom.index] = total[freedom.index] + freedom.ratio * entry
        if link.parent >= 0:
            force, torque = gathered(crossed[i], force, torque)
            outer = forces[link.parent]
            forces[link.parent] = (add(outer[0], force), add(outer[1], torque))
    return total


def energy(tree: KinematicTree, algebra: Algebra, crossed: list[Arm]) -> tuple[Scalar, Scalar]:
    """Kinetic and potential energy (J); the latter is zero with all mass at the origin of ground."""
    kinetic: Scalar = 0
    velocities: list[tuple[Vector, Vector]] = []
    for link, arm in zip(tree.links, crossed, strict=True):
        set_label(algebra, f"kinetic energy, {caption(link)}")
        angular, linear = velocities[link.parent] if link.parent >= 0 else (ZERO, ZERO)
        linear = arm.rotation.into(add(linear, cross(angular, arm.at)))
        linear = add(linear, vector.combine(arm.rates, arm.motion.linear))
        turned = ZERO if arm.level else arm.rotation.into(angular)
        angular = add(turned, vector.combine(arm.rates, arm.motion.angular))
        velocities.append((angular, linear))
        mass, first, inertia = link.moments
        momentum = add(vector.scale(mass, linear), cross(angular, first))
        spin = add(applied_to(inertia, angular), cross(first, linear))
        kinetic = kinetic + (dot(linear, momentum) + dot(angular, spin))
    return kinetic / 2, _potential(tree, algebra, crossed)


def coordinate_rates(
    tree: KinematicTree, algebra: Algebra, q: Iterable[Scalar], v: Iterable[Scalar]
) -> list[Scalar]:
    """``q̇ = N(q) v``."""
    q, v = tuple(q), tuple(v)
    rates: list[Scalar] = [0] * len(tree.positions)
    for link in tree.links:
        places = link.place.positions
        if any(f.ratio != 1 or f.offset != 0 for f in places):
            continue
        at, own_v = coordinates(link.place, q, v)
        if link.place.level:
            own_v = own_rates(link.place, v)
        own = link.joint.rates(algebra, at, own_v) if places else ()
        for freedom, rate in zip(places, own, strict=True):
            rates[freedom.index] = rate
    return rates


def _spins(
    tree: KinematicTree,
    algebra: Algebra,
    crossed: list[Arm],
    acceleration: Iterable[Scalar] | None,
) -> list[Spin]:
    """Circuit equations of velocity and acceleration: H^T, from the root to the leaves.

    Gravity enters as the acceleration -g of ground.
    """
    a = None if acceleration is None else tuple(acceleration)
    ground = Spin(ZERO, ZERO, vector.negate(tree.gravity))
    spins: list[Spin] = []
    for link, arm in zip(tree.links, crossed, strict=True):
        set_label(algebra, f"motion, {caption(link)}")
        near = spins[link.parent] if link.parent >= 0 else ground
        velocity, angular, linear = _relative(arm, near.velocity)
        if not arm.level:
            angular = add(arm.rotation.into(near.angular), angular)
        linear = add(arm.rotation.into(add(near.linear, _accelerated(near, arm.at))), linear)
        if a is not None and link.velocities:
            own = tuple(f.ratio * a[f.index] for f in link.velocities)
            angular = add(angular, vector.combine(own, arm.motion.angular))
            linear = add(linear, vector.combine(own, arm.motion.linear))
        spins.append(Spin(velocity, angular, linear))
    return spins


def _relative(arm: Arm, near: Vector) -> tuple[Vector, Vector, Vector]:
    """What a joint makes of its near link's angular velocity, with v̇ = 0 and in the far link's axes.

    Returns:
        The far link's angular velocity and the joint's share of its angular and linear acceleration.
    """
    motion = arm.motion
    w = vector.combine(arm.rates, motion.angular)
    if arm.level:
        # such joints have no shift: their origin moves with the near link alone
        return w, motion.angular_bias, ZERO
    u = vector.combine(arm.rates, motion.linear)
    carried_w = arm.rotation.into(near)
    velocity = add(carried_w, w)
    angular = add(cross(carried_w, w), motion.angular_bias)
    # Coriolis: the relative velocity u turns with the near link (twice) and with the joint
    linear = add(cross(add(velocity, carried_w), u), motion.linear_bias)
    if arm.prescribed:
        angular = add(angular, vector.combine(arm.prescribed, motion.angular))
        linear = add(linear, vector.combine(arm.prescribed, motion.linear))
    return velocity, angular, linear


def bias_accelerations(
    tree: KinematicTree, algebra: Algebra, crossed: list[Arm]
) -> tuple[list[Vector], list[tuple[Vector, Vector]]]:
    """Angular velocity of each link, and what each joint adds to the acceleration that reaches it.

    The second is (angular, linear) with v̇ = 0, in the far link's axes; at ground it contains -g.
    """
    velocities: list[Vector] = []
    extra: list[tuple[Vector, Vector]] = []
    for link, arm in zip(tree.links, crossed, strict=True):
        set_label(algebra, f"motion, {caption(link)}")
        near = velocities[link.parent] if link.parent >= 0 else ZERO
        velocity, angular, linear = _relative(arm, near)
        turning = Spin(near, ZERO, ZERO)
        pull = _accelerated(turning, arm.at)
        if link.parent < 0:
            pull = vector.subtract(pull, tree.gravity)
        velocities.append(velocity)
        extra.append((angular, add(arm.rotation.into(pull), linear)))
    return velocities, extra


def bias_force(moments: Moments, velocity: Vector) -> tuple[Vector, Vector]:
    """Torque and force, about a link's origin, that its turning asks for at zero acceleration."""
    _, first, inertia = moments
    torque = cross(velocity, applied_to(inertia, velocity))
    return torque, _accelerated(Spin(velocity, ZERO, ZERO), first)


def _products(w: Vector) -> Inertia:
    """ω ω^T: computed once, since the DAG shares it between all uses."""
    x, y, z = w
    return (x * x, x * y, x * z, y * y, y * z, z * z)


def _accelerated(spin: Spin, r: Vector) -> Vector:
    """``U r`` with U = [ε x] + [ω x][ω x]: acceleration of a point r of a link, less its origin's."""
    xx, xy, xz, yy, yz, zz = _products(spin.velocity)
    x, y, z = spin.angular
    return (
        (xy - z) * r[1] + (xz + y) * r[2] - (yy + zz) * r[0],
        (xy + z) * r[0] + (yz - x) * r[2] - (xx + zz) * r[1],
        (xz - y) * r[0] + (yz + x) * r[1] - (xx + yy) * r[2],
    )


def _d_alembert(
    moments: Moments, spin: Spin, algebra: Algebra, link: Link
) -> tuple[Vector, Vector]:
    """Force and torque that the motion of a link asks for, about its origin.

    f = m a + U b and n = I ε + ω x I ω + b x a, with b the first moment; the torque's rotational part is
    written with the entries of U, which the force and the arms need anyway.
    """
    set_label(algebra, f"forces, {caption(link)}")
    mass, first, inertia = moments
    force = add(vector.scale(mass, spin.linear), _accelerated(spin, first))
    xx, xy, xz, yy, yz, zz = _products(spin.velocity)
    x, y, z = spin.angular
    jxx, jxy, jxz, jyy, jyz, jzz = inertia
    torque = (
        jxx * x + (jzz - jyy) * yz + jxy * (y - xz) + jxz * (z + xy) + jyz * (yy - zz),
        jyy * y + (jxx - jzz) * xz + jyz * (z - xy) + jxy * (x + yz) + jxz * (zz - xx),
        jzz * z + (jyy - jxx) * xy + jxz * (x - yz) + jyz * (y + xz) + jxy * (xx - yy),
    )
    return force, add(torque, cross(first, spin.linear))


def _potential(tree: KinematicTree, algebra: Algebra, crossed: list[Arm]) -> Scalar:
    """``-g . (sum of m r)``: first moments gathered from the leaves to the root."""
    gathered = [(link.moments.mass, link.moments.first) for link in tree.links]
    total: Vector = ZERO
    for i in reversed(range(len(tree.links))):
        link, arm = tree.links[i], crossed[i]
        set_label(algebra, f"potential energy, {caption(link)}")
        mass, first = gathered[i]
        first = add(arm.rotation.out(first), vector.scale(mass, arm.at))
        if link.parent < 0:
            total = add(total, first)
        else:
            outer = gathered[link.parent]
            gathered[link.parent] = (outer[0] + mass, add(outer[1], first))
    return -dot(tree.gravity, total)


def gathered(arm: Arm, force: Vector, torque: Vector) -> tuple[Vector, Vector]:
    """Cutset equation with its connecting term: carry a force and a torque across an arm inward.

    The torque on a link that turns against ground ends there, in its inertia edge.
    """
    force = arm.rotation.out(force)
    if arm.level:
        return force, cross(arm.at, force)
    return force, add(arm.rotation.out(torque), cross(arm.at, force))


def projection(motion: Motion, a: int, force: Vector, torque: Vector) -> Scalar:
    """Through variables projected on one freedom of a joint: s . n + κ . f."""
    return dot(motion.angular[a], torque) + dot(motion.linear[a], force)


def applied_to(j: Inertia, a: Vector) -> Vector:
    """A symmetric tensor times a vector."""
    xx, xy, xz, yy, yz, zz = j
    return (
        xx * a[0] + xy * a[1] + xz * a[2],
        xy * a[0] + yy * a[1] + yz * a[2],
        xz * a[0] + yz * a[1] + zz * a[2],
    )


def caption(link: Link) -> str:
    """How comments in emitted code call a link: its joint and its bodies."""
    return f"{link.joint.name} -> {link.name}"


def set_label(algebra: Algebra, text: str) -> None:
    """Tell a DAG which part the next nodes belong to."""
    if hasattr(algebra, "label"):
        algebra.label = text
