"""The rack and its pinion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ROTATION_1D, TRANSLATION_1D
from linegraph.components.scalar.base import TwoPort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Rack(TwoPort):
    """A rack and pinion, or a wheel on the road: ``X2 = radius X1``.

    Attributes:
        radius: of the pinion (m).

    Example:
        >>> Rack("steering", ("column", "ground"), ("rod", "ground"), radius=0.01).kind
        'rack'
    """

    radius: Any = None
    kind = "rack"
    domain_names = (ROTATION_1D.name, TRANSLATION_1D.name)
    required = ("radius",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """No power is kept."""
        r = at.value(self.radius)
        return at.X[1] - r * at.X[0], at.Y[0] + r * at.Y[1]
