"""Derivatives of inverse dynamics from composites: a joint moves all that it carries as one body.

If one freedom of a joint, turning s and shift k in far axes, moves a little, its far side moves on as
one; seen from there it is the near side that moves differently. With w', e', a' the near side's angular
velocity and acceleration and the acceleration of its point at the joint's origin, w and u the joint's
relative velocities,

    by q    dw = w' x s    η = e' x s - dw x w'      α = a' x s + e' x k + w' x (w' x k) + 2 dw x u
    by v    dw = s         η = 2 w' x s + w x s      α = (2 w' + w) x k + s x u

and each carried point r, of velocity V, gets the acceleration α + η x r + 2 dw x V. The force for it is
that of one composite, linear in (α, η, dw): with its moments m, b, J, its momentum P and the moments of
velocity G = ∫ V rᵀ dm,

    f = m α + η x b + 2 dw x P        n = b x α + J η + 2 (tr G - G) dw

Joints further in receive this force; besides, all forces turn with s and shift with k. Joints further
out are affected by the transpose of the same map, carried inward as the columns of M are. A common
velocity may be subtracted from all V: they are taken relative to the root's origin.

[Carpentier and Mansard 2018] obtain the same derivatives by differentiating the recursive Newton-Euler
algorithm.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.algebra.protocol import set_label
from linegraph.dynamics.mass_matrix import composites
from linegraph.dynamics.orthogonality import applied_to, gathered, projection
from linegraph.ir.dag import Node
from linegraph.kinematics.accelerations import (
    Spin,
    accelerated,
    inertia_forces,
    resting,
    spins,
    together,
)
from linegraph.spatial import vector
from linegraph.spatial.rotation import square
from linegraph.spatial.vector import ZERO, add, cross, dot, scale, skew, subtract

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.accelerations import Wrench
    from linegraph.kinematics.arms import Arm
    from linegraph.kinematics.state_layout import Freedom
    from linegraph.kinematics.tree_state import TreeState
    from linegraph.spatial.inertia import Moments
    from linegraph.spatial.vector import Matrix, Vector

Rows = list[list["Scalar"]]


class TorqueDerivatives(NamedTuple):
    """∂τ/∂d, ∂τ/∂v and ∂τ/∂a = M of mechanics, n x n; d are changes of q along the velocities."""

    by_change: Rows
    by_velocity: Rows
    by_acceleration: Rows


def has_slopes(state: TreeState) -> bool:
    """Whether every freedom is a turn and a shift that are constant in far axes, as `slopes` requires."""
    if state.tree.levelled:
        return False
    for arm in state.arms:
        motion = arm.motion
        biases = (*motion.angular_bias, *motion.linear_bias)
        entries = (x for part in (*motion.angular, *motion.linear) for x in part)
        if any(x != 0 for x in biases) or not all(map(_constant, entries)):
            return False
    return True


def _constant(x: Scalar) -> bool:
    return not isinstance(x, Node) or (x.op == "symbol" and x.a == "p")


def slopes(state: TreeState, a: Sequence[Scalar]) -> TorqueDerivatives:
    """The derivatives of ``τ = M a + h`` without applied forces.

    Args:
        state: the tree at (q, v), for which `has_slopes` is true.
        a: the accelerations v̇ (rad/s², m/s²).

    Returns:
        Three matrices, one row per generalised force and one column per change.
    """
    tree = state.tree
    size = len(tree.velocities)
    found = TorqueDerivatives(*([[0] * size for _ in range(size)] for _ in range(3)))
    carried = composites(state)
    momenta = _momenta(state)
    motions = spins(state, a)
    forces = _transmitted(state, a)
    steps: list[list[_Step]] = []
    for i, (link, arm) in enumerate(zip(tree.links, state.arms, strict=True)):
        set_label(state.algebra, f"derivatives, {link.caption}")
        near = motions[link.parent] if link.parent >= 0 else resting(tree.gravity)
        near = _seen(arm, near)
        here = [_step(arm, k, near, momenta[i].velocity) for k in range(len(link.velocities))]
        steps.append(here)
        _inward(state, i, here, (carried[i], momenta[i], forces[i]), found)
        _outward(state, i, steps, (carried[i], momenta[i]), found)
    return found


class _Momentum(NamedTuple):
    """Twice the velocity of a composite: of its origin, and the moments ∫ V dm and ∫ V rᵀ dm."""

    velocity: Vector
    first: Vector
    second: Matrix


class _Step(NamedTuple):
    """One freedom: its turning and shift, and the changes (dw, η, α) by q and by v."""

    s: Vector
    k: Vector
    by_change: tuple[Vector, Vector, Vector]
    by_velocity: tuple[Vector, Vector, Vector]


def _seen(arm: Arm, near: Spin) -> Spin:
    """Motion of the near link's point at the joint's origin, in far axes."""
    into = arm.rotation.into
    pull = add(near.linear, accelerated(near, arm.at))
    return Spin(into(near.velocity), into(near.angular), into(pull))


def _step(arm: Arm, k: int, near: Spin, velocity: Vector) -> _Step:
    s, shift = arm.motion.angular[k], arm.motion.linear[k]
    w = vector.combine(arm.rates, arm.motion.angular)
    u = vector.combine(arm.rates, arm.motion.linear)
    turn = cross(near.velocity, s)
    # momenta are relative to the root's velocity: subtract 2 dw x the velocity of the origin
    moving = cross(turn, subtract(scale(2, u), velocity))
    change = (
        turn,
        subtract(cross(near.angular, s), cross(turn, near.velocity)),
        add(add(cross(near.linear, s), accelerated(near, shift)), moving),
    )
    twice = scale(2, near.velocity)
    rate = (
        s,
        cross(add(twice, w), s),
        add(cross(add(twice, w), shift), cross(s, subtract(u, velocity))),
    )
    return _Step(s, shift, change, rate)


def _momenta(state: TreeState) -> list[_Momentum]:
    """The momentum of all that each joint carries, velocities relative to the origin of its root."""
    tree, arms = state.tree, state.arms
    turning = [scale(2, spin.velocity) for spin in spins(state)]
    found: list[_Momentum] = []
    for i, (link, arm) in enumerate(zip(tree.links, arms, strict=True)):
        set_label(state.algebra, f"momentum, {link.caption}")
        v = ZERO
        if link.parent >= 0:
            inner = add(found[link.parent].velocity, cross(turning[link.parent], arm.at))
            own = scale(2, vector.combine(arm.rates, arm.motion.linear))
            v = add(arm.rotation.into(inner), own)
        mass, first, second, _ = arm.moments
        # in plane motion only tr G matters, and [ω x] S adds nothing to it: S is symmetric
        tensor = square((0,) * 6 if link.in_plane else second)
        spread = _product(skew(turning[i]), tensor)
        moved = tuple(
            tuple(x + v[r] * first[c] for c, x in enumerate(row)) for r, row in enumerate(spread)
        )
        found.append(_Momentum(v, add(scale(mass, v), cross(turning[i], first)), moved))  # type: ignore[arg-type]
    for i in reversed(range(len(tree.links))):
        link, arm = tree.links[i], arms[i]
        if link.parent < 0:
            continue
        set_label(state.algebra, f"momentum carried by {link.caption}")
        inner = arm.rotation.out(found[i].first)
        tensor = arm.rotation.similarity(found[i].second)
        outer = found[link.parent]
        whole = tuple(
            tuple(outer.second[r][c] + (tensor[r][c] + inner[r] * arm.at[c]) for c in range(3))
            for r in range(3)
        )
        found[link.parent] = _Momentum(outer.velocity, add(outer.first, inner), whole)  # type: ignore[arg-type]
    return found


def _product(a: Matrix, b: Matrix) -> Matrix:
    columns = vector.transpose(b)
    x, y, z = (tuple(dot(row, column) for column in columns) for row in a)
    return (x, y, z)


def _transmitted(state: TreeState, a: Sequence[Scalar]) -> list[Wrench]:
    """Force and torque transmitted by every joint, about its link's origin."""
    forces = inertia_forces(state, a)
    for i in reversed(range(len(forces))):
        link = state.tree.links[i]
        if link.parent >= 0:
            set_label(state.algebra, f"forces, {link.caption}")
            outer = forces[link.parent]
            forces[link.parent] = together(outer, gathered(state.arms[i], *forces[i]))
    return forces


