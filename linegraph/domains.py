"""Power subspaces as data: one through and one across variable whose product is a power.

A unit is a product of SI base units, written as exponents of (kg, m, s, A, K); rad is 1.
"""

from __future__ import annotations

from dataclasses import dataclass

Unit = tuple[int, int, int, int, int]

POWER: Unit = (1, 2, -3, 0, 0)


@dataclass(frozen=True)
class Variable:
    """A through or an across variable: its name, the usual symbol of its unit, and the unit itself."""

    name: str
    symbol: str
    unit: Unit


@dataclass(frozen=True)
class Domain:
    """A power subspace.

    Attributes:
        across: measured in parallel, between the ends of an edge.
        through: measured in series, along an edge.
        dimension: 1 for a scalar subspace, 3 for a spatial one.
        power: whether through times across is a power; the usual thermal pair is the exception.

    Raises:
        ValueError: the units' product is not what `power` says.
    """

    name: str
    across: Variable
    through: Variable
    dimension: int = 1
    power: bool = True

    def __post_init__(self) -> None:
        """Hold the definition of a power subspace."""
        product = tuple(a + b for a, b in zip(self.across.unit, self.through.unit, strict=True))
        if (product == POWER) != self.power:
            raise ValueError(f"domain {self.name}: through x across must be a power")


TRANSLATION = Domain(
    "translation",
    across=Variable("velocity", "m/s", (0, 1, -1, 0, 0)),
    through=Variable("force", "N", (1, 1, -2, 0, 0)),
    dimension=3,
)
ROTATION = Domain(
    "rotation",
    across=Variable("angular velocity", "rad/s", (0, 0, -1, 0, 0)),
    through=Variable("torque", "N*m", (1, 2, -2, 0, 0)),
    dimension=3,
)

DOMAINS: dict[str, Domain] = {domain.name: domain for domain in (TRANSLATION, ROTATION)}
"""The register: a new domain is one entry."""
