"""The edges of transducers in 3-D mechanics, as force elements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.algebra.formula import Formula
from linegraph.components.forces.base import Element

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.forces.base import Resolve
    from linegraph.components.scalar.base import Component


@dataclass(frozen=True)
class NetworkForce(Element):
    """The edge of a transducer in 3-D mechanics: ``through = Y``, which holds its ends back.

    Y is a variable of the network (N, or N m at a joint that turns); where the transducer drives, Y < 0.

    Example:
        >>> from linegraph.components.scalar import COMPONENTS
        >>> drive = COMPONENTS["dc_motor"]("m", ("a", "ground"), "hinge", constant=0.1, resistance=2)
        >>> forces_of([drive])[0].name
        'm.mechanical'
    """

    kind = "edge"

    def through(self, algebra: Algebra, x: Scalar, v: Scalar, resolve: Resolve) -> Scalar:
        """The through variable Y of the edge, which the network determines."""
        return resolve(Formula("variable", ("through", self.name, "")))


def forces_of(components: Iterable[Component]) -> tuple[NetworkForce, ...]:
    """The edges in 3-D mechanics of all components.

    Args:
        components: those of a system, in declared order.
    """
    return tuple(
        NetworkForce(port.edge(component.name), port.points, port.joint)
        for component in components
        for port in component.ports()
        if port.spatial
    )
