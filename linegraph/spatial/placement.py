"""Placements: origin and axes of one frame, resolved in another."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.spatial import vector
from linegraph.spatial.rotation import (
    product,
    rotation_of,
    snapped,
)

if TYPE_CHECKING:
    from linegraph.spatial.vector import Matrix, Vector


class Placement(NamedTuple):
    """An inner frame as seen from an outer one, such as a frame fixed on a body.

    Attributes:
        at: the inner frame's origin from the outer frame's origin, in outer axes (m).
        rotation: inner to outer components, 3 x 3 by rows.
    """

    at: Vector
    rotation: Matrix


def compose(outer: Placement, inner: Placement, snap: float) -> Placement:
    """The placement of a frame in the outermost of three frames.

    Args:
        outer: the middle frame in the outermost.
        inner: the frame in the middle one.
        snap: the distance within which entries of the rotation become exact, see `rotation.snapped`.
    """
    at = vector.add(outer.at, swept(rotation_of(outer.rotation).out(inner.at), inner.at))
    return Placement(at, snapped(product(outer.rotation, inner.rotation), snap))


def inverse(placement: Placement) -> Placement:
    """The placement of the outer frame in the inner one."""
    back = vector.transpose(placement.rotation)
    return Placement(vector.negate(rotation_of(back).out(placement.at)), back)


def swept(turned: Vector, original: Vector, within: float = 4e-16) -> Vector:
    """A rotated vector with rounding errors replaced by zero where the exact result is zero.

    Without it a structural zero would become a term in all formulas that follow.

    Args:
        turned: the rotated vector; returned unchanged if it or the original has symbolic entries.
        original: the vector before the rotation.
        within: the largest entry that counts as zero, relative to the largest entry of the original.
    """
    if not all(isinstance(x, (int, float)) for x in (*turned, *original)):
        return turned
    scale = max(abs(x) for x in original)
    x, y, z = (0 if abs(c) <= within * scale else c for c in turned)
    return (x, y, z)
