"""Small changes of a state: the space on which derivatives with respect to q are taken.

A change of q is given along the velocities: ``dq = N(q) d``, with one entry of d per velocity. So a
unit quaternion keeps its length, derivatives with respect to an orientation have three columns, and d
is dq itself where v is the derivative of q. Differences of quaternions would have four columns and
leave the unit sphere. As the state moves, d obeys

    ḋ = dv - (ad v) d        q(t) changed by d = the neighbouring motion, to first order

with ad v of the group that a joint's positions form (`Joint.adjoint`): [ω x] for a ball, zero for a
hinge.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.kinematics.arms import coordinate_rates
from linegraph.kinematics.state_layout import own_rates

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.differentiation import Gradient, Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.links import KinematicTree

CHANGE = "d"
"""The argument of the changes d: one symbol per velocity of mechanics."""


def changes(tree: KinematicTree) -> list[Symbol]:
    """The symbols of d, one per velocity of mechanics."""
    return [(CHANGE, k) for k in range(tree.layout.mechanical)]


def chain(tree: KinematicTree, q: Sequence[Scalar]) -> dict[Symbol, Gradient]:
    """Derivatives of every coordinate with respect to the changes: the rows of N(q).

    Args:
        tree: the links.
        q: the coordinates, as symbols or other scalars.

    Returns:
        For each coordinate symbol its derivatives by the symbols of d; zeros are left out.
    """
    found: dict[Symbol, Gradient] = {("q", i): {} for i in range(len(q))}
    size = len(tree.velocities)
    for k, change in enumerate(changes(tree)):
        unit = [int(j == k) for j in range(size)]
        for i, slope in enumerate(coordinate_rates(tree, q, unit)):
            if slope != 0:
                found["q", i][change] = slope
    return found


def adjoint(tree: KinematicTree, v: Sequence[Scalar]) -> list[list[Scalar]]:
    """The matrix ``ad v`` of all joints, block by block: ``ḋ = dv - (ad v) d``.

    Args:
        tree: the links.
        v: the velocities.

    Returns:
        A square matrix with one row per velocity of mechanics (rad/s for an orientation).
    """
    size = tree.layout.mechanical
    rows: list[list[Scalar]] = [[0] * size for _ in range(size)]
    for link in tree.links:
        own = link.place.velocities
        if not own or any(f.ratio != 1 for f in own):
            continue  # a joint that follows another has no position of its own
        block = link.joint.adjoint(own_rates(link.place, tuple(v)))
        for a, row in zip(own, block, strict=True):
            for b, entry in zip(own, row, strict=True):
                rows[a.index][b.index] = entry
    return rows
