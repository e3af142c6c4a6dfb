"""Power subspaces as data: one through and one across variable whose product is a power.

A unit is a product of SI base units, written as exponents of (kg, m, s, A, K); rad is 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Mapping

Unit = tuple[int, int, int, int, int]

POWER: Unit = (1, 2, -3, 0, 0)


@dataclass(frozen=True)
class Variable:
    """A through or an across variable: its name, the usual symbol of its unit, and the unit itself.

    Attributes:
        name: as engineers call it.
        symbol: of its unit.
        unit: exponents of (kg, m, s, A, K).
        letter: the beginning of names of states: ``v_C1`` is the voltage of C1.
        integral: letter, unit and name of its integral over time, where that has some.
    """

    name: str
    symbol: str
    unit: Unit
    letter: str = ""
    integral: tuple[str, str, str] = ("", "", "")


@dataclass(frozen=True)
class Domain:
    """A power subspace.

    Attributes:
        name: of the subspace.
        across: measured in parallel, between the ends of an edge.
        through: measured in series, along an edge.
        dimension: 1 for a scalar subspace, 3 for a spatial one.
        power: whether through times across is a power; the usual thermal pair, temperature and heat flow, is
            the exception: it is in the graph, but not in the power audit.

    Raises:
        ValueError: the units' product is a power (W) and `power` is false, or the reverse.
    """

    name: str
    across: Variable
    through: Variable
    dimension: int = 1
    power: bool = True

    def __post_init__(self) -> None:
        """Require that through times across is a power exactly where `power` is true."""
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

ELECTRICAL = Domain(
    "electrical",
    across=Variable("voltage", "V", (1, 2, -3, -1, 0), "v", ("psi", "V*s", "flux linkage")),
    through=Variable("current", "A", (0, 0, 0, 1, 0), "i", ("q", "A*s", "charge")),
)
TRANSLATION_1D = Domain(
    "translation_1d",
    across=Variable("velocity", "m/s", (0, 1, -1, 0, 0), "v", ("x", "m", "displacement")),
    through=Variable("force", "N", (1, 1, -2, 0, 0), "F", ("P", "N*s", "momentum")),
)
ROTATION_1D = Domain(
    "rotation_1d",
    across=Variable("angular velocity", "rad/s", (0, 0, -1, 0, 0), "w", ("x", "rad", "angle")),
    through=Variable("torque", "N*m", (1, 2, -2, 0, 0), "tau", ("P", "N*m*s", "angular momentum")),
)
HYDRAULIC = Domain(
    "hydraulic",
    across=Variable("pressure", "Pa", (1, -1, -2, 0, 0), "p", ("P", "Pa*s", "pressure momentum")),
    through=Variable("volume flow", "m^3/s", (0, 3, -1, 0, 0), "Q", ("V", "m^3", "volume")),
)
THERMAL = Domain(
    "thermal",
    across=Variable("temperature", "K", (0, 0, 0, 0, 1), "T", ("", "", "")),
    through=Variable("heat flow", "W", (1, 2, -3, 0, 0), "H", ("U", "J", "heat")),
    power=False,
)
MAGNETIC = Domain(
    "magnetic",
    across=Variable("magnetomotive force", "A", (0, 0, 0, 1, 0), "F", ("", "", "")),
    through=Variable("flux rate", "V", (1, 2, -3, -1, 0), "dphi", ("phi", "V*s", "flux")),
)

DOMAINS: dict[str, Domain] = {
    domain.name: domain
    for domain in (
        TRANSLATION,
        ROTATION,
        ELECTRICAL,
        TRANSLATION_1D,
        ROTATION_1D,
        HYDRAULIC,
        THERMAL,
        MAGNETIC,
    )
}
"""The register: a new domain is one entry."""

UNITS: dict[str, Unit] = {
    "kg": (1, 0, 0, 0, 0),
    "m": (0, 1, 0, 0, 0),
    "s": (0, 0, 1, 0, 0),
    "A": (0, 0, 0, 1, 0),
    "K": (0, 0, 0, 0, 1),
    "rad": (0, 0, 0, 0, 0),
    "1": (0, 0, 0, 0, 0),
    "N": (1, 1, -2, 0, 0),
    "Pa": (1, -1, -2, 0, 0),
    "J": (1, 2, -2, 0, 0),
    "W": (1, 2, -3, 0, 0),
    "C": (0, 0, 1, 1, 0),
    "V": (1, 2, -3, -1, 0),
    "Wb": (1, 2, -2, -1, 0),
    "Hz": (0, 0, -1, 0, 0),
}
"""The symbols that the unit of a domain's variable may be made of."""


def exponents(symbol: str) -> Unit:
    """A unit such as ``m^3/s`` or ``N*m`` as exponents of base units: after the slash they are negative.

    Args:
        symbol: products of symbols of `UNITS` and their powers; those after a slash divide.

    Raises:
        ValueError: a symbol is not known, or a power is no number.

    Example:
        >>> exponents("N*m/s") == POWER
        True
    """
    above, *below = symbol.replace(" ", "").split("/")
    total = [0] * 5
    for names, sign in ((above, 1), *((part, -1) for part in below)):
        for factor in names.split("*"):
            name, _, power = factor.partition("^")
            if name not in UNITS:
                raise ValueError(f'"{name}" is no unit known here; known: {", ".join(UNITS)}')
            if power and not power.lstrip("-").isdigit():
                raise ValueError(f'"{factor}" is no power of a unit; write m^3')
            times = int(power) if power else 1
            total = [t + sign * times * e for t, e in zip(total, UNITS[name], strict=True)]
    return (total[0], total[1], total[2], total[3], total[4])


SPATIAL = (TRANSLATION.name, ROTATION.name)
"""The subspaces of 3-D mechanics; all others are scalar networks."""


def declared(
    name: str,
    across: Mapping[str, str],
    through: Mapping[str, str],
    power: bool,
    others: Mapping[str, Domain],
) -> Domain:
    """A domain of a user's own.

    Args:
        name: unlike those of all other domains.
        across: name, unit and letter of the across variable.
        through: name, unit and letter of the through variable.
        power: whether their product is a power.
        others: the domains that the model has declared already.

    Raises:
        ModelError: the name is taken, a unit is not known, or the units do not make a power.
    """
    who = f'domain "{name}"'
    if name in DOMAINS or name in others:
        raise ModelError(who, "the name is taken; names of domains are unique")
    try:
        variables = [
            Variable(given["name"], given["unit"], exponents(given["unit"]), given["letter"])
            for given in (across, through)
        ]
        return Domain(name, variables[0], variables[1], power=power)
    except KeyError as error:
        raise ModelError(who, f"{error.args[0]} is missing: name, unit and letter") from None
    except ValueError as error:
        problem = str(error).removeprefix(f"domain {name}: ")
        hint = "" if power else "; leave power = false out"
        raise ModelError(who, f"{problem}{hint if 'must be' in problem else ''}") from None
