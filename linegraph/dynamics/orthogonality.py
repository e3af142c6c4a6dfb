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

from typing import TYPE_CHECKING

from linegraph.algebra.protocol import set_label
from linegraph.kinematics.accelerations import inertia_forces
from linegraph.spatial import vector
from linegraph.spatial.vector import ZERO, Vector, add, cross, dot, subtract

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.applied_forces import Applied
    from linegraph.kinematics.arms import Arm
    from linegraph.kinematics.tree_state import TreeState
    from linegraph.spatial.motion import Motion
    from linegraph.spatial.rotation import Inertia


def inverse_dynamics(
    state: TreeState,
    acceleration: Iterable[Scalar] | None = None,
    applied: Applied | None = None,
) -> list[Scalar]:
    """``M v̇ + h`` for given v̇, without M; with no v̇ the bias h itself: (14) of the paper.

    Motion runs from the root to the leaves (H^T), d'Alembert's forces and torques, less those `applied`,
    back (H).
    """
    forces = inertia_forces(state, acceleration)
    total: list[Scalar] = [0] * len(state.tree.velocities)
    if applied is not None:
        forces = [
            (subtract(f, g), subtract(n, m))
            for (f, n), (g, m) in zip(forces, applied.wrenches, strict=True)
        ]
        total = [-effort for effort in applied.efforts]
    return _inward(state, forces, total)


def generalised_forces(state: TreeState, applied: Applied) -> list[Scalar]:
    """What applied forces do along v: H, and the projection on every joint."""
    return _inward(state, list(applied.wrenches), list(applied.efforts))


def _inward(
    state: TreeState, forces: list[tuple[Vector, Vector]], total: list[Scalar]
) -> list[Scalar]:
    """Cutset equations: forces from the leaves to the root, projected on every freedom they pass."""
    tree, arms = state.tree, state.arms
    for i in reversed(range(len(tree.links))):
        link = tree.links[i]
        set_label(state.algebra, f"forces, {link.caption}")
        force, torque = forces[i]
        for a, freedom in enumerate(link.velocities):
            entry = projection(arms[i].motion, a, force, torque)
            total[freedom.index] = total[freedom.index] + freedom.ratio * entry
        if link.parent >= 0:
            force, torque = gathered(arms[i], force, torque)
            outer = forces[link.parent]
            forces[link.parent] = (add(outer[0], force), add(outer[1], torque))
    return total


def energy(state: TreeState) -> tuple[Scalar, Scalar]:
    """Kinetic and potential energy (J); the latter is zero with all mass at the origin of ground."""
    kinetic: Scalar = 0
    velocities: list[tuple[Vector, Vector]] = []
    for link, arm in zip(state.tree.links, state.arms, strict=True):
        set_label(state.algebra, f"kinetic energy, {link.caption}")
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
    return kinetic / 2, _potential(state)


def _potential(state: TreeState) -> Scalar:
    """``-g . (sum of m r)``: first moments gathered from the leaves to the root."""
    tree, arms = state.tree, state.arms
    gathered = [(arm.moments.mass, arm.moments.first) for arm in arms]
    total: Vector = ZERO
    for i in reversed(range(len(tree.links))):
        link, arm = tree.links[i], arms[i]
        set_label(state.algebra, f"potential energy, {link.caption}")
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
