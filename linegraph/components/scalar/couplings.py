"""Couplings: two edges that exchange power without loss, ``X1 Y1 + X2 Y2 = 0``.

Each has two laws. One ties the across variables (a transformer) or an across variable to the other edge's
through variable (a gyrator); the other is its reciprocal, and with both no power is stored or lost. X1, Y1
belong to the edge "first" (`between`), X2, Y2 to the edge "second".
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ELECTRICAL, MAGNETIC, ROTATION_1D, TRANSLATION_1D
from linegraph.components.scalar.base import Pair, Port, TwoPort
from linegraph.components.scalar.twins import Twins

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Terminals


@dataclass(frozen=True)
class Ratio(TwoPort):
    """A coupling of like edges: ``X1 = ratio X2``.

    The second law is ``Y2 = -ratio Y1``: the flow into the first edge leaves the second, multiplied by the
    ratio.
    """

    ratio: Any = None
    required = ("ratio",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """``X1 - ratio X2`` and ``Y2 + ratio Y1``, both zero."""
        return _transformed(at, at.value(self.ratio))


Gear = Twins(ROTATION_1D, __name__).of(
    Ratio,
    "gear",
    "A gear: ``X1 = ratio X2``; negative where the shafts turn against each other, as outer gears do.",
    ratio="turns of the first shaft for one of the second.",
)
Lever = Twins(TRANSLATION_1D, __name__).of(
    Ratio,
    "lever",
    "A lever: ``X1 = ratio X2``; negative where the ends move against each other.",
    ratio="arm of the first end over that of the second.",
)


@dataclass(frozen=True)
class TwoDomains(TwoPort):
    """A coupling whose edges may be in any two scalar subspaces."""

    ratio: Any = None
    domains: Pair = (ELECTRICAL.name, ELECTRICAL.name)
    required = ("ratio",)

    def ports(self) -> tuple[Port, ...]:
        """The edges "first" and "second", each in its own subspace."""
        first, second = self.domains
        return Port("first", first, self.between), Port("second", second, self.second)


@dataclass(frozen=True)
class Transformer(TwoDomains):
    """An ideal transformer: ``X1 = ratio X2``, ``Y2 = -ratio Y1``, also of direct current.

    The flow into the first edge leaves the second, multiplied by the ratio. Between unlike subspaces the
    ratio has a unit: that of the first across variable over that of the second.

    Attributes:
        ratio: n; it may depend on any variable.
        domains: of its first and of its second edge, "electrical" if left out.

    Example:
        >>> Transformer("T", ("a", "ground"), ("b", "ground"), ratio=10.0).kind
        'transformer'
    """

    kind = "transformer"

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """``X1 - ratio X2`` and ``Y2 + ratio Y1``, both zero."""
        return _transformed(at, at.value(self.ratio))


@dataclass(frozen=True)
class Gyrator(TwoDomains):
    """An ideal gyrator: ``X1 = ratio Y2``, ``X2 = -ratio Y1``.

    Across and through variables change places: a capacitor at its second edge looks like an inductor from
    the first [Tellegen 1948, eq. 10]. Between unlike subspaces the unit of the ratio is that of the first
    across variable over that of the second through variable.

    Attributes:
        ratio: ohm; it may depend on any variable.
        domains: of its first and of its second edge, "electrical" if left out.

    Example:
        >>> Gyrator("G", ("a", "ground"), ("b", "ground"), ratio=50.0).kind
        'gyrator'
    """

    kind = "gyrator"

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """``X1 - ratio Y2`` and ``X2 + ratio Y1``, both zero."""
        return _gyrated(at, at.value(self.ratio))


@dataclass(frozen=True)
class Winding(TwoPort):
    """A winding: ``X1 = turns Y2``, the rate of flux, and ``X2 = -turns Y1``, its magnetomotive force.

    Faraday's law of induction and Ampere's law: a gyrator between an electrical edge (V, A) and a magnetic
    one (A, V) [Hamill 1994]. A positive current drives flux through the second edge from its tail to its
    head, and back through the path around it.

    Attributes:
        turns: how often it goes around the path.

    Example:
        >>> Winding("primary", ("a", "ground"), ("core", "ground"), turns=200).kind
        'winding'
    """

    turns: Any = None
    kind = "winding"
    domain_names = (ELECTRICAL.name, MAGNETIC.name)
    required = ("turns",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """``X1 - turns Y2`` (V) and ``X2 + turns Y1`` (A), both zero."""
        return _gyrated(at, at.value(self.turns))


@dataclass(frozen=True)
class Belt(TwoPort):
    """A belt without slip: ``radius1 X1 = radius2 X2``; crossed, one radius is negative.

    Both pulleys have the belt's speed. The torques follow from its tension: ``radius1 Y2 = -radius2 Y1``.

    Attributes:
        radius1: of the first pulley (m).
        radius2: of the second pulley (m).

    Example:
        >>> Belt("belt", ("motor", "ground"), ("load", "ground"), radius1=0.02, radius2=0.1).kind
        'belt'
    """

    radius1: Any = None
    radius2: Any = None
    kind = "belt"
    domain_names = (ROTATION_1D.name, ROTATION_1D.name)
    required = ("radius1", "radius2")

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """``radius1 X1 - radius2 X2`` (m/s) and ``radius1 Y2 + radius2 Y1`` (N m^2), both zero."""
        first, second = at.value(self.radius1), at.value(self.radius2)
        return first * at.X[0] - second * at.X[1], first * at.Y[1] + second * at.Y[0]


@dataclass(frozen=True)
class Rack(TwoPort):
    """A rack and pinion, or a wheel on the road: ``X2 = radius X1``.

    X1 is the angular velocity of the pinion (rad/s), X2 the velocity of the rack (m/s); the torque is
    ``Y1 = -radius Y2``.

    Attributes:
        radius: of the pinion (m).

    Example:
        >>> Rack("steering", ("column", "ground"), ("rod", "ground"), radius=0.01).kind
        'rack'
    """

    radius: Any = None
    kind = "rack"
    domain_names = (ROTATION_1D.name, TRANSLATION_1D.name)
    required = ("radius",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """``X2 - radius X1`` (m/s) and ``Y1 + radius Y2`` (N m), both zero."""
        return _rolled(at, at.value(self.radius))


@dataclass(frozen=True)
class Screw(TwoPort):
    """A lead screw: ``X2 = lead / (2 pi) X1``.

    X1 is the angular velocity of the spindle (rad/s), X2 the velocity of the nut (m/s); the torque is
    ``Y1 = -lead / (2 pi) Y2``. It runs without friction in both directions; add `rotational_friction` for a
    screw that locks itself.

    Attributes:
        lead: way for one turn (m).

    Example:
        >>> Screw("spindle", ("motor", "ground"), ("table", "ground"), lead=0.005).kind
        'screw'
    """

    lead: Any = None
    kind = "screw"
    domain_names = (ROTATION_1D.name, TRANSLATION_1D.name)
    required = ("lead",)

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """``X2 - lead / (2 pi) X1`` (m/s) and ``Y1 + lead / (2 pi) Y2`` (N m), both zero."""
        return _rolled(at, at.value(self.lead) / (2 * pi))


def _transformed(at: Terminals, ratio: Scalar) -> tuple[Scalar, Scalar]:
    """The laws of a transformer: across variables in a fixed ratio, through variables in its reciprocal."""
    return at.X[0] - ratio * at.X[1], at.Y[1] + ratio * at.Y[0]


def _gyrated(at: Terminals, ratio: Scalar) -> tuple[Scalar, Scalar]:
    """The laws of a gyrator: across variables follow the other edge's through variable."""
    return at.X[0] - ratio * at.Y[1], at.X[1] + ratio * at.Y[0]


def _rolled(at: Terminals, radius: Scalar) -> tuple[Scalar, Scalar]:
    """The laws of a turning first edge and a sliding second one, with the lever arm between them (m)."""
    return at.X[1] - radius * at.X[0], at.Y[0] + radius * at.Y[1]