def _response(
    composite: Moments, momentum: _Momentum, change: tuple[Vector, Vector, Vector]
) -> Wrench:
    """Force and torque of a composite for a change (dw, η, α) of the near side."""
    dw, angular, linear = change
    mass, first, *_ = composite
    force = add(scale(mass, linear), cross(angular, first))
    force = add(force, cross(dw, momentum.first))
    torque = add(applied_to(composite.inertia, angular), cross(first, linear))
    return force, add(torque, vector.times(_turning(momentum), dw))


def _turning(momentum: _Momentum) -> Matrix:
    """``2 (tr G - G)``."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = momentum.second
    return ((yy + zz, -xy, -xz), (-yx, xx + zz, -yz), (-zx, -zy, xx + yy))


def _inward(
    state: TreeState,
    i: int,
    here: Sequence[_Step],
    known: tuple[Moments, _Momentum, Wrench],
    found: TorqueDerivatives,
) -> None:
    """The columns of a link's freedoms: rows of the joint itself, and of all joints further in."""
    composite, momentum, (force, torque) = known
    tree, arms = state.tree, state.arms
    link = tree.links[i]
    for step, freedom in zip(here, link.velocities, strict=True):
        by_change = _response(composite, momentum, step.by_change)
        by_velocity = _response(composite, momentum, step.by_velocity)
        for b, own in enumerate(link.velocities):
            for rows, wrench in ((found.by_change, by_change), (found.by_velocity, by_velocity)):
                entry = projection(arms[i].motion, b, *wrench)
                _contribute(rows, own, freedom, entry)
        turned = (cross(step.s, force), add(cross(step.s, torque), cross(step.k, force)))
        by_change = together(by_change, turned)
        place = i
        while (parent := tree.links[place].parent) >= 0:
            by_change = gathered(arms[place], *by_change)
            by_velocity = gathered(arms[place], *by_velocity)
            place = parent
            for b, other in enumerate(tree.links[place].velocities):
                for rows, wrench in (
                    (found.by_change, by_change),
                    (found.by_velocity, by_velocity),
                ):
                    entry = projection(arms[place].motion, b, *wrench)
                    _contribute(rows, other, freedom, entry)


