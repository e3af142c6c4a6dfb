"""How large numbers are: norms, and what is rounding or too large."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.ir.algorithms.language import infinity, ratio, small, sqrt

if TYPE_CHECKING:
    from linegraph.ir.algorithms.language import ModuleAtState, Reals


def size_of(n: int, r: Reals) -> float:
    """The largest of n numbers in magnitude; infinite if one is not finite."""
    largest = 0.0
    for i in range(n):
        size = abs(r[i])
        # a NaN is taken for the largest, so that nothing hides it afterwards
        if not size <= largest:
            largest = size if size < infinity else infinity
    return largest


def largest_of(n: int, r: Reals, size: Reals) -> float:
    """The largest of n numbers in magnitude, each divided by its size; infinite if one is not finite."""
    largest = 0.0
    for i in range(n):
        part = ratio(abs(r[i]), size[i])
        # a NaN is taken for the largest, so that nothing hides it afterwards
        if not part <= largest:
            largest = part if part < infinity else infinity
    return largest


def is_rounding(n: int, r: Reals, s: Reals) -> bool:
    """Whether n residuals are no more than rounding of their terms, of sizes s."""
    more = 0
    for i in range(n):
        if not (abs(r[i]) <= small.residual * s[i] and s[i] < infinity):
            more += 1
    return more == 0


def too_large(n: int, x: Reals) -> int:
    """How many of n numbers are NaN, or so large that sums of their products may overflow."""
    count = 0
    for i in range(n):
        if not abs(x[i]) < small.large:
            count += 1
    return count


def unit(module: ModuleAtState, q: Reals) -> None:
    """Normalise the quaternions among the coordinates."""
    at = module.quaternions
    for k in range(len(at)):
        i = at[k]
        length = sqrt(q[i] * q[i] + q[i + 1] * q[i + 1] + q[i + 2] * q[i + 2] + q[i + 3] * q[i + 3])
        for j in range(4):
            q[i + j] = ratio(q[i + j], length)
