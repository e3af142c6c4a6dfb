"""Numerical bounds of the algorithms in emitted code, for doubles and for floats.

Positions, velocities and rows of J are pure numbers when they are compared with these: they are first
divided by sizes of the model itself (`linegraph.dynamics.circuit_lengths`).
"""

from __future__ import annotations

from typing import NamedTuple

from linegraph.tolerance import ACCURATE, CLOSED, DEPENDENT


class Rounding(NamedTuple):
    """Bounds of algorithms; all are pure numbers.

    Attributes:
        rank: entries of J up to this are zero. pivot: the least pivot of a mass matrix, relative to the
        terms that it is the sum of. residual: a residual up to this is zero, relative to the size of its
        terms. rounding: the rounding of a constraint. step: a correction up to this ends Newton's method.
        still: the same for `project`, whose corrections fall below the rounding of positions. closed: a gap
        of loops up to this is none. accurate: the relative error of accelerations that is accepted. far:
        beyond this gap, a state is none of the mechanism, and its error is not estimated. reach: a step of
        Newton's method from here on corrects nothing: where it leads, the rounding of positions
            is as large as gaps that close.
        any: more than anything.
        large: treated as infinite in intermediate results, so that all languages agree.
        slack: the relative error by which redundant constraints may contradict each other.
    """

    rank: float
    pivot: float
    residual: float
    rounding: float
    step: float
    still: float
    closed: float
    accurate: float
    far: float
    reach: float
    any: float
    large: float
    slack: float


DOUBLE = Rounding(
    rank=DEPENDENT,
    pivot=1e-13,
    residual=1e-13,
    rounding=5e-16,
    step=1e-14,
    still=1e-15,
    closed=CLOSED,
    accurate=ACCURATE,
    far=1e-2,
    reach=1e4,
    any=1e300,
    large=1e100,
    slack=1e-2,
)
FLOAT = Rounding(
    rank=1e-5,
    pivot=5e-5,
    residual=5e-5,
    rounding=2e-7,
    step=5e-6,
    still=1e-7,
    closed=2e-5,
    accurate=2e-2,
    far=1e-2,
    reach=1e2,
    any=1e30,
    large=1e30,
    slack=1e-2,
)
