"""The damper of 1-D rotation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ROTATION_1D
from linegraph.components.scalar.base import Dissipator

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class RotationalDamper(Dissipator):
    """A viscous damper in 1-D rotation: ``Y = damping X``.

    Attributes:
        damping: N m s/rad.

    Example:
        >>> RotationalDamper("strut", ("car", "wheel"), damping=20.0).kind
        'rotational_damper'
    """

    damping: Any = None
    kind = "rotational_damper"
    domain_name = ROTATION_1D.name
    required = ("damping",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """In proportion to the rate."""
        return (at.Y[0] - at.value(self.damping) * at.X[0],)
