"""The ideal operational amplifier."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.domains import ELECTRICAL
from linegraph.components.scalar.base import Component, Pair, Port

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class OpAmp(Component):
    """An ideal operational amplifier, a nullor: at its input X = Y = 0, at its output anything.

    Its edges are "input" and "output".

    Attributes:
        between: its inputs (plus, minus).
        output: the vertices of its output, mostly (out, ground).

    Example:
        >>> OpAmp("stage", ("ground", "minus"), ("out", "ground")).kind
        'opamp'
    """

    between: Pair
    output: Pair
    kind = "opamp"
    source = True

    def ports(self) -> tuple[Port, ...]:
        """Input and output."""
        domain = ELECTRICAL.name
        return Port("input", domain, self.between), Port("output", domain, self.output)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """Two for the input, none for the output."""
        return at.X[0], at.Y[0]
