"""The source of angular velocity in 1-D rotation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ROTATION_1D
from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class AngularVelocitySource(OnePort):
    """A source: ``X = velocity``, tail over head.

    Attributes:
        velocity: rad/s: a number, an input, an expression of t or of any variable.

    Example:
        >>> AngularVelocitySource("source", ("a", "ground"), velocity=1.0).kind
        'angular_velocity_source'
    """

    velocity: Any = None
    kind = "angular_velocity_source"
    domain_name = ROTATION_1D.name
    required = ("velocity",)
    source = True

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """As given."""
        return (at.X[0] - at.value(self.velocity),)
