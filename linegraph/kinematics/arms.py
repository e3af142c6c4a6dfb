"""The joints of a tree at a state: each link's motion relative to its parent, near side to far side."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.algebra.protocol import set_label
from linegraph.kinematics.links import parallel
from linegraph.kinematics.state_layout import coordinates, own_rates
from linegraph.spatial import vector
from linegraph.spatial.inertia import Moments
from linegraph.spatial.motion import Motion, reverse
from linegraph.spatial.rotation import Full, Rotation, Turn
from linegraph.spatial.vector import Vector, add

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.links import KinematicTree, Link


class Arm(NamedTuple):
    """A link's joint at a state, in the direction of the walk: from the near link to the far one.

    Attributes:
        rotation: from the link's working axes to its parent's.
        at: the link's origin, from its parent's origin and in the parent's working axes (m).
        motion: the joint's motion, reversed if its edge points towards ground; in the link's working
            axes.
        rates: the joint's own velocities (rad/s, m/s).
        prescribed: their derivatives if the motion is prescribed (rad/s², m/s²); empty if it is free.
        level: whether the link's orientation is measured from ground: in the rotational projection its
            inertia edge is the branch, not the joint.
        moments: the link's mass distribution about its origin, in its working axes.
        turn: for a link whose working axes stay still, the rotation from its own axes to those.
        angle: the angle of this rotation about z (rad).
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


def arms(tree: KinematicTree, q: Iterable[Scalar], v: Iterable[Scalar]) -> list[Arm]:
    """The motion of every joint at (q, v): the connecting equations of the tree.

    Args:
        tree: the links.
        q: the coordinates, one per `tree.positions` (rad, m; unit quaternions x, y, z, w).
        v: the velocities, one per `tree.velocities` (rad/s, m/s).

    Returns:
        One arm per link, parents first.
    """
    algebra, q, v = tree.algebra, tuple(q), tuple(v)
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
    """A link in a run of parallel axes: its angle is measured from the near side of the first one.

    With L the constant rotation to the joint, which keeps z or reverses it, ``Rz(a) L Rz(b) = L Rz(b +
    a)`` or ``L Rz(b - a)``. One sine and cosine of a sum of angles replace the product of two
    rotations.
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
    tree: KinematicTree, found: list[Arm], link: Link, absolute: Rotation
) -> Rotation:
    """Rotation of a link to its parent's axes, if its rotation to ground axes is given."""
    outward: list[Rotation] = []
    i = link.parent
    while i >= 0:
        near = tree.links[i]
        outward.append(found[i].motion.rotation if near.in_space else found[i].rotation)
        i = -1 if near.in_space else near.parent
    matrix = absolute.matrix()
    for rotation in reversed(outward):
        matrix = vector.transpose(
            tuple(rotation.into(column) for column in vector.transpose(matrix))  # type: ignore[arg-type]
        )
    return Rotation((Full(matrix),))


def coordinate_rates(tree: KinematicTree, q: Iterable[Scalar], v: Iterable[Scalar]) -> list[Scalar]:
    """Rates of the coordinates, ``q̇ = N(q) v``.

    N is the identity except for quaternions and for Euler angles, whose v is an angular velocity.

    Args:
        tree: the links.
        q: the coordinates.
        v: the velocities.

    Returns:
        One rate per entry of q (rad/s, m/s, 1/s for quaternions).
    """
    algebra, q, v = tree.algebra, tuple(q), tuple(v)
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
