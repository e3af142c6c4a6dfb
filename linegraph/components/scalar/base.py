"""The base of all components of scalar networks.

A *component* is a terminal graph in scalar subspaces: one edge for each of its ports. The across variable X
of an edge is the potential of its tail less that of its head, the through variable Y flows through the
component from tail to head, so that X Y is the power it takes in. Across and through variables, and stores
of the A-type and the T-type, are those of linear graphs [Rowell and Wormley 1997].

    between = (tail, head)   the vertices of an edge: names, in each domain its own, "ground" the datum
    joint = name             where a transducer acts in 3-D mechanics: X is the rate of the coordinate
    points = (a, b)          the same between two points: X is the rate of their distance
    shaft = (tail, head)     the same in a network of 1-D mechanics

A port is *static*, with a law between across and through variables, or it *stores*: it keeps one of its
variables, and the other is the rate of its charge, ``∂W'/∂kept`` of the component's co-energy W'. With a
displacement x in the co-energy the mechanical port pushes with ``∂W'/∂x``. All types have the same methods
in the same order:

    ports   kept   states   laws   kept_coenergy   charges   rates   own_energy   dissipation
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from linegraph.components.domains import ROTATION_1D, TRANSLATION_1D
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar

ACROSS, THROUGH, STATIC = "across", "through", ""
"""The variable that a port keeps; a static port keeps none."""

Pair = tuple[str, str]
Own = Mapping[str, tuple[str, ...]]
"""The names of its own variables that the expression of a field may use, by field."""


@dataclass(frozen=True)
class Port:
    """One edge of a component.

    Attributes:
        label: what it is called beside the component's name; empty for the only one.
        domain: its subspace; of a port in 3-D mechanics empty.
        between: its vertices; or
        joint, points: where it is in 3-D mechanics.
    """

    label: str
    domain: str
    between: Pair | None = None
    joint: str | None = None
    points: Pair | None = None

    def edge(self, component: str) -> str:
        """The name of its edge: ``component.label``, or the component's where it is the only one.

        Args:
            component: the component's name.
        """
        return f"{component}.{self.label}" if self.label else component

    @property
    def spatial(self) -> bool:
        """Whether it is in 3-D mechanics: at a joint or between two points."""
        return self.between is None


class Terminals(Protocol):
    """The variables of a component and the functions that its laws are written in.

    X, Y and the states belong to the component alone; there is one X and one Y for each of its ports, in
    their order.
    """

    @property
    def X(self) -> Sequence[Scalar]:
        """The across variable of each port, the tail's potential less the head's."""

    @property
    def Y(self) -> Sequence[Scalar]:
        """The through variable of each port, from tail to head."""

    @property
    def x(self) -> Scalar:
        """The displacement of the mechanical port (m or rad): coordinate, distance, or the integral of X."""

    @property
    def states(self) -> Mapping[str, Scalar]:
        """The component's own states, by the names in `Component.states`."""

    def value(self, given: Any, **own: Scalar) -> Scalar:
        """The scalar of a model value.

        Args:
            given: a number, a parameter, or an expression of anything that a law may name.
            own: scalars of further names that the expression may use, such as x for the displacement.
        """

    def function(self, name: str, *x: Scalar) -> Scalar:
        """The value of an elementary function.

        Args:
            name: one of `linegraph.ir.functions.ARITY`.
            x: its arguments.
        """

    def potential(self, domain: str, vertex: str) -> Scalar:
        """The across variable from a vertex to ground.

        Args:
            domain: the subspace.
            vertex: a vertex in it.
        """

    def derivative(self, of: Scalar, by: Scalar) -> Scalar:
        """The partial derivative of an expression.

        Args:
            of: the expression.
            by: the symbol with respect to which it is differentiated: a state, or the displacement.
        """

    def taken(self, name: str) -> Scalar:
        """The power that another component, or a force element, turns into heat (W).

        Args:
            name: of the component or element.
        """


@dataclass(frozen=True)
class OwnState:
    """A state that belongs to a component alone.

    Attributes:
        name: in the component's expressions.
        label: what the state's name begins with.
        unit: of the state.
        about: what it is.
    """

    name: str
    label: str
    unit: str
    about: str


