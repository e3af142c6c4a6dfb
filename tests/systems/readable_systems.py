"""Seeded random systems of the size people read: every kind of joint, parameters as symbols or as numbers.

Axes are mostly those of frames and places lie along them, as people draw them. The same seed gives the same
system with symbols and with numbers: what is drawn does not depend on it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linegraph import Model

KINDS = (
    *("revolute", "prismatic", "universal", "spherical xyz", "cylindrical", "spherical"),
    *("helical", "planar", "free", "compound", "spherical zxz", "free zyx"),
)
"""The kinds of the first joint, one after the other; the joints after it have one freedom."""

SINGLE = ("revolute", "revolute", "prismatic")
AXES = np.eye(3, dtype=int)


class Drawn:
    """A system being drawn.

    Attributes:
        model: the model.
        values: of its parameters, also of those written as numbers.
        driven: whether a joint has, or would have if drives were wanted, a prescribed motion.
    """

    def __init__(self, seed: int, *, symbolic: bool, elements: bool = True, drives: bool = True):
        """Draw the bodies one after the other."""
        self.rng, self.symbolic = np.random.default_rng([seed, 7]), symbolic
        self.model = Model(f"readable{seed}")
        self.values: dict[str, float] = {}
        self.elements, self.drives, self.driven = elements, drives, False
        self.model.gravity = (0, 0, -1 * self.value("g", 9.81))
        self.bodies: list[Any] = []
        self.single: list[str] = []
        count = 1 + seed // len(KINDS) % 3
        for k in range(count):
            kind = KINDS[seed % len(KINDS)] if k == 0 else str(self.rng.choice(SINGLE))
            self._add(k, kind, last=k == count - 1)
        self._apply()

    def value(self, name: str, exact: float | None = None) -> Any:
        """A parameter with this value, or the value alone."""
        number = float(round(self.rng.uniform(0.3, 2.0), 2)) if exact is None else exact
        if name not in self.values and self.symbolic:
            self.model.parameter(name, number)
        self.values[name] = number
        return self.model.parameters[name] if self.symbolic else number

    def axis(self) -> tuple[int, ...]:
        """A direction of the frame's, of either sign."""
        chosen = AXES[int(self.rng.integers(3))] * int(self.rng.choice([-1, 1, 1]))
        return tuple(int(x) for x in chosen)

    def place(self, name: str) -> tuple[Any, Any, Any]:
        """A point on a coordinate axis."""
        found: list[Any] = [0, 0, 0]
        found[int(self.rng.integers(3))] = self.value(name)
        return found[0], found[1], found[2]

    def _add(self, k: int, kind: str, *, last: bool) -> None:
        names = [f"{letter}{k}" for letter in "ABC"]
        moments = tuple(self.value(name) for name in names)
        body = self.model.body(
            f"b{k}", mass=self.value(f"m{k}"), mass_center=self.place(f"c{k}"), inertia=moments
        )
        near = self.bodies[-1] if self.bodies else self.model.ground
        ends: tuple[Any, Any] = (near.frame(f"out{k}", at=self.place(f"l{k}")), body)
        if self.rng.random() < 0.25:
            ends = (ends[1], ends[0])
        word, _, angles = kind.partition(" ")
        options: dict[str, Any] = {"angles": angles} if angles else {}
        if word in ("revolute", "prismatic", "helical", "cylindrical", "planar"):
            options["axis"] = self.axis()
        if word == "helical":
            options["lead"] = self.value(f"h{k}")
        if word == "universal":
            options["axes"] = ((1, 0, 0), (0, 1, 0))
        if word == "compound":
            options["parts"] = (("revolute", self.axis()), ("prismatic", self.axis()))
        driven = self.rng.random() < 0.3
        if word in ("revolute", "prismatic"):
            driven = driven and not last
            self.driven |= driven
            if driven and self.drives:
                w = self.value("w", 1.25)
                options["motion"] = f"0.5*sin({'w' if self.symbolic else w}*t)"
            else:
                self.single.append(f"j{k}")
        getattr(self.model, word)(f"j{k}", between=ends, **options)
        self.bodies.append(body)

    def _apply(self) -> None:
        """A spring and a damper in joints, a spring between points, a load that an input drives."""
        if not self.elements:
            return
        for joint in self.single[:1]:
            self.model.spring("coil", joint=joint, stiffness=self.value("k"), length=0.25)
            self.model.damper("oil", joint=joint, damping=self.value("c"))
        if self.rng.random() < 0.3:
            hook = self.model.ground.frame("hook", at=(0, 3, 1))
            self.model.spring("rope", between=(hook, self.bodies[-1]), stiffness=self.value("kr"))
        self.model.input("pull")
        self.model.load("hand", at=self.bodies[-1], force=("pull", 0, 1), torque=(0, "pull", 0))


def system(seed: int, *, symbolic: bool, elements: bool = True, drives: bool = True) -> Drawn:
    """The system of this number."""
    return Drawn(seed, symbolic=symbolic, elements=elements, drives=drives)
