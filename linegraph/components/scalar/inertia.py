"""The rotary inertia of 1-D rotation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ROTATION_1D
from linegraph.components.scalar.stores import AcrossStore

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Inertia(AcrossStore):
    """An inertia that turns: ``Y = d/dt (inertia X)``. One of its ends is ground, against which it turns.

    Attributes:
        inertia: kg m^2.

    Example:
        >>> Inertia("rotor", ("shaft", "ground"), inertia=1e-4).kind
        'inertia'
    """

    inertia: Any = None
    kind = "inertia"
    domain_name = ROTATION_1D.name
    grounded = True
    required = ("inertia",)

    def constant(self, at: Terminals) -> Scalar:
        """The inertia."""
        return at.value(self.inertia)
