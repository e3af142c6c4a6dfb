"""Stops: a smooth law that keeps a distance or a coordinate within limits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.forces.base import Element

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.forces.base import Resolve


@dataclass(frozen=True)
class Stop(Element):
    """Elastic limits: ``through = stiffness (p(x - upper) - p(lower - x))`` plus damping in contact.

    p(d) = (d + sqrt(d^2 + width^2)) / 2 is a smooth max(d, 0): far inside the limits it falls off as width^2
    / (4 d). In contact the damping acts in proportion to dp/dd, which rises from 0 to 1, so that it does not
    set in with a jump. Beyond `upper` the element pulls back, beyond `lower` it pushes.

    Attributes:
        lower, upper: limits of x; None where there is none.
        stiffness: N/m, or N m/rad in a revolute joint.
        damping: N s/m, or N m s/rad.
        width: how far from the limit the law is rounded (m or rad).

    Example:
        >>> Stop("end", joint="slide", upper=0.5, stiffness=1e4).kind
        'stop'
    """

    lower: Any = None
    upper: Any = None
    stiffness: Any = 0
    damping: Any = 0
    width: Any = 1e-3
    kind = "stop"
    needs = (("lower", "upper"), ("stiffness",))

    def through(self, algebra: Algebra, x: Scalar, v: Scalar, resolve: Resolve) -> Scalar:
        """The force (N) or torque (N m) of both limits, back into the range between them."""
        total: Scalar = 0
        if self.upper is not None:
            total = total + self._push(algebra, x - resolve(self.upper), v, resolve)
        if self.lower is not None:
            total = total - self._push(algebra, resolve(self.lower) - x, -v, resolve)
        return total

    def _push(self, algebra: Algebra, depth: Scalar, rate: Scalar, resolve: Resolve) -> Scalar:
        width = resolve(self.width)
        root = algebra.sqrt(depth * depth + width * width)
        contact = (1 + depth / root) / 2
        depth_rounded = (depth + root) / 2
        return resolve(self.stiffness) * depth_rounded + resolve(self.damping) * (contact * rate)

    def potential(self, algebra: Algebra, x: Scalar, resolve: Resolve) -> Scalar:
        """``stiffness`` times the integral of p over the depth beyond each limit (J), 0 at the limits."""
        total: Scalar = 0
        if self.upper is not None:
            total = total + self._held(algebra, x - resolve(self.upper), resolve)
        if self.lower is not None:
            total = total + self._held(algebra, resolve(self.lower) - x, resolve)
        return total

    def _held(self, algebra: Algebra, depth: Scalar, resolve: Resolve) -> Scalar:
        """The integral of p: ``(d² + d r + width² asinh(d/width)) / 4`` with ``r² = d² + width²``."""
        width = resolve(self.width)
        root = algebra.sqrt(depth * depth + width * width)
        size = algebra.function("abs", depth)
        # asinh, of the size: for a negative argument the sum would cancel
        grown = algebra.function("log", (size + root) / width)
        turned = algebra.function("sign", depth) * grown
        return resolve(self.stiffness) * ((depth * (depth + root) + width * width * turned) / 4)
