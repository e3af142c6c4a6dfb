"""Any element: a law between its across and through variables, with a state if need be."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.algebra.formula import Formula, parse
from linegraph.components.scalar.base import Component, OwnState, Pair, Port
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class LawEquation:
    """An equation as it is written: ``left = right``.

    Attributes:
        left, right: the formulas on either side.
    """

    left: Formula
    right: Formula

    @property
    def difference(self) -> Formula:
        """The residual ``left - right``, which is zero."""
        return Formula("-", (self.left, self.right))


def equation(text: str) -> LawEquation:
    """Read an equation.

    Args:
        text: two formulas with one sign of equality between them.

    Raises:
        ModelError: there is not one sign of equality, or a side cannot be read.

    Example:
        >>> sorted(set(equation("y = g*x").difference.names()))
        ['g', 'x', 'y']
    """
    left, sign, right = text.partition("=")
    if not sign or "=" in right:
        raise ModelError("", f"an equation such as y = f(x) is wanted, not {text[:60]!a}")
    return LawEquation(parse(left), parse(right))


@dataclass(frozen=True)
class AnyElement(Component):
    """An element with any law, in any subspace.

    ``law`` is one equation of x, the across variable of the tail less that of the head, and y, the through
    variable from tail to head, both in the units of the subspace. With a state, ``ds/dt = rate``. Without one
    all that it takes in, ``x y``, counts as heat.

    Attributes:
        between: its vertices (tail, head).
        domain: its subspace.
        law: an equation of its across variable x, its through variable y, its state s, t and anything else.
        rate: the derivative of its state s, if it has one.

    Example:
        >>> AnyElement("D", ("a", "b"), "electrical", law="y = Is*(exp(x/Vt) - 1)").kind
        'element'
    """

    between: Pair
    domain: str = "electrical"
    law: Any = None
    rate: Any = None
    kind = "element"
    required = ("law",)

    def ports(self) -> tuple[Port, ...]:
        """One edge in the chosen subspace."""
        return (Port("", self.domain, self.between),)

    def states(self) -> tuple[OwnState, ...]:
        """The state s, where its rate is given."""
        return () if self.rate is None else (OwnState("s", "s", "", "state"),)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Residual of the equation: its left side less its right."""
        return (at.value(self._law.difference, **self._own(at)),)

    def rates(self, at: Terminals) -> tuple[Scalar, ...]:
        """The value of `rate`, where it is given."""
        return () if self.rate is None else (at.value(self.rate, **self._own(at)),)

    def dissipation(self, at: Terminals) -> Scalar:
        """``x y`` (W); 0 if it has a state, because then it may store a part, which is not known."""
        return at.X[0] * at.Y[0] if self.rate is None else 0

    def values(self) -> tuple[Any, ...]:
        """Both sides of the law, and the rate if it is given."""
        law = self._law
        return tuple(x for x in (law.left, law.right, self.rate) if x is not None)

    def require_fields(self) -> None:
        """Refuse also a law that is no equation.

        Raises:
            ModelError: the law is missing or cannot be read.
        """
        super().require_fields()
        try:
            _ = self._law
        except ModelError as error:
            raise ModelError(f'{self.kind} "{self.name}"', f"law: {error.problem}") from None

    @property
    def _law(self) -> LawEquation:
        return self.law if isinstance(self.law, LawEquation) else equation(str(self.law))

    def _own(self, at: Terminals) -> dict[str, Scalar]:
        return {"x": at.X[0], "y": at.Y[0], **at.states}
