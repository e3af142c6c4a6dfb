"""Forces that elements and loads exert on links and along joints."""

from __future__ import annotations

from collections import ChainMap
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.algebra.protocol import set_label
from linegraph.components.forces import Element, Load
from linegraph.components.forces.load import BODY
from linegraph.components.joints import Joint
from linegraph.components.parameters import names_in, resolver
from linegraph.components.scalar.forces import NetworkForce, forces_of
from linegraph.dynamics import potentials
from linegraph.dynamics.chords import Chords
from linegraph.dynamics.law_names import joint_state, scope
from linegraph.dynamics.network_state import ALL, DRIVEN, RESTING, EdgeMotion, Exchange
from linegraph.errors import ModelError
from linegraph.kinematics.ground_frames import GroundFrame, Pair, seated
from linegraph.kinematics.links import Seat
from linegraph.model.terminal_graphs import terminals_of
from linegraph.spatial import vector
from linegraph.spatial.rotation import Full, product
from linegraph.spatial.vector import ZERO, Vector, add, cross, dot, subtract, times

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.law_names import State
    from linegraph.kinematics.arms import Arm
    from linegraph.kinematics.links import Closure, KinematicTree
    from linegraph.model.system import System


@dataclass(frozen=True)
class Applied:
    """What acts on a tree besides gravity and joint efforts.

    Attributes:
        wrenches: for each link (force, torque about its origin), in its working axes.
        efforts: along each velocity.
        potential: energy stored in springs.
    """

    wrenches: list[tuple[Vector, Vector]]
    efforts: list[Scalar]
    potential: Scalar = 0


def depends_on_inputs(model: System, values: Sequence[Any]) -> bool:
    """Whether a law names an input: then it belongs to Q, otherwise to the bias."""
    inputs = {declared.name for declared in model.inputs}
    return any(names_in(value) & inputs for value in values)


def applied(
    model: System,
    tree: KinematicTree,
    algebra: Algebra,
    parameters: Mapping[str, Scalar],
    crossed: Sequence[Arm],
    q: tuple[Scalar, ...],
    v: tuple[Scalar, ...],
    *,
    driven: bool,
    network: str | None = None,
) -> Applied:
    """Evaluate the elements and loads that depend on inputs (`driven`), or those that do not.

    Of networks the part with inputs zero, or what inputs add to that; or what `network` says. What elements
    hold that inputs drive, too, is counted with those that they do not.

    Raises:
        ModelError: a law names something that does not exist.
    """
    found: list[Element | Load] = [
        e for e in model.force_elements if depends_on_inputs(model, e.values()) == driven
    ]
    storing = [] if driven else [e for e in model.force_elements if e not in found]
    if not found and not storing and tree.network is None:
        return Applied([(ZERO, ZERO)] * len(tree.links), [0] * len(tree.velocities))
    found += forces_of(model.components)
    chords = Chords(tree, algebra, crossed, parameters)
    what = network or (DRIVEN if driven else RESTING)
    acting = Acting(model, tree, algebra, parameters, chords, (q, v), what)
    for element in storing:
        if isinstance(element, Element):
            acting.hold(element)
    return acting.of(found)


def efforts(
    tree: KinematicTree, algebra: Algebra, chords: Chords, actions: Sequence[Scalar]
) -> list[Scalar]:
    """Q of the joints' efforts: at their own velocity, or projected where the joint is not the branch."""
    total = list(actions)
    for index, k in tree.layout.efforts:
        total[index] = total[index] + algebra.symbol("u", k)
    for joint, first in tree.layout.pushes.items():
        place = tree.layout.own(joint)
        if place is not None:
            effort = algebra.symbol("u", first)
            for freedom in (*place.velocities, *place.less[1]):
                total[freedom.index] = total[freedom.index] + freedom.ratio * effort
            continue
        set_label(algebra, f"effort in {joint}")
        (closure,) = (c for c in tree.closures if c.component.name == joint)
        assert isinstance(closure.component, Joint)
        given = [algebra.symbol("u", first + k) for k in range(closure.component.freedoms)]
        for freedom, entry in chords.along(chords.effort(closure, given)):
            total[freedom.index] = total[freedom.index] + entry
    return total


