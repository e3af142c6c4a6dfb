"""Where a network of 1-D mechanics meets a joint of 3-D mechanics."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.domains import ROTATION_1D, TRANSLATION_1D
from linegraph.components.scalar.base import Transducer
from linegraph.components.scalar.twins import Twins

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Interface(Transducer):
    """A vertex of a network that moves with 3-D mechanics: ``X = w``.

    X is the velocity of the tail relative to the head, w the rate of the coordinate or of the distance of two
    points. Y, the force or torque from the network, acts along that coordinate, so that no power is lost.
    """

    def __init_subclass__(cls) -> None:
        """A shaft turns where the network is one of rotation."""
        super().__init_subclass__()
        cls.turns = cls.domain_name == ROTATION_1D.name

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """``X - w`` (m/s or rad/s), and the sum of both through variables (N or N m), both zero."""
        return at.X[0] - at.X[1], at.Y[1] + at.Y[0]


TranslationalInterface = Twins(TRANSLATION_1D, __name__).of(
    Interface,
    "translational_interface",
    "A vertex of 1-D translation that moves as a prismatic joint or a distance does: ``X = w``.",
)
RotationalInterface = Twins(ROTATION_1D, __name__).of(
    Interface,
    "rotational_interface",
    "A vertex of 1-D rotation that turns as a revolute joint does: ``X = w``.",
)
