"""Rotations as products of cheap factors, applied to vectors and to symmetric tensors.

A `Rotation` R maps components in an inner frame to components in an outer frame. Kept as a product, a
planar factor costs 4 multiplications for a vector and 8 for a symmetric tensor, where a full matrix costs 9
and 45; a signed permutation of axes costs nothing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

from linegraph.algebra.protocol import Constants
from linegraph.algebra.scalar import Scalar
from linegraph.spatial.vector import Matrix, Vector, times, transpose

Inertia = tuple[Scalar, Scalar, Scalar, Scalar, Scalar, Scalar]
"""A symmetric tensor: (xx, xy, xz, yy, yz, zz)."""

Diagonal = tuple[Scalar | None, Scalar | None, Scalar | None]
"""The entries xx, yy, zz of a tensor; None where unknown."""

IDENTITY_MATRIX: Matrix = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
_PLACE = ((0, 1, 2), (1, 3, 4), (2, 4, 5))


class Factor(Protocol):
    """A rotation R from inner to outer axes that knows its cheapest application."""

    def out(self, a: Vector) -> Vector:
        """``R a``: components of a vector in outer axes from those in inner axes."""

    def into(self, a: Vector) -> Vector:
        """``R^T a``: components of a vector in inner axes from those in outer axes."""

    def congruence(self, j: Inertia) -> Inertia:
        """``R J R^T``: a symmetric tensor in outer axes from the same in inner axes."""

    def similarity(self, m: Matrix) -> Matrix:
        """``R M R^T``: any tensor in outer axes from the same in inner axes."""

    def inverse(self) -> Factor:
        """The inverse rotation ``R^T`` as a factor."""


@dataclass(frozen=True)
class Turn:
    """Right-handed rotation of the inner frame about coordinate axis `axis` (0, 1, 2), by cosine and sine."""

    axis: int
    cosine: Scalar
    sine: Scalar

    def out(self, a: Vector) -> Vector:
        """``R a``, with 4 multiplications."""
        i, j = (self.axis + 1) % 3, (self.axis + 2) % 3
        c, s = self.cosine, self.sine
        turned = list(a)
        turned[i] = c * a[i] - s * a[j]
        turned[j] = s * a[i] + c * a[j]
        return (turned[0], turned[1], turned[2])

    def into(self, a: Vector) -> Vector:
        """``R^T a``, with 4 multiplications."""
        i, j = (self.axis + 1) % 3, (self.axis + 2) % 3
        c, s = self.cosine, self.sine
        turned = list(a)
        turned[i] = c * a[i] + s * a[j]
        turned[j] = c * a[j] - s * a[i]
        return (turned[0], turned[1], turned[2])

    def congruence(self, j: Inertia) -> Inertia:
        """``R J R^T``, 8 multiplications: s (J_ii - J_jj) + 2 c J_ij takes the place of c² and s²."""
        k, i1, i2 = self.axis, (self.axis + 1) % 3, (self.axis + 2) % 3
        c, s = self.cosine, self.sine
        ii, jj, ij = _PLACE[i1][i1], _PLACE[i2][i2], _PLACE[i1][i2]
        ik, jk = _PLACE[i1][k], _PLACE[i2][k]
        twist = s * (j[ii] - j[jj]) + (c + c) * j[ij]
        moved = s * twist
        turned = list(j)
        turned[ii] = j[ii] - moved
        turned[jj] = j[jj] + moved
        turned[ij] = c * twist - j[ij]
        turned[ik] = c * j[ik] - s * j[jk]
        turned[jk] = s * j[ik] + c * j[jk]
        return tuple(turned)

    def similarity(self, m: Matrix) -> Matrix:
        """``R M R^T``; in the plane of the turn the skew part of M and its trace are invariant."""
        k, i, j = self.axis, (self.axis + 1) % 3, (self.axis + 2) % 3
        c, s = self.cosine, self.sine
        twist = s * (m[i][i] - m[j][j]) + c * (m[i][j] + m[j][i])
        moved, common = s * twist, c * twist
        turned = [list(row) for row in m]
        turned[i][i] = m[i][i] - moved
        turned[j][j] = m[j][j] + moved
        turned[i][j] = common - m[j][i]
        turned[j][i] = common - m[i][j]
        turned[i][k], turned[j][k] = c * m[i][k] - s * m[j][k], s * m[i][k] + c * m[j][k]
        turned[k][i], turned[k][j] = c * m[k][i] - s * m[k][j], s * m[k][i] + c * m[k][j]
        x, y, z = (tuple(row) for row in turned)
        return (x, y, z)

    def inverse(self) -> Turn:
        """Rotation about the same axis by the opposite angle."""
        return Turn(self.axis, self.cosine, -self.sine)


@dataclass(frozen=True)
class Relabel:
    """A signed permutation of axes: outer component r is ``signs[r] * inner[source[r]]``, signs ±1."""

    source: tuple[int, int, int]
    signs: tuple[int, int, int]

    def out(self, a: Vector) -> Vector:
        """``R a``: entries exchange places and signs."""
        (i, j, k), (x, y, z) = self.source, self.signs
        return (x * a[i], y * a[j], z * a[k])

    def into(self, a: Vector) -> Vector:
        """``R^T a``: entries exchange places and signs."""
        return self.inverse().out(a)

    def congruence(self, j: Inertia) -> Inertia:
        """``R J R^T``: entries exchange places and signs."""

        def entry(r: int, c: int) -> Scalar:
            return self.signs[r] * self.signs[c] * j[_PLACE[self.source[r]][self.source[c]]]

        return (entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2))

    def similarity(self, m: Matrix) -> Matrix:
        """``R M R^T``: entries exchange places and signs."""
        x, y, z = (
            tuple(
                self.signs[r] * self.signs[c] * m[self.source[r]][self.source[c]] for c in range(3)
            )
            for r in range(3)
        )
        return (x, y, z)

    def inverse(self) -> Relabel:
        """The permutation from outer to inner axes."""
        back = [0, 0, 0]
        signs = [1, 1, 1]
        for row in range(3):
            back[self.source[row]] = row
            signs[self.source[row]] = self.signs[row]
        return Relabel((back[0], back[1], back[2]), (signs[0], signs[1], signs[2]))


@dataclass(frozen=True)
class Full:
    """A rotation matrix without structure, by rows."""

    rows: Matrix

    def out(self, a: Vector) -> Vector:
        """``R a``, with 9 multiplications."""
        return times(self.rows, a)

    def into(self, a: Vector) -> Vector:
        """``R^T a``, with 9 multiplications."""
        return times(transpose(self.rows), a)

    def congruence(self, j: Inertia) -> Inertia:
        """``R J R^T`` of a symmetric tensor, with 45 multiplications."""
        xx, xy, xz, yy, yz, zz = j
        x, y, z = (times(((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)), row) for row in self.rows)
        p, r, s = self.rows
        return (
            x[0] * p[0] + x[1] * p[1] + x[2] * p[2],
            x[0] * r[0] + x[1] * r[1] + x[2] * r[2],
            x[0] * s[0] + x[1] * s[1] + x[2] * s[2],
            y[0] * r[0] + y[1] * r[1] + y[2] * r[2],
            y[0] * s[0] + y[1] * s[1] + y[2] * s[2],
            z[0] * s[0] + z[1] * s[1] + z[2] * s[2],
        )

    def similarity(self, m: Matrix) -> Matrix:
        """``R M R^T`` of any tensor, with 54 multiplications."""
        x, y, z = (self.out(column) for column in transpose(m))
        p, r, s = (self.out(row) for row in transpose((x, y, z)))
        return (p, r, s)

    def inverse(self) -> Full:
        """The rotation with the transposed matrix."""
        return Full(transpose(self.rows))


@dataclass(frozen=True)
class Rotation:
    """A product of factors, outermost first; the empty product is the identity.

    `R1 @ R2` applies R2 first: its inner frame is that of R2, its outer frame that of R1.
    """

    factors: tuple[Factor, ...] = ()

    def out(self, a: Vector) -> Vector:
        """``R a``: components of a vector in outer axes from those in inner axes."""
        for factor in reversed(self.factors):
            a = factor.out(a)
        return a

    def into(self, a: Vector) -> Vector:
        """``R^T a``: components of a vector in inner axes from those in outer axes."""
        for factor in self.factors:
            a = factor.into(a)
        return a

    def congruence(self, j: Inertia) -> Inertia:
        """``R J R^T``: a symmetric tensor in outer axes from the same in inner axes."""
        for factor in reversed(self.factors):
            j = factor.congruence(j)
        return j

    def similarity(self, m: Matrix) -> Matrix:
        """``R M R^T``: any tensor in outer axes from the same in inner axes."""
        for factor in reversed(self.factors):
            m = factor.similarity(m)
        return m

    def diagonal(self, known: Diagonal) -> Diagonal:
        """Which diagonal entries of a tensor are known in outer axes if only some are known in inner axes.

        A signed permutation keeps all of them, a turn that of its axis; others would need products of
        inertia.
        """
        for factor in reversed(self.factors):
            if isinstance(factor, Relabel):
                i, j, k = factor.source
                known = (known[i], known[j], known[k])
            else:
                axis = factor.axis if isinstance(factor, Turn) else None
                x, y, z = (entry if k == axis else None for k, entry in enumerate(known))
                known = (x, y, z)
        return known

    def inverse(self) -> Rotation:
        """The inverse rotation ``R^T``, which maps outer components to inner ones."""
        return Rotation(tuple(factor.inverse() for factor in reversed(self.factors)))

    def __matmul__(self, inner: Rotation) -> Rotation:
        return Rotation(self.factors + inner.factors)

    def matrix(self) -> Matrix:
        """The 3 x 3 matrix of the product, by rows; its columns are the inner axes in outer components."""
        x, y, z = (self.out(axis) for axis in IDENTITY_MATRIX)
        return transpose((x, y, z))


def rotation_of(m: Matrix) -> Rotation:
    """A constant rotation matrix by its cheapest factor: none, `Relabel`, `Turn` or `Full`."""
    if m == IDENTITY_MATRIX:
        return Rotation()
    if all(x in (0, 1, -1) for row in m for x in row):
        source = tuple(next(c for c in range(3) if row[c] != 0) for row in m)
        signs = tuple(int(row[c]) for row, c in zip(m, source, strict=True))
        return Rotation((Relabel(source, signs),))  # type: ignore[arg-type]
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        if m[k][k] == 1 and all(x == 0 for x in (m[k][i], m[k][j], m[i][k], m[j][k])):
            return Rotation((Turn(k, m[i][i], m[j][i]),))
    return Rotation((Full(m),))


ROUNDING = 4e-15
"""The rounding error of the products of a rotation's rows."""

