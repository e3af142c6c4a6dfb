"""The status codes of emitted functions: the only list of statuses and their numbers.

A number stands for one status in all functions of a module and in all modules: velocities count from 1, the
statuses of this list from 900, and what comes after the velocities leaves these numbers out.
"""

from __future__ import annotations

from linegraph.ir.program import Status

NO_LOOP_SOLUTION = Status(
    900,
    "the algebraic loop of the network has no solution here, has several, or none was found",
    "NO_LOOP_SOLUTION",
)
SINGULAR_NETWORK = Status(
    901,
    "the static laws of the network are singular here: a resistance or a ratio is zero",
    "SINGULAR_NETWORK",
)
NOT_FINITE_INPUT = Status(902, "an argument is infinite or not a number", "NOT_FINITE_INPUT")
NOT_FINITE = Status(
    903, "a result would be infinite or not a number: too large, or not defined here", "NOT_FINITE"
)
SINGULAR_POSITION = Status(
    904,
    "the position is singular, or too near to one: more motions are free there than elsewhere",
    "SINGULAR_POSITION",
)
SINGULAR_INERTIA = Status(
    905, "the mass matrix is singular on the motions that the constraints allow", "SINGULAR_INERTIA"
)
CONTRADICTION = Status(906, "the constraints contradict each other", "CONTRADICTION")
NOT_CLOSED = Status(907, "no position that satisfies the constraints was found", "NOT_CLOSED")
NO_VELOCITY = Status(908, "the constraints of velocity contradict each other", "NO_VELOCITY")
NOT_DETERMINED = Status(
    909,
    "the independent coordinates do not determine the others here, or not with certainty",
    "NOT_DETERMINED",
)

COMMON = (
    NO_LOOP_SOLUTION,
    SINGULAR_NETWORK,
    NOT_FINITE_INPUT,
    NOT_FINITE,
    SINGULAR_POSITION,
    SINGULAR_INERTIA,
    CONTRADICTION,
    NOT_CLOSED,
    NO_VELOCITY,
    NOT_DETERMINED,
)
"""Those that do not depend on the model."""

FIRST, LAST = 900, 999
"""The numbers that are kept for `COMMON`."""


def counted(place: int) -> int:
    """The status number of the item at an index: 1, 2, ... without the numbers kept for `COMMON`.

    Example:
        >>> counted(0), counted(898), counted(899)
        (1, 899, 1000)
    """
    return place + 1 if place + 1 < FIRST else place + 2 + LAST - FIRST


def singular_at(place: int, velocity: str) -> Status:
    """The status that the mass matrix is singular at a velocity.

    Args:
        place: the index of the velocity in v; it determines the number of the status.
        velocity: the name of the velocity, for the text and the name of the status.
    """
    about = f"the mass matrix is singular at {velocity}"
    return Status(counted(place), about, f"SINGULAR_AT_{velocity}")
