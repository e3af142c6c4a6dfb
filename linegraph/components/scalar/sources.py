"""The two ideal sources: of an across variable and of a through variable, in any subspace."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class AcrossSource(OnePort):
    """A source of an across variable: ``X = value``, whatever flows through it.

    X is the potential of the tail less that of the head, so a positive value lifts the tail above the head.
    The source takes in ``X Y``, Y flowing from tail to head; where it delivers power that product is
    negative.
    """

    source = True

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Residual: the across variable less its prescribed value, in the unit of the across variable."""
        return (at.X[0] - at.value(getattr(self, self.required[0])),)


@dataclass(frozen=True)
class ThroughSource(OnePort):
    """A source of a through variable: ``Y = value``, whatever lies across it.

    Y flows through the source from tail to head, so a positive value is drawn from the network at the tail
    and returned to it at the head. The source takes in ``X Y``; where it delivers power that product is
    negative.
    """

    source = True

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Residual: the through variable less its prescribed value, in the unit of the through variable."""
        return (at.Y[0] - at.value(getattr(self, self.required[0])),)
