"""The piezo stack."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import ACROSS, STATIC, Transducer

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Piezo(Transducer):
    """A piezo stack: charge ``capacitance v + coupling x``; it pushes with ``coupling v - stiffness x``.

    v is the voltage (V), x the displacement of its mechanical port (m): its length beyond that at rest. Both
    follow from ``W' = capacitance v² / 2 + coupling v x - stiffness x² / 2``, the linear equations of
    piezoelectricity [IEEE 176-1987] integrated over a stack in which field and strain are uniform.

    Attributes:
        stiffness: with its terminals shorted (N/m).
        coupling: N/V, the same as A s/m.
        capacitance: with its ends held (F).

    Example:
        >>> Piezo("p", ("a", "ground"), "slide", stiffness=5e7, coupling=9.0, capacitance=2e-6).kept()
        ('across', '')
    """

    stiffness: Any = None
    coupling: Any = None
    capacitance: Any = None
    kind = "piezo"
    domain_name = ELECTRICAL.name
    required = ("stiffness", "coupling", "capacitance")

    def kept(self) -> tuple[str, ...]:
        """The voltage; nothing in mechanics."""
        return ACROSS, STATIC

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Nothing beside the rate of the charge and the force, which follow from the co-energy."""
        return 0, at.Y[1]

    def kept_coenergy(self, at: Terminals) -> Scalar:
        """``W'(v, x) = capacitance v² / 2 + coupling v x - stiffness x² / 2`` (J)."""
        v, x = at.X[0], at.x
        electric = at.value(self.capacitance) * (v * v / 2) + at.value(self.coupling) * v * x
        return electric - at.value(self.stiffness) * (x * x / 2)

    @property
    def displaced(self) -> bool:
        """True: charge and force depend on the displacement."""
        return True
