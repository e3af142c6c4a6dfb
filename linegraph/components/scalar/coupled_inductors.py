"""Inductors that share their flux."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import THROUGH, Component, Pair, Port
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class CoupledInductors(Component):
    """Inductors that share their flux: ``X = d/dt (inductance Y)`` with a symmetric matrix.

    Its edges are "winding1", "winding2", ...

    Attributes:
        windings: the vertices of each, (tail, head).
        inductance: the matrix, row by row (H): self-inductances on the diagonal, mutual ones beside it.

    Example:
        >>> pair = (("a", "ground"), ("b", "ground"))
        >>> CoupledInductors("T", pair, inductance=((2.0, 0.9), (0.9, 0.5))).kept()
        ('through', 'through')
    """

    windings: tuple[Pair, ...]
    inductance: tuple[tuple[Any, ...], ...] = ()
    kind = "coupled_inductors"

    def ports(self) -> tuple[Port, ...]:
        """One for each winding."""
        return tuple(
            Port(f"winding{k + 1}", ELECTRICAL.name, ends) for k, ends in enumerate(self.windings)
        )

    def kept(self) -> tuple[str, ...]:
        """All currents."""
        return (THROUGH,) * len(self.windings)

    def kept_coenergy(self, at: Terminals) -> Scalar:
        """``Y^T inductance Y / 2``."""
        rows = [[at.value(entry) for entry in row] for row in self.inductance]
        total: Scalar = 0
        for i, row in enumerate(rows):
            total = total + row[i] * (at.Y[i] * at.Y[i] / 2)
            for j in range(i):
                total = total + row[j] * (at.Y[i] * at.Y[j])
        return total

    def require_fields(self) -> None:
        """Refuse a matrix of another size, or one that is not symmetric as it is written."""
        n, who = len(self.windings), f'{self.kind} "{self.name}"'
        if n < 2:
            raise ModelError(who, "windings: at least two are needed, each [tail, head]")
        if len(self.inductance) != n or any(len(row) != n for row in self.inductance):
            raise ModelError(who, f"inductance: a {n} x {n} matrix is needed for {n} windings")
        rows = self.inductance
        if any(str(rows[i][j]) != str(rows[j][i]) for i in range(n) for j in range(i)):
            raise ModelError(who, "inductance: the matrix is not symmetric")
