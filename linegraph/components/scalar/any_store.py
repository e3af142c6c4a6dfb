"""Any store: a charge or a co-energy as a function of the variable kept, in any subspace."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linegraph.components.scalar.base import ACROSS, THROUGH, Component, Pair, Port
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Own, Terminals


@dataclass(frozen=True)
class AnyStore(Component):
    """A store in any subspace: ``Y = d/dt Q(X)`` if it keeps X, ``X = d/dt Q(Y)`` if it keeps Y.

    X is the across variable of the tail less that of the head, Y flows from tail to head, in the units of the
    subspace. With k the variable kept, ``Q = constant k``, or as given, or ``∂W'/∂k``; it stores ``Q k -
    W'``.

    Attributes:
        between: its vertices (tail, head).
        domain: its subspace.
        keeps: "across" or "through".
        constant: Q for one of what it keeps; or
        charge: Q as a function of k, what it keeps; or
        coenergy: its co-energy (J) as a function of k.

    Example:
        >>> AnyStore("box", ("box", "ground"), "acoustic", constant=1e-7).kept()
        ('across',)
    """

    between: Pair
    domain: str = "electrical"
    keeps: str = ACROSS
    constant: Any = None
    charge: Any = None
    coenergy: Any = None
    kind = "store"
    own: ClassVar[Own] = {"charge": ("k",), "coenergy": ("k",)}
    needs = (("constant", "charge", "coenergy"),)

    def ports(self) -> tuple[Port, ...]:
        """One edge in the chosen subspace."""
        return (Port("", self.domain, self.between),)

    def kept(self) -> tuple[str, ...]:
        """Its across or its through variable, as chosen."""
        return (self.keeps,)

    def kept_coenergy(self, at: Terminals) -> Scalar:
        """``constant k² / 2`` (J), or as given; 0 of a charge, which the network integrates."""
        k = self._kept(at)
        if self.coenergy is not None:
            return at.value(self.coenergy, k=k)
        return 0 if self.constant is None else at.value(self.constant) * (k * k / 2)

    def charges(self, at: Terminals) -> tuple[Scalar, ...] | None:
        """The charge where it is given as such; else None, and it follows from the co-energy."""
        return None if self.charge is None else (at.value(self.charge, k=self._kept(at)),)

    def require_fields(self) -> None:
        """Refuse also a variable to keep that is neither.

        Raises:
            ModelError: a field is missing or one too many, or `keeps` is neither.
        """
        super().require_fields()
        if self.keeps not in (ACROSS, THROUGH):
            problem = f'keeps "{ACROSS}" or "{THROUGH}", not "{self.keeps}"'
            raise ModelError(f'{self.kind} "{self.name}"', problem)

    def _kept(self, at: Terminals) -> Scalar:
        return at.X[0] if self.keeps == ACROSS else at.Y[0]
