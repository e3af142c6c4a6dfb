"""What tells that a mass matrix cannot be inverted: checks on the pivots of its factors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.expression import Node
from linegraph.program import Check
from linegraph.regularity import SINGULAR

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.shared import Functions
    from linegraph.vector import Scalar


def bound(pivot: Scalar, entry: Scalar) -> Scalar:
    """What a pivot must exceed: rounding of what it was made of, or zero if it was not made of anything."""
    return 0 if pivot is entry else SINGULAR * entry


def checks(f: Functions, pivots: Sequence[Scalar], bounds: Sequence[Scalar]) -> tuple[Check, ...]:
    """One check for each velocity whose pivot is not a number; status k + 1 is the velocity k's."""
    first = f.tree.layout.mechanical
    found = []
    for i, (pivot, least) in enumerate(zip(pivots, bounds, strict=True)):
        # what a network stores may be negative, behind an op-amp say; inertia may not
        size = pivot if i < first else f.dag.function("abs", pivot)
        if isinstance(size, Node):
            about = f"the mass matrix is singular at {f.tree.velocities[i].name}"
            found.append(Check(size, least if i < first else 0, i + 1, about))
    return tuple(found)
