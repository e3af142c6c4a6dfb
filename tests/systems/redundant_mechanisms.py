"""Seeded random mechanisms with joints that say again what others say, and the same without them.

A chain of one to three bodies hangs on ground by hinges, slides, balls and cylinders, or a coupler stands on
cranks that are parallel and equal. To some joints others are added that hold the same two bodies and allow
the same motion: a hinge further along the axis of a hinge, a cylinder or a ball on it, a slide parallel to
a slide, a ball in the centre of a ball; a third crank. These are off their places by a misalignment, a part
of the mechanism's size.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from oracles.closed_systems import direction
from oracles.newton_euler import turned
from support.spec_models import numbers, rows
from systems.random_trees import random_rotation

from linegraph import Model
from linegraph.components.joints import JOINTS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

SIZES = (1e-6, 1e-3, 1.0, 1e3, 1e6)
MISALIGNMENTS = (0.0, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10)

BESIDE = {
    "revolute": ("revolute", "revolute", "cylindrical", "spherical"),
    "prismatic": ("prismatic",),
    "cylindrical": ("cylindrical",),
    "spherical": ("spherical",),
}
"""What may stand beside a joint and allow all that it allows."""

FREEDOMS = {"revolute": 1, "prismatic": 1, "cylindrical": 2, "spherical": 3}

X, Y, Z = np.eye(3)


@dataclass
class Pair:
    """A mechanism with redundant joints, and the same without.

    Attributes:
        rng: where randomness comes from.
        size: a length (m).
        misalignment: of redundant joints, a part of that length, and an angle (rad).
        whole, plain: with and without.
        freedoms: the degrees of freedom of both.
        redundant: how many constraints of the whole follow from others.
    """

    rng: np.random.Generator
    size: float
    misalignment: float
    whole: Model
    plain: Model
    freedoms: int = 0
    redundant: int = 0
    ends: dict[tuple[str, str], Any] = field(default_factory=dict)

    def body(self, name: str) -> None:
        """A body with the inertia of a cloud of points, hence a valid one."""
        rng, size = self.rng, self.size
        mass = 1e3 * size**3 * rng.uniform(0.5, 2.0)
        points = rng.normal(scale=0.4 * size, size=(6, 3))
        points -= points.mean(axis=0)
        moments = mass / 6 * points.T @ points
        inertia = rows(np.trace(moments) * np.eye(3) - moments)
        center = numbers(rng.normal(scale=0.3 * size, size=3))
        for kind, model in (("whole", self.whole), ("plain", self.plain)):
            self.ends[kind, name] = model.body(
                name, mass=float(mass), mass_center=center, inertia=inertia
            )
            self.ends[kind, "ground"] = model.ground

    def joint(
        self,
        kind: str,
        name: str,
        ends: tuple[str, str],
        tail: tuple[Array, Array],
        head: tuple[Array, Array],
        redundant: bool = False,
        start: float | None = None,
    ) -> None:
        """A joint along z of two frames, each a place and axes; a redundant one is off its place."""
        at, turn = head
        if redundant:
            at = at + self.misalignment * self.size * direction(self.rng)
            turn = turn @ turned(direction(self.rng), self.misalignment)
        for which, model in (("whole", self.whole), ("plain", self.plain)):
            if redundant and which == "plain":
                continue
            near = self.ends[which, ends[0]].frame(
                f"{name}_tail", at=numbers(tail[0]), rotation=rows(tail[1])
            )
            far = self.ends[which, ends[1]].frame(
                f"{name}_head", at=numbers(at), rotation=rows(turn)
            )
            made = JOINTS[kind](name, (near, far), effort=not redundant, start=start)
            model.add_joint(made)


def random_pair(seed: int) -> Pair:
    """The pair of this number; 40 in a row have all sizes and all misalignments."""
    rng = np.random.default_rng([seed, 20261201])
    size, misalignment = SIZES[seed % 5], MISALIGNMENTS[seed // 5 % 8]
    gravity = numbers(9.81 * size * direction(rng))
    models = (Model("whole", gravity=gravity), Model("plain", gravity=gravity))
    pair = Pair(rng, size, misalignment, *models)
    (_cranks if seed // 40 % 5 == 4 else _chain)(pair)
    return pair


def _chain(pair: Pair) -> None:
    """One to three bodies one on another, and joints beside at least one of their joints."""
    rng, size = pair.rng, pair.size
    count = int(rng.integers(1, 4))
    doubled = set(rng.permutation(count)[: int(rng.integers(1, count + 1))].tolist())
    for k in range(count):
        pair.body(f"b{k}")
        near, far = ("ground" if k == 0 else f"b{k - 1}"), f"b{k}"
        kind = str(rng.choice(["revolute", "revolute", "prismatic", "cylindrical", "spherical"]))
        tail = rng.normal(scale=size, size=3), random_rotation(rng)
        head = rng.normal(scale=size, size=3), random_rotation(rng)
        pair.joint(kind, f"j{k}", (near, far), tail, head)
        pair.freedoms += FREEDOMS[kind]
        for i in range(int(rng.integers(1, 3)) if k in doubled else 0):
            other = str(rng.choice(BESIDE[kind]))
            shift = _apart(rng, kind, size)
            places = [(at + turn @ shift, turn) for at, turn in (tail, head)]
            pair.joint(other, f"r{k}{i}", (near, far), places[0], places[1], redundant=True)
            pair.redundant += 6 - FREEDOMS[other]


def _apart(rng: np.random.Generator, kind: str, size: float) -> Array:
    """Where another joint may stand, in the axes of the first: along its axis, anywhere, or in its place."""
    if kind == "prismatic":
        return np.asarray(rng.normal(scale=size, size=3))
    if kind == "spherical" or rng.random() < 0.25:
        return np.zeros(3)
    return np.asarray(rng.normal(scale=size) * Z)


def _cranks(pair: Pair) -> None:
    """A coupler on two equal parallel cranks, and on a third one that is redundant."""
    rng, size = pair.rng, pair.size
    base, turn = rng.normal(scale=size, size=3), random_rotation(rng)
    length, angle = rng.uniform(0.4, 1.2) * size, float(rng.uniform(0.7, 1.2))
    pair.freedoms, pair.redundant = 1, 6 * 5 - (4 * 6 - 1)
    pair.body("coupler")
    feet = [np.zeros(3), size * X, size * np.array([0.3, 0.4, rng.normal()])]
    pair.ends["whole", "crank2"] = pair.whole.body("crank2")
    for k, foot in enumerate(feet):
        name, redundant = f"crank{k}", k == 2
        if not redundant:
            pair.body(name)
        for kind, ends, tail, head, start in (
            ("foot", ("ground", name), (base + turn @ foot, turn), (0 * X, np.eye(3)), angle),
            ("hand", (name, "coupler"), (length * X, np.eye(3)), (foot, np.eye(3)), -angle),
        ):
            pair.joint("revolute", f"{kind}{k}", ends, tail, head, redundant, start)