_ROOTS = (math.sqrt(0.5), math.sqrt(0.75))
_EXACT = (0, 1, -1, 0.5, -0.5, *_ROOTS, *(-x for x in _ROOTS))


def snapped(m: Matrix, within: float) -> Matrix:
    """A rotation matrix with numbers near 0, ±1 and ±1/2 replaced by these exactly.

    So are their partners sqrt(1/2) and sqrt(3/4) in turns by 45, 30 and 60 degrees, or the matrix would lose
    its orthogonality. Where it would all the same, since the partner is not near, it is returned unchanged.

    Args:
        m: 3 x 3, by rows; symbolic entries stay as they are.
        within: the largest distance at which a number is replaced.
    """

    def snap(x: Scalar) -> Scalar:
        if isinstance(x, float):
            for exact in _EXACT:
                if abs(x - exact) <= within:
                    return exact
        return x

    x, y, z = (tuple(snap(entry) for entry in row) for row in m)
    replaced: Matrix = (x, y, z)
    numbers = all(isinstance(entry, (int, float)) for row in m for entry in row)
    loses = numbers and deviation(replaced) > deviation(m) + ROUNDING
    return m if loses else replaced


def deviation(m: Matrix) -> float:
    """The largest absolute entry of ``M M^T - 1`` of a matrix of numbers: its distance from a rotation."""
    products = (
        abs(sum(a * b for a, b in zip(p, q, strict=True)) - (i == j))
        for i, p in enumerate(m)
        for j, q in enumerate(m[: i + 1])
    )
    return float(max(products))


