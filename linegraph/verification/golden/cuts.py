"""Forces and torques in all joints, for given accelerations and multipliers: cut the joint, sum over bodies.

A cut through a branch frees all bodies beyond it. By Newton and Euler the joint exerts on them

    Σ (wrench for their motion, less weight) - Σ (wrenches of elements, loads and chords on them)

A chord exerts its multipliers along its reaction directions. These are the derivatives of its equations
with respect to the position of its head, by virtual work. Bodies have their own masses; accelerations are
derivatives of positions (`walk`). Only the laws of elements and the directions of joint efforts are shared
with the emitted program.
"""

from __future__ import annotations

from collections import ChainMap
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.algebra.jets import Jet, Jets, lifted
from linegraph.components.constraints.base import Constraint, Instant, Pose, Prescribed
from linegraph.components.forces import Element, PointForce
from linegraph.components.parameters import resolver
from linegraph.components.scalar.forces import NetworkForce
from linegraph.dynamics.chords import equations
from linegraph.dynamics.force_laws import ForceLaws
from linegraph.dynamics.law_names import scope
from linegraph.dynamics.reaction_rows import rows_of
from linegraph.errors import ModelError
from linegraph.model.terminal_graphs import terminals_of
from linegraph.verification.golden.pulls import GroundPlace, Pull

if TYPE_CHECKING:
    from linegraph.kinematics.links import Closure, Seat
    from linegraph.model.system import System
    from linegraph.numeric.derived import Derived
    from linegraph.verification.golden.bodies import Bodies
    from linegraph.verification.golden.kinematics import KinematicReference
    from linegraph.verification.golden.pulls import Sized
    from linegraph.verification.golden.walk import Moved, Valued, Walk

    Array = Any


ASIDE = 1e-3
"""Relative step for slopes of laws; only their size matters."""


@dataclass(frozen=True)
class Cuts:
    """Wrenches in all edges of a model at a state, for given accelerations and multipliers.

    Attributes:
        derivation: the model, and which edges are branches.
        walk: the motion of all links.
        bodies: Newton's and Euler's equations of all bodies.
        kinematics: motion of frames.
        a: v̇ (n) and its sizes.
        lam: multipliers λ (c) and their sizes; ``M v̇ + h = Q + Jᵀ λ``.
    """

    derivation: Derived
    walk: Walk
    bodies: Bodies
    kinematics: KinematicReference
    a: Valued
    lam: Valued

    @property
    def model(self) -> System:
        """The system that was derived."""
        return self.derivation.system

    @cached_property
    def acting(self) -> ForceLaws:
        """The laws of elements, loads and networks, evaluated in floats."""
        chords = self.walk.numeric.chords(self.walk.q, self.walk.v)
        return ForceLaws(chords, [float(x) for x in self.a[0]])

    # -- places

    def place(self, terminal: str) -> GroundPlace:
        """Motion of a terminal or mass centre in ground axes, named as ``body`` or ``body.frame``."""
        np, (a, of_a), v = self.walk.np, self.a, absolute(self.walk.v)
        at = self.kinematics.frame(terminal)
        linear, angular = at.linear[:, :-1], at.angular[:, :-1]
        u, w = (np.linalg.norm(x, axis=0) for x in (linear, angular))
        # A point on an axis is at rest because two lever arms cancel, so its size includes the whole
        # distance.
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
        """Wrench for a body's motion less its weight, in ground axes.

        The torque is about the body's own reference point.
        """
        np, (a, of_a) = self.walk.np, self.a
        heavy = self.bodies.heavy_of(body)
        moved = heavy.moved
        linear, angular = moved.linear[:, :-1], moved.angular[:, :-1]
        gravity = self.bodies.gravity
        # Weight acts at the mass centre like an acceleration -g of the whole body, so it needs no wrench of
        # its own.
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
        """Wrench of every element and load on its head, about the head's origin, in ground axes, by name."""
        return {element.name: self._element(element) for element in self.model.elements}

    def _element(self, element: Element | PointForce) -> Pull:
        np = self.walk.np
        if isinstance(element, PointForce):
            force, torque = (_array(np, x) for x in self.acting.wrench(element))
            return self._pull(force, torque, element.at)
        if element.between is not None:
            tail, head = (self.place(end) for end in element.between)
            line = head.origin - tail.origin
            length = float(np.linalg.norm(line))
            pull = _array(np, self.acting.between(element)[1])
            y = float(pull @ line) / length
            # A positive through variable pulls the two points together, so it pulls the head towards the
            # tail.
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
        """Size of a law's value that results from the sizes of its length and rate, which may cancel."""
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
            # Coarse differences are enough: only the size of the slopes matters.
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
        """Wrench of a chord on its head: multipliers along reaction directions, and joint efforts.

        Elements that act in the joint are left out.
        """
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
        """For each row of a chord the force and torque on its head that do no work on any motion it allows.

        They are the derivatives of the row as its head moves along and turns about the axes of ground. A
        row that constrains velocities only is its own direction.
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
        """Motion of a seat, a point with axes fixed in a link."""
        return self.walk.moved(seat.link, seat.at, seat.rotation)

    # -- joints

    @cached_property
    def joints(self) -> dict[str, Pull]:
        """Wrench of every joint and constraint on its head, about the head's origin, in ground axes, by name.

        Elements that act in a joint are not part of its wrench; they have their own edges.
        """
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
            if isinstance(element, PointForce):
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
                    # The cut also carries the element in the joint, which has its own edge.
                    found[name] = found[name].with_(self.elements[element.name].turned())
        return {name: found[name] for name in self.walk.tree.ends}

    def _apart(self, give: Any, joint: str, pull: Pull) -> None:
        """Apply a wrench in a joint or constraint to its head, and the reaction to its tail."""
        tail, head = self.walk.tree.ends[joint].component.between
        give(head, pull)
        give(tail, pull.turned())

    @cached_property
    def _branches(self) -> dict[str, tuple[list[str], bool]]:
        """For every joint that is a branch, the bodies beyond it and whether its head is among them."""
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
    """Return the absolute values of a sequence of numbers as an array."""
    import numpy

    return numpy.abs(numpy.array(x, float))


def _array(np: Any, x: Any) -> Any:
    return np.array([float(c) for c in x])


def _rows(matrix: Any) -> Any:
    return tuple(tuple(float(x) for x in row) for row in matrix)
