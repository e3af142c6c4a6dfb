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

from linegraph.algebra.protocol import set_label
from linegraph.components.joints import Moments, Motion
from linegraph.kinematics.accelerations import inertia_forces
from linegraph.kinematics.links import parallel
from linegraph.kinematics.state_layout import coordinates, own_rates
from linegraph.spatial import vector
from linegraph.spatial.rotation import Full, Rotation, Turn
from linegraph.spatial.vector import ZERO, Vector, add, cross, dot, subtract

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.applied_forces import Applied
    from linegraph.kinematics.links import KinematicTree, Link
    from linegraph.spatial.rotation import Inertia


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
    mass, first, second, about = arm.moments
    second = second if link.in_plane else turn.congruence(second)
    seen = Moments(mass, turn.out(first), second, (None, None, about[2]))
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
    forces = inertia_forces(tree, algebra, crossed, acceleration)
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
        set_label(algebra, f"forces, {link.caption}")
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
        set_label(algebra, f"kinetic energy, {link.caption}")
        angular, linear = velocities[link.parent] if link.parent >= 0 else (ZERO, ZERO)
        linear = arm.rotation.into(add(linear, cross(angular, arm.at)))
        linear = add(linear, vector.combine(arm.rates, arm.motion.linear))
        turned = ZERO if arm.level else arm.rotation.into(angular)
        angular = add(turned, vector.combine(arm.rates, arm.motion.angular))
        velocities.append((angular, linear))
        mass, first, *_ = arm.moments
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


def _potential(tree: KinematicTree, algebra: Algebra, crossed: list[Arm]) -> Scalar:
    """``-g . (sum of m r)``: first moments gathered from the leaves to the root."""
    gathered = [(arm.moments.mass, arm.moments.first) for arm in crossed]
    total: Vector = ZERO
    for i in reversed(range(len(tree.links))):
        link, arm = tree.links[i], crossed[i]
        set_label(algebra, f"potential energy, {link.caption}")
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
