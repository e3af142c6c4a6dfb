"""The inverse scheme: once v̇ and λ are known, every variable of every edge follows.

Across variables follow from the circuit equations, through variables from the cutset equations, body by
body from the leaves to the root: the joint towards ground transmits the force that the body's motion
requires, less all forces of its other edges. Masses are those of the model, not the regrouped ones of
the equations of motion.

In each subspace, through times across summed over all edges is zero. A force beside a mass centre is a
torque about it: its arm has a *lever* edge in rotation, from ground to the mass centre.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.algebra.protocol import set_label
from linegraph.components.body import GROUND, MASS_CENTER
from linegraph.components.body_mass import mass_center
from linegraph.components.constraints.base import Constraint
from linegraph.components.forces import Element, PointForce
from linegraph.dynamics.edge_quantities import NOTHING, EdgeVariables, Wrench
from linegraph.dynamics.force_laws import ForceLaws
from linegraph.dynamics.orthogonality import applied_to
from linegraph.kinematics.ground_frames import GROUND_FRAME, GroundFrame, Pair, frames, seated
from linegraph.kinematics.links import Seat
from linegraph.model.choices import GROUND_AXES, HEAD
from linegraph.model.terminal_graphs import terminals_of
from linegraph.spatial.vector import (
    ZERO,
    Vector,
    add,
    cross,
    dot,
    negate,
    scale,
    subtract,
    times,
    transpose,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.chords import Chords
    from linegraph.kinematics.links import Closure


class InverseScheme:
    """Every variable of a model at a state, over any algebra; computed on demand.

    Args:
        chords: the tree at the state, not regrouped, with its constraints.
        acceleration: v̇ (rad/s², m/s²); None if only across variables are needed.
        multipliers: λ, one per entry of `chords.equations`; empty if only across variables are needed.
    """

    def __init__(
        self,
        chords: Chords,
        acceleration: Sequence[Scalar] | None = None,
        multipliers: Sequence[Scalar] = (),
    ) -> None:
        """Compute the links' motion; forces and reactions follow when they are first needed."""
        self.chords = chords
        self._tree = tree = chords.state.tree
        self._model = tree.system
        self._algebra = tree.algebra
        self._resolve = tree.resolve
        self._multipliers = multipliers
        self._frames = frames(chords.state, acceleration)
        self._terminals = terminals_of(tree.system)
        self._known: dict[str, GroundFrame] = {}
        self._laws = ForceLaws(chords, acceleration)

    # -- places and motion

    def terminal(self, name: str) -> GroundFrame:
        """Motion of a terminal or a mass centre, in ground axes."""
        if name not in self._known:
            self._known[name] = self._found(name)
        return self._known[name]

    def center(self, body: str) -> GroundFrame:
        """Motion of a body's mass centre; the frame has the body's axes."""
        return self.terminal(f"{body}.{MASS_CENTER}")

    def _found(self, name: str) -> GroundFrame:
        body, _, last = name.rpartition(".")
        if last == MASS_CENTER and body in self._model.bodies:
            return self._body(body).at(mass_center(self._model.bodies[body], self._resolve))
        body, placement = self._terminals[name]
        at = self._vector(placement.at)
        x, y, z = (self._vector(row) for row in placement.rotation)
        return self._body(body).at(at, (x, y, z))

    def _body(self, body: str) -> GroundFrame:
        link, pose = self._tree.bodies[body]
        return seated(self._frames, Seat(link, pose.at, pose.rotation))

    def _vector(self, a: Vector) -> Vector:
        return (self._resolve(a[0]), self._resolve(a[1]), self._resolve(a[2]))

    # -- applied forces

    @cached_property
    def joints(self) -> dict[str, Wrench]:
        """The wrench of every joint and constraint on its head, about the head's origin, in ground axes.

        It includes efforts and driving forces, but not elements in the joint: these have edges of their
        own.
        """
        found: dict[str, Wrench] = {}
        needed = {name: self._needed(name) for name in self._model.bodies}
        for element in self._model.elements:
            for terminal, wrench in self._ends_of(element):
                self._give(needed, terminal, wrench)
        for closure in self._tree.closures:
            name = closure.component.name
            if name not in self._branches:
                found[name] = self._chord(closure)
                self._exchange(needed, closure, found[name])
        for step in reversed(self._tree.walk):
            name = step.edge.name
            if name in self._branches:
                found[name] = self._branch(needed, self._tree.ends[name], step.forward)
        for element in self._model.elements:
            if isinstance(element, Element) and element.joint is not None:
                own = self.elements[element.name].through
                found[element.joint] = found[element.joint] + own.turned()
        return found

    @cached_property
    def _branches(self) -> set[str]:
        joints = {joint.name for joint in self._model.joints}
        return {
            step.edge.name for step in self._tree.walk if step.edge.component in joints
        } & joints

    def _needed(self, body: str) -> Wrench:
        """The force that a body's motion requires, less its weight, about its mass centre."""
        set_label(self._algebra, f"forces, body {body}")
        return self.inertia(body).through.turned()

    def _branch(self, needed: dict[str, Wrench], closure: Closure, forward: bool) -> Wrench:
        """The cutset of a branch: it transmits all forces that the bodies beyond it still need."""
        joint: Any = closure.component
        set_label(self._algebra, f"reaction in {joint.name}")
        head = self.terminal(joint.between[1])
        near, far = joint.between if forward else reversed(joint.between)
        body, inner = self._terminals[far][0], self._terminals[near][0]
        rest = needed[body].about(self.center(body).origin, head.origin)
        if inner in needed:
            needed[inner] = needed[inner] + rest.about(head.origin, self.center(inner).origin)
        return rest if forward else rest.turned()

    def _chord(self, closure: Closure) -> Wrench:
        """The wrench of a chord: multipliers times reaction directions, efforts, and elements in it."""
        total = NOTHING
        component = closure.component
        equations = self.chords.equations if self._multipliers else ()
        for equation, multiplier in zip(equations, self._multipliers, strict=True):
            if equation.component == component.name:
                row = self.chords.rows[component.name][equation.place]
                total = total + Wrench(scale(multiplier, row.force), scale(multiplier, row.torque))
        first = self._tree.layout.pushes.get(component.name)
        if first is not None and not isinstance(component, Constraint):
            given = [self._algebra.symbol("u", first + k) for k in range(component.freedoms)]
            pair = self.chords.effort(closure, given)
            total = total + Wrench(pair.force, pair.torque)
        for element in self._model.elements:
            if isinstance(element, Element) and element.joint == component.name:
                total = total + self.elements[element.name].through
        return total

    def _exchange(self, needed: dict[str, Wrench], closure: Closure, wrench: Wrench) -> None:
        """Apply a chord's wrench to the body at its head, and the reaction to that at its tail."""
        component: Any = closure.component
        tail, head = component.between
        origin = self.terminal(head).origin
        for terminal, acting in ((head, wrench), (tail, wrench.turned())):
            body = self._terminals[terminal][0]
            if body in needed:
                given = acting.about(origin, self.center(body).origin).turned()
                needed[body] = needed[body] + given

    def _give(self, needed: dict[str, Wrench], terminal: str, wrench: Wrench) -> None:
        """Subtract a force at a terminal from those that its body still needs."""
        body = self._terminals[terminal][0]
        if body in needed:
            origin = self.terminal(terminal).origin
            given = wrench.about(origin, self.center(body).origin).turned()
            needed[body] = needed[body] + given

    def _ends_of(self, element: Element | PointForce) -> list[tuple[str, Wrench]]:
        """The wrenches of a load, or of an element between points, on its terminals."""
        if isinstance(element, PointForce):
            return [(element.at, self.elements[element.name].through)]
        if element.between is None:
            return []
        on_head = self.elements[element.name].through
        tail, head = element.between
        return [(head, on_head), (tail, on_head.turned())]

    @cached_property
    def elements(self) -> dict[str, EdgeVariables]:
        """Every force element and load as an edge."""
        return {element.name: self._element(element) for element in self._model.elements}

    def _element(self, element: Element | PointForce) -> EdgeVariables:
        set_label(self._algebra, f"{element.kind} {element.name}")
        if isinstance(element, PointForce):
            frame = self.terminal(element.at)
            return EdgeVariables(Wrench(*self._laws.wrench(element)), frame.linear, frame.angular)
        if element.between is not None:
            tail, head = (self.terminal(end) for end in element.between)
            pull = self._laws.between(element)[1]
            return self._edge(Wrench(negate(pull), ZERO), tail, head)
        closure = self._tree.ends[str(element.joint)]
        y = self._laws.in_joint(element)[1]
        pair: Pair = self.chords.effort(closure, [-y])
        joint: Any = closure.component
        tail, head = (self.terminal(end) for end in joint.between)
        return self._edge(Wrench(pair.force, pair.torque), tail, head)

    def inertia(self, body: str) -> EdgeVariables:
        """A body's inertia edge, ground to mass centre: d'Alembert's force and torque, with weight."""
        own = self._model.bodies[body]
        frame = self.center(body)
        mass = self._resolve(own.mass)
        pull = subtract(frame.pull, self._tree.gravity)
        inward = transpose(frame.rotation)
        spin, omega = times(inward, frame.spin), times(inward, frame.angular)
        tensor = self._central(body, mass)
        torque = add(applied_to(tensor, spin), cross(omega, applied_to(tensor, omega)))
        through = Wrench(scale(mass, pull), times(frame.rotation, torque)).turned()
        return EdgeVariables(through, frame.linear, frame.angular)

    def _central(self, body: str, mass: Scalar) -> Any:
        """A body's inertia about its mass centre, in its axes: six entries (kg m²)."""
        own = self._model.bodies[body]
        xx, xy, xz, yy, yz, zz = (self._resolve(x) for x in own.inertia)
        if own.first is None:
            return (xx, xy, xz, yy, yz, zz)
        x, y, z = mass_center(own, self._resolve)
        return (
            xx - mass * (y * y + z * z),
            xy + mass * (x * y),
            xz + mass * (x * z),
            yy - mass * (x * x + z * z),
            yz + mass * (y * z),
            zz - mass * (x * x + y * y),
        )

    @staticmethod
    def _edge(through: Wrench, tail: GroundFrame, head: GroundFrame) -> EdgeVariables:
        """An edge between two moving frames."""
        lever = negate(cross(subtract(head.origin, tail.origin), through.force))
        return EdgeVariables(
            through,
            subtract(head.linear, tail.linear),
            subtract(head.angular, tail.angular),
            lever,
            tail.angular,
        )

    # -- results

    def reaction(self, joint: str) -> Wrench:
        """The wrench of a joint on its head, about the head's origin, in the axes of `choices.reactions`."""
        component: Any = self._tree.ends[joint].component
        tail, head = component.between
        axes = {HEAD: head, GROUND_AXES: GROUND}.get(self._model.choices.reactions, tail)
        frame = GROUND_FRAME if axes == GROUND else self.terminal(axes)
        inward = transpose(frame.rotation)
        return Wrench(*(times(inward, part) for part in self.joints[joint]))

    def tension(self, element: Element) -> tuple[Scalar, Scalar]:
        """Across and through variable of a force element: its length or coordinate, and its tension."""
        if element.between is None:
            return self._laws.in_joint(element)
        x, pull = self._laws.between(element)
        tail, head = (self.terminal(end) for end in element.between)
        return x, dot(pull, subtract(head.origin, tail.origin)) / x

    def across(self) -> dict[str, tuple[Vector, Vector]]:
        """Velocity and angular velocity of the head less the tail, for every edge, in ground axes."""
        found: dict[str, tuple[Vector, Vector]] = {}
        for body in self._model.bodies:
            center = self.center(body)
            found[f"{body}/inertia"] = (center.linear, center.angular)
        for name, (tail, head) in (*self._between.items(), *self._rigid.items()):
            first, second = self.terminal(tail), self.terminal(head)
            linear = subtract(second.linear, first.linear)
            # both ends of a rigid arm have the same angular velocity: an exact zero, not a difference
            turned = ZERO if name in self._rigid else subtract(second.angular, first.angular)
            found[name] = (linear, turned)
        return found

    @cached_property
    def _rigid(self) -> dict[str, tuple[str, str]]:
        """Mass centre and terminal of every rigid arm of a body."""
        return {
            f"{body}/arm{terminal.removeprefix(body)}": (f"{body}.{MASS_CENTER}", terminal)
            for terminal, (body, _) in self._terminals.items()
            if body in self._model.bodies
        }

    @cached_property
    def _between(self) -> dict[str, tuple[str, str]]:
        """Tail and head of every joint, constraint, element and load."""
        ends = {name: end.component.between for name, end in self._tree.ends.items()}
        for element in self._model.elements:
            if isinstance(element, PointForce):
                ends[element.name] = (GROUND, element.at)
            else:
                ends[element.name] = element.between or ends[str(element.joint)]
        return ends

    def drives(self) -> dict[str, Scalar]:
        """Driving effort along each prescribed coordinate (N m or N), by name of its velocity."""
        found: dict[str, Scalar] = {}
        for name, closure in self._tree.ends.items():
            joint: Any = closure.component
            if isinstance(joint, Constraint) or not any(x is not None for x in closure.drive):
                continue
            wrench = self.joints[name]
            inward = transpose(self.chords.ends(name)[1].rotation)
            force, torque = (times(inward, part) for part in wrench)
            at, rates = (tuple(getattr(x, c) for x in closure.drive) for c in ("x", "dx"))
            motion = joint.motion(self._algebra, at, rates)
            for quantity, s, u in zip(
                joint.velocities(), motion.angular, motion.linear, strict=True
            ):
                found[quantity.name] = dot(s, torque) + dot(u, force)
        return found

    def network(self) -> dict[str, tuple[Scalar, Scalar]]:
        """Across and through variable of every edge of the scalar networks."""
        exchange = self._laws.exchange
        if exchange is None:
            return {}
        set_label(self._algebra, "network, every edge")
        names = [b.name for b in exchange.network.branches if not b.port.spatial]
        return {name: (exchange.across(name), exchange.through(name)) for name in names}

    def gains(self) -> dict[str, Scalar]:
        """The energy balance of each component of the networks (W): zero."""
        exchange = self._laws.exchange
        return {} if exchange is None else exchange.gains()

    def variables(self) -> Mapping[str, Scalar]:
        """Variables ``across(R1)`` and ``through(R1)`` of networks, under the names that outputs use."""
        exchange = self._laws.exchange
        return {} if exchange is None else exchange.variables()

    def edges(self) -> dict[str, EdgeVariables]:
        """All edges of the system graph, by name, in both mechanical subspaces."""
        found: dict[str, EdgeVariables] = {}
        for body in self._model.bodies:
            found[f"{body}/inertia"] = self.inertia(body)
        for name, closure in self._tree.ends.items():
            component: Any = closure.component
            tail, head = (self.terminal(end) for end in component.between)
            found[name] = self._edge(self.joints[name], tail, head)
        found |= self.elements
        return found | self._arms(found)

    def _arms(self, found: Mapping[str, EdgeVariables]) -> dict[str, EdgeVariables]:
        """Rigid arms transmit the sum of their terminals' other edges: the vertex postulate."""
        received: dict[str, Wrench] = {}
        for name, (tail, head) in self._between.items():
            edge = found[name]
            back = Wrench(negate(edge.through.force), add(negate(edge.through.torque), edge.lever))
            received[head] = received.get(head, NOTHING) + edge.through
            received[tail] = received.get(tail, NOTHING) + back
        return {
            name: self._edge(
                received.get(head, NOTHING).turned(), self.terminal(tail), self.terminal(head)
            )
            for name, (tail, head) in self._rigid.items()
        }
