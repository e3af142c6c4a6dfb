"""Checks that the mass matrix can be inverted, on the pivots of its factors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.dynamics.regularity import SINGULAR
from linegraph.ir.dag import Node
from linegraph.ir.program import Check
from linegraph.ir.statuses import singular_at

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.ir.dag import Operand
    from linegraph.programs.workspace import Workspace


def bound(pivot: Scalar, entry: Scalar) -> Scalar:
    """Scale by which a pivot is judged: the diagonal entry that it was reduced from, else zero.

    A pivot that is the entry itself involves no subtraction, so it has no rounding to compare with.

    Args:
        pivot: of the factorisation.
        entry: the diagonal entry of M.
    """
    return 0 if pivot is entry else entry


def checks(
    f: Workspace,
    pivots: Sequence[Scalar],
    bounds: Sequence[Scalar],
    places: Sequence[int] = (),
) -> tuple[Check, ...]:
    """One check for each velocity whose pivot is not a number.

    Args:
        f: the shared equations.
        pivots: of the factorisation.
        bounds: the scale of each pivot.
        places: of the velocities in v, if M is not of all of them.
    """
    first = f.tree.layout.mechanical
    places = places or range(len(f.tree.velocities))
    found = []
    asked: set[tuple[int, Operand]] = set()
    for i, (pivot, least) in enumerate(zip(pivots, bounds, strict=True)):
        # a store of a network may be negative, e.g. behind an op-amp; an inertia may not
        size = pivot if i < first else f.dag.function("abs", pivot)
        limit = least if i < first else 0
        if isinstance(size, Node) and (size.index, limit) not in asked:
            asked.add((size.index, limit))
            status = singular_at(places[i], f.tree.velocities[places[i]].name)
            fraction = SINGULAR if isinstance(limit, Node) or limit else None
            found.append(Check(size, limit, *status, fraction))
    return tuple(found)
