"""The moving coil: loudspeaker, voice coil, shaker."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import STATIC, THROUGH, Transducer

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class MovingCoil(Transducer):
    """A coil in a magnet's field: ``X = resistance Y + d/dt (inductance Y) + constant w``.

    It pushes with ``constant Y`` (N) along w (m/s). X is the voltage (V) and Y the current (A) of the coil.
    Induction and Laplace's force have one constant, so the field takes no power: the back-EMF takes
    ``(constant w) Y`` from the network, and the force gives as much to mechanics.

    Attributes:
        constant: flux density times length of wire, B l (N/A, the same as V s/m).
        resistance: ohm; 0 if left out.
        inductance: H; left out, the current is no state.

    Example:
        >>> MovingCoil("coil", ("plus", "ground"), joint="cone", constant=7.0).kind
        'moving_coil'
    """

    constant: Any = None
    resistance: Any = 0
    inductance: Any = None
    kind = "moving_coil"
    domain_name = ELECTRICAL.name
    required = ("constant",)

    def kept(self) -> tuple[str, ...]:
        """Its current, where it has inductance; nothing in mechanics."""
        return STATIC if self.inductance is None else THROUGH, STATIC

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Voltage beside that of the inductance (V), and Y plus Laplace's force (N).

        Without inductance the first is the residual X less that voltage.
        """
        k = at.value(self.constant)
        voltage = at.value(self.resistance) * at.Y[0] + k * at.X[1]
        force = k * at.Y[0]
        return at.X[0] - voltage if self.inductance is None else voltage, at.Y[1] + force

    def kept_coenergy(self, at: Terminals) -> Scalar:
        """``inductance Y² / 2`` (J); 0 without inductance."""
        if self.inductance is None:
            return 0
        return at.value(self.inductance) * (at.Y[0] * at.Y[0] / 2)

    def dissipation(self, at: Terminals) -> Scalar:
        """Heat of the winding: ``resistance Y²`` (W)."""
        return at.value(self.resistance) * (at.Y[0] * at.Y[0])
