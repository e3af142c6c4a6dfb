"""Friction in 1-D rotation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ROTATION_1D
from linegraph.components.scalar.base import Dissipator

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class RotationalFriction(Dissipator):
    """Friction in 1-D rotation: ``Y = viscous X + coulomb tanh(X / width)``.

    Attributes:
        viscous: N m s/rad.
        coulomb: what dry friction takes in motion (N m).
        width: the rate at which dry friction has risen to 76 % (rad/s).

    Example:
        >>> RotationalFriction("bearing", ("shaft", "ground"), coulomb=0.1).kind
        'rotational_friction'
    """

    viscous: Any = 0
    coulomb: Any = 0
    width: Any = 1e-3
    kind = "rotational_friction"
    domain_name = ROTATION_1D.name

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Against the rate."""
        dry = at.value(self.coulomb) * at.function("tanh", at.X[0] / at.value(self.width))
        return (at.Y[0] - (at.value(self.viscous) * at.X[0] + dry),)
