"""Rigid motion in NumPy, over real and complex numbers, so that its derivatives need no formulas.

A pose is a 4 x 4 matrix: rotation and place. The imaginary part of a function at ``q + i h v`` is h times
its rate, exact to rounding; second derivatives are differences of such rates.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

Array = Any
UPPER = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
TINY = 1e-30
STEP = 1e-5


def cross_matrix(a: Sequence[Any]) -> Array:
    """The matrix whose product with b is a x b."""
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def turned(axis: Sequence[float], angle: Any) -> Array:
    """The rotation about an axis, which need not have length 1: Rodrigues' formula."""
    k = cross_matrix(np.asarray(axis, float) / np.linalg.norm(axis))
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


def of_quaternion(q: Array) -> Array:
    """The rotation of (x, y, z, w), which need have length 1 in its real part only."""
    axis, w = q[:3], q[3]
    whole = (w * w - axis @ axis) * np.eye(3) + 2 * np.outer(axis, axis)
    return whole + 2 * w * cross_matrix(axis)


def pose(rotation: Any = None, place: Any = (0, 0, 0)) -> Array:
    """A pose from its parts."""
    rotation = np.eye(3) if rotation is None else np.asarray(rotation)
    found = np.eye(4, dtype=np.result_type(rotation, np.asarray(place), float))
    found[:3, :3], found[:3, 3] = rotation, place
    return found


def undone(given: Array) -> Array:
    """The inverse of a pose."""
    back = given[:3, :3].T
    return pose(back, -back @ given[:3, 3])


def axial(m: Array) -> Array:
    """The vector of a skew matrix."""
    return np.array([m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]]) / 2


def tensor(packed: Sequence[float]) -> Array:
    """A symmetric matrix from xx, xy, xz, yy, yz, zz."""
    found = np.zeros((3, 3))
    for (i, j), x in zip(UPPER, packed, strict=True):
        found[i, j] = found[j, i] = x
    return found


def rows(m: Array) -> Any:
    """A matrix as tuples of floats."""
    return tuple(tuple(float(x) for x in row) for row in m)


class Moving(NamedTuple):
    """A frame in motion, all in ground axes; accelerations as its path has them."""

    rotation: Array
    place: Array
    angular: Array
    linear: Array
    spin: Array
    pull: Array


def moving(path: Callable[[Any], Array], t: float = 0.0) -> Moving:
    """The motion of a pose given as a function of time."""

    def rates(at: float) -> tuple[Array, Array]:
        ahead = path(at + 1j * TINY)
        turn = ahead[:3, :3].imag / TINY @ ahead[:3, :3].real.T
        return axial(turn), ahead[:3, 3].imag / TINY

    (w1, u1), (w0, u0) = rates(t + STEP), rates(t - STEP)
    here, (w, u) = path(t), rates(t)
    spin, pull = (w1 - w0) / (2 * STEP), (u1 - u0) / (2 * STEP)
    return Moving(here[:3, :3], here[:3, 3], w, u, spin, pull)
