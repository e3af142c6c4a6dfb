"""The bias h beside the mass matrix: from composites, which M needs anyway.

The accelerations of a link's points at v̇ = 0 are a field x -> a + A x. What a joint adds to the field that
its near link has, it adds for all that it carries, so its inertia force is that of one composite:

    ΔA = [σ x][w x] + [β x]        Δa = σ x u + β'

with w, u the joint's relative velocities, σ the sum of the angular velocities on its two sides and β, β' the
rest of its relative acceleration. Of a hinge ΔA has three entries: points on its axis move with both links.
A joint's h is then what the whole field at it does to its composite, and what the joints beyond add.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph import vector
from linegraph.mass_matrix import composites
from linegraph.orthogonality import (
    applied_to,
    caption,
    crossing,
    d_alembert,
    gathered,
    projection,
    set_label,
    spins,
)
from linegraph.vector import Vector, add, cross

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra import Algebra
    from linegraph.joints import Moments
    from linegraph.kinematics import KinematicTree
    from linegraph.loads import Applied
    from linegraph.orthogonality import Arm
    from linegraph.rotation import Inertia
    from linegraph.vector import Matrix, Scalar

Wrench = tuple[Vector, Vector]


def bias_beside_mass(
    tree: KinematicTree, algebra: Algebra, crossed: Sequence[Arm], acting: Applied
) -> list[Scalar]:
    """h(q, v), less what `acting` does; the composites are those of `mass_matrix`."""
    carried = composites(tree, algebra, list(crossed))
    motions = spins(tree, algebra, crossed, None)
    total: list[Scalar] = [-effort for effort in acting.efforts]
    beyond: list[Wrench] = [
        (vector.negate(force), vector.negate(torque)) for force, torque in acting.wrenches
    ]
    for i in reversed(range(len(tree.links))):
        link, arm = tree.links[i], crossed[i]
        set_label(algebra, f"forces, {caption(link)}")
        force, torque = beyond[i]
        whole = d_alembert(carried[i], motions[i])
        for a, freedom in enumerate(link.velocities):
            entry = projection(arm.motion, a, *whole) + projection(arm.motion, a, force, torque)
            total[freedom.index] = total[freedom.index] + freedom.ratio * entry
        if link.parent >= 0:
            near = motions[link.parent].velocity
            own = _added(carried[i], arm, near)
            force, torque = gathered(arm, add(force, own[0]), add(torque, own[1]))
            outer = beyond[link.parent]
            beyond[link.parent] = (add(outer[0], force), add(outer[1], torque))
    return total


def _added(composite: Moments, arm: Arm, near: Vector) -> Wrench:
    """Force and torque about a link's origin of what its joint adds to the accelerations beyond it."""
    mass, first, second = composite
    here = crossing(arm, near)
    w, sums = here.turning, add(here.before, here.velocity)
    field = _turning(w, sums)
    force = add(vector.scale(mass, here.linear), cross(here.angular, first))
    torque = add(applied_to(composite.inertia, here.angular), cross(first, here.linear))
    about_one_axis = sum(x != 0 for x in w) == 1
    gyroscopic = _axial(field, second) if about_one_axis else cross(applied_to(second, sums), w)
    return add(force, vector.times(field, first)), add(torque, gyroscopic)


def _turning(w: Vector, sums: Vector) -> Matrix:
    """``[σ x][w x] = w σ^T - (w . σ) 1``."""
    x, y, z = (w[k] * sums[k] for k in range(3))
    return (
        (-(y + z), w[0] * sums[1], w[0] * sums[2]),
        (w[1] * sums[0], -(x + z), w[1] * sums[2]),
        (w[2] * sums[0], w[2] * sums[1], -(x + y)),
    )


def _axial(field: Matrix, second: Inertia) -> Vector:
    """The torque ``∫ r x (A r) dm``: the axial vector of A S."""
    xx, xy, xz, yy, yz, zz = second
    rows = [vector.times(((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)), row) for row in field]
    return (rows[2][1] - rows[1][2], rows[0][2] - rows[2][0], rows[1][0] - rows[0][1])
