"""Any law: a through variable as an expression."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.forces.base import Element

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.forces.base import Resolve


@dataclass(frozen=True)
class Law(Element):
    """An element given by `through`, an expression in x, v, t, coordinates, inputs and parameters.

    ``through = force(x, v, t, ...)``, where a positive force pulls the points together or the coordinate
    back. Gravity between two bodies, an actuator with its own characteristic, a cable that only pulls. Of
    forces that depend on x and parameters alone the potential energy is found by integration, where rules are
    known.

    Attributes:
        force: the tension (N, or N m in a revolute joint).
        energy: its potential energy (J), an expression in x whose derivative is the force at v = 0, where
            that cannot be integrated.

    Example:
        >>> Law("pull", ("earth", "moon"), force="G*m1*m2/x**2").kind
        'law'
    """

    force: Any = 0
    energy: Any = None
    kind = "law"
    laws = ("force", "energy")
    needs = (("force",),)

    def through(self, algebra: Algebra, x: Scalar, v: Scalar, resolve: Resolve) -> Scalar:
        """The value of the expression at (x, v) (N or N m)."""
        return resolve(self.force, x=x, v=v)
