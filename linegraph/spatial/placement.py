"""Placements: where one frame stands in another."""

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
    """A frame on a body: its origin and its axes, both in the body's frame."""

    at: Vector
    rotation: Matrix


def compose(outer: Placement, inner: Placement, snap: float) -> Placement:
    """A frame given in an inner frame, seen from the outer one."""
    at = vector.add(outer.at, swept(rotation_of(outer.rotation).out(inner.at), inner.at))
    return Placement(at, snapped(product(outer.rotation, inner.rotation), snap))


def inverse(placement: Placement) -> Placement:
    """The outer frame seen from the inner one."""
    back = vector.transpose(placement.rotation)
    return Placement(vector.negate(rotation_of(back).out(placement.at)), back)


def swept(turned: Vector, original: Vector, within: float = 4e-16) -> Vector:
    """Drop the rounding dust, of this part of the original, that is left where an exact zero belongs."""
    if not all(isinstance(x, (int, float)) for x in (*turned, *original)):
        return turned
    scale = max(abs(x) for x in original)
    x, y, z = (0 if abs(c) <= within * scale else c for c in turned)
    return (x, y, z)
