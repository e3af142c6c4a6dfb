"""The lead screw."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ROTATION_1D, TRANSLATION_1D
from linegraph.components.scalar.base import TwoPort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Screw(TwoPort):
    """A lead screw: ``X2 = lead / (2 pi) X1``.

    Attributes:
        lead: way for one turn (m).

    Example:
        >>> Screw("spindle", ("motor", "ground"), ("table", "ground"), lead=0.005).kind
        'screw'
    """

    lead: Any = None
    kind = "screw"
    domain_names = (ROTATION_1D.name, TRANSLATION_1D.name)
    required = ("lead",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """No power is kept."""
        r = at.value(self.lead) / (2 * pi)
        return at.X[1] - r * at.X[0], at.Y[0] + r * at.Y[1]
