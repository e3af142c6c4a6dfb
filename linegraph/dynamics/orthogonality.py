"""The equations of motion of a tree, from the principle of orthogonality.

Summed over all edges of all subspaces, through times across is zero, and stays so when the across
variables are varied. With the cutset equations the sum becomes d'Alembert's principle; with the circuit
and connecting equations all variations become those of the joint coordinates, and their coefficients
are

    M(q) v̇ + h(q, v) = Q

In the paper's matrices [Boiadzhiev and Lilov 1993, (12)-(15)], with H = P^-1 and Λ = S x (H C) + K,

    M = (S H) I (S H)ᵀ + Λ (H m Hᵀ) Λᵀ

Here H is applied, never multiplied out, since as a matrix it costs n² blocks instead of n steps: Hᵀ
sums from the root to the leaves (circuit equations: motion), H from the leaves to the root (cutset
equations: forces). Each link's vectors are resolved in its own working frame, its mass distribution is
taken about its joint.
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
    """Generalised forces ``M v̇ + h`` for given v̇, without M: (14) of the paper, with H applied.

    Motion is computed from the root to the leaves (Hᵀ), d'Alembert's forces less applied ones are
    gathered back (H): the recursive Newton-Euler algorithm [Featherstone 2008, sec. 5.3].

    Args:
        state: the tree at (q, v).
        acceleration: v̇ (rad/s², m/s²); if None, the result is the bias h.
        applied: wrenches about the links' origins in their working axes, and generalised forces, both
            subtracted.

    Returns:
        One generalised force per velocity (N m or N).
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
    """Generalised forces of applied forces: H, and the projection on every joint.

    Args:
        state: the tree at (q, v).
        applied: wrenches about the links' origins in their working axes, and generalised forces.

    Returns:
        One generalised force per velocity (N m or N).
    """
    return _inward(state, list(applied.wrenches), list(applied.efforts))


def _inward(
    state: TreeState, forces: list[tuple[Vector, Vector]], total: list[Scalar]
) -> list[Scalar]:
    """Cutset equations: forces from the leaves to the root, projected on every freedom that they pass."""
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
    """Kinetic and potential energy (J); weight has zero potential with all mass at the origin of ground."""
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
    """Potential energy of weight, ``-g·Σ m r``: first moments gathered from the leaves to the root."""
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
    """Cutset equation with its connecting term: carry a wrench across an arm inward.

    The torque on a link whose orientation is measured from ground ends in its inertia edge and is not
    carried on.

    Args:
        arm: the joint at the state.
        force: on the link, in its working axes (N).
        torque: about the link's origin, in its working axes (N m).

    Returns:
        The force and the torque about the parent's origin, in the parent's working axes.
    """
    force = arm.rotation.out(force)
    if arm.level:
        return force, cross(arm.at, force)
    return force, add(arm.rotation.out(torque), cross(arm.at, force))


def projection(motion: Motion, a: int, force: Vector, torque: Vector) -> Scalar:
    """Generalised force of a wrench along one freedom of a joint: s·n + κ·f.

    Args:
        motion: the joint's motion, with unit twists (s, κ).
        a: which freedom.
        force: f, in the same axes (N).
        torque: n, about the far link's origin (N m).
    """
    return dot(motion.angular[a], torque) + dot(motion.linear[a], force)


def applied_to(j: Inertia, a: Vector) -> Vector:
    """A symmetric tensor times a vector.

    Args:
        j: its entries xx, xy, xz, yy, yz, zz; off-diagonal ones have the sign of the matrix entries.
        a: the vector, in the same axes.
    """
    xx, xy, xz, yy, yz, zz = j
    return (
        xx * a[0] + xy * a[1] + xz * a[2],
        xy * a[0] + yy * a[1] + yz * a[2],
        xz * a[0] + yz * a[1] + zz * a[2],
    )
