"""The drag of a fluid on a body: quadratic in the velocity relative to the fluid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.forces.point_force import PointForce
from linegraph.spatial.vector import ZERO, Vector, dot, scale, subtract

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.components.forces.base import Resolve
    from linegraph.components.forces.point_force import PointMotion


@dataclass(frozen=True)
class Drag(PointForce):
    """A quadratic drag: ``force = -coefficient |u| u``, u the velocity of the terminal less `wind`.

    The coefficient of a blunt body is ``rho c A / 2`` with the density of the fluid, the drag coefficient and
    the frontal area. Relative to the fluid it only takes energy: the power ``force . u`` is never positive.

    Attributes:
        name: also the name of its edges.
        at: the terminal it acts on, the centre of pressure.
        coefficient: N s^2/m^2; an expression of t, coordinates, inputs and parameters.
        wind: the velocity of the fluid in ground axes (m/s), three such expressions.

    Example:
        >>> Drag("air", "ball", coefficient=0.01).wind
        (0, 0, 0)
    """

    coefficient: Any = 0
    wind: Vector = ZERO

    kind = "drag"
    vectors = ("wind",)
    needs = (("coefficient",),)

    def values(self) -> tuple[Any, ...]:
        """The coefficient and the three components of the wind."""
        return (self.coefficient, *self.wind)

    def wrench(
        self, algebra: Algebra, point: PointMotion, resolve: Resolve
    ) -> tuple[Vector, Vector]:
        """The force opposite to the velocity relative to the fluid; no torque.

        Args:
            algebra: the algebra to calculate in.
            point: how the terminal moves.
            resolve: from model values to scalars.
        """
        x, y, z = self.wind
        u = subtract(point.linear, (resolve(x), resolve(y), resolve(z)))
        # the limit at 0 is written out: derivatives of a bare root would be 0 over 0 at rest, not 0
        speed = algebra.sqrt(algebra.function("max", dot(u, u), 0))
        return scale(-(resolve(self.coefficient) * speed), u), ZERO
