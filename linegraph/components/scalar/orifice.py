"""The orifice with turbulent flow."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import HYDRAULIC
from linegraph.components.scalar.base import Dissipator

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Orifice(Dissipator):
    """A sharp-edged orifice: ``Y = coefficient sign(X) sqrt(|X|)``, rounded where |X| is below `width`.

    Attributes:
        coefficient: flow for a pressure drop of one (m^3/s/sqrt(Pa)).
        width: where the root is rounded: Y = coefficient X / (X^2 + width^2)^(1/4) (Pa).

    Example:
        >>> Orifice("jet", ("tank", "ground"), coefficient=1e-6).kind
        'orifice'
    """

    coefficient: Any = None
    width: Any = 1.0
    kind = "orifice"
    domain_name = HYDRAULIC.name
    required = ("coefficient",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Rounded Torricelli's law."""
        width = at.value(self.width)
        root = at.function("sqrt", at.function("sqrt", at.X[0] * at.X[0] + width * width))
        return (at.Y[0] - at.value(self.coefficient) * (at.X[0] / root),)
