"""The source of magnetomotive force."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import MAGNETIC
from linegraph.components.scalar.base import OnePort

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class MmfSource(OnePort):
    """A source: ``X = mmf``, tail over head.

    Attributes:
        mmf: A: a number, an input, an expression of t or of any variable.

    Example:
        >>> MmfSource("source", ("a", "ground"), mmf=1.0).kind
        'mmf_source'
    """

    mmf: Any = None
    kind = "mmf_source"
    domain_name = MAGNETIC.name
    required = ("mmf",)
    source = True

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """As given."""
        return (at.X[0] - at.value(self.mmf),)
