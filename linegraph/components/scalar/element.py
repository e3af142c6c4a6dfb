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
    """An equation as it is written: ``left = right``."""

    left: Formula
    right: Formula

    @property
    def difference(self) -> Formula:
        """What is zero."""
        return Formula("-", (self.left, self.right))


def equation(text: str) -> LawEquation:
    """Read an equation.

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
        """Its one edge."""
        return (Port("", self.domain, self.between),)

    def states(self) -> tuple[OwnState, ...]:
        """s, where its rate is given."""
        return () if self.rate is None else (OwnState("s", "s", "", "state"),)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """The difference of both sides."""
        return (at.value(self._law.difference, **self._own(at)),)

    def rates(self, at: Terminals) -> tuple[Scalar, ...]:
        """As given."""
        return () if self.rate is None else (at.value(self.rate, **self._own(at)),)

    def dissipation(self, at: Terminals) -> Scalar:
        """All that it takes in, unless it has a state."""
        return at.X[0] * at.Y[0] if self.rate is None else 0

    def values(self) -> tuple[Any, ...]:
        """Both sides of the law."""
        law = self._law
        return tuple(x for x in (law.left, law.right, self.rate) if x is not None)

    def require_fields(self) -> None:
        """Refuse a law that is no equation."""
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
