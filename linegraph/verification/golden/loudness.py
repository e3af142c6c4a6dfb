"""Loudness: how far a steep law lets one state dwarf others, or one term all that is added to it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.verification.golden.point import Point

EVEN = 300.0
"""Largest ratio of forces in a network at one state to those at most states, and to those very near zero."""

CALM, QUIET = 12, 0.25
"""Number of states from which forces very near zero are estimated, and the quantile that counts as quiet."""


def acting(points: Sequence[Point]) -> Any:
    """Absolute bias h of the states of networks: one row for each point, one column for each state."""
    np, first = points[0].walk.np, points[0].walk.tree.layout.mechanical
    return np.array([np.abs(point.bodies.bias[0][first:]) for point in points])


def even(points: Sequence[Point], calm: Any) -> bool:
    """Whether forces in networks are of about the same size at all states, and not far above those near zero.

    The second condition is needed because an exponential law may be huge at all states alike, and then
    hides everything that is added to it.

    Args:
        points: the states to judge.
        calm: result of `acting` at states very near zero; no rows where laws are undefined there.
    """
    np, sizes = points[0].walk.np, acting(points)
    most = sizes.max(axis=0)
    alike = bool((most <= EVEN * _middle(np, sizes)).all())
    if not len(calm):
        return alike
    # Laws that vanish near zero have a dead zone and must be tested beyond it.
    least = np.quantile(calm, QUIET, axis=0)
    return alike and bool((most <= EVEN * np.where(least > 0, least, np.inf)).all())


def quietest(found: Sequence[Sequence[Point]]) -> list[Point]:
    """Choose the least loud state of each group."""
    np = found[0][0].walk.np
    sizes = np.array([acting(some) for some in found])
    least = np.quantile(sizes, QUIET, axis=(0, 1))
    loud = (sizes / np.where(least > 0, least, np.inf)).max(axis=2, initial=0.0)
    return [some[k] for some, k in zip(found, loud.argmin(axis=1), strict=True)]


def loudest(points: Sequence[Point]) -> Point:
    """Choose the state whose forces exceed those at the other states by most orders of magnitude in total."""
    np, sizes = points[0].walk.np, acting(points)
    ratios = np.maximum(sizes / _middle(np, sizes), 1.0)
    return points[int(np.log(ratios).sum(axis=1).argmax())]


def _middle(np: Any, sizes: Any) -> Any:
    """Median of each column over the states where it is not zero: a valve may be shut at most states."""
    known = [column[column > 0] for column in sizes.T]
    return np.array([np.median(column) if len(column) else 1.0 for column in known])
