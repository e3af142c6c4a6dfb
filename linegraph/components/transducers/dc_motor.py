"""The motor of direct current."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import ACROSS, STATIC, THROUGH, Transducer

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class DcMotor(Transducer):
    """A motor of direct current behind a gear, w the rate of its joint or shaft.

    ``X = resistance Y + d/dt (inductance Y) + constant ratio w``, and it drives with
    ``constant ratio Y - ratio^2 (damping w + d/dt (inertia w))``.

    X is the voltage (V) and Y the current (A) of the armature, w in rad/s. One constant serves for torque and
    back-EMF, because the armature turns the power ``constant Y`` times the rotor's speed from electrical into
    mechanical without loss. The gear has no loss either; torques of the rotor reach the joint times
    `ratio`, its inertia and damping times the square of it.

    Attributes:
        constant: torque by current (N m/A), the same as back-EMF by speed (V s/rad).
        resistance: ohm.
        inductance: H; left out, the current follows at once and is no state.
        inertia: of the rotor (kg m^2).
        damping: of the rotor (N m s/rad).
        ratio: turns of the rotor for one of the joint or shaft.

    Example:
        >>> DcMotor("drive", ("plus", "ground"), joint="hinge", constant=0.04, resistance=2.4).kept()
        ('', '')
    """

    constant: Any = None
    resistance: Any = None
    inductance: Any = None
    inertia: Any = None
    damping: Any = None
    ratio: Any = 1
    kind = "dc_motor"
    domain_name = ELECTRICAL.name
    turns = True
    required = ("constant", "resistance")

    def kept(self) -> tuple[str, ...]:
        """Its current, where it has inductance, and its speed, where it has inertia."""
        first = STATIC if self.inductance is None else THROUGH
        return first, STATIC if self.inertia is None else ACROSS

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Voltage beside that of the inductance (V) and torque beside that of the inertia (N m).

        Without inductance or inertia, the residual instead: X or Y less that value.
        """
        n = at.value(self.ratio)
        k = at.value(self.constant) * n
        dragged = 0 if self.damping is None else n * n * at.value(self.damping) * at.X[1]
        voltage = at.value(self.resistance) * at.Y[0] + k * at.X[1]
        taken = dragged - k * at.Y[0]
        return (
            at.X[0] - voltage if self.inductance is None else voltage,
            at.Y[1] - taken if self.inertia is None else taken,
        )

    def kept_coenergy(self, at: Terminals) -> Scalar:
        """``inductance Y² / 2 + inertia (ratio w)² / 2`` (J), as far as it has them."""
        total: Scalar = 0
        if self.inductance is not None:
            total = total + at.value(self.inductance) * (at.Y[0] * at.Y[0] / 2)
        if self.inertia is not None:
            n = at.value(self.ratio)
            total = total + n * n * at.value(self.inertia) * (at.X[1] * at.X[1] / 2)
        return total

    def dissipation(self, at: Terminals) -> Scalar:
        """Heat of the winding and of the bearings: ``resistance Y² + damping (ratio w)²`` (W)."""
        lost = at.value(self.resistance) * (at.Y[0] * at.Y[0])
        if self.damping is None:
            return lost
        speed = at.value(self.ratio) * at.X[1]
        return lost + at.value(self.damping) * (speed * speed)
