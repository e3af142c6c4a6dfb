"""Any law: a through variable as an expression."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.elements.base import Element

if TYPE_CHECKING:
    from linegraph.algebra import Algebra
    from linegraph.elements.base import Resolve
    from linegraph.vector import Scalar


@dataclass(frozen=True)
class Law(Element):
    """An element given by `through`, an expression in x, v, t, coordinates, inputs and parameters.

    Gravity between two bodies, an actuator with its own characteristic, a cable that only pulls.

    Example:
        >>> Law("pull", ("earth", "moon"), force="G*m1*m2/x**2").kind
        'law'
    """

    force: Any = 0
    kind = "law"
    laws = ("force",)
    needs = (("force",),)

    def through(self, algebra: Algebra, x: Scalar, v: Scalar, resolve: Resolve) -> Scalar:
        """As the expression says."""
        return resolve(self.force, x=x, v=v)
