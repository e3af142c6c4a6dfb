"""Plane mechanisms of one freedom in closed form, written apart from linegraph.

Where every body is a function of one coordinate s, the energies say all:

    J(s) s̈ + 1/2 J'(s) ṡ² + V'(s) = Q        J = sum m |r'|² + I φ'²

Derivatives of the places are differences with 50 digits. Reactions follow body by body from Newton's
and Euler's laws, all at once as one linear system.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from mpmath import mp

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    Array = Any

DIGITS = 50


@dataclass(frozen=True)
class Body:
    """A body in the plane x, y.

    Attributes:
        mass, inertia: the latter about its mass centre.
        place: (x, y, angle) of the mass centre as functions of s, over mpmath.
    """

    mass: float
    inertia: float
    place: Callable[[Any], tuple[Any, Any, Any]]


class Course(NamedTuple):
    """A quantity along s: its value and its first two derivatives by s."""

    x: float
    dx: float
    ddx: float

    def rate(self, w: float) -> float:
        """Its rate."""
        return self.dx * w

    def acceleration(self, w: float, a: float) -> float:
        """Its second derivative by time."""
        return self.ddx * w * w + self.dx * a


def course(function: Callable[[Any], Any], s: float) -> Course:
    """A function of s and its derivatives."""
    with mp.workdps(DIGITS):
        found = mp.taylor(function, mp.mpf(s), 2)
        return Course(float(found[0]), float(found[1]), float(2 * found[2]))


def courses(body: Body, s: float) -> tuple[Course, Course, Course]:
    """x, y and angle of a body."""
    x, y, angle = (course(lambda s, k=k: body.place(s)[k], s) for k in range(3))
    return x, y, angle


def acceleration(bodies: Sequence[Body], s: float, w: float, gravity: float, force: float) -> float:
    """s̈ under gravity along -y and a generalised force."""
    inertia = half_rate = weight = 0.0
    for body in bodies:
        x, y, angle = courses(body, s)
        for part, share in ((x, body.mass), (y, body.mass), (angle, body.inertia)):
            inertia += share * part.dx * part.dx
            half_rate += share * part.dx * part.ddx
        weight += body.mass * gravity * y.dx
    return (force - half_rate * w * w - weight) / inertia


class Pin(NamedTuple):
    """A joint in the plane.

    Attributes:
        tail, head: bodies by name; None for ground.
        at: the point about which it acts.
        free: the entries of (force x, force y, torque) on its head that are unknown.
    """

    tail: str | None
    head: str
    at: tuple[float, float]
    free: tuple[int, ...] = (0, 1)


class Moving(NamedTuple):
    """A body in motion, and the force and torque about its mass centre that elements and gravity exert."""

    mass: float
    inertia: float
    at: tuple[float, float]
    acceleration: tuple[float, float, float]
    applied: tuple[float, float, float]


def moving(body: Body, s: float, w: float, a: float, applied: Sequence[float]) -> Moving:
    """A body as it moves along s."""
    x, y, angle = courses(body, s)
    change = (x.acceleration(w, a), y.acceleration(w, a), angle.acceleration(w, a))
    return Moving(body.mass, body.inertia, (x.x, y.x), change, tuple(applied))


def reactions(bodies: Mapping[str, Moving], pins: Mapping[str, Pin]) -> dict[str, Array]:
    """(force x, force y, torque) of every joint on its head: three equations for each body."""
    names = list(bodies)
    unknown = [(pin, entry) for pin in pins for entry in pins[pin].free]
    matrix = np.zeros((3 * len(names), len(unknown)))
    for column, (name, entry) in enumerate(unknown):
        pin = pins[name]
        for body, sign in ((pin.head, 1.0), (pin.tail, -1.0)):
            if body is not None:
                rows = slice(3 * names.index(body), 3 * names.index(body) + 3)
                matrix[rows, column] += sign * _about(pin.at, bodies[body].at, np.eye(3)[entry])
    right = np.concatenate(
        [
            np.array([b.mass, b.mass, b.inertia]) * b.acceleration - np.array(b.applied)
            for b in bodies.values()
        ]
    )
    solution = np.linalg.solve(matrix, right)
    found = {name: np.zeros(3) for name in pins}
    for (name, entry), value in zip(unknown, solution, strict=True):
        found[name][entry] = value
    return found


def _about(old: Sequence[float], new: Sequence[float], wrench: Array) -> Array:
    """A force with a torque about another point."""
    x, y = old[0] - new[0], old[1] - new[1]
    return np.array([wrench[0], wrench[1], wrench[2] + x * wrench[1] - y * wrench[0]])
