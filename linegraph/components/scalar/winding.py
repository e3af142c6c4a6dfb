"""The winding on a magnetic path."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ELECTRICAL, MAGNETIC
from linegraph.components.scalar.base import TwoPort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Winding(TwoPort):
    """A winding: ``X1 = turns Y2``, the rate of flux, and ``X2 = -turns Y1``, its magnetomotive force.

    Attributes:
        turns: how often it goes around the path.

    Example:
        >>> Winding("primary", ("a", "ground"), ("core", "ground"), turns=200).kind
        'winding'
    """

    turns: Any = None
    kind = "winding"
    domain_names = (ELECTRICAL.name, MAGNETIC.name)
    required = ("turns",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Faraday's and Ampere's laws."""
        n = at.value(self.turns)
        return at.X[0] - n * at.Y[1], at.X[1] + n * at.Y[0]
