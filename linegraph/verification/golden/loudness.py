"""How loud states of networks are: a steep law may dwarf one state by another, or all that adds to it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.verification.golden.point import Point

EVEN = 300.0
"""What acts in a network may be this much larger at one state than at most, and than very near zero."""

CALM, QUIET = 12, 0.25
"""How many states say what acts very near zero, and which part of them is quiet."""


def acting(points: Sequence[Point]) -> Any:
    """How large what acts in networks is, a row for each state."""
    np, first = points[0].walk.np, points[0].walk.tree.layout.mechanical
    return np.array([np.abs(point.bodies.bias[0][first:]) for point in points])


def even(points: Sequence[Point], calm: Any) -> bool:
    """Whether what acts in networks is of the same size at all states, more or less, and very near zero too.

    An exponential law may be huge at all states alike, and then hides all that adds to it.
    """
    np, sizes = points[0].walk.np, acting(points)
    most = sizes.max(axis=0)
    alike = bool((most <= EVEN * _middle(np, sizes)).all())
    if not len(calm):
        return alike
    # what is nothing near zero has a dead zone, and is to be seen beyond it
    least = np.quantile(calm, QUIET, axis=0)
    return alike and bool((most <= EVEN * np.where(least > 0, least, np.inf)).all())


def quietest(found: Sequence[Sequence[Point]]) -> list[Point]:
    """The least loud of each group of states."""
    np = found[0][0].walk.np
    sizes = np.array([acting(some) for some in found])
    least = np.quantile(sizes, QUIET, axis=(0, 1))
    loud = (sizes / np.where(least > 0, least, np.inf)).max(axis=2, initial=0.0)
    return [some[k] for some, k in zip(found, loud.argmin(axis=1), strict=True)]


def loudest(points: Sequence[Point]) -> Point:
    """The state at which most acts, by orders of magnitude beyond what acts at the others."""
    np, sizes = points[0].walk.np, acting(points)
    ratios = np.maximum(sizes / _middle(np, sizes), 1.0)
    return points[int(np.log(ratios).sum(axis=1).argmax())]


def _middle(np: Any, sizes: Any) -> Any:
    """The median of each entry over the states at which it is not zero: a valve may be shut at most."""
    known = [column[column > 0] for column in sizes.T]
    return np.array([np.median(column) if len(column) else 1.0 for column in known])
