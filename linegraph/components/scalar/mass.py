"""The mass of 1-D translation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import TRANSLATION_1D
from linegraph.components.scalar.stores import AcrossStore

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Mass(AcrossStore):
    """A mass that slides: ``Y = d/dt (mass X)``. One of its ends is ground, against which it moves.

    Attributes:
        mass: kg.

    Example:
        >>> Mass("car", ("car", "ground"), mass=300.0).kind
        'mass'
    """

    mass: Any = None
    kind = "mass"
    domain_name = TRANSLATION_1D.name
    grounded = True
    required = ("mass",)

    def constant(self, at: Terminals) -> Scalar:
        """The mass."""
        return at.value(self.mass)
