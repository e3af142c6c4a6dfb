"""Small changes of a state: the space that derivatives by q are taken on.

A change of q is given along the velocities: ``dq = N(q) d``, with one entry of d for each velocity. So a unit
quaternion keeps its length, derivatives by an orientation have three columns, and where v is the derivative
of q, d is dq itself. While the state moves, d goes on as

    d' = dv - (ad v) d        q(t) moved by d = the neighbouring motion, to first order

with ad v of the group that a joint's positions form (`Joint.adjoint`): [ω x] of a ball, zero of a hinge.
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
"""The argument that stands for the changes, one for each velocity of mechanics."""


def changes(tree: KinematicTree) -> list[Symbol]:
    """The symbols of d."""
    return [(CHANGE, k) for k in range(tree.layout.mechanical)]


def chain(tree: KinematicTree, q: Sequence[Scalar]) -> dict[Symbol, Gradient]:
    """The derivatives of every coordinate by the changes: the rows of N(q)."""
    found: dict[Symbol, Gradient] = {("q", i): {} for i in range(len(q))}
    size = len(tree.velocities)
    for k, change in enumerate(changes(tree)):
        unit = [int(j == k) for j in range(size)]
        for i, slope in enumerate(coordinate_rates(tree, q, unit)):
            if slope != 0:
                found["q", i][change] = slope
    return found


def adjoint(tree: KinematicTree, v: Sequence[Scalar]) -> list[list[Scalar]]:
    """``ad v`` of all joints: d' = dv - (ad v) d."""
    size = tree.layout.mechanical
    rows: list[list[Scalar]] = [[0] * size for _ in range(size)]
    for link in tree.links:
        own = link.place.velocities
        if not own or any(f.ratio != 1 for f in own):
            continue  # what follows another joint has no position of its own
        block = link.joint.adjoint(own_rates(link.place, tuple(v)))
        for a, row in zip(own, block, strict=True):
            for b, entry in zip(own, row, strict=True):
                rows[a.index][b.index] = entry
    return rows
