"""Outlines of points in the picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.drawing.scene import Point

SLENDER = 60
"""Twice the area of a triangle that counts as a line."""


def hull_of(points: Sequence[Point]) -> list[Point]:
    """The corners of the smallest convex outline, or the two ends where all are in a line."""
    ordered = sorted(set(points))
    if len(ordered) < 3:
        return ordered

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
    """Whether a point is within an outline, or within a bar's width of its line."""
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
    """The square of a distance."""
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2


def far(a: Point, b: Point, limit: float) -> bool:
    """Whether two points are apart by a distance, far from rounding's border."""
    return distance2(a, b) > limit * limit + 1e-6
