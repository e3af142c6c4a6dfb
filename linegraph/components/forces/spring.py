"""The spring: linear by its stiffness, or by any law."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.forces.base import Element

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.forces.base import Resolve


@dataclass(frozen=True)
class Spring(Element):
    """A spring: ``through = stiffness (x - length)``, or `force` as a law of the stretch and its rate.

    Stretched, x > length, it pulls the points together or the coordinate back. Its energy is
    ``stiffness (x - length)² / 2`` (J), or the integral of the law over the stretch.

    Attributes:
        stiffness: N/m, or N m/rad in a revolute joint.
        length: x of the unstrained spring.
        force: instead of `stiffness`, an expression in x, the stretch beyond `length`, and v, its rate.
        energy: its potential energy (J), an expression in x whose derivative is the force at v = 0, where
            that cannot be integrated.

    Example:
        >>> Spring("strut", ("ground", "cart"), stiffness=200.0, length=0.4).kind
        'spring'
    """

    stiffness: Any = None
    length: Any = 0
    force: Any = None
    energy: Any = None
    kind = "spring"
    laws = ("force", "energy")
    needs = (("stiffness", "force"),)

    def through(self, algebra: Algebra, x: Scalar, v: Scalar, resolve: Resolve) -> Scalar:
        """The tension (N) or torque (N m) of the stretch ``x - length``."""
        stretch = x - resolve(self.length)
        if self.force is not None:
            return resolve(self.force, x=stretch, v=v)
        return resolve(self.stiffness) * stretch

    def potential(self, algebra: Algebra, x: Scalar, resolve: Resolve) -> Scalar:
        """``stiffness (x - length)² / 2`` (J); 0 for a law, which `dynamics.potentials` integrates."""
        if self.force is not None:
            return 0
        stretch = x - resolve(self.length)
        return resolve(self.stiffness) * (stretch * stretch) / 2