class Acting:
    """Evaluates what elements and loads do at a state, and gathers it."""

    def __init__(
        self,
        model: System,
        tree: KinematicTree,
        algebra: Algebra,
        parameters: Mapping[str, Scalar],
        chords: Chords,
        state: State,
        what: str = ALL,
        acceleration: Sequence[Scalar] | None = None,
    ) -> None:
        """Nothing acts yet; `what` of networks is asked for, and at which v̇."""
        self._model = model
        self._tree = tree
        self._algebra = algebra
        self._state = state
        self._chords = chords
        self._what = what
        names = scope(model, tree, algebra, parameters, state, self._chords)
        self._forces = {e.name: e for e in model.elements if isinstance(e, Element)}
        self.exchange = None
        self._values: Mapping[str, Scalar] = names
        if tree.network is not None:
            known = ChainMap(_Taken(self), names)
            self.exchange = Exchange(
                tree.network, tree, algebra, parameters, state[1], known, self.motion, acceleration
            )
            self._values = ChainMap(names, self.exchange.variables())
        self._terminals = terminals_of(model)
        self._wrenches: list[tuple[Vector, Vector]] = [(ZERO, ZERO)] * len(tree.links)
        self._efforts: list[Scalar] = [0] * len(tree.velocities)
        self._potential: Scalar = 0

    def of(self, elements: Sequence[Element | Load]) -> Applied:
        """All of them."""
        for element in elements:
            set_label(self._algebra, f"{element.kind} {element.name}")
            try:
                self._take(element)
            except ModelError as error:
                if isinstance(element, NetworkForce) and error.thing:
                    raise  # it names the component
                raise ModelError(f'{element.kind} "{element.name}"', error.problem) from None
            except ZeroDivisionError:
                problem = "division by zero: a value that is divided by is zero"
                raise ModelError(f'{element.kind} "{element.name}"', problem) from None
        if self.exchange is not None:
            for k, state in enumerate(self.exchange.network.states):
                set_label(self._algebra, f"network, {state.quantity.name}")
                place = self.exchange.first + k
                self._efforts[place] = self._efforts[place] + self.exchange.force(k, self._what)
        return Applied(self._wrenches, self._efforts, self._potential)

    def _take(self, element: Element | Load) -> None:
        if isinstance(element, Load):
            self._push(self.terminal(element.at), *self.load(element))
        elif element.joint is not None:
            self._in_joint(element, element.joint)
        else:
            self._between(element)

    def _resolve(self, value: Any, /, **names: Scalar) -> Scalar:
        values: Any = self._values
        values = ChainMap(names, values) if names else values
        return resolver(self._algebra, values)(value)

    def _y(self, element: Element, x: Scalar, v: Scalar) -> Scalar:
        """An element's through variable; of an edge of a network as the network says."""
        if not isinstance(element, NetworkForce) or self.exchange is None:
            return element.through(self._algebra, x, v, self._resolve)
        if self.exchange.acceleration is not None:
            return self.exchange.through(element.name)
        ports = [port.name for port in self.exchange.network.ports]
        row = len(self.exchange.network.states) + ports.index(element.name)
        return -self.exchange.force(row, self._what)

    def motion(self, port: str) -> EdgeMotion:
        """How the edge of a network in mechanics moves."""
        element = self._forces[port]
        if element.joint is None:
            return self._stretching(element)
        x, v = self._motion(element.joint)
        place = self._tree.layout.own(element.joint)
        if place is None:
            pair = self._chords.effort(self._closure(element.joint), [1])
            row = [(freedom.index, entry) for freedom, entry in self._chords.along(pair)]
            return EdgeMotion(x, v, tuple(row), None)
        freedoms = (*place.velocities, *place.less[1])
        bias = place.drive[0].ddx if place.drive else 0
        return EdgeMotion(x, v, tuple((f.index, f.ratio) for f in freedoms), bias)

    def _stretching(self, element: Element) -> EdgeMotion:
        """The same of an edge between two points: the distance, and its acceleration at v̇ = 0."""
        assert element.between is not None
        (near, a), (far, b) = (self.terminal(end) for end in element.between)
        x, direction, v = self._line(a, b)
        pair = Pair(direction, ZERO, b.origin, far, near)
        row = [(f.index, entry) for f, entry in self._chords.along(pair)]
        apart = subtract(b.linear, a.linear)
        turning = (dot(apart, apart) - v * v) / x
        return EdgeMotion(x, v, tuple(row), dot(direction, subtract(b.pull, a.pull)) + turning)

    def _line(self, a: GroundFrame, b: GroundFrame) -> tuple[Scalar, Vector, Scalar]:
        """The distance of two points, the direction from one to the other, and the rate."""
        line = subtract(b.origin, a.origin)
        x = self._algebra.sqrt(dot(line, line))
        direction = vector.scale(1 / x, line)
        return x, direction, dot(direction, subtract(b.linear, a.linear))

    def taken(self, name: str) -> Scalar:
        """The power that a force element takes in."""
        element = self._forces[name]
        if element.joint is not None:
            x, v = self._motion(element.joint)
        else:
            assert element.between is not None
            (_, a), (_, b) = (self.terminal(end) for end in element.between)
            x, _, v = self._line(a, b)
        return self._y(element, x, v) * v

    def in_joint(self, element: Element) -> tuple[Scalar, Scalar]:
        """An element's coordinate, which is its joint's, and its through variable."""
        x, v = self._motion(str(element.joint))
        return x, self._y(element, x, v)

    def between(self, element: Element) -> tuple[Scalar, Vector]:
        """An element's length, and the pull on its tail in ground axes."""
        assert element.between is not None
        (_, a), (_, b) = (self.terminal(end) for end in element.between)
        x, direction, v = self._line(a, b)
        return x, vector.scale(self._y(element, x, v), direction)

    def load(self, load: Load) -> tuple[Vector, Vector]:
        """A load's force and torque in ground axes."""
        _, frame = self.terminal(load.at)
        force, torque = (
            tuple(self._resolve(component) for component in given)
            for given in (load.force, load.torque)
        )
        if load.axes == BODY:
            force, torque = times(frame.rotation, force), times(frame.rotation, torque)
        return force, torque

    def terminal(self, terminal: str) -> tuple[int, GroundFrame]:
        """A terminal's link and its motion."""
        body, placement = self._terminals[terminal]
        link, pose = self._tree.bodies[body]
        constant = resolver(self._algebra, self._values)
        at = add(pose.at, times(pose.rotation, _resolved(placement.at, constant)))
        rows = tuple(_resolved(row, constant) for row in placement.rotation)
        axes = product(pose.rotation, rows)  # type: ignore[arg-type]
        return link, seated(self._chords.frames, Seat(link, at, axes))

    def _in_joint(self, element: Element, joint: str) -> None:
        x, y = self.in_joint(element)
        place = self._tree.layout.own(joint)
        if place is not None:
            for freedom in (*place.velocities, *place.less[1]):
                known = self._efforts[freedom.index]
                self._efforts[freedom.index] = known - freedom.ratio * y
        else:
            pair = self._chords.effort(self._closure(joint), [-y])
            for freedom, entry in self._chords.along(pair):
                self._efforts[freedom.index] = self._efforts[freedom.index] + entry
        self._store(element, x)

    def _motion(self, joint: str) -> tuple[Scalar, Scalar]:
        """The coordinate of a joint of one freedom and its velocity."""
        found = joint_state(self._tree, joint, self._state)
        if found is None:
            found = self._chords.coordinates(self._closure(joint))
        (x,), (v,) = found
        return x, v

    def _closure(self, joint: str) -> Closure:
        return next(c for c in self._tree.closures if c.component.name == joint)

    def _between(self, element: Element) -> None:
        assert element.between is not None
        x, pull = self.between(element)
        a, b = (self.terminal(end) for end in element.between)
        self._push(a, pull)
        self._push(b, vector.negate(pull))
        self._store(element, x)

    def _push(self, at: tuple[int, GroundFrame], force: Vector, torque: Vector = ZERO) -> None:
        """Apply a force and a torque in ground axes to a point of a link."""
        link, point = at
        if link < 0:
            return
        frame = self._chords.frames[link]
        torque = add(torque, cross(subtract(point.origin, frame.origin), force))
        into = Full(frame.rotation).into
        known = self._wrenches[link]
        self._wrenches[link] = (add(known[0], into(force)), add(known[1], into(torque)))

    def hold(self, element: Element) -> None:
        """Count an element's potential energy alone."""
        if potentials.holds(self._model, element):
            self._store(element, self._measured(element))

    def _measured(self, element: Element) -> Scalar:
        """An element's coordinate or length."""
        if element.joint is not None:
            return self._motion(element.joint)[0]
        assert element.between is not None
        (_, a), (_, b) = (self.terminal(end) for end in element.between)
        return self._line(a, b)[0]

    def _store(self, element: Element, x: Scalar) -> None:
        held = potentials.stored(self._model, element, self._algebra, x, self._resolve)
        self._potential = self._potential + held


class _Taken(dict[str, Any]):
    """``taken(bearing)``: the power that a force element takes in, evaluated as it is looked up."""

    def __init__(self, acting: Acting) -> None:
        super().__init__()
        self._acting = acting

    def __contains__(self, name: object) -> bool:
        return str(name).startswith("taken(")

    def __getitem__(self, name: str) -> Scalar:
        if name not in self:
            raise KeyError(name)
        return self._acting.taken(name[len("taken(") : -1])


def _resolved(a: Vector, resolve: Any) -> Vector:
    return (resolve(a[0]), resolve(a[1]), resolve(a[2]))
