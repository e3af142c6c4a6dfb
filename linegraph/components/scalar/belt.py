"""The belt between two pulleys."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ROTATION_1D
from linegraph.components.scalar.base import TwoPort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Belt(TwoPort):
    """A belt without slip: ``radius1 X1 = radius2 X2``; crossed, one radius is negative.

    Attributes:
        radius1: of the first pulley (m).
        radius2: of the second pulley (m).

    Example:
        >>> Belt("belt", ("motor", "ground"), ("load", "ground"), radius1=0.02, radius2=0.1).kind
        'belt'
    """

    radius1: Any = None
    radius2: Any = None
    kind = "belt"
    domain_names = (ROTATION_1D.name, ROTATION_1D.name)
    required = ("radius1", "radius2")

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """No power is kept."""
        first, second = at.value(self.radius1), at.value(self.radius2)
        return first * at.X[0] - second * at.X[1], first * at.Y[1] + second * at.Y[0]
