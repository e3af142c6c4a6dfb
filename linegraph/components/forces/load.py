"""Applied forces and torques: given vectors on a body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from linegraph.spatial.vector import ZERO, Vector

WORLD, BODY = "world", "body"


@dataclass(frozen=True)
class Load:
    """A force (N) and a torque (N m) on a body at a terminal, from ground.

    Its edges run from ground to the terminal, in translation and in rotation; their through variables are the
    force and the torque that it exerts on the body. It does the work ``force . velocity`` of the terminal's
    origin and ``torque . angular velocity`` of the body.

    Attributes:
        name: also the name of its edges.
        at: the terminal it acts on; the force acts at its origin.
        force, torque: three expressions of t, coordinates, inputs and parameters each.
        axes: "world", resolved in ground axes, or "body", in the terminal's own.

    Example:
        >>> Load("wind", "mast.top", force=(3.0, 0, 0)).axes
        'world'
    """

    name: str
    at: str
    force: Vector = ZERO
    torque: Vector = ZERO
    axes: str = WORLD

    kind: ClassVar[str] = "load"

    def values(self) -> tuple[Any, ...]:
        """The six model values of force and torque."""
        return (*self.force, *self.torque)
