"""The ideal transformer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import Pair, Port, TwoPort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Transformer(TwoPort):
    """An ideal transformer: ``X1 = ratio X2``, ``Y2 = -ratio Y1``, also of direct current.

    Attributes:
        ratio: n; it may depend on any variable.
        domains: of its first and of its second edge, "electrical" if left out.

    Example:
        >>> Transformer("T", ("a", "ground"), ("b", "ground"), ratio=10.0).kind
        'transformer'
    """

    ratio: Any = None
    domains: Pair = (ELECTRICAL.name, ELECTRICAL.name)
    kind = "transformer"
    required = ("ratio",)

    def ports(self) -> tuple[Port, ...]:
        """Both edges, each in its subspace."""
        first, second = self.domains
        return Port("first", first, self.between), Port("second", second, self.second)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """No power is kept."""
        n = at.value(self.ratio)
        return at.X[0] - n * at.X[1], at.Y[1] + n * at.Y[0]