@dataclass(frozen=True)
class Component:
    """Base of all components of scalar networks.

    Attributes:
        name: also the name of its edge, or what the names of its edges begin with.
    """

    name: str

    kind: ClassVar[str]
    own: ClassVar[Own] = {}
    needs: ClassVar[tuple[tuple[str, ...], ...]] = ()
    """Of each group of fields, exactly one is given."""
    required: ClassVar[tuple[str, ...]] = ()
    """Fields that must be given."""
    source: ClassVar[bool] = False
    """Whether it delivers power from outside."""

    def ports(self) -> tuple[Port, ...]:
        """Its edges, in the order of X and Y."""
        raise NotImplementedError

    def kept(self) -> tuple[str, ...]:
        """For each port the variable it keeps, "across" or "through"; "" for a static port."""
        return (STATIC,) * len(self.ports())

    def states(self) -> tuple[OwnState, ...]:
        """Its states besides those that ports keep."""
        return ()

    def laws(self, at: Terminals) -> tuple[Scalar, ...]:
        """One expression for each port.

        For a static port, a residual, which is zero. For a port that stores, the part of its other variable
        that is not the rate of its charge. A mechanical port's law starts with +Y; the force of a
        displacement in the co-energy is added to it.

        Args:
            at: the component's variables.
        """
        return (0,) * len(self.ports())

    def kept_coenergy(self, at: Terminals) -> Scalar:
        """The co-energy W' of the kept variables and the displacement (J).

        Args:
            at: the component's variables.
        """
        return 0

    def charges(self, at: Terminals) -> tuple[Scalar, ...] | None:
        """The charge of each port that stores, where it is given and not the derivative of a co-energy.

        Args:
            at: the component's variables.

        Returns:
            The charges, through variable times second or across variable times second; None where they follow
            from `kept_coenergy`.
        """
        return None

    def rates(self, at: Terminals) -> tuple[Scalar, ...]:
        """The derivatives of its own states with respect to time, in the order of `states`.

        Args:
            at: the component's variables.
        """
        return ()

    def own_energy(self, at: Terminals) -> Scalar:
        """The energy stored in states of its own, besides ``Σ kept charge - W'`` (J).

        Args:
            at: the component's variables.
        """
        return 0

    def dissipation(self, at: Terminals) -> Scalar:
        """The power it turns into heat (W), positive.

        Args:
            at: the component's variables.
        """
        return 0

    @property
    def displaced(self) -> bool:
        """Whether its laws use the displacement of its mechanical port, which then is a state."""
        return False

    def values(self) -> tuple[Any, ...]:
        """The model values its laws depend on; those left out are not among them."""
        own = (getattr(self, f.name) for f in fields(self) if f.name not in PLACES)
        return tuple(value for given in own for value in _flat(given) if value is not None)

    def require_fields(self) -> None:
        """Refuse a component that lacks a field or has one too many.

        Raises:
            ModelError: names the field.
        """
        who = f'{self.kind} "{self.name}"'
        for group in self.needs:
            given = [key for key in group if getattr(self, key) is not None]
            if len(given) != 1:
                raise ModelError(who, f"give {' or '.join(group)}{', not both' * bool(given)}")
        for key in self.required:
            if getattr(self, key) is None:
                raise ModelError(who, f"{key} is missing")


PLACES = (
    "name",
    "between",
    "second",
    "output",
    "windings",
    "joint",
    "points",
    "shaft",
    "domain",
    "domains",
    "of",
    "keeps",
)


def _flat(given: Any) -> tuple[Any, ...]:
    if isinstance(given, (tuple, list)):
        return tuple(x for part in given for x in _flat(part))
    return (given,)


@dataclass(frozen=True)
class OnePort(Component):
    """A component with one edge.

    Attributes:
        between: its vertices (tail, head).
    """

    between: Pair

    domain_name: ClassVar[str]

    def ports(self) -> tuple[Port, ...]:
        """Its edge, which has its name."""
        return (Port("", self.domain_name, self.between),)


@dataclass(frozen=True)
class Dissipator(OnePort):
    """A component with one edge that turns all it takes in into heat."""

    def dissipation(self, at: Terminals) -> Scalar:
        """All power it takes in, ``X Y`` (W)."""
        return at.X[0] * at.Y[0]


@dataclass(frozen=True)
class TwoPort(Component):
    """A component with two edges, "first" and "second".

    Attributes:
        between: the vertices of its first edge.
        second: the vertices of its second edge.
    """

    between: Pair
    second: Pair

    domain_names: ClassVar[tuple[str, str]] = ("", "")

    def ports(self) -> tuple[Port, ...]:
        """The edges "first" and "second", in that order."""
        first, second = self.domain_names
        return Port("first", first, self.between), Port("second", second, self.second)


@dataclass(frozen=True)
class Transducer(Component):
    """A component with one edge in a network and one in mechanics, called after their subspaces.

    X[0], Y[0] belong to the edge in the network, X[1], Y[1] to the one in mechanics. X[1] is the rate w of
    the joint's coordinate, of the distance or of the shaft; Y[1] opposes it, so a transducer that drives with
    a force F has the law ``Y[1] + F = 0``.

    Attributes:
        between: the vertices of its edge in the network.
        joint: the joint it drives along its coordinate; or
        points: the two points, body or body.frame, it pushes apart; or
        shaft: the vertices of its edge in a network of 1-D mechanics.
    """

    between: Pair
    joint: str | None = None
    points: Pair | None = None
    shaft: Pair | None = None

    domain_name: ClassVar[str]
    turns: ClassVar[bool] = False
    """Whether a shaft turns."""

    def ports(self) -> tuple[Port, ...]:
        """The edge in the network, then the one in mechanics."""
        return Port(self.domain_name, self.domain_name, self.between), self.mechanical()

    def mechanical(self) -> Port:
        """The edge in mechanics, "mechanical".

        Raises:
            ModelError: it has no place, or several.
        """
        given = [x for x in (self.joint, self.points, self.shaft) if x is not None]
        if len(given) != 1:
            problem = "give exactly one of joint, points and shaft: where it acts in mechanics"
            raise ModelError(f'{self.kind} "{self.name}"', problem)
        if self.shaft is None:
            return Port("mechanical", "", None, self.joint, self.points)
        domain = ROTATION_1D if self.turns else TRANSLATION_1D
        return Port("mechanical", domain.name, self.shaft)
