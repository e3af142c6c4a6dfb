"""The components of 1-D mechanics, each one class for translation and rotation.

`translational` and `rotational` name the types. X is a velocity (m/s) or an angular velocity (rad/s) of the
tail relative to the head, Y the force (N) or torque (N m) that presses the ends together: where Y > 0 the
head is pushed forward and the tail back.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.scalar.base import Dissipator
from linegraph.components.scalar.stores import AcrossStore

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Inertia1D(AcrossStore):
    """A mass that slides or an inertia that turns: ``Y = d/dt (inertia X)``.

    Newton's second law: X is the velocity relative to ground, whichever end ground is, and Y the resultant of
    the forces that accelerate it. It stores ``inertia X² / 2`` (J).
    """

    grounded = True

    def constant(self, at: Terminals) -> Scalar:
        """Momentum for a unit of velocity: the mass (kg) or the moment of inertia (kg m^2)."""
        return at.value(getattr(self, self.required[0]))


@dataclass(frozen=True)
class Damper1D(Dissipator):
    """A viscous damper in 1-D mechanics: ``Y = damping X``.

    The ends are pressed apart the faster they approach each other, X > 0; it turns ``damping X²`` (W) into
    heat.
    """

    damping: Any = None
    required = ("damping",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Residual: the force or torque less the damping times the rate (N or N m)."""
        return (at.Y[0] - at.value(self.damping) * at.X[0],)


@dataclass(frozen=True)
class Friction1D(Dissipator):
    """Friction in 1-D mechanics: ``Y = viscous X + coulomb tanh(X / width)``.

    Viscous friction, and Coulomb's with the jump at standstill made smooth: without it the law has no
    derivative there, and no unique force at rest. The price is that a body under a load smaller than
    `coulomb` creeps, at a rate of the order of `width`, instead of sticking
    [Andersson et al. 2007].
    """

    viscous: Any = 0
    coulomb: Any = 0
    width: Any = 1e-3

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Residual: the force or torque less viscous and dry friction, both along X (N or N m)."""
        dry = at.value(self.coulomb) * at.function("tanh", at.X[0] / at.value(self.width))
        return (at.Y[0] - (at.value(self.viscous) * at.X[0] + dry),)
