"""The source of torque in 1-D rotation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ROTATION_1D
from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class TorqueSource(OnePort):
    """A source: ``Y = torque``, through it from tail to head.

    Attributes:
        torque: N m: a number, an input, an expression of t or of any variable.

    Example:
        >>> TorqueSource("source", ("a", "ground"), torque=1.0).kind
        'torque_source'
    """

    torque: Any = None
    kind = "torque_source"
    domain_name = ROTATION_1D.name
    required = ("torque",)
    source = True

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """As given."""
        return (at.Y[0] - at.value(self.torque),)
