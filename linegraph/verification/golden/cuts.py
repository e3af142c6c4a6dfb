"""What acts in every joint, from accelerations and multipliers: joints cut, equations of bodies written.

A cut through a branch frees all bodies beyond it. By Newton and Euler the joint exerts on them

    Σ (what their motion needs, weight taken off) - Σ (what elements, loads and chords exert on them)

A chord exerts its multipliers along its reaction directions, which are the derivatives of its equations by
the place of its head: virtual work. Bodies have their own masses, accelerations are derivatives of places
(`walk`). Shared with the emitted program are the laws of elements, and along what a joint's effort acts.
"""

from __future__ import annotations

from collections import ChainMap
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.algebra.jets import Jet, Jets, lifted
from linegraph.components.constraints.base import Constraint, Instant, Pose, Prescribed
from linegraph.components.forces import Element, Load
from linegraph.components.parameters import resolver
from linegraph.components.scalar.forces import NetworkForce
from linegraph.dynamics.chords import equations
from linegraph.dynamics.force_laws import ForceLaws
from linegraph.dynamics.law_names import scope
from linegraph.dynamics.reaction_rows import rows_of
from linegraph.errors import ModelError
from linegraph.model.terminal_graphs import terminals_of

if TYPE_CHECKING:
    from linegraph.kinematics.links import Closure, Seat
    from linegraph.model.system import System
    from linegraph.numeric.derived import Derived
    from linegraph.verification.golden.bodies import Bodies
    from linegraph.verification.golden.kinematics import KinematicReference
    from linegraph.verification.golden.walk import Moved, Valued, Walk

    Array = Any


Sized = tuple[float, float]
"""A number, and how large what it is made of is."""

ASIDE = 1e-3
"""A step for slopes of laws, of which only the size matters."""


class Pull(NamedTuple):
    """A force and a torque about a point, in ground axes, and how large what they are made of is.

    Attributes:
        force, torque: N and N m.
        point: what the torque is about (m).
        of_force, of_torque: the sums of the lengths of their parts.
    """

    force: Array
    torque: Array
    point: Array
    of_force: float
    of_torque: float

    def about(self, point: Array) -> Pull:
        """The same about another point."""
        import numpy as np

        arm = self.point - point
        torque = self.torque + np.cross(arm, self.force)
        reach = float(np.linalg.norm(arm))
        return Pull(
            self.force, torque, point, self.of_force, self.of_torque + reach * self.of_force
        )

    def with_(self, other: Pull) -> Pull:
        """The sum, about the point of the first."""
        other = other.about(self.point)
        return Pull(
            self.force + other.force,
            self.torque + other.torque,
            self.point,
            self.of_force + other.of_force,
            self.of_torque + other.of_torque,
        )

    def turned(self) -> Pull:
        """The reaction."""
        return self._replace(force=-self.force, torque=-self.torque)


class GroundPlace(NamedTuple):
    """A point and its axes in motion, in ground axes, accelerations at the v̇ given.

    Attributes:
        rotation, origin: as of `walk.Moved`.
        linear, angular, pull, spin: velocities and accelerations of its origin and of its axes.
        of_linear, of_angular: how large what the velocities are made of is.
        of_pull, of_spin: the same of the accelerations.
    """

    rotation: Array
    origin: Array
    linear: Array
    angular: Array
    pull: Array
    spin: Array
    of_linear: float
    of_angular: float
    of_pull: float
    of_spin: float


