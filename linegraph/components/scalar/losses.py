"""Heat from what other components lose."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.domains import THERMAL
from linegraph.components.scalar.base import OnePort
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Losses(OnePort):
    """A source of heat: all that the named components and force elements dissipate.

    Resistors, motors, diodes, dampers and friction, in networks and in 3-D joints. The coupling is one-way.

    Attributes:
        of: their names.

    Example:
        >>> Losses("copper", ("ground", "winding"), of=("R1", "motor")).kind
        'losses'
    """

    of: tuple[str, ...] = ()
    kind = "losses"
    domain_name = THERMAL.name

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """The sum."""
        total: Scalar = 0
        for name in self.of:
            total = total + at.taken(name)
        return (at.Y[0] - total,)

    def require_fields(self) -> None:
        """Refuse losses of nothing."""
        if not self.of:
            raise ModelError(f'{self.kind} "{self.name}"', "of: name what loses power")
