"""Friction: viscous, and Coulomb's smoothed around standstill."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.forces.base import Element

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.forces.base import Resolve


@dataclass(frozen=True)
class Friction(Element):
    """Friction: ``through = viscous v + coulomb tanh(v / width)``.

    It opposes the rate v. The hyperbolic tangent makes the jump of Coulomb's law at standstill smooth
    [Andersson et al. 2007]: without it the law has no derivative there and no unique force at rest. The
    price is that a load smaller than `coulomb` lets the element creep, at a rate of the order of `width`.

    Attributes:
        viscous: N s/m, or N m s/rad in a revolute joint.
        coulomb: the force or torque of dry friction in motion (N or N m).
        width: the rate at which dry friction has risen to 76 % (m/s or rad/s).

    Example:
        >>> Friction("bearing", joint="hinge", coulomb=0.02).width
        0.001
    """

    viscous: Any = 0
    coulomb: Any = 0
    width: Any = 1e-3
    kind = "friction"
    needs = (("viscous", "coulomb"),)

    def through(self, algebra: Algebra, x: Scalar, v: Scalar, resolve: Resolve) -> Scalar:
        """Viscous and dry friction (N or N m), opposed to the rate."""
        dry = algebra.function("tanh", v / resolve(self.width))
        return resolve(self.viscous) * v + resolve(self.coulomb) * dry
