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
from linegraph.kinematics import parallel
from linegraph.layout import coordinates, own_rates
from linegraph.rotation import Full, Rotation, Turn
from linegraph.vector import ZERO, Scalar, Vector, add, cross, dot, subtract

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

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
        moments: the link's mass distribution about its origin, in working axes.
        turn: of a link whose working axes are still, its own axes to those.
        angle: of that turn about z.
    """

    rotation: Rotation
    at: Vector
    motion: Motion
    rates: tuple[Scalar, ...]
    prescribed: tuple[Scalar, ...]
    level: bool
    moments: Moments
    turn: Rotation = Rotation()
    angle: Scalar = 0


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
        near = found[link.parent].turn if link.parent >= 0 else Rotation()
        if link.in_space:
            rotation = _against_parent(tree, found, link, motion.rotation)
        else:
            rotation = link.rotation @ motion.rotation
        at = near.out(add(link.at, link.rotation.out(motion.displacement)))
        prescribed = tuple(x.ddx for x in link.place.drive)
        arm = Arm(rotation, at, motion, rates, prescribed, link.place.level, link.moments)
        if link.still or (near.factors and parallel(link)):
            (angle,) = positions
            arm = _in_a_run(algebra, link, arm, found, angle if link.forward else -angle)
        found.append(arm)
    return found


def _in_a_run(algebra: Algebra, link: Link, arm: Arm, found: Sequence[Arm], angle: Scalar) -> Arm:
    """A link in a run of parallel axes: its angle is measured from the first one's near side.

    With L the constant rotation to the joint, which keeps z or turns it round,
    ``Rz(a) L Rz(b) = L Rz(b + a)`` or ``L Rz(b - a)``.
    """
    rotation = link.rotation
    if link.parent >= 0 and found[link.parent].turn.factors:
        along = rotation.out((0, 0, 1))[2]
        angle = angle + along * found[link.parent].angle
    turn = Rotation((Turn(2, algebra.cos(angle), algebra.sin(angle)),))
    if not link.still:
        return arm._replace(rotation=rotation @ turn)
    mass, first, second = arm.moments
    seen = Moments(mass, turn.out(first), second if link.in_plane else turn.congruence(second))
    return arm._replace(rotation=rotation, moments=seen, turn=turn, angle=angle)


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
    forces = []
    motions = spins(tree, algebra, crossed, acceleration)
    for link, arm, spin in zip(tree.links, crossed, motions, strict=True):
        set_label(algebra, f"forces, {caption(link)}")
        forces.append(d_alembert(arm.moments, spin))
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
        mass, first, _ = arm.moments
        momentum = add(vector.scale(mass, linear), cross(angular, first))
        spin = add(applied_to(arm.moments.inertia, angular), cross(first, linear))
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


def spins(
    tree: KinematicTree,
    algebra: Algebra,
    crossed: Sequence[Arm],
    acceleration: Iterable[Scalar] | None = None,
) -> list[Spin]:
    """Circuit equations of velocity and acceleration: H^T, from the root to the leaves.

    Gravity enters as the acceleration -g of ground.
    """
    a = None if acceleration is None else tuple(acceleration)
    ground = resting(tree)
    found: list[Spin] = []
    for link, arm in zip(tree.links, crossed, strict=True):
        set_label(algebra, f"motion, {caption(link)}")
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


def resting(tree: KinematicTree) -> Spin:
    """How ground moves: gravity enters as its acceleration -g."""
    return Spin(ZERO, ZERO, vector.negate(tree.gravity))


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
        crossed_here = crossing(arm, near)
        turning = Spin(near, ZERO, ZERO)
        pull = accelerated(turning, arm.at)
        if link.parent < 0:
            pull = vector.subtract(pull, tree.gravity)
        velocities.append(crossed_here.velocity)
        extra.append((crossed_here.spin, add(arm.rotation.into(pull), crossed_here.linear)))
    return velocities, extra


def bias_force(moments: Moments, velocity: Vector) -> tuple[Vector, Vector]:
    """Torque and force, about a link's origin, that its turning asks for at zero acceleration."""
    _, first, second = moments
    # ω x J ω: what of J is isotropic does not show
    torque = cross(applied_to(second, velocity), velocity)
    return torque, accelerated(Spin(velocity, ZERO, ZERO), first)


def _products(w: Vector) -> Inertia:
    """ω ω^T: computed once, since the DAG shares it between all uses."""
    x, y, z = w
    return (x * x, x * y, x * z, y * y, y * z, z * z)


def accelerated(spin: Spin, r: Vector) -> Vector:
    """``U r`` with U = [ε x] + [ω x][ω x]: acceleration of a point r of a link, less its origin's."""
    xx, xy, xz, yy, yz, zz = _products(spin.velocity)
    x, y, z = spin.angular
    return (
        (xy - z) * r[1] + (xz + y) * r[2] - (yy + zz) * r[0],
        (xy + z) * r[0] + (yz - x) * r[2] - (xx + zz) * r[1],
        (xz - y) * r[0] + (yz + x) * r[1] - (xx + yy) * r[2],
    )


def d_alembert(moments: Moments, spin: Spin) -> tuple[Vector, Vector]:
    """Force and torque that the motion of a link asks for, about its origin.

    f = m a + U b and n = b x a + the axial vector of U S, with b and S the first and second moments; it is
    written with the entries of U, which the force and the arms need anyway.
    """
    mass, first, second = moments
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


def _twisted(a: Scalar, b: Scalar, both: Scalar, turn: Scalar) -> Scalar:
    """``a (both + turn) - b (both - turn)``; where neither is zero their sum and difference serve better."""
    if a == 0 or b == 0:
        return a * (both + turn) - b * (both - turn)
    return (a + b) * turn + (a - b) * both


def _potential(tree: KinematicTree, algebra: Algebra, crossed: list[Arm]) -> Scalar:
    """``-g . (sum of m r)``: first moments gathered from the leaves to the root."""
    gathered = [(arm.moments.mass, arm.moments.first) for arm in crossed]
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