@dataclass(frozen=True)
class Cuts:
    """All edges of a model at a state, for given accelerations and multipliers.

    Attributes:
        derivation: the model, and which edges are branches.
        walk: how everything moves there.
        bodies: what that takes.
        kinematics: places on bodies.
        a: the accelerations, and how large what they are made of is.
        lam: the same of the multipliers.
    """

    derivation: Derived
    walk: Walk
    bodies: Bodies
    kinematics: KinematicReference
    a: Valued
    lam: Valued

    @property
    def model(self) -> System:
        """What was said."""
        return self.derivation.system

    @cached_property
    def acting(self) -> ForceLaws:
        """The laws of elements, loads and networks, in numbers."""
        chords = self.walk.numeric.chords(self.walk.q, self.walk.v)
        return ForceLaws(chords, [float(x) for x in self.a[0]])

    # -- places

    def place(self, terminal: str) -> GroundPlace:
        """How a terminal, or a mass centre, moves."""
        np, (a, of_a), v = self.walk.np, self.a, absolute(self.walk.v)
        at = self.kinematics.frame(terminal)
        linear, angular = at.linear[:, :-1], at.angular[:, :-1]
        u, w = (np.linalg.norm(x, axis=0) for x in (linear, angular))
        # a point of an axis is still for its two distances from somewhere cancel
        fast, far = float(w @ v), float(np.linalg.norm(at.origin))
        turning = float(np.linalg.norm(at.spin) + w @ (np.abs(a) + of_a))
        return GroundPlace(
            at.rotation,
            at.origin,
            at.linear[:, -1],
            at.angular[:, -1],
            at.pull + linear @ a,
            at.spin + angular @ a,
            float(u @ v + np.linalg.norm(at.linear[:, -1])) + fast * far,
            float(fast + np.linalg.norm(at.angular[:, -1])),
            float(np.linalg.norm(at.pull) + u @ (np.abs(a) + of_a)) + (turning + fast**2) * far,
            turning,
        )

    # -- bodies

    def needed(self, body: str) -> Pull:
        """What a body's motion needs, its weight taken off, about its own point."""
        np, (a, of_a) = self.walk.np, self.a
        heavy = self.bodies.heavy_of(body)
        moved = heavy.moved
        linear, angular = moved.linear[:, :-1], moved.angular[:, :-1]
        gravity = self.bodies.gravity
        pull = moved.pull + linear @ a - gravity
        heavy = heavy._replace(moved=moved._replace(spin=moved.spin + angular @ a))
        force, torque = self.bodies.required(heavy, pull)
        u, w = (np.linalg.norm(x, axis=0) for x in (linear, angular))
        far = np.linalg.norm(moved.pull) + np.linalg.norm(gravity) + u @ (np.abs(a) + of_a)
        fast = np.linalg.norm(moved.spin) + w @ (np.abs(a) + of_a)
        fast += np.linalg.norm(moved.angular[:, -1]) ** 2
        first, inertia = np.linalg.norm(heavy.first), np.linalg.norm(heavy.inertia)
        of_force = float(heavy.mass * far + first * fast)
        return Pull(force, torque, moved.origin, of_force, float(inertia * fast + first * far))

    # -- elements, loads and chords

    @cached_property
    def elements(self) -> dict[str, Pull]:
        """What every element and load exerts on its head, about the head's origin."""
        return {element.name: self._element(element) for element in self.model.elements}

    def _element(self, element: Element | Load) -> Pull:
        np = self.walk.np
        if isinstance(element, Load):
            force, torque = (_array(np, x) for x in self.acting.load(element))
            return self._pull(force, torque, element.at)
        if element.between is not None:
            tail, head = (self.place(end) for end in element.between)
            line = head.origin - tail.origin
            length = float(np.linalg.norm(line))
            pull = _array(np, self.acting.between(element)[1])
            y = float(pull @ line) / length
            found = self._pull(-y * line / length, np.zeros(3), element.between[1])
            apart = float(np.linalg.norm(head.origin) + np.linalg.norm(tail.origin))
            rate = float((head.linear - tail.linear) @ line) / length
            carried = self._carried(
                element, (length, apart), (rate, tail.of_linear + head.of_linear)
            )
            return found._replace(of_force=found.of_force + carried)
        closure = self.walk.tree.ends[str(element.joint)]
        _, y = self.acting.in_joint(element)
        pair = self.walk.numeric.chords(self.walk.q, self.walk.v).effort(closure, [-y])
        force, torque = _array(np, pair.force), _array(np, pair.torque)
        return self._pull(force, torque, closure.component.between[1])

    def _carried(self, element: Element, x: Sized, v: Sized) -> float:
        """What a law makes of how large its length and its rate are, which may cancel."""
        if isinstance(element, NetworkForce):
            return 0.0
        numeric = self.walk.numeric
        chords = numeric.chords(self.walk.q, self.walk.v)
        names: Any = scope(chords.state, chords)
        if self.acting.exchange is not None:
            names = ChainMap(names, self.acting.exchange.variables())

        def y(length: float, rate: float) -> float:
            def resolve(value: Any, /, **own: Any) -> Any:
                return resolver(numeric.algebra, ChainMap(own, names))(value)

            return float(element.through(numeric.algebra, length, rate, resolve))

        try:
            here = y(x[0], v[0])
            apart = abs(y(x[0] + ASIDE * x[1], v[0]) - here) + abs(
                y(x[0], v[0] + ASIDE * v[1]) - here
            )
        except (ModelError, ArithmeticError):
            return 0.0
        return apart / ASIDE

    def _pull(self, force: Array, torque: Array, terminal: str) -> Pull:
        np = self.walk.np
        sizes = float(np.linalg.norm(force)), float(np.linalg.norm(torque))
        return Pull(force, torque, self.place(terminal).origin, *sizes)

    def _chord(self, closure: Closure) -> Pull:
        """Multipliers along reaction directions, and efforts; elements that sit in it left out."""
        np, (lam, of_lam) = self.walk.np, self.lam
        component: Any = closure.component
        total = self._pull(np.zeros(3), np.zeros(3), component.between[1])
        for k, equation in enumerate(equations(self.walk.tree)):
            if equation.component == component.name:
                direction = self._directions(closure)[equation.place]
                f, m = direction[:3], direction[3:]
                size = abs(lam[k]) + of_lam[k]
                sizes = float(size * np.linalg.norm(f)), float(size * np.linalg.norm(m))
                total = total.with_(Pull(lam[k] * f, lam[k] * m, total.point, *sizes))
        first = self.walk.tree.layout.pushes.get(component.name)
        if first is not None and not isinstance(component, Constraint):
            u = self.walk.numeric.algebra.arguments["u"]
            given = u[first : first + component.freedoms]
            pair = self.walk.numeric.chords(self.walk.q, self.walk.v).effort(closure, given)
            force, torque = _array(np, pair.force), _array(np, pair.torque)
            total = total.with_(self._pull(force, torque, component.between[1]))
        return total

    def _directions(self, closure: Closure) -> list[Array]:
        """Of each row of a chord the force and torque on its head that do work on nothing it allows.

        They are the row's derivatives as its head moves along and turns about the axes of ground; of what
        only velocities obey they are the row itself.
        """
        np = self.walk.np
        jets, resolve = Jets(self.walk.numeric.algebra), self.walk.numeric.resolve
        tail, head = (self.seat(end) for end in (closure.tail, closure.head))
        x, y, z = map(float, tail.origin)
        still = Pose(_rows(tail.rotation), (x, y, z))
        zero, turns = np.zeros(6), np.zeros((3, 3, 6))
        for k, unit in enumerate(np.eye(3)):
            turns[:, :, 3 + k] = np.cross(unit, head.rotation, axisa=0, axisb=0, axisc=0)
        rotation = tuple(
            tuple(Jet(float(head.rotation[i, j]), turns[i, j], 0.0) for j in range(3))
            for i in range(3)
        )
        origin = tuple(Jet(float(head.origin[i]), np.eye(6)[i], 0.0) for i in range(3))
        drive = [
            None if x is None else Prescribed(Jet(x.x, zero, 0.0), Jet(x.dx, zero, 0.0))
            for x in closure.drive
        ]
        moving: Any = Pose(rotation, origin)  # type: ignore[arg-type]
        at = Instant(jets, lambda x: lifted(resolve(x)), still, moving, drive)
        found = []
        for row in rows_of(closure, at):
            if row.position is not None:
                found.append(np.broadcast_to(lifted(row.position).dx, 6))
            else:
                parts = [lifted(x).x for x in (*row.force, *row.torque)]
                found.append(np.array(parts, float))
        return found

    def seat(self, seat: Seat) -> Moved:
        """How a seat of a link moves."""
        return self.walk.moved(seat.link, seat.at, seat.rotation)

    # -- joints

    @cached_property
    def joints(self) -> dict[str, Pull]:
        """What every joint and constraint exerts on its head, about the head's origin; elements not."""
        terminals = terminals_of(self.model)
        chords = {
            closure.component.name: self._chord(closure)
            for closure in self.walk.tree.closures
            if closure.component.name not in self._branches
        }
        on = {body: self.needed(body) for body in self.model.bodies}

        def give(terminal: str, pull: Pull) -> None:
            body = terminals[terminal][0]
            if body in on:
                on[body] = on[body].with_(pull.turned())

        for element in self.model.elements:
            if isinstance(element, Load):
                give(element.at, self.elements[element.name])
            elif element.between is not None:
                give(element.between[1], self.elements[element.name])
                give(element.between[0], self.elements[element.name].turned())
            elif element.joint not in self._branches:
                self._apart(give, str(element.joint), self.elements[element.name])
        for name, pull in chords.items():
            self._apart(give, name, pull)
        found = chords
        for name, (far, forward) in self._branches.items():
            head = self.place(self.walk.tree.ends[name].component.between[1]).origin
            zero = self.walk.np.zeros(3)
            total = Pull(zero, zero, head, 0.0, 0.0)
            for body in far:
                total = total.with_(on[body])
            found[name] = total if forward else total.turned()
            for element in self.model.elements:
                if isinstance(element, Element) and element.joint == name:
                    found[name] = found[name].with_(self.elements[element.name].turned())
        return {name: found[name] for name in self.walk.tree.ends}

    def _apart(self, give: Any, joint: str, pull: Pull) -> None:
        """Let what acts in a joint or constraint act on both of its ends."""
        tail, head = self.walk.tree.ends[joint].component.between
        give(head, pull)
        give(tail, pull.turned())

    @cached_property
    def _branches(self) -> dict[str, tuple[list[str], bool]]:
        """Of every joint that is a branch the bodies beyond it, and whether its head is among them."""
        joints = {joint.name: joint for joint in self.model.joints}
        terminals = terminals_of(self.model)
        walk = self.derivation.topology.walk
        steps = [step for step in walk if {step.edge.component, step.edge.name} <= joints.keys()]
        links: dict[str, list[tuple[str, str]]] = {}
        for step in steps:
            a, b = (terminals[end][0] for end in joints[step.edge.name].between)
            links.setdefault(a, []).append((b, step.edge.name))
            links.setdefault(b, []).append((a, step.edge.name))
        found = {}
        for step in steps:
            tail, head = (terminals[end][0] for end in joints[step.edge.name].between)
            far, pending = [], [head if step.forward else tail]
            crossed = {step.edge.name}
            while pending:
                body = pending.pop()
                far.append(body)
                for other, joint in links[body]:
                    if joint not in crossed:
                        crossed.add(joint)
                        pending.append(other)
            found[step.edge.name] = (far, step.forward)
        return found


def absolute(x: Any) -> Any:
    """Absolute values as an array."""
    import numpy

    return numpy.abs(numpy.array(x, float))


def _array(np: Any, x: Any) -> Any:
    return np.array([float(c) for c in x])


def _rows(matrix: Any) -> Any:
    return tuple(tuple(float(x) for x in row) for row in matrix)
