"""Outlines of sets of points in the picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.drawing.scene import Point

SLENDER = 60
"""A triangle of at most half this area counts as a line."""


def hull_of(points: Sequence[Point]) -> list[Point]:
    """Corners of the convex hull of points; the two ends if all are on a line."""
    ordered = sorted(set(points))
    if len(ordered) < 3:
        return ordered

    # Andrew's monotone chain: the upper and the lower half of the hull from points sorted by x.
    def half(row: Iterable[Point]) -> list[Point]:
        kept: list[Point] = []
        for p in row:
            while len(kept) > 1 and _turn(kept[-2], kept[-1], p) <= SLENDER:
                kept.pop()
            kept.append(p)
        return kept[:-1]

    hull = half(ordered) + half(ordered[::-1])
    return hull if len(hull) > 2 else [ordered[0], ordered[-1]]


def _turn(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def inside(p: Point, hull: Sequence[Point]) -> bool:
    """Whether a point is inside an outline, or closer than a bar's width if that is a line.

    Args:
        p: the point.
        hull: corners of a convex outline, or two ends of a line.
    """
    if len(hull) > 2:
        return all(
            _turn(a, b, p) >= -SLENDER for a, b in zip(hull, [*hull[1:], hull[0]], strict=True)
        )
    a, b = hull[0], hull[-1]
    length2 = distance2(a, b)
    t = ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length2 if length2 else 0
    t = min(max(t, 0), 1)
    return distance2(p, (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]))) < 25


def distance2(a: Point, b: Point) -> float:
    """The squared distance of two points.

    Args:
        a: the first point.
        b: the second point.
    """
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2


def far(a: Point, b: Point, limit: float) -> bool:
    """Whether two points are farther apart than a limit; a distance equal to it does not count.

    The margin makes the result independent of rounding where distances equal the limit.

    Args:
        a: the first point.
        b: the second point.
        limit: the distance.
    """
    return distance2(a, b) > limit * limit + 1e-6
