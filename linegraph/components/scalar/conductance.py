"""The conductance: a current in proportion to the voltage."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import Dissipator

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


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
