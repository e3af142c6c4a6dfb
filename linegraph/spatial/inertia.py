"""Mass distributions: mass, first and second moments about a point, and how they transform between frames."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from linegraph.algebra.scalar import Scalar
from linegraph.spatial import vector
from linegraph.spatial.vector import ZERO, Vector

if TYPE_CHECKING:
    from linegraph.spatial.rotation import (
        Diagonal,
        Inertia,
        Rotation,
    )
if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar


class Moments(NamedTuple):
    """The mass distribution of a body about an origin, in its axes: m, ∫ r dm and ∫ r r^T dm.

    The second moments S take fewer operations to transform than the inertia tensor J = tr(S) 1 - S, and the
    resultants of an acceleration field on the body are linear in them.

    Attributes:
        mass: m (kg).
        first: ∫ r dm (kg m).
        second: S = ∫ r r^T dm (kg m²).
        about: those diagonal entries of J that are known by themselves. As sums of entries of S, small ones
            would not be exact to the last digit, and zeros would not be zero.
    """

    mass: Scalar
    first: Vector
    second: Inertia
    about: Diagonal = (None, None, None)

    @property
    def inertia(self) -> Inertia:
        """The inertia tensor J = tr(S) 1 - S about the origin (kg m²), with J_xy = -∫ x y dm."""
        xx, xy, xz, yy, yz, zz = self.second
        sums = (yy + zz, xx + zz, xx + yy)
        x, y, z = (s if known is None else known for s, known in zip(sums, self.about, strict=True))
        return (x, -xy, -xz, y, -yz, z)


NO_MOMENTS = Moments(0, ZERO, (0, 0, 0, 0, 0, 0), (0, 0, 0))


def second_moments(inertia: Inertia) -> Inertia:
    """``S = tr(J) / 2 - J``, exact to the last digit for numbers, however slender the body is.

    Args:
        inertia: J about any point (kg m²). For a planar body, where only zz is given, S is what results in
            that zz.

    Returns:
        S about the same point, in the same axes (kg m²).
    """
    xx, xy, xz, yy, yz, zz = inertia
    x, y, z = _less(yy, zz, xx), _less(zz, xx, yy), _less(xx, yy, zz)
    return (x / 2, -xy, -xz, y / 2, -yz, z / 2)


def _less(a: Scalar, b: Scalar, c: Scalar) -> Scalar:
    """``a + b - c``; where c is the same node as a or b, these two would only round the other one."""
    if all(isinstance(x, (int, float)) for x in (a, b, c)):
        # exact up to one rounding: for a slender body the moments nearly cancel
        return math.fsum((a, b, -c))
    if c in (a, b):
        return b if c == a else a
    return a + b - c


def point_apart(head: Moments) -> tuple[Moments, Moments]:
    """The body split into one without mass and its mass as a point at the origin.

    For joints whose two frames have a common origin: the point moves with the parent, too, and may as well
    belong to it, which leaves fewer parameters in the equations of motion.

    Returns:
        The remaining moments, and those of the point.
    """
    return head._replace(mass=0), NO_MOMENTS._replace(mass=head.mass)


def round_apart(head: Moments) -> tuple[Moments, Moments]:
    """The body split into one with S_zz = 0 and its extent along z.

    For joints whose two frames have a common direction of z: the extent has no inertia about z and the frames
    turn alike across z, so that it may as well belong to the parent.

    Returns:
        The remaining moments, and those with nothing but S_zz.
    """
    *others, zz = head.second
    kept = Moments(head.mass, head.first, (*others, 0), (None, None, head.about[2]))
    return kept, Moments(0, ZERO, (0, 0, 0, 0, 0, zz))


def carried(moments: Moments, rotation: Rotation, at: Vector) -> Moments:
    """Moments about another origin and in other axes.

    With a the position `at`, b the rotated first moment and f = b + m a the first moment about the outer
    origin, the second moments gain a b^T + f a^T. This contains Steiner's term m a a^T, so that the mass
    centre is not needed.

    Args:
        moments: about the inner origin, in inner axes.
        rotation: inner to outer components.
        at: the inner origin from the outer one, in outer axes (m).

    Returns:
        Moments about the outer origin, in outer axes.
    """
    m = moments.mass
    b = rotation.out(moments.first)
    xx, xy, xz, yy, yz, zz = rotation.congruence(moments.second)
    first = vector.add(b, vector.scale(m, at))
    return Moments(
        m,
        first,
        (
            xx + _spread(at[0], b[0], first[0]),
            xy + (at[0] * b[1] + at[1] * first[0]),
            xz + (at[0] * b[2] + at[2] * first[0]),
            yy + _spread(at[1], b[1], first[1]),
            yz + (at[1] * b[2] + at[2] * first[1]),
            zz + _spread(at[2], b[2], first[2]),
        ),
        _about(moments, rotation, at, vector.add(b, first)),
    )


def _about(moments: Moments, rotation: Rotation, at: Vector, twice: Vector) -> Diagonal:
    """The diagonal of J, where it was known, in outer axes and about the outer origin."""
    known = rotation.diagonal(moments.about)
    p = tuple(x * y for x, y in zip(at, twice, strict=True))
    x, y, z = (
        None if j is None else j + (p[(k + 1) % 3] + p[(k + 2) % 3]) for k, j in enumerate(known)
    )
    return (x, y, z)


def carried_in_plane(moments: Moments, rotation: Rotation, at: Vector) -> Moments:
    """The same as `carried` for a planar motion, of which only the inertia about z counts.

        J_zz + 2 a . b + m a . a        with a and b as there, products over x and y

    Args:
        moments: about the inner origin.
        rotation: inner to outer components, about z.
        at: the inner origin from the outer one, in outer axes (m).

    Returns:
        Moments about the outer origin, which hold J_zz both as `second[0]` and as `about[2]`, and no other
        second moment.
    """
    b = rotation.out(moments.first)
    first = vector.add(b, vector.scale(moments.mass, at))
    about = moments.inertia[5]
    # in two steps, because the first sum also is an entry of M beside the diagonal, and is then shared
    about = about + (at[0] * b[0] + at[1] * b[1])
    about = about + (at[0] * first[0] + at[1] * first[1])
    return Moments(moments.mass, first, (about, 0, 0, 0, 0, 0), (None, None, about))


def _spread(at: Scalar, inner: Scalar, outer: Scalar) -> Scalar:
    """``at (inner + outer)``; without mass both are the same node, and its product is shared with M."""
    shared = inner is outer and not isinstance(at, (int, float))
    return 2 * (at * inner) if shared else at * (inner + outer)


def joined(a: Moments, b: Moments) -> Moments:
    """The moments of two bodies together.

    Args:
        a: of one body.
        b: of the other, about the same origin and in the same axes.
    """
    second = tuple(x + y for x, y in zip(a.second, b.second, strict=True))
    known = zip(a.about, b.about, strict=True)
    x, y, z = (None if j is None or k is None else j + k for j, k in known)
    return Moments(a.mass + b.mass, vector.add(a.first, b.first), second, (x, y, z))
