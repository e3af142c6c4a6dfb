"""The lever of 1-D translation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import TRANSLATION_1D
from linegraph.components.scalar.base import TwoPort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Lever(TwoPort):
    """A lever: ``X1 = ratio X2``; negative where the ends move against each other.

    Attributes:
        ratio: arm of the first end over that of the second.

    Example:
        >>> Lever("beam", ("a", "ground"), ("b", "ground"), ratio=-2.0).kind
        'lever'
    """

    ratio: Any = None
    kind = "lever"
    domain_names = (TRANSLATION_1D.name, TRANSLATION_1D.name)
    required = ("ratio",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """No power is kept."""
        n = at.value(self.ratio)
        return at.X[0] - n * at.X[1], at.Y[1] + n * at.Y[0]
