"""The laws of force elements, loads and network edges in mechanics, evaluated at a state.

A law may name anything the model knows at the state: parameters, inputs, time, coordinates and their
rates, and across and through variables of networks. Laws of networks may in turn name the power that a
force element takes in.
"""

from __future__ import annotations

from collections import ChainMap
from typing import TYPE_CHECKING, Any

from linegraph.components.forces import Element
from linegraph.components.parameters import resolver
from linegraph.components.scalar.forces import NetworkForce
from linegraph.dynamics.law_names import joint_state, scope
from linegraph.dynamics.network_state import ALL, EdgeMotion, Exchange
from linegraph.kinematics.ground_frames import GroundFrame, Pair, seated
from linegraph.kinematics.links import Seat
from linegraph.model.terminal_graphs import terminals_of
from linegraph.spatial import vector
from linegraph.spatial.rotation import product
from linegraph.spatial.vector import ZERO, Vector, add, dot, subtract, times

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.components.forces import PointForce
    from linegraph.dynamics.chords import Chords
    from linegraph.kinematics.links import Closure


class ForceLaws:
    """Evaluates the laws of elements and loads at a state, one at a time.

    Args:
        chords: the tree at the state, with the motion of all joint ends.
        acceleration: v̇ if it is known; through variables of networks then follow from it.
        part: the part of a network's forces to evaluate; see `network_state`.
    """

    def __init__(
        self, chords: Chords, acceleration: Sequence[Scalar] | None = None, part: str = ALL
    ) -> None:
        """Collect the names that laws may use; no law is evaluated yet."""
        self.chords = chords
        self.part = part
        self._state = chords.state
        self._tree = tree = chords.state.tree
        self._algebra = tree.algebra
        names = scope(self._state, chords)
        self._elements = {e.name: e for e in tree.system.elements if isinstance(e, Element)}
        self._terminals = terminals_of(tree.system)
        self.exchange = None
        self._values: Mapping[str, Scalar] = names
        if tree.network is not None:
            known = ChainMap(_Taken(self), names)
            self.exchange = Exchange(tree.network, self._state, known, self.motion, acceleration)
            self._values = ChainMap(names, self.exchange.variables())

    def resolve(self, value: Any, /, **names: Scalar) -> Scalar:
        """The scalar of a model value at the state.

        Args:
            value: a number or an expression.
            names: local names such as x and v, which hide others of the same name.

        Raises:
            ModelError: the expression names something unknown.
        """
        values: Any = self._values
        values = ChainMap(names, values) if names else values
        return resolver(self._algebra, values)(value)

    # -- places and motion

    def terminal(self, terminal: str) -> tuple[int, GroundFrame]:
        """A terminal's link, -1 for ground, and its motion in ground axes."""
        body, placement = self._terminals[terminal]
        link, pose = self._tree.bodies[body]
        constant = resolver(self._algebra, self._values)
        at = add(pose.at, times(pose.rotation, _resolved(placement.at, constant)))
        rows = tuple(_resolved(row, constant) for row in placement.rotation)
        axes = product(pose.rotation, rows)  # type: ignore[arg-type]
        return link, seated(self.chords.frames, Seat(link, at, axes))

    def closure(self, joint: str) -> Closure:
        """The chord that a joint is."""
        return next(c for c in self._tree.closures if c.component.name == joint)

    def moved(self, joint: str) -> tuple[Scalar, Scalar]:
        """The coordinate and velocity of a joint of one freedom, branch or chord."""
        found = joint_state(self._state, joint)
        if found is None:
            found = self.chords.coordinates(self.closure(joint))
        (x,), (v,) = found
        return x, v

    def _line(self, element: Element) -> tuple[Scalar, Vector, Scalar]:
        """Length of an element, unit vector from tail to head in ground axes, and rate of the length."""
        assert element.between is not None
        (_, a), (_, b) = (self.terminal(end) for end in element.between)
        line = subtract(b.origin, a.origin)
        x = self._algebra.sqrt(dot(line, line))
        direction = vector.scale(1 / x, line)
        return x, direction, dot(direction, subtract(b.linear, a.linear))

    def measured(self, element: Element) -> Scalar:
        """An element's coordinate (rad or m) or length (m)."""
        return self._line(element)[0] if element.joint is None else self.moved(element.joint)[0]

    # -- applied forces

    def _through(self, element: Element, x: Scalar, v: Scalar) -> Scalar:
        """An element's through variable; for an edge of a network, the network's."""
        if not isinstance(element, NetworkForce) or self.exchange is None:
            return element.through(self._algebra, x, v, self.resolve)
        if self.exchange.acceleration is not None:
            return self.exchange.through(element.name)
        ports = [port.name for port in self.exchange.network.ports]
        row = len(self.exchange.network.states) + ports.index(element.name)
        return -self.exchange.force(row, self.part)

    def in_joint(self, element: Element) -> tuple[Scalar, Scalar]:
        """Coordinate and through variable of an element in a joint; a positive one opposes the coordinate."""
        x, v = self.moved(str(element.joint))
        return x, self._through(element, x, v)

    def between(self, element: Element) -> tuple[Scalar, Vector]:
        """Length of an element between points (m), and the pull on its tail in ground axes (N)."""
        x, direction, v = self._line(element)
        return x, vector.scale(self._through(element, x, v), direction)

    def wrench(self, acting: PointForce) -> tuple[Vector, Vector]:
        """Force (N) of a load or drag on its body, and torque about its terminal (N m), in ground axes."""
        _, point = self.terminal(acting.at)
        return acting.wrench(self._algebra, point, self.resolve)

    def taken(self, name: str) -> Scalar:
        """The power that a force element takes in (W)."""
        element = self._elements[name]
        if element.joint is not None:
            x, v = self.moved(element.joint)
        else:
            x, _, v = self._line(element)
        return self._through(element, x, v) * v

    # -- motion of network edges

    def motion(self, port: str) -> EdgeMotion:
        """Displacement, rate and acceleration of a network's edge in mechanics."""
        element = self._elements[port]
        if element.joint is None:
            return self._stretching(element)
        x, v = self.moved(element.joint)
        place = self._tree.layout.own(element.joint)
        if place is None:
            pair = self.chords.effort(self.closure(element.joint), [1])
            row = [(freedom.index, entry) for freedom, entry in self.chords.along(pair)]
            return EdgeMotion(x, v, tuple(row), None)
        freedoms = (*place.velocities, *place.less[1])
        bias = place.drive[0].ddx if place.drive else 0
        return EdgeMotion(x, v, tuple((f.index, f.ratio) for f in freedoms), bias)

    def _stretching(self, element: Element) -> EdgeMotion:
        """The motion of an edge between two points: its length, and the length's acceleration at v̇ = 0."""
        assert element.between is not None
        (near, a), (far, b) = (self.terminal(end) for end in element.between)
        x, direction, v = self._line(element)
        pair = Pair(direction, ZERO, b.origin, far, near)
        row = [(f.index, entry) for f, entry in self.chords.along(pair)]
        apart = subtract(b.linear, a.linear)
        turning = (dot(apart, apart) - v * v) / x
        return EdgeMotion(x, v, tuple(row), dot(direction, subtract(b.pull, a.pull)) + turning)


class _Taken(dict[str, Any]):
    """The names ``taken(bearing)``: power that a force element takes in, evaluated on look-up."""

    def __init__(self, laws: ForceLaws) -> None:
        super().__init__()
        self._laws = laws

    def __contains__(self, name: object) -> bool:
        return str(name).startswith("taken(")

    def __getitem__(self, name: str) -> Scalar:
        if name not in self:
            raise KeyError(name)
        return self._laws.taken(name[len("taken(") : -1])


def _resolved(a: Vector, resolve: Any) -> Vector:
    return (resolve(a[0]), resolve(a[1]), resolve(a[2]))
