"""The mass of 1-D translation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.stores import AcrossStore
from linegraph.domains import TRANSLATION_1D

if TYPE_CHECKING:
    from linegraph.components.base import Terminals
    from linegraph.vector import Scalar


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
