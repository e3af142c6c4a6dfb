"""The mass matrix from composite bodies: (13) and (15) of the paper with H applied, not multiplied out.

This is the composite-rigid-body algorithm [Featherstone 2008, p. 107] in the paper's terms [Boiadzhiev
and Lilov 1993].
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from linegraph.algebra.protocol import set_label
from linegraph.algebra.scalar import Scalar
from linegraph.dynamics.orthogonality import applied_to, gathered, projection
from linegraph.kinematics.state_layout import Freedom
from linegraph.spatial import vector
from linegraph.spatial.inertia import NO_MOMENTS, carried, carried_in_plane, joined
from linegraph.spatial.rotation import IDENTITY_MATRIX, Full, Relabel, Turn
from linegraph.spatial.vector import ZERO, Matrix, Vector, add, cross, dot

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.kinematics.tree_state import TreeState
    from linegraph.spatial.inertia import Moments

Rows = list[list[Scalar]]
Column = Iterator[tuple[Freedom, Scalar]]
"""Generalised forces of a wrench on a link, along each freedom between the link and ground."""


def mass_matrix(state: TreeState) -> Rows:
    """M(q), n x n: (13) and (15) of the paper with H applied [Boiadzhiev and Lilov 1993].

    The composite of a link is all mass that its joint carries, gathered by H. Its inertia force for a
    unit acceleration of one coordinate, projected on every joint on the way to the root, is one column
    of M. The force is carried from frame to frame or, in long chains, once and for all to ground: from
    there it is projected on every joint without being turned again.

    Entries of a rotational velocity are in kg m², those of a translational one in kg.
    """
    tree, arms = state.tree, state.arms
    size = len(tree.velocities)
    rows: Rows = [[0] * size for _ in range(size)]
    carried_by = composites(state)
    inward = _inward_in_ground if ground_is_cheaper(state) else _inward_by_frames
    columns = inward(state)
    for i, link in enumerate(tree.links):
        set_label(state.algebra, f"mass matrix, {link.caption}")
        motion = arms[i].motion
        for a, freedom in enumerate(link.velocities):
            force, torque = inertia_force(carried_by[i], motion.angular[a], motion.linear[a])
            for b in range(a + 1):
                entry = projection(motion, b, force, torque)
                _contribute(rows, freedom, link.velocities[b], entry, once=a == b)
            for other, entry in columns(i, force, torque):
                _contribute(rows, freedom, other, entry, once=False)
    return rows


def _inward_by_frames(state: TreeState) -> Callable[[int, Vector, Vector], Column]:
    """Carry a link's force and torque inward, from working frame to working frame."""
    tree, arms = state.tree, state.arms

    def column(i: int, force: Vector, torque: Vector) -> Column:
        while (parent := tree.links[i].parent) >= 0:
            force, torque = gathered(arms[i], force, torque)
            i = parent
            for b, freedom in enumerate(tree.links[i].velocities):
                yield freedom, projection(arms[i].motion, b, force, torque)

    return column


def _inward_in_ground(state: TreeState) -> Callable[[int, Vector, Vector], Column]:
    """Carry a link's force and torque to the origin of ground, where the axes of all joints are known too."""
    tree = state.tree
    rows: list[Matrix] = []
    places: list[Vector] = []
    axes: list[list[tuple[Vector, Vector]]] = []
    for link, arm in zip(tree.links, state.arms, strict=True):
        set_label(state.algebra, f"pose, {link.caption}")
        outer = rows[link.parent] if link.parent >= 0 else IDENTITY_MATRIX
        origin = places[link.parent] if link.parent >= 0 else ZERO
        at = add(origin, vector.times(outer, arm.at))
        x, y, z = (arm.rotation.into(row) for row in outer)
        rows.append((x, y, z))
        places.append(at)
        turned = [vector.times(rows[-1], s) for s in arm.motion.angular]
        moved = [vector.times(rows[-1], u) for u in arm.motion.linear]
        # the unit twist about the origin of ground: a turn about an axis through `at` moves that point too;
        # a prescribed joint has no freedom to project on
        pairs = zip(turned, moved, strict=True) if link.velocities else ()
        axes.append([(s, add(u, cross(at, s))) for s, u in pairs])

    def column(i: int, force: Vector, torque: Vector) -> Column:
        force, torque = vector.times(rows[i], force), vector.times(rows[i], torque)
        torque = add(torque, cross(places[i], force))
        while (i := tree.links[i].parent) >= 0:
            for freedom, (s, u) in zip(tree.links[i].velocities, axes[i], strict=True):
                yield freedom, dot(s, torque) + dot(u, force)

    return column


