"""The damper: a force in proportion to a rate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.forces.base import Element

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.forces.base import Resolve


@dataclass(frozen=True)
class Damper(Element):
    """A viscous damper: ``through = damping v``.

    v > 0 lengthens the element, or moves the coordinate forward, and the damper pulls back. It turns
    ``damping v²`` (W) into heat.

    Attributes:
        damping: N s/m, or N m s/rad in a revolute joint.

    Example:
        >>> Damper("bearing", joint="hinge", damping=1e-4).kind
        'damper'
    """

    damping: Any = 0
    kind = "damper"
    needs = (("damping",),)

    def through(self, algebra: Algebra, x: Scalar, v: Scalar, resolve: Resolve) -> Scalar:
        """``damping v`` (N or N m), opposed to the rate."""
        return resolve(self.damping) * v
