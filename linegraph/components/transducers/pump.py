"""Machines that displace a liquid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import HYDRAULIC
from linegraph.components.scalar.base import Transducer

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Pump(Transducer):
    """A pump of positive displacement: ``Y = displacement w + leakage X``.

    Its shaft feels ``displacement X``. Liquid flows from tail to head as the joint or shaft turns forward,
    so the pressure rises along it.

    w in rad/s, X the pressure of the tail less that of the head (Pa), Y the flow from tail to head (m^3/s).
    A pump in use has X < 0, and the torque ``displacement X`` opposes its turning. Only the leakage, back
    through the gap, loses power.

    Attributes:
        displacement: volume by angle (m^3/rad).
        leakage: flow by pressure (m^3/s/Pa).

    Example:
        >>> Pump("pump", ("tank", "line"), joint="axle", displacement=1e-6).kind
        'pump'
    """

    displacement: Any = None
    leakage: Any = 0
    kind = "pump"
    domain_name = HYDRAULIC.name
    turns = True
    required = ("displacement",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Flow less displacement and leakage (m^3/s), and Y plus the torque (N m), both zero."""
        d = at.value(self.displacement)
        flow = d * at.X[1] + at.value(self.leakage) * at.X[0]
        return at.Y[0] - flow, at.Y[1] + d * at.X[0]

    def dissipation(self, at: Terminals) -> Scalar:
        """Heat of the leakage: ``leakage X²`` (W)."""
        return at.value(self.leakage) * (at.X[0] * at.X[0])


@dataclass(frozen=True)
class HydraulicMotor(Pump):
    """A hydraulic motor, a pump run backwards: it drives with ``displacement X``, the pressure drop.

    ``Y = displacement w + leakage X``, as of a pump: X > 0 drives it forward (N m), and liquid flows from
    tail to head.

    Example:
        >>> HydraulicMotor("motor", ("line", "tank"), joint="axle", displacement=1e-6).kind
        'hydraulic_motor'
    """

    kind = "hydraulic_motor"