def _outward(
    state: TreeState,
    i: int,
    steps: Sequence[Sequence[_Step]],
    known: tuple[Moments, _Momentum],
    found: TorqueDerivatives,
) -> None:
    """The rows of a link's freedoms in the columns of all joints further in, and M."""
    composite, momentum = known
    tree, arms = state.tree, state.arms
    link = tree.links[i]
    back = vector.transpose(_turning(momentum))
    for step, freedom in zip(steps[i], link.velocities, strict=True):
        force, torque = _response(composite, momentum, (ZERO, step.s, step.k))
        swept = add(vector.times(back, step.s), cross(momentum.first, step.k))
        place = i
        for b, own in enumerate(link.velocities):
            entry = projection(arms[i].motion, b, force, torque)
            _contribute(found.by_acceleration, own, freedom, entry)
        while (parent := tree.links[place].parent) >= 0:
            force, torque = gathered(arms[place], force, torque)
            swept = arms[place].rotation.out(swept)
            place = parent
            for other, outer in zip(steps[place], tree.links[place].velocities, strict=True):
                entry = dot(other.s, torque) + dot(other.k, force)
                _contribute(found.by_acceleration, freedom, outer, entry)
                _contribute(found.by_acceleration, outer, freedom, entry)
                for rows, (dw, angular, linear) in (
                    (found.by_change, other.by_change),
                    (found.by_velocity, other.by_velocity),
                ):
                    entry = dot(linear, force) + dot(angular, torque) + dot(dw, swept)
                    _contribute(rows, freedom, outer, entry)


def _contribute(rows: Rows, row: Freedom, column: Freedom, entry: Scalar) -> None:
    """Add a product of two freedoms; coupled ones may share an entry."""
    value = (row.ratio * column.ratio) * entry
    rows[row.index][column.index] = rows[row.index][column.index] + value
