"""Motions one after the other: the parts of joints that have several, without bodies in between."""

from __future__ import annotations

from functools import reduce
from itertools import accumulate
from math import hypot
from typing import TYPE_CHECKING, Any

from linegraph.components.body import unit
from linegraph.components.joints.revolute import Revolute
from linegraph.components.validation import vector
from linegraph.spatial.motion import Motion
from linegraph.spatial.rotation import (
    IDENTITY_MATRIX,
    Factor,
    Full,
    Relabel,
    Rotation,
    Turn,
    rotation_of,
    snapped,
    z_onto,
)
from linegraph.spatial.vector import (
    ZERO,
    Matrix,
    Vector,
    add,
    combine,
    cross,
    dot,
    scale,
    subtract,
    times,
    transpose,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.joints.base import Joint

DUST = 4e-15
"""Rounding of a product of constant rotations."""

PARALLEL = 1e-9
"""Two directions are the same below this sine of the angle between them."""


def compose(
    first: Motion, second: Motion, v1: tuple[Scalar, ...], v2: tuple[Scalar, ...]
) -> Motion:
    """The motion of two joints, the head frame of the first being the tail frame of the second.

    With R = R1 R2 and d = d1 + R1 d2, and with all of the first carried to the head's origin and axes,

        w = R2^T w1 + w2                        u = R2^T (u1 + w1 x d2) + u2

    Their derivatives in head axes bring w1 x w2, u1 x w2 and w1 x u2 into the biases: the columns of the
    first part turn relative to the head axes with -w2, and the lever d2 grows with u2.

    Args:
        first: the motion at the tail.
        second: the motion at the head, in the same axes.
        v1: velocity coordinates of the first.
        v2: velocity coordinates of the second.

    Example:
        >>> arm = Motion(Rotation(), (0, 0, 2), (ZERO,), ((0, 0, 1),))
        >>> swing = turn((1, 0, 0), 1, 0)
        >>> compose(swing, arm, (3.0,), (5.0,)).linear
        ((0, -2, 0), (0, 0, 1))
    """
    into, d = second.rotation.into, second.displacement
    swept = (add(u, cross(s, d)) for s, u in zip(first.angular, first.linear, strict=True))
    angular = tuple(into(s) for s in first.angular)
    linear = tuple(into(u) for u in swept)
    w1, u1 = combine(v1, angular), combine(v1, linear)
    w2, u2 = combine(v2, second.angular), combine(v2, second.linear)
    bent = add(into(first.angular_bias), cross(w1, w2))
    moved = into(add(first.linear_bias, cross(first.angular_bias, d)))
    moved = add(moved, add(cross(w1, u2), cross(u1, w2)))
    return Motion(
        joined(first.rotation, second.rotation),
        add(first.displacement, first.rotation.out(d)),
        angular + second.angular,
        linear + second.linear,
        add(bent, second.angular_bias),
        add(moved, second.linear_bias),
    )


def joined(outer: Rotation, inner: Rotation) -> Rotation:
    """The product of two rotations, with factors of one kind that meet in it made one.

    The product ``outer @ inner`` would keep both; two turns about one axis then cost twice the operations.

    Args:
        outer: applied last: components in its head's axes to those in its tail's.
        inner: applied first.

    Example:
        >>> joined(Rotation((Turn(2, 0, 1),)), Rotation((Turn(2, 0.8, 0.6),))).factors
        (Turn(axis=2, cosine=-0.6, sine=0.8),)
    """
    if not (outer.factors and inner.factors):
        return outer @ inner
    a, b = outer.factors[-1], inner.factors[0]
    if isinstance(a, Turn) and isinstance(b, Turn) and a.axis == b.axis:
        cosine = a.cosine * b.cosine - a.sine * b.sine
        sine = a.sine * b.cosine + a.cosine * b.sine
        meeting = Rotation((Turn(a.axis, cosine, sine),)).matrix()
    elif isinstance(a, Full | Relabel) and isinstance(b, Full | Relabel):
        meeting = Rotation((a, b)).matrix()
    else:
        return outer @ inner
    # where the two cancel, their neighbours meet
    outer = joined(Rotation(outer.factors[:-1]), constant(meeting))
    return joined(outer, Rotation(inner.factors[1:]))


def chain(motions: Sequence[Motion], v: Sequence[Scalar]) -> Motion:
    """The motion of several joints one after the other, tail to head.

    Args:
        motions: at least one, all in the same axes.
        v: the velocities of all of them in order.
    """
    ends = tuple(accumulate(len(motion.angular) for motion in motions))

    def extend(so_far: Motion, k: int) -> Motion:
        start, end = ends[k - 1], ends[k]
        return compose(so_far, motions[k], tuple(v[:start]), tuple(v[start:end]))

    return reduce(extend, range(1, len(motions)), motions[0])


def turn(axis: Vector, cosine: Scalar, sine: Scalar) -> Motion:
    """The motion of a hinge about a constant direction.

    Args:
        axis: the direction, of unit length, in the axes of both frames.
        cosine: of the angle, right-handed about the axis.
        sine: of the same angle.

    Example:
        >>> turn((0, -1, 0), 0.8, 0.6).rotation.factors
        (Turn(axis=1, cosine=0.8, sine=-0.6),)
    """
    about_z = Motion(Rotation((Turn(2, cosine, sine),)), ZERO, ((0, 0, 1),), (ZERO,))
    return reoriented(about_z, onto(axis))


def turns(
    algebra: Algebra, axes: Sequence[Vector], q: Sequence[Scalar], v: Sequence[Scalar]
) -> Motion:
    """The motion of hinges one after the other.

    Args:
        algebra: where to calculate.
        axes: a direction of unit length for each hinge, in the axes left by those before it.
        q: their angles (rad).
        v: their rates (rad/s).
    """
    hinges = [turn(a, algebra.cos(x), algebra.sin(x)) for a, x in zip(axes, q, strict=True)]
    return chain(hinges, v)


def hinges(joint: Joint, axes: Sequence[Vector]) -> tuple[tuple[Joint, Rotation], ...]:
    """Hinges about constant directions, as the `sequence` of a joint.

    Args:
        joint: the joint they make up; their names begin with its name.
        axes: the direction of each, of unit length, in aligned axes.
    """
    return tuple(
        (Revolute(f"{joint.name}_angle{k}", joint.between), onto(axis))
        for k, axis in enumerate(axes, 1)
    )


def reoriented(motion: Motion, change: Rotation) -> Motion:
    """A motion resolved in other axes.

    Args:
        motion: rotation, columns and biases, tail and head in the same axes.
        change: the constant rotation from these axes to the other ones.
    """
    out = change.out
    return Motion(
        _conjugate(motion.rotation, change),
        out(motion.displacement),
        tuple(out(s) for s in motion.angular),
        tuple(out(u) for u in motion.linear),
        out(motion.angular_bias),
        out(motion.linear_bias),
    )


def _conjugate(rotation: Rotation, change: Rotation) -> Rotation:
    """``B R B^T``: a turn about a coordinate axis that B takes to another stays one."""
    turned: list[Factor] = []
    for factor in rotation.factors:
        image = change.out(IDENTITY_MATRIX[factor.axis]) if isinstance(factor, Turn) else ZERO
        place = [k for k in range(3) if image[k] in (1, -1)]
        if not (isinstance(factor, Turn) and place):
            return change @ rotation @ change.inverse()
        turned.append(Turn(place[0], factor.cosine, image[place[0]] * factor.sine))
    return Rotation(tuple(turned))


def direction(given: Sequence[Any], who: str) -> Vector:
    """A direction as a user writes it, scaled to length 1.

    Args:
        given: three numbers, parameters or SymPy expressions.
        who: the thing that errors name.

    Raises:
        ModelError: not three finite numbers or symbols, or no length.
    """
    return unit(vector(given, who), who)


def common_axes(axes: Sequence[Vector]) -> Matrix:
    """The axes, as columns, in which turns about `axes` take the fewest operations.

    Coordinate axes are left as they are. Else z is along the last one, and the last of the others that is
    not parallel to it lies in the plane of x and z: where it is normal to z, along x.

    Example:
        >>> common_axes([(0, -1, 0), (0, 0, 1)])
        ((0, 1, 0), (-1, 0, 0), (0, 0, 1))
    """
    if all(axis in IDENTITY_MATRIX for axis in axes):
        return IDENTITY_MATRIX
    z = axes[-1]
    if not all(map(_known, axes)):
        return z_onto(z)
    for axis in reversed(axes[:-1]):
        if not parallel(axis, z):
            # twice: the first difference is inexact where the two are nearly in line
            x = _across(_across(axis, z), z)
            return transpose((x, cross(z, x), z))
    return z_onto(z)


def _across(a: Vector, z: Vector) -> Vector:
    """The direction of the part of `a` that is normal to a unit vector."""
    return unit(subtract(a, scale(dot(a, z), z)), "")


def parallel(a: Vector, b: Vector) -> bool:
    """Whether two unit vectors are known to be parallel or opposite.

    The sine of the angle between them is compared with `PARALLEL`. Vectors with symbols are not: an axis
    must not be dropped because two coincide for some values of the parameters.

    Args:
        a: a unit vector.
        b: another one, in the same axes.
    """
    normal = cross(a, b)
    return _known(normal) and bool(dot(normal, normal) < PARALLEL * PARALLEL)


def onto(axis: Vector) -> Rotation:
    """A constant rotation that takes z to a direction, of all these one that takes few operations.

    Args:
        axis: the direction, of unit length.
    """
    smallest = constant(z_onto(axis))
    x, y, z = axis
    if not any(isinstance(factor, Full) for factor in smallest.factors) or not _known(axis):
        return smallest
    # two turns take fewer operations than a full matrix
    r = hypot(x, y)
    return Rotation((Turn(2, x / r, y / r), Turn(1, z, r)))


def constant(matrix: Matrix) -> Rotation:
    """The cheapest form of a constant rotation that was computed, with its rounding removed.

    Args:
        matrix: orthogonal up to `DUST`.
    """
    return rotation_of(snapped(matrix, DUST))


def _known(a: Vector) -> bool:
    """Whether all components are numbers."""
    return all(isinstance(x, (int, float)) for x in a)


def seen(axis: Vector, axes: Matrix) -> Vector:
    """A direction resolved in other axes; the third of these stays exactly (0, 0, 1).

    Args:
        axis: the direction.
        axes: the other axes as the columns of a matrix, in the axes that `axis` is resolved in.
    """
    inward = transpose(axes)
    return (0, 0, 1) if axis == inward[2] else times(inward, axis)


def angles_of(algebra: Algebra, sequence: str, rotation: Matrix) -> tuple[Scalar, ...]:
    """The angles of three turns, each about an axis left by those before it, that make up a rotation.

    All are arctangents of two arguments, so that they keep their accuracy near 90 degrees; Diebel lists the
    matrices of all twelve sequences [Diebel 2006].

    Args:
        algebra: where to calculate.
        sequence: the axes in order, such as "xyz" or "zxz".
        rotation: a 3 x 3 matrix, head components to tail components.

    Returns:
        Three angles (rad): the first and the last between -pi and pi; the second between -pi/2 and pi/2 for
        three different axes, and between 0 and pi where the first is also the last.

    Example:
        >>> from linegraph.algebra.protocol import Floats
        >>> turned = turns(Floats(), IDENTITY_MATRIX, (0.3, -0.4, 0.5), (0, 0, 0)).rotation
        >>> [round(x, 12) for x in angles_of(Floats(), "xyz", turned.matrix())]
        [0.3, -0.4, 0.5]
    """
    i, j, last = ("xyz".index(c) for c in sequence)
    k = 3 - i - j
    sign = 1 if (j - i) % 3 == 1 else -1
    r = rotation

    def angle(sine: Scalar, cosine: Scalar) -> Scalar:
        return algebra.function("atan2", sine, cosine)

    across = algebra.sqrt(r[i][j] * r[i][j] + _square(r[i][k] if i == last else r[i][i]))
    if i == last:
        middle = angle(across, r[i][i])
        return angle(r[j][i], -sign * r[k][i]), middle, angle(r[i][j], sign * r[i][k])
    middle = angle(sign * r[i][k], across)
    return angle(-sign * r[j][k], r[k][k]), middle, angle(-sign * r[i][j], r[i][i])


def _square(x: Scalar) -> Scalar:
    return x * x


def reciprocal(columns: Sequence[Vector]) -> tuple[Vector, ...]:
    """The reciprocal basis of two or three vectors: in their span, ``r_a . s_b = 1`` where a = b, else 0.

    Args:
        columns: the vectors s, linearly independent.
    """
    if len(columns) == 2:
        a, b = columns
        common, aa, bb = dot(a, b), dot(a, a), dot(b, b)
        inverse = 1 / (aa * bb - common * common)
        first = scale(inverse, subtract(scale(bb, a), scale(common, b)))
        return first, scale(inverse, subtract(scale(aa, b), scale(common, a)))
    a, b, c = columns
    inverse = 1 / dot(a, cross(b, c))
    return tuple(scale(inverse, cross(x, y)) for x, y in ((b, c), (c, a), (a, b)))
