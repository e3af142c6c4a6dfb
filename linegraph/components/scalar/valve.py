"""The valve: an orifice that opens."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import HYDRAULIC
from linegraph.components.scalar.base import Dissipator

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Valve(Dissipator):
    """A valve: ``Y = coefficient opening sign(X) sqrt(|X|)``, rounded where |X| is below `width`.

    Attributes:
        coefficient: flow for a pressure drop of one when fully open (m^3/s/sqrt(Pa)).
        opening: from 0, shut, to 1; mostly an expression of an input.
        width: where the root is rounded (Pa).

    Example:
        >>> Valve("spool", ("pump", "cylinder"), coefficient=1e-6, opening="spool").kind
        'valve'
    """

    coefficient: Any = None
    opening: Any = 1
    width: Any = 1.0
    kind = "valve"
    domain_name = HYDRAULIC.name
    required = ("coefficient",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Rounded Torricelli's law; an opening below 0 counts as 0."""
        width = at.value(self.width)
        root = at.function("sqrt", at.function("sqrt", at.X[0] * at.X[0] + width * width))
        opening = at.value(self.opening)
        if not isinstance(opening, (int, float)) or opening < 0:
            opening = at.function("max", opening, 0)
        return (at.Y[0] - at.value(self.coefficient) * opening * (at.X[0] / root),)
