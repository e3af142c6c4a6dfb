"""The gear of 1-D rotation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ROTATION_1D
from linegraph.components.scalar.base import TwoPort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Gear(TwoPort):
    """A gear: ``X1 = ratio X2``; negative where the shafts turn against each other, as outer gears do.

    Attributes:
        ratio: turns of the first shaft for one of the second.

    Example:
        >>> Gear("gear", ("motor", "ground"), ("load", "ground"), ratio=-4.0).kind
        'gear'
    """

    ratio: Any = None
    kind = "gear"
    domain_names = (ROTATION_1D.name, ROTATION_1D.name)
    required = ("ratio",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """No power is kept."""
        n = at.value(self.ratio)
        return at.X[0] - n * at.X[1], at.Y[1] + n * at.Y[0]
