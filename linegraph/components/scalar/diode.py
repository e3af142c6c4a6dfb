"""The diode by Shockley's law."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import Dissipator

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Diode(Dissipator):
    """A diode: ``Y = saturation (exp(X / voltage) - 1)``.

    Attributes:
        saturation: the current it lets through backwards (A).
        voltage: thermal voltage times ideality (V).

    Example:
        >>> Diode("D1", ("in", "out"), saturation=1e-12).kind
        'diode'
    """

    saturation: Any = 1e-14
    voltage: Any = 0.02585
    kind = "diode"
    domain_name = ELECTRICAL.name

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Shockley's law."""
        grown = at.function("exp", at.X[0] / at.value(self.voltage))
        return (at.Y[0] - at.value(self.saturation) * (grown - 1),)
