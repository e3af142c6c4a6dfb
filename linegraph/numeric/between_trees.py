"""The same state in the coordinates of another tree.

Two trees of one model share the motion of the bodies. From it every joint's coordinates are measured;
angles are known up to full turns.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from linegraph.components.joints import Free, Spherical
from linegraph.kinematics.ground_frames import (
    GROUND_FRAME,
    GroundFrame,
    frames,
    relative_motion,
    seated,
    seen,
)
from linegraph.kinematics.links import Seat
from linegraph.spatial.vector import Matrix, dot, times, transpose

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.kinematics.links import KinematicTree, Link
    from linegraph.numeric.reference import Numeric

State = tuple[list[float], list[float]]


def transfer(source: Numeric, q: Sequence[float], v: Sequence[float], target: Numeric) -> State:
    """The state (q, v) of one derivation in the coordinates of another derivation of the same model.

    Args:
        source: equations of the first derivation.
        q: its coordinates.
        v: its velocities.
        target: equations of the second derivation, at the same time and inputs.

    Example:
        >>> from linegraph import Model, derive
        >>> model = Model("pendulum")
        >>> bob = model.body("bob", mass=2.0, mass_center=(0, 0, -0.5))
        >>> _ = model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
        >>> joint = derive(model).numeric()
        >>> _ = model.formulation(coordinates="absolute")
        >>> q, v = transfer(joint, [0.0], [2.0], derive(model).numeric())
        >>> q[:3], v[:3]
        ([0.0, 0.0, -0.5], [-1.0, 0.0, 0.0])
    """
    tree = target.tree
    bodies = body_frames(source, q, v)
    found: State = ([0.0] * len(tree.positions), [0.0] * len(tree.velocities))
    links = [_link_frame(tree, i, bodies) for i in range(len(tree.links))]
    for link, far in zip(tree.links, links, strict=True):
        near = links[link.parent] if link.parent >= 0 else GROUND_FRAME
        if not _copied(source, q, v, link, found):
            _measure(target, link, near, far, found)
    return found


def _copied(
    source: Numeric, q: Sequence[float], v: Sequence[float], link: Link, found: State
) -> bool:
    """Copy the coordinates of a joint that has the same ones in both trees, full turns included."""
    place = source.tree.layout.own(link.joint.name)
    plain = place is not None and not (place.level or link.place.level or place.drive)
    if not plain or place is None or len(place.positions) != len(link.place.positions):
        return False
    for old, new, values, into in (
        (place.positions, link.place.positions, q, found[0]),
        (place.velocities, link.velocities, v, found[1]),
    ):
        for a, b in zip(old, new, strict=True):
            if a.ratio != 1 or b.ratio != 1 or a.offset != 0 or b.offset != 0:
                return False
            into[b.index] = float(values[a.index])
    return True


def body_frames(numeric: Numeric, q: Sequence[float], v: Sequence[float]) -> dict[str, GroundFrame]:
    """The motion of every body's own frame, in ground axes.

    Args:
        numeric: equations over floats.
        q: the coordinates.
        v: the velocities.
    """
    tree = numeric.tree
    moving = frames(numeric.at(q, v).state)
    return {
        body: seated(moving, Seat(link, pose.at, pose.rotation))
        for body, (link, pose) in tree.bodies.items()
    }


def _link_frame(tree: KinematicTree, index: int, bodies: dict[str, GroundFrame]) -> GroundFrame:
    """A link's working frame, from one of the bodies welded into it."""
    body, pose = next((b, pose) for b, (link, pose) in tree.bodies.items() if link == index)
    back = transpose(pose.rotation)
    x, y, z = times(back, pose.at)
    return bodies[body].at((-x, -y, -z), back)


def _measure(
    numeric: Numeric, link: Link, near: GroundFrame, far: GroundFrame, found: State
) -> None:
    """Measure a joint's coordinates and velocities, and write them into the state."""
    if link.place.drive or any(f.ratio != 1 or f.offset != 0 for f in link.place.positions):
        return
    joint = link.joint
    start = GROUND_FRAME if link.in_space else near.at(link.at, link.rotation.matrix())
    tail, head = (start, far) if link.forward else (far, start)
    rotation, displacement = seen(tail, head)
    at = coordinates_at(numeric.algebra, joint, rotation, displacement)
    u, w = relative_motion(tail, head)
    back = transpose(head.rotation)
    u, w = times(back, u), times(back, w)
    rates = [dot(m, w) + dot(f, u) for m, f in joint.duals(numeric.algebra, rotation, displacement)]
    q, v = found
    positions, velocities = link.place.less
    if positions:
        at = [at[0] - sum(f.ratio * q[f.index] + f.offset for f in positions)]
        rates = [rates[0] - sum(f.ratio * v[f.index] for f in velocities)]
    for freedom, x in zip(link.place.positions, at, strict=True):
        q[freedom.index] = float(x)
    for freedom, x in zip(link.velocities, rates, strict=True):
        v[freedom.index] = float(x)


def coordinates_at(algebra: Any, joint: Any, rotation: Matrix, displacement: Any) -> list[float]:
    """The coordinates of a joint at a relative pose, quaternions included.

    Args:
        algebra: floats.
        joint: a joint in the tree's algebra.
        rotation: from head components to tail components.
        displacement: from tail origin to head origin, in the tail's axes (m).
    """
    if isinstance(joint, Spherical | Free) and joint.angles is None:
        quaternion = quaternion_of(rotation)
        return quaternion if isinstance(joint, Spherical) else [*displacement, *quaternion]
    return list(joint.measured(algebra, rotation, displacement))


def quaternion_of(rotation: Matrix) -> list[float]:
    """The unit quaternion (x, y, z, w) of a rotation, with w not negative.

    Each row of 4 q qᵀ gives q up to a factor. The row of the largest diagonal entry is used: the
    formula from the trace alone divides by w, which is zero for half turns.

    Example:
        >>> from linegraph.spatial.rotation import from_quaternion
        >>> quaternion_of(from_quaternion(0.0, 1.0, 0.0, 0.0))
        [0.0, 1.0, 0.0, 0.0]
    """
    r = rotation
    squares = [
        1 + r[0][0] - r[1][1] - r[2][2],
        1 - r[0][0] + r[1][1] - r[2][2],
        1 - r[0][0] - r[1][1] + r[2][2],
        1 + r[0][0] + r[1][1] + r[2][2],
    ]
    rows = [
        (squares[0], r[0][1] + r[1][0], r[0][2] + r[2][0], r[2][1] - r[1][2]),
        (r[0][1] + r[1][0], squares[1], r[1][2] + r[2][1], r[0][2] - r[2][0]),
        (r[0][2] + r[2][0], r[1][2] + r[2][1], squares[2], r[1][0] - r[0][1]),
        (r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1], squares[3]),
    ]
    row = rows[max(range(4), key=squares.__getitem__)]
    length = math.copysign(math.hypot(*row), row[3] if row[3] != 0 else 1.0)
    return [x / length for x in row]
