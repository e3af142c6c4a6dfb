"""Where a network of 1-D mechanics meets a joint of 3-D mechanics."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.domains import ROTATION_1D, TRANSLATION_1D
from linegraph.components.scalar.base import Transducer

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class TranslationalInterface(Transducer):
    """A vertex of 1-D translation that moves as a prismatic joint or a distance does: ``X = w``.

    Example:
        >>> TranslationalInterface("hook", ("rod", "ground"), joint="slide").kind
        'translational_interface'
    """

    kind = "translational_interface"
    domain_name = TRANSLATION_1D.name

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """What flows in acts along the joint's coordinate."""
        return at.X[0] - at.X[1], at.Y[1] + at.Y[0]


@dataclass(frozen=True)
class RotationalInterface(Transducer):
    """A vertex of 1-D rotation that turns as a revolute joint does: ``X = w``.

    Example:
        >>> RotationalInterface("coupling", ("shaft", "ground"), joint="axle").kind
        'rotational_interface'
    """

    kind = "rotational_interface"
    domain_name = ROTATION_1D.name
    turns = True

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """What flows in acts along the joint's coordinate."""
        return at.X[0] - at.X[1], at.Y[1] + at.Y[0]