def square(j: Inertia) -> Matrix:
    """A symmetric tensor (xx, xy, xz, yy, yz, zz) as a 3 x 3 matrix."""
    xx, xy, xz, yy, yz, zz = j
    return ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))


def product(a: Matrix, b: Matrix) -> Matrix:
    """The matrix product ``A B``.

    Args:
        a: A, 3 x 3 by rows.
        b: B, 3 x 3 by rows.
    """
    columns = transpose(b)
    x, y, z = (times(a, column) for column in columns)
    return transpose((x, y, z))


def from_rpy(roll: Scalar, pitch: Scalar, yaw: Scalar) -> Matrix:
    """The matrix ``Rz(yaw) Ry(pitch) Rx(roll)``, inner to outer components, as in URDF.

    Args:
        roll: first angle, about the fixed outer x axis (rad).
        pitch: second angle, about the fixed outer y axis (rad).
        yaw: third angle, about the fixed outer z axis (rad).
    """
    (cr, sr), (cp, sp), (cy, sy) = (_cos_sin(angle) for angle in (roll, pitch, yaw))
    return (
        (cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        (sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        (-sp, cp * sr, cp * cr),
    )


def about(axis: Vector, angle: Scalar) -> Matrix:
    """The rotation matrix about a unit vector n, by Rodrigues' formula c 1 + s [n x] + (1 - c) n n^T.

    Args:
        axis: n, of length 1; its components are the same in inner and outer axes.
        angle: in rad, right-handed about n; a number, a parameter or a SymPy expression.
    """
    c, s = _cos_sin(angle)
    x, y, z = axis
    k = 1 - c
    return (
        (c + k * x * x, k * x * y - s * z, k * x * z + s * y),
        (k * x * y + s * z, c + k * y * y, k * y * z - s * x),
        (k * x * z - s * y, k * y * z + s * x, c + k * z * z),
    )


def _cos_sin(angle: Scalar) -> tuple[Scalar, Scalar]:
    constants = Constants()
    return constants.cos(angle), constants.sin(angle)


def z_onto(axis: Vector) -> Matrix:
    """The smallest rotation that takes (0, 0, 1) to a unit vector; half a turn about x for (0, 0, -1)."""
    a, b, c = axis
    if a == 0 and b == 0 and c == -1:
        return ((1, 0, 0), (0, -1, 0), (0, 0, -1))
    # 1 / (1 + c), in the form that does not cancel where c is near -1
    k = (1 - c) / (a * a + b * b) if isinstance(c, (int, float)) and c < 0 else 1 / (1 + c)
    return (
        (1 - k * a * a, -(k * a * b), a),
        (-(k * a * b), 1 - k * b * b, b),
        (-a, -b, c),
    )


def from_quaternion(x: Scalar, y: Scalar, z: Scalar, w: Scalar) -> Matrix:
    """The rotation matrix of a unit quaternion w + x i + y j + z k, inner to outer components.

    Args:
        x: coefficient of i.
        y: coefficient of j.
        z: coefficient of k.
        w: the scalar part.
    """
    # doubled once, instead of a factor 2 in each of nine products
    x2, y2, z2 = x + x, y + y, z + z
    xx, yy, zz = x * x2, y * y2, z * z2
    xy, xz, yz = x * y2, x * z2, y * z2
    wx, wy, wz = w * x2, w * y2, w * z2
    return (
        (1 - (yy + zz), xy - wz, xz + wy),
        (xy + wz, 1 - (xx + zz), yz - wx),
        (xz - wy, yz + wx, 1 - (xx + yy)),
    )
