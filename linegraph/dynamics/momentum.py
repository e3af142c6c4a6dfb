"""The system as a whole relative to ground: centre of mass, momentum and their derivatives.

With P the momentum and L the angular momentum about the centre of mass c, in ground axes,

    (P, L) = A(q) v        d/dt (P, L) = A v̇ + Ȧ v        P = m ċ

A is the centroidal momentum matrix [Orin et al. 2013]. A column of it is the momentum of the composite
body that a joint carries when only that joint's velocity is 1. First moments and composites are
gathered from the leaves to the root, as for the mass matrix. For links with regrouped moments all sums
are the original ones, since moments that are passed on move alike on both sides of the joint.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from linegraph.algebra.protocol import set_label
from linegraph.dynamics.mass_matrix import composites, inertia_force
from linegraph.dynamics.orthogonality import applied_to
from linegraph.kinematics.accelerations import inertia_forces
from linegraph.kinematics.twists import Column, Outlook, Twist, total
from linegraph.spatial import vector
from linegraph.spatial.vector import ZERO, Vector, add, cross, subtract, times

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.links import KinematicTree

Moment = tuple["Scalar", Vector]
"""Mass (kg) and first moment of mass (kg m)."""


def shared(tree: KinematicTree, mass: Scalar) -> KinematicTree:
    """The tree with masses and first moments divided by the total mass.

    Its first moment is then the centre of mass itself, with no division at the end.

    Args:
        tree: the links.
        mass: the total mass (kg).
    """
    links = []
    for link in tree.links:
        m, first, *_ = link.moments
        own = link.moments._replace(mass=m / mass, first=_divided(first, mass))
        links.append(replace(link, moments=own))
    return replace(tree, links=tuple(links))


def center(view: Outlook, at_rest: Vector) -> Vector:
    """First moment of the whole system, ``Σ m r``, gathered from the leaves to the root.

    Args:
        view: the links relative to ground.
        at_rest: first moment that links on ground passed on and that the links lack (kg m).

    Returns:
        A vector in ground axes (kg m); the centre of mass (m) if the tree has `shared` masses.
    """
    _, total_first = _firsts(view, level=False)
    return add(at_rest, total_first)


def center_columns(view: Outlook) -> list[Column]:
    """The change of the first moment for a unit of each velocity; the second vectors are zero."""
    carried, _ = _firsts(view, level=True)
    found = []
    for i, (mass, first) in enumerate(carried):
        link, arm = view.tree.links[i], view.arms[i]
        set_label(view.algebra, f"centre of mass, {link.caption}")
        moved = zip(arm.motion.linear, arm.motion.angular, view.moved(i), strict=True)
        for u, s, (freedom, rate, _, _) in moved:
            own = add(vector.scale(mass, u), cross(s, first))
            found.append(Column(freedom, rate, times(view.rotation(i), own), ZERO))
    return found


def center_velocity(shares: Outlook) -> Vector:
    """Velocity of the centre of mass in ground axes (m/s), for a tree with `shared` masses."""
    return _gathered(shares, [(push, ZERO) for push, _ in _own_momenta(shares)])[0]


def momentum_columns(view: Outlook, c: Vector) -> list[Column]:
    """The columns of A, those of prescribed velocities included.

    Args:
        view: the links relative to ground.
        c: the centre of mass, in ground axes (m).
    """
    found = []
    carried = composites(view.state)
    apart = _apart(view)
    for i, (link, arm) in enumerate(zip(view.tree.links, view.arms, strict=True)):
        set_label(view.algebra, f"momentum matrix, {link.caption}")
        origin = view.frames[i].origin
        lever = subtract(origin, c)
        own = zip(arm.motion.linear, arm.motion.angular, view.moved(i), strict=True)
        for u_here, s_here, (freedom, rate, u, s) in own:
            force, torque = inertia_force(carried[i], s_here, u_here)
            linear = times(view.rotation(i), force)
            angular = add(times(view.rotation(i), torque), cross(lever, linear))
            for place, first in apart[i]:
                angular = add(angular, cross(first, add(u, cross(s, subtract(place, origin)))))
            found.append(Column(freedom, rate, linear, angular))
    return found


def _apart(view: Outlook) -> list[list[tuple[Vector, Vector]]]:
    """For each link, those that it carries but does not turn: origin, and first moment carried there.

    A composite contains them as points at their origins, which is enough for forces along joints. Their
    mass centres are elsewhere, which matters for momentum about another point.
    """
    found: list[list[tuple[Vector, Vector]]] = [[] for _ in view.arms]
    if not view.tree.levelled:
        return found
    carried, _ = _firsts(view, level=False)
    for k, arm in enumerate(view.arms):
        moment = view.frames[k].origin, times(view.rotation(k), carried[k][1])
        for i in view.way(view.tree.links[k].parent if arm.level else -1):
            found[i].append(moment)
            if view.arms[i].level:
                break
    return found


def momenta(view: Outlook, c: Vector) -> list[Twist]:
    """Alternative formulas for (P, L), all equal: by the columns of A, or summed over links inward.

    Args:
        view: the links relative to ground.
        c: the centre of mass, in ground axes (m).

    Returns:
        Momentum (N s) and angular momentum about c (N m s), in ground axes.
    """
    return [total(momentum_columns(view, c)), _about(c, _gathered(view, _own_momenta(view)))]


def _own_momenta(view: Outlook) -> list[Twist]:
    """Momentum of each link, and its moment about the link's origin, in the link's axes."""
    found = []
    for link, arm, moving in zip(view.tree.links, view.arms, view.velocities, strict=True):
        set_label(view.algebra, f"momentum, {link.caption}")
        (linear, angular), (mass, first, *_) = moving, arm.moments
        push = add(vector.scale(mass, linear), cross(angular, first))
        turn = add(applied_to(arm.moments.inertia, angular), cross(first, linear))
        found.append((push, turn))
    return found


def momentum_rate(view: Outlook, c: Vector) -> Twist:
    """Rate ``d/dt (P, L)`` at v̇ = 0: d'Alembert's forces of all links, without gravity.

    Args:
        view: the links relative to ground.
        c: the centre of mass, in ground axes (m).

    Returns:
        Force (N) and torque about c (N m), in ground axes.
    """
    forces = inertia_forces(view.state, gravity=ZERO)
    return _about(c, _gathered(view, forces))


def _firsts(view: Outlook, *, level: bool) -> tuple[list[Moment], Vector]:
    """Mass and first moment that each joint carries, and the first moment of all about ground's origin.

    Args:
        view: the links relative to ground.
        level: whether a link whose orientation is measured from ground counts as a point for the joints
            before it, which do not turn it.
    """
    found: list[Moment] = [(arm.moments.mass, arm.moments.first) for arm in view.arms]
    whole: Vector = ZERO
    for i in reversed(range(len(found))):
        link, arm = view.tree.links[i], view.arms[i]
        set_label(view.algebra, f"carried by {link.caption}")
        mass, first = found[i]
        own = ZERO if level and arm.level else arm.rotation.out(first)
        seen = add(own, vector.scale(mass, arm.at))
        if link.parent < 0:
            whole = add(whole, seen)
        else:
            outer = found[link.parent]
            found[link.parent] = (outer[0] + mass, add(outer[1], seen))
    return found, whole


def _gathered(view: Outlook, wrenches: Iterable[Twist]) -> Twist:
    """The sum of the wrenches of all links, about the origin of ground and in its axes."""
    found = list(wrenches)
    whole: Twist = (ZERO, ZERO)
    for i in reversed(range(len(found))):
        link, arm = view.tree.links[i], view.arms[i]
        set_label(view.algebra, f"gathered, {link.caption}")
        force = arm.rotation.out(found[i][0])
        torque = add(arm.rotation.out(found[i][1]), cross(arm.at, force))
        outer = whole if link.parent < 0 else found[link.parent]
        both = (add(outer[0], force), add(outer[1], torque))
        if link.parent < 0:
            whole = both
        else:
            found[link.parent] = both
    return whole


def _about(c: Vector, whole: Twist) -> Twist:
    """A wrench about the origin of ground, moved to another point."""
    force, torque = whole
    return force, subtract(torque, cross(c, force))


def _divided(a: Vector, by: Scalar) -> Vector:
    return (a[0] / by, a[1] / by, a[2] / by)


def scaled(found: Sequence[Column], by: Scalar) -> list[Column]:
    """Columns with their first vectors divided by a scalar.

    Args:
        found: the columns.
        by: the divisor, e.g. the total mass (kg).
    """
    return [column._replace(first=_divided(column.first, by)) for column in found]
