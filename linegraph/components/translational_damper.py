"""The damper of 1-D translation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.base import Dissipator
from linegraph.domains import TRANSLATION_1D

if TYPE_CHECKING:
    from linegraph.components.base import Terminals
    from linegraph.vector import Scalar


@dataclass(frozen=True)
class TranslationalDamper(Dissipator):
    """A viscous damper in 1-D translation: ``Y = damping X``.

    Attributes:
        damping: N s/m.

    Example:
        >>> TranslationalDamper("strut", ("car", "wheel"), damping=20.0).kind
        'translational_damper'
    """

    damping: Any = None
    kind = "translational_damper"
    domain_name = TRANSLATION_1D.name
    required = ("damping",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """In proportion to the rate."""
        return (at.Y[0] - at.value(self.damping) * at.X[0],)
