"""3-vectors and 3 x 3 matrices over any algebra: plain tuples of scalars.

A vector does not know its frame. All operands of a function must be resolved in the same axes, in which the
result is resolved, too.
"""

from __future__ import annotations

from typing import TypeAlias

from linegraph.algebra.scalar import Scalar

Vector: TypeAlias = tuple[Scalar, Scalar, Scalar]
Matrix: TypeAlias = tuple[Vector, Vector, Vector]

ZERO: Vector = (0, 0, 0)


def add(a: Vector, b: Vector) -> Vector:
    """The sum ``a + b``.

    Args:
        a: a vector.
        b: another in the same axes.
    """
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def subtract(a: Vector, b: Vector) -> Vector:
    """The difference ``a - b``.

    Args:
        a: a vector.
        b: another in the same axes.
    """
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def negate(a: Vector) -> Vector:
    """The opposite vector, ``-a``."""
    return (-a[0], -a[1], -a[2])


def scale(s: Scalar, a: Vector) -> Vector:
    """The multiple ``s a`` of a vector.

    Args:
        s: a scalar.
        a: the vector.
    """
    return (s * a[0], s * a[1], s * a[2])


def dot(a: Vector, b: Vector) -> Scalar:
    """The scalar product ``a . b``.

    Args:
        a: a vector.
        b: another in the same axes.
    """
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """The vector product ``a x b``, right-handed.

    Args:
        a: a vector.
        b: another in the same axes.
    """
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def skew(a: Vector) -> Matrix:
    """The cross-product matrix ``[a x]``, with ``[a x] b = a x b``."""
    x, y, z = a
    return ((0, -z, y), (z, 0, -x), (-y, x, 0))


def combine(coefficients: tuple[Scalar, ...], vectors: tuple[Vector, ...]) -> Vector:
    """The linear combination ``sum_i c_i a_i``; zero if there are no terms.

    Args:
        coefficients: the scalars c_i.
        vectors: as many vectors a_i, in the same axes.

    Raises:
        ValueError: the numbers of coefficients and vectors differ.
    """
    total = ZERO
    for c, a in zip(coefficients, vectors, strict=True):
        total = add(total, scale(c, a))
    return total


def times(m: Matrix, a: Vector) -> Vector:
    """The product ``M a`` of a matrix and a vector.

    Args:
        m: 3 x 3, by rows.
        a: the vector.
    """
    return (dot(m[0], a), dot(m[1], a), dot(m[2], a))


def transpose(m: Matrix) -> Matrix:
    """The matrix with rows and columns exchanged."""
    return (
        (m[0][0], m[1][0], m[2][0]),
        (m[0][1], m[1][1], m[2][1]),
        (m[0][2], m[1][2], m[2][2]),
    )


def is_zero(a: Vector) -> bool:
    """Whether all entries are the number zero. A symbolic entry never is, whatever its value."""
    return bool(a[0] == 0 and a[1] == 0 and a[2] == 0)
