"""Forces and torques on a body at a point, from ground: the base of loads and drags.

Each type is one file beside this one and one line in the register; it gives the model values it depends on,
and its wrench for a motion of the point.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.components.forces.base import Resolve
    from linegraph.spatial.vector import Matrix, Vector


class PointMotion(Protocol):
    """How the point moves on which a force acts.

    Attributes:
        rotation: the terminal's axes, as a matrix from their components to those of ground.
        linear: the velocity of its origin, in ground axes (m/s).
    """

    @property
    def rotation(self) -> Matrix:
        """From components in the terminal's axes to those in ground axes."""

    @property
    def linear(self) -> Vector:
        """The velocity of the terminal's origin, in ground axes (m/s)."""


@dataclass(frozen=True)
class PointForce:
    """Base of all that acts on a body at a terminal, from ground.

    Its edges run from ground to the terminal, in translation and in rotation; their through variables are the
    force and the torque that it exerts on the body. It does the work ``force . velocity`` of the terminal's
    origin and ``torque . angular velocity`` of the body.

    Attributes:
        name: also the name of its edges.
        at: the terminal it acts on; the force acts at its origin.
    """

    name: str
    at: str

    kind: ClassVar[str]
    vectors: ClassVar[tuple[str, ...]] = ()
    """Fields that hold three expressions each."""
    needs: ClassVar[tuple[tuple[str, ...], ...]] = ()
    """Of each group of fields, a model file gives at least one."""

    def values(self) -> tuple[Any, ...]:
        """The model values on which it depends: if one names an input, it is part of Q, else of h."""
        raise NotImplementedError

    def wrench(
        self, algebra: Algebra, point: PointMotion, resolve: Resolve
    ) -> tuple[Vector, Vector]:
        """The force (N) and the torque (N m) on the body, in ground axes, about the terminal's origin.

        Args:
            algebra: the algebra to calculate in.
            point: how the terminal moves.
            resolve: from model values to scalars.
        """
        raise NotImplementedError
