"""Wrenches of force elements and loads on links, their generalised forces in joints, and joint efforts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.algebra.protocol import set_label
from linegraph.components.forces import Element, PointForce
from linegraph.components.joints import Joint
from linegraph.components.parameters import names_in
from linegraph.components.scalar.forces import NetworkForce, forces_of
from linegraph.dynamics import potentials
from linegraph.dynamics.force_laws import ForceLaws
from linegraph.dynamics.network_state import DRIVEN, RESTING
from linegraph.errors import ModelError
from linegraph.spatial import vector
from linegraph.spatial.rotation import Full
from linegraph.spatial.vector import ZERO, Vector, add, cross, subtract

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.chords import Chords
    from linegraph.kinematics.ground_frames import GroundFrame
    from linegraph.model.system import System


@dataclass(frozen=True)
class Applied:
    """Forces on a tree besides gravity and joint efforts.

    Attributes:
        wrenches: for each link force (N) and torque about its origin (N m), in its working axes.
        efforts: generalised forces that act in joints, along each velocity (N m or N).
        potential: energy stored in springs (J).
    """

    wrenches: list[tuple[Vector, Vector]]
    efforts: list[Scalar]
    potential: Scalar = 0


def depends_on_inputs(system: System, values: Sequence[Any]) -> bool:
    """Whether one of some expressions names an input; its law then belongs to Q, otherwise to the bias h.

    Args:
        system: the declared inputs.
        values: the expressions of a law, or numbers.
    """
    inputs = {declared.name for declared in system.inputs}
    return any(names_in(value) & inputs for value in values)


def applied(chords: Chords, *, driven: bool, network: str | None = None) -> Applied:
    """Evaluate the elements and loads that depend on inputs, or those that do not.

    The potential energy of elements that inputs drive is counted with the other elements.

    Args:
        chords: the tree at the state, with the motion of all joint ends.
        driven: True for laws that name inputs (they belong to Q), False for the others (they belong to
            h).
        network: part of the networks' forces to include (see `network_state`); by default that driven
            by inputs, or the rest, to match `driven`.

    Raises:
        ModelError: a law names something that does not exist.
    """
    tree = chords.state.tree
    given = tree.system.force_elements
    found: list[Element | PointForce] = [
        e for e in given if depends_on_inputs(tree.system, e.values()) == driven
    ]
    storing = [] if driven else [e for e in given if e not in found]
    if not found and not storing and tree.network is None:
        return Applied([(ZERO, ZERO)] * len(tree.links), [0] * len(tree.velocities))
    part = network or (DRIVEN if driven else RESTING)
    return exerted(chords, [*found, *forces_of(tree.system.components)], part, storing)


def exerted(
    chords: Chords,
    elements: Sequence[Element | PointForce],
    part: str,
    storing: Sequence[Element | PointForce] = (),
) -> Applied:
    """Forces of given elements and loads, and of the networks.

    Args:
        chords: the tree at the state, with the motion of all joint ends.
        elements: those that act.
        part: the part of the networks' forces to include; see `network_state`.
        storing: elements of which only the potential energy counts.

    Raises:
        ModelError: a law names something that does not exist or has no value there.
    """
    acting = _Acting(ForceLaws(chords, part=part))
    for element in storing:
        if isinstance(element, Element):
            acting.hold(element)
    return acting.of(elements)


def efforts(chords: Chords, actions: Sequence[Scalar]) -> list[Scalar]:
    """Generalised forces Q with the joints' efforts: at their own velocity, or projected from a chord.

    Args:
        chords: the tree at the state, with the motion of all joint ends.
        actions: other generalised forces along each velocity (N m or N), to which efforts are added.
    """
    tree, algebra = chords.state.tree, chords.state.algebra
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


class _Acting:
    """Collects wrenches on links, generalised forces in joints, and energy."""

    def __init__(self, laws: ForceLaws) -> None:
        self._laws = laws
        self._chords = laws.chords
        self._tree = tree = laws.chords.state.tree
        self._algebra = tree.algebra
        self._wrenches: list[tuple[Vector, Vector]] = [(ZERO, ZERO)] * len(tree.links)
        self._efforts: list[Scalar] = [0] * len(tree.velocities)
        self._potential: Scalar = 0

    def of(self, elements: Sequence[Element | PointForce]) -> Applied:
        """Evaluate all elements and loads, then the forces of the networks on their own states."""
        for element in elements:
            set_label(self._algebra, f"{element.kind} {element.name}")
            try:
                self._take(element)
            except ModelError as error:
                if isinstance(element, NetworkForce) and error.thing:
                    raise  # the error already names the component
                raise ModelError(f'{element.kind} "{element.name}"', error.problem) from None
            except ZeroDivisionError:
                problem = "division by zero: a value that is divided by is zero"
                raise ModelError(f'{element.kind} "{element.name}"', problem) from None
        exchange = self._laws.exchange
        if exchange is not None:
            for k, state in enumerate(exchange.network.states):
                set_label(self._algebra, f"network, {state.quantity.name}")
                place = exchange.first + k
                self._efforts[place] = self._efforts[place] + exchange.force(k, self._laws.part)
        return Applied(self._wrenches, self._efforts, self._potential)

    def _take(self, element: Element | PointForce) -> None:
        if isinstance(element, PointForce):
            self._push(self._laws.terminal(element.at), *self._laws.wrench(element))
        elif element.joint is not None:
            self._in_joint(element, element.joint)
        else:
            self._between(element)

    def _in_joint(self, element: Element, joint: str) -> None:
        x, y = self._laws.in_joint(element)
        place = self._tree.layout.own(joint)
        if place is not None:
            for freedom in (*place.velocities, *place.less[1]):
                known = self._efforts[freedom.index]
                self._efforts[freedom.index] = known - freedom.ratio * y
        else:
            pair = self._chords.effort(self._laws.closure(joint), [-y])
            for freedom, entry in self._chords.along(pair):
                self._efforts[freedom.index] = self._efforts[freedom.index] + entry
        self._store(element, x)

    def _between(self, element: Element) -> None:
        assert element.between is not None
        x, pull = self._laws.between(element)
        a, b = (self._laws.terminal(end) for end in element.between)
        self._push(a, pull)
        self._push(b, vector.negate(pull))
        self._store(element, x)

    def _push(self, at: tuple[int, GroundFrame], force: Vector, torque: Vector = ZERO) -> None:
        """Apply a force (N) and a torque (N m), both in ground axes, at a point of a link."""
        link, point = at
        if link < 0:
            return
        frame = self._chords.frames[link]
        torque = add(torque, cross(subtract(point.origin, frame.origin), force))
        into = Full(frame.rotation).into
        known = self._wrenches[link]
        self._wrenches[link] = (add(known[0], into(force)), add(known[1], into(torque)))

    def hold(self, element: Element) -> None:
        """Count an element's potential energy only."""
        if potentials.holds(self._tree.system, element):
            self._store(element, self._laws.measured(element))

    def _store(self, element: Element, x: Scalar) -> None:
        system, resolve = self._tree.system, self._laws.resolve
        self._potential = self._potential + potentials.stored(
            system, element, self._algebra, x, resolve
        )
