"""The bias h from composite inertias, which the mass matrix needs in any case.

The accelerations of a link's points at v̇ = 0 are a field x -> a + A x. The field that a joint adds to
that of its near link applies to everything that it carries, so its inertia force is that of one
composite body:

    ΔA = [σ x][w x] + [β x]        Δa = σ x u + β'

with w, u the joint's relative velocities, σ the sum of the angular velocities of its two links, and β,
β' the rest of its relative acceleration. For a hinge ΔA has three entries, since points on its axis
move with both links. A joint's part of h is the inertia force of its composite in the near link's
field, plus those of the fields added by itself and by the joints beyond.

Beside M this may take fewer operations than the pass over single links
(`orthogonality.inverse_dynamics`), or more: `programs.workspace` counts both.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.algebra.protocol import set_label
from linegraph.dynamics.mass_matrix import composites
from linegraph.dynamics.orthogonality import applied_to, projection
from linegraph.kinematics.accelerations import (
    Crossing,
    Spin,
    accelerated,
    crossed_with,
    d_alembert,
    resting,
    seen_near,
    spins,
    together,
)
from linegraph.spatial import vector
from linegraph.spatial.inertia import Moments
from linegraph.spatial.rotation import square
from linegraph.spatial.vector import add, cross

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.applied_forces import Applied
    from linegraph.kinematics.accelerations import Wrench
    from linegraph.kinematics.arms import Arm
    from linegraph.kinematics.tree_state import TreeState
    from linegraph.spatial.motion import Motion
    from linegraph.spatial.rotation import Inertia, Rotation
    from linegraph.spatial.vector import Matrix, Vector


def bias_beside_mass(state: TreeState, acting: Applied) -> list[Scalar]:
    """The bias h(q, v) less the applied forces, from the composites of `mass_matrix`.

    Args:
        state: the tree at (q, v).
        acting: applied forces, subtracted: wrenches about the links' origins in their working axes.

    Returns:
        One generalised force per velocity (N m or N).
    """
    tree, arms = state.tree, state.arms
    carried = composites(state)
    motions = spins(state)
    total: list[Scalar] = [-effort for effort in acting.efforts]
    beyond = [(vector.negate(force), vector.negate(torque)) for force, torque in acting.wrenches]
    for i in reversed(range(len(tree.links))):
        link, arm = tree.links[i], arms[i]
        set_label(state.algebra, f"forces, {link.caption}")
        near = motions[link.parent] if link.parent >= 0 else resting(tree.gravity)
        here = _at_joint(arm, near, carried[i])
        whole = d_alembert(here.carried, here.field)
        own = _added(here.carried, crossed_with(arm, here.motion, here.field.velocity))
        for a, freedom in enumerate(link.velocities):
            entry = projection(here.motion, a, *together(whole, own))
            entry = entry + projection(arm.motion, a, *beyond[i])
            total[freedom.index] = total[freedom.index] + freedom.ratio * entry
        if link.parent >= 0:
            force, torque = here.passed_on(beyond[i], own)
            passed = (force, add(torque, cross(arm.at, force)))
            beyond[link.parent] = together(beyond[link.parent], passed)
    return total


class _Joint(NamedTuple):
    """A joint with the quantities at it, in one set of axes and about its far link's origin.

    Attributes:
        motion: the joint's motion.
        carried: the moments of the composite beyond it.
        field: the motion of the near link's points there.
        rotation: from far axes to near axes.
        near: whether the axes are those of the near link, not the far one.
    """

    motion: Motion
    carried: Moments
    field: Spin
    rotation: Rotation
    near: bool

    def passed_on(self, far: Wrench, own: Wrench) -> Wrench:
        """The sum of a wrench in far axes and one in the joint's axes, in near axes."""
        out = self.rotation.out
        if self.near:
            return together((out(far[0]), out(far[1])), own)
        force, torque = together(far, own)
        return out(force), out(torque)


def _at_joint(arm: Arm, near: Spin, composite: Moments) -> _Joint:
    """A joint in near axes if its directions are constant there: a leaf link then needs no others."""
    pull = add(near.linear, accelerated(near, arm.at))
    rotation, motion = arm.rotation, arm.motion
    seen = seen_near(arm)
    if all(isinstance(x, (int, float)) for s in (*seen.angular, *seen.linear) for x in s):
        mass, first, second, _ = composite
        turned = Moments(mass, rotation.out(first), rotation.congruence(second))
        return _Joint(seen, turned, near._replace(linear=pull), rotation, near=True)
    into = rotation.into
    field = Spin(into(near.velocity), into(near.angular), into(pull))
    return _Joint(motion, composite, field, rotation, near=False)


def _added(composite: Moments, here: Crossing) -> Wrench:
    """Wrench about a link's origin of the acceleration field that its joint adds beyond it."""
    mass, first, second, _ = composite
    w, sums = here.turning, add(here.before, here.velocity)
    field = _turning(w, sums)
    force = add(vector.scale(mass, here.linear), cross(here.angular, first))
    torque = add(applied_to(composite.inertia, here.angular), cross(first, here.linear))
    about_one_axis = sum(x != 0 for x in w) == 1
    gyroscopic = _axial(field, second) if about_one_axis else cross(applied_to(second, sums), w)
    return add(force, vector.times(field, first)), add(torque, gyroscopic)


def _turning(w: Vector, sums: Vector) -> Matrix:
    """``[σ x][w x] = w σᵀ - (w·σ) 1``."""
    x, y, z = (w[k] * sums[k] for k in range(3))
    return (
        (-(y + z), w[0] * sums[1], w[0] * sums[2]),
        (w[1] * sums[0], -(x + z), w[1] * sums[2]),
        (w[2] * sums[0], w[2] * sums[1], -(x + y)),
    )


def _axial(field: Matrix, second: Inertia) -> Vector:
    """The torque ``∫ r x (A r) dm``: the axial vector of A S."""
    rows = [vector.times(square(second), row) for row in field]
    return (rows[2][1] - rows[1][2], rows[0][2] - rows[2][0], rows[1][0] - rows[0][1])
