"""The view of a mechanism: along the normal of a planar motion, else obliquely from above."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING

from linegraph.components.joints.look import ABOUT, ALONG
from linegraph.spatial.vector import Vector, cross, dot, scale, subtract

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.drawing.poses import Poses

PARALLEL = 1e-6
NEAR = 0.07
"""Points closer than this fraction of the picture hide each other."""

_HALF, _ROOT3 = 0.5, 0.8660254037844386
_HIGH, _FLAT = 0.42261826174069944, 0.9063077870366499  # sine and cosine of 25 degrees

_AZIMUTHS = (
    (_HALF, -_ROOT3),
    (_ROOT3, -_HALF),
    (-_HALF, -_ROOT3),
    (_ROOT3, _HALF),
    (-_ROOT3, -_HALF),
    (_HALF, _ROOT3),
)
"""Directions to the eye, seen from above."""


@dataclass(frozen=True)
class View:
    """An orthographic view, by unit vectors in ground axes.

    Attributes:
        right, up: axes of the picture.
        toward: direction to the eye.
        planar: whether the view is along the normal of a planar mechanism.
    """

    right: Vector
    up: Vector
    toward: Vector
    planar: bool

    def seen(self, point: Vector) -> tuple[float, float]:
        """Projection of a point or direction; y is upward."""
        return (dot(self.right, point), dot(self.up, point))


def chosen_view(found: Poses) -> View:
    """Choose the view of a mechanism: of six oblique ones the one that hides least."""
    normal = _normal(found)
    upward = found.upward or (0.0, 0.0, 1.0)
    if normal is not None:
        up = _in_plane(upward, normal)
        if up is None:
            other = (0.0, 1.0, 0.0) if abs(normal[1]) < 0.9 else (1.0, 0.0, 0.0)
            up = _in_plane(other, normal)
        assert up is not None
        right = cross(up, normal)
        largest = max(right, key=abs)
        # Of the two sides, choose the one from which an axis of ground points to the right.
        if largest < 0:
            normal, right = scale(-1, normal), scale(-1, right)
        return View(right, up, normal, True)
    first = _in_plane((1.0, 0.0, 0.0), upward) or _in_plane((0.0, 0.0, 1.0), upward)
    assert first is not None
    second = cross(upward, first)
    views = [_aslant(upward, first, second, *azimuth) for azimuth in _AZIMUTHS]
    points = _points(found)
    return min(views, key=lambda view: _hidden(view, points, found))


def _normal(found: Poses) -> Vector | None:
    """Normal of the plane of motion of all joints; None if there is none."""
    turning = [p.axis for p in found.joints if p.joint.look.plane == ABOUT]
    sliding = [p.axis for p in found.joints if p.joint.look.plane == ALONG]
    if len(turning) + len(sliding) < len(found.joints) or not found.joints:
        return None
    candidates: list[Vector] = turning[:1] or [(0.0, -1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)]
    for normal in candidates:
        flat = all(_length(cross(normal, axis)) < PARALLEL for axis in turning)
        if flat and all(abs(dot(normal, axis)) < PARALLEL for axis in sliding):
            return normal
    return None


def _aslant(upward: Vector, first: Vector, second: Vector, x: float, y: float) -> View:
    level = _sum(scale(x, first), scale(y, second))
    toward = _sum(scale(_FLAT, level), scale(_HIGH, upward))
    right = _unit(cross(upward, toward))
    return View(right, cross(toward, right), toward, False)


def _hidden(view: View, points: Sequence[Vector], found: Poses) -> int:
    """Number of pairs of points that coincide in the picture, and of axes that are seen end-on."""
    flat = [view.seen(point) for point in points]
    size = max(
        (abs(a - b) for p in flat for q in flat for a, b in zip(p, q, strict=True)), default=0.0
    )
    limit = NEAR * size
    count = 0
    for i, p in enumerate(flat):
        for j in range(i):
            apart = max(abs(p[0] - flat[j][0]), abs(p[1] - flat[j][1]))
            # The margin makes the choice independent of rounding where distances equal the limit.
            if apart < limit * (1 - 1e-9) and _length(subtract(points[i], points[j])) > limit:
                count += 1
    for place in found.joints:
        x, y = view.seen(place.axis)
        count += x * x + y * y < 0.1
    return count


def _points(found: Poses) -> list[Vector]:
    """Distinct positions of joints and mass centres, limited in number."""
    every = [p.head for p in found.joints] + list(found.centers.values())
    kept: list[Vector] = []
    for point in every:
        if all(_length(subtract(point, other)) > 1e-9 for other in kept):
            kept.append(point)
    return kept[:60]


def _in_plane(a: Vector, normal: Vector) -> Vector | None:
    """Direction of a vector's part perpendicular to another one; None if it is parallel to that."""
    rest = subtract(a, scale(dot(a, normal), normal))
    return None if _length(rest) < 1e-3 else _unit(rest)


def _unit(a: Vector) -> Vector:
    return scale(1 / _length(a), a)


def _length(a: Vector) -> float:
    return sqrt(dot(a, a))


def _sum(a: Vector, b: Vector) -> Vector:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])
