"""The ideal gyrator."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import Pair, Port, TwoPort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Gyrator(TwoPort):
    """An ideal gyrator: ``X1 = ratio Y2``, ``X2 = -ratio Y1``.

    Attributes:
        ratio: ohm; it may depend on any variable.
        domains: of its first and of its second edge, "electrical" if left out.

    Example:
        >>> Gyrator("G", ("a", "ground"), ("b", "ground"), ratio=50.0).kind
        'gyrator'
    """

    ratio: Any = None
    domains: Pair = (ELECTRICAL.name, ELECTRICAL.name)
    kind = "gyrator"
    required = ("ratio",)

    def ports(self) -> tuple[Port, ...]:
        """Both edges, each in its subspace."""
        first, second = self.domains
        return Port("first", first, self.between), Port("second", second, self.second)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """No power is kept."""
        g = at.value(self.ratio)
        return at.X[0] - g * at.Y[1], at.X[1] + g * at.Y[0]
