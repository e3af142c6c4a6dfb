"""3-vectors over any algebra: plain triples of scalars, resolved in a frame the caller knows."""

from __future__ import annotations

from typing import TypeAlias

from linegraph.algebra.scalar import Scalar

Vector: TypeAlias = tuple[Scalar, Scalar, Scalar]
Matrix: TypeAlias = tuple[Vector, Vector, Vector]

ZERO: Vector = (0, 0, 0)


def add(a: Vector, b: Vector) -> Vector:
    """``a + b``."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def subtract(a: Vector, b: Vector) -> Vector:
    """``a - b``."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def negate(a: Vector) -> Vector:
    """``-a``."""
    return (-a[0], -a[1], -a[2])


def scale(s: Scalar, a: Vector) -> Vector:
    """``s a``."""
    return (s * a[0], s * a[1], s * a[2])


def dot(a: Vector, b: Vector) -> Scalar:
    """``a . b``."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """``a x b``."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def skew(a: Vector) -> Matrix:
    """``[a x]``: the matrix whose product with b is a x b."""
    x, y, z = a
    return ((0, -z, y), (z, 0, -x), (-y, x, 0))


def combine(coefficients: tuple[Scalar, ...], vectors: tuple[Vector, ...]) -> Vector:
    """``sum_i c_i a_i``."""
    total = ZERO
    for c, a in zip(coefficients, vectors, strict=True):
        total = add(total, scale(c, a))
    return total


def times(m: Matrix, a: Vector) -> Vector:
    """``M a``."""
    return (dot(m[0], a), dot(m[1], a), dot(m[2], a))


def transpose(m: Matrix) -> Matrix:
    """The matrix with rows and columns exchanged."""
    return (
        (m[0][0], m[1][0], m[2][0]),
        (m[0][1], m[1][1], m[2][1]),
        (m[0][2], m[1][2], m[2][2]),
    )


def is_zero(a: Vector) -> bool:
    """Whether the vector is known to be zero; a symbolic entry never is."""
    return bool(a[0] == 0 and a[1] == 0 and a[2] == 0)
