"""The conductance: a current in proportion to the voltage."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.base import Dissipator
from linegraph.domains import ELECTRICAL

if TYPE_CHECKING:
    from linegraph.components.base import Terminals
    from linegraph.vector import Scalar


@dataclass(frozen=True)
class Conductance(Dissipator):
    """A conductance: ``Y = conductance X``.

    Attributes:
        conductance: S; it may be 0, an open switch.

    Example:
        >>> Conductance("leak", ("plate", "ground"), conductance=1e-9).kind
        'conductance'
    """

    conductance: Any = None
    kind = "conductance"
    domain_name = ELECTRICAL.name
    required = ("conductance",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Ohm's law."""
        return (at.Y[0] - at.value(self.conductance) * at.X[0],)
