"""Mass distributions: mass, first and second moments about a point, and how they are carried along."""

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

    The second moments S are carried from frame to frame with fewer operations than the inertia tensor
    J = tr(S) 1 - S, and what an acceleration field does to a body is linear in them.

    Attributes:
        mass, first, second: m, ∫ r dm and ∫ r r^T dm.
        about: the diagonal of J as far as it is known without the sums of S, of which small ones would not be
            left to the last digit, and zeros not be zero.
    """

    mass: Scalar
    first: Vector
    second: Inertia
    about: Diagonal = (None, None, None)

    @property
    def inertia(self) -> Inertia:
        """J about the origin."""
        xx, xy, xz, yy, yz, zz = self.second
        sums = (yy + zz, xx + zz, xx + yy)
        x, y, z = (s if known is None else known for s, known in zip(sums, self.about, strict=True))
        return (x, -xy, -xz, y, -yz, z)


NO_MOMENTS = Moments(0, ZERO, (0, 0, 0, 0, 0, 0), (0, 0, 0))


def second_moments(inertia: Inertia) -> Inertia:
    """``S = tr(J) / 2 - J``, of numbers to the last digit, however slender the body.

    Of a planar body, whose J has no more than zz, S is what gives that zz.
    """
    xx, xy, xz, yy, yz, zz = inertia
    x, y, z = _less(yy, zz, xx), _less(zz, xx, yy), _less(xx, yy, zz)
    return (x / 2, -xy, -xz, y / 2, -yz, z / 2)


def _less(a: Scalar, b: Scalar, c: Scalar) -> Scalar:
    """``a + b - c``, from which two that are the same are left out: they would take digits of the third."""
    if all(isinstance(x, (int, float)) for x in (a, b, c)):
        return math.fsum((a, b, -c))
    if c in (a, b):
        return b if c == a else a
    return a + b - c


def point_apart(head: Moments) -> tuple[Moments, Moments]:
    """The mass as a point at the origin, handed over: for joints whose frames have their origin in common."""
    return head._replace(mass=0), NO_MOMENTS._replace(mass=head.mass)


def round_apart(head: Moments) -> tuple[Moments, Moments]:
    """The spread along z, handed over: for joints whose frames have the direction of z in common."""
    *others, zz = head.second
    kept = Moments(head.mass, head.first, (*others, 0), (None, None, head.about[2]))
    return kept, Moments(0, ZERO, (0, 0, 0, 0, 0, zz))


def carried(moments: Moments, rotation: Rotation, at: Vector) -> Moments:
    """Moments about an inner origin, resolved about an outer one and in outer axes.

    With b the rotated first moment and f = b + m at the one about the outer origin, the second moments gain
    at b^T + f at^T.
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
    """The same where only the inertia about z counts, on both sides: ``J + 2 at . b + m at . at``."""
    b = rotation.out(moments.first)
    first = vector.add(b, vector.scale(moments.mass, at))
    about = moments.inertia[5]
    # one after the other: with the first, the sum is what M has beside its diagonal
    about = about + (at[0] * b[0] + at[1] * b[1])
    about = about + (at[0] * first[0] + at[1] * first[1])
    return Moments(moments.mass, first, (about, 0, 0, 0, 0, 0), (None, None, about))


def _spread(at: Scalar, inner: Scalar, outer: Scalar) -> Scalar:
    """``at (inner + outer)``; without mass the two are one, whose product with an arm M needs, too."""
    shared = inner is outer and not isinstance(at, (int, float))
    return 2 * (at * inner) if shared else at * (inner + outer)


def joined(a: Moments, b: Moments) -> Moments:
    """The moments of two bodies together, about one origin and in one frame."""
    second = tuple(x + y for x, y in zip(a.second, b.second, strict=True))
    known = zip(a.about, b.about, strict=True)
    x, y, z = (None if j is None or k is None else j + k for j, k in known)
    return Moments(a.mass + b.mass, vector.add(a.first, b.first), second, (x, y, z))
