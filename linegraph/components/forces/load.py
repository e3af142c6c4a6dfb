"""Applied forces and torques: given vectors on a body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.forces.point_force import PointForce
from linegraph.spatial.vector import ZERO, Vector, times

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.components.forces.base import Resolve
    from linegraph.components.forces.point_force import PointMotion

WORLD, BODY = "world", "body"


@dataclass(frozen=True)
class Load(PointForce):
    """A force (N) and a torque (N m) on a body at a terminal, from ground.

    Attributes:
        name: also the name of its edges.
        at: the terminal it acts on; the force acts at its origin.
        force, torque: three expressions of t, coordinates, inputs and parameters each.
        axes: "world", resolved in ground axes, or "body", in the terminal's own.

    Example:
        >>> Load("wind", "mast.top", force=(3.0, 0, 0)).axes
        'world'
    """

    force: Vector = ZERO
    torque: Vector = ZERO
    axes: str = WORLD

    kind = "load"
    vectors = ("force", "torque")
    needs = (("force", "torque"),)

    def values(self) -> tuple[Any, ...]:
        """The six model values of force and torque."""
        return (*self.force, *self.torque)

    def wrench(
        self, algebra: Algebra, point: PointMotion, resolve: Resolve
    ) -> tuple[Vector, Vector]:
        """The force and the torque as given, turned into ground axes if they are given in the body's.

        Args:
            algebra: the algebra to calculate in.
            point: how the terminal moves.
            resolve: from model values to scalars.
        """
        (fx, fy, fz), (tx, ty, tz) = self.force, self.torque
        force = (resolve(fx), resolve(fy), resolve(fz))
        torque = (resolve(tx), resolve(ty), resolve(tz))
        if self.axes == BODY:
            return times(point.rotation, force), times(point.rotation, torque)
        return force, torque