def ground_is_cheaper(state: TreeState) -> bool:
    """Whether the chains are long enough for carrying every column of M to ground to save operations.

    Estimated operations: from frame to frame, turning two vectors and adding a lever at every step; in
    ground 11 at every step, and to get there about 60 for each link and 40 for each column.
    """
    if state.tree.levelled:
        return False
    inward: list[int] = []
    depth: list[int] = []
    by_frames = in_ground = 0
    for link, arm in zip(state.tree.links, state.arms, strict=True):
        step = sum(TURNING[type(factor)] for factor in arm.rotation.factors)
        step += 4 * sum(1 for x in arm.at if x != 0)
        # the root's own arm is never crossed: columns end at its joint
        inward.append(step + inward[link.parent] if link.parent >= 0 else 0)
        depth.append(1 + depth[link.parent] if link.parent >= 0 else 0)
        by_frames += len(link.velocities) * inward[-1]
        in_ground += 60 + len(link.velocities) * (40 + 11 * depth[-1])
    return in_ground < by_frames


TURNING: dict[type, int] = {Relabel: 0, Turn: 12, Full: 30}
"""Operations to turn a force and a torque by one factor of a rotation."""


def composites(state: TreeState) -> list[Moments]:
    """The composite body that each joint carries: moments gathered from leaves to root (H m Hᵀ etc.)."""
    tree, arms = state.tree, state.arms
    moments = [arm.moments for arm in arms]
    for i in reversed(range(len(tree.links))):
        link = tree.links[i]
        if link.parent >= 0:
            set_label(state.algebra, f"carried by {link.caption}")
            carry = moments[i]
            if arms[i].level:
                # a link whose orientation is measured from ground moves with its parent like a point
                carry = NO_MOMENTS._replace(mass=carry.mass)
            in_plane = link.in_plane and tree.links[link.parent].in_plane
            carry_over = carried_in_plane if in_plane else carried
            seen = carry_over(carry, arms[i].rotation, arms[i].at)
            # here moments depend on q: the diagonal of J from second moments is cheaper than kept separately
            both = joined(moments[link.parent], seen)
            in_plane = tree.links[link.parent].in_plane
            moments[link.parent] = both if in_plane else both._replace(about=(None, None, None))
    return moments


def inertia_force(composite: Moments, angular: Vector, linear: Vector) -> tuple[Vector, Vector]:
    """Inertia force of a composite body at rest that is accelerated.

    Args:
        composite: its moments about the origin.
        angular: angular acceleration (rad/s²).
        linear: acceleration of the origin (m/s²).

    Returns:
        Force (N) and torque about the origin (N m), in the same axes.
    """
    mass, first, *_ = composite
    force = add(vector.scale(mass, linear), cross(angular, first))
    torque = add(applied_to(composite.inertia, angular), cross(first, linear))
    return force, torque


def _contribute(rows: Rows, a: Freedom, b: Freedom, entry: Scalar, *, once: bool) -> None:
    """Add a product of two freedoms to M, on both sides of the diagonal; coupled ones may share an entry."""
    value = (a.ratio * b.ratio) * entry
    rows[a.index][b.index] = rows[a.index][b.index] + value
    if not once:
        rows[b.index][a.index] = rows[b.index][a.index] + value
