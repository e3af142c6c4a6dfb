"""Friction in 1-D translation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.base import Dissipator
from linegraph.domains import TRANSLATION_1D

if TYPE_CHECKING:
    from linegraph.components.base import Terminals
    from linegraph.vector import Scalar


@dataclass(frozen=True)
class TranslationalFriction(Dissipator):
    """Friction in 1-D translation: ``Y = viscous X + coulomb tanh(X / width)``.

    Attributes:
        viscous: N s/m.
        coulomb: what dry friction takes in motion (N).
        width: the rate at which dry friction has risen to 76 % (m/s).

    Example:
        >>> TranslationalFriction("bearing", ("shaft", "ground"), coulomb=0.1).kind
        'translational_friction'
    """

    viscous: Any = 0
    coulomb: Any = 0
    width: Any = 1e-3
    kind = "translational_friction"
    domain_name = TRANSLATION_1D.name

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Against the rate."""
        dry = at.value(self.coulomb) * at.function("tanh", at.X[0] / at.value(self.width))
        return (at.Y[0] - (at.value(self.viscous) * at.X[0] + dry),)
