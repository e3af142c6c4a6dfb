"""The relation: any constraint that is linear in velocities, as an expression."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linegraph.ir.program import Quantity

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar


@dataclass(frozen=True)
class Relation:
    """``a(q) v = b(q, t)``, written as an expression that is zero and linear in the rates ``der(x)``.

    It names coordinates and not terminals, so it has no edge in the graph; its multiplier is a generalised
    force that does no work on motions it allows.

    Attributes:
        name: of its multiplier.
        rate: the expression, of coordinates, rates, parameters and t.

    Example:
        >>> Relation("gear", rate="der(a) - 2*der(b)").values()
        ('der(a) - 2*der(b)',)
    """

    name: str
    rate: Any

    kind: ClassVar[str] = "relation"

    def values(self) -> tuple[Any, ...]:
        """The one model value it depends on, its expression."""
        return (self.rate,)

    def equation(self) -> Quantity:
        """Its multiplier, a generalised force in the unit of power over that of the rate."""
        return Quantity(f"{self.name}_multiplier", "", f"multiplier of relation {self.name}")

    def linear(self, algebra: Algebra, evaluate: Any, count: int) -> tuple[list[Scalar], Scalar]:
        """The coefficients of its velocities and the rest: ``rate = a v - b`` gives (a, b).

        The expression is linear in the velocities, so its values at zero and at unit velocities determine it
        exactly; differentiating the formula would have to follow all names in it.

        Args:
            algebra: where to calculate.
            evaluate: the value of `rate` for given velocities.
            count: the number of velocities.
        """
        rest = evaluate((0,) * count)
        row = []
        for k in range(count):
            unit = tuple(int(i == k) for i in range(count))
            row.append(evaluate(unit) - rest)
        return row, -rest
