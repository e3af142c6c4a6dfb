"""Y and rest of ``tau = Y pi + rest``, and the model's own parameters pi, by Newton and Euler.

A column of a link's moments is the generalised force of a body with 1 for one moment, about the origin of
the body that the link's joint carries, and 0 for all others:

    f = m a + α x b + ω x (ω x b)      n = J α + ω x J ω + b x a      column = Jᵀ (f, n)

with a less gravity and α at the given accelerations [Atkeson et al. 1986]. A column of a joint is the
effort along its rate, the derivative of its coordinate. The values pi are masses, first moments and
inertias of a link's bodies as given in the model, moved to that origin and summed, and the constants of its
dampers and frictions. rest is tau of all bodies and elements less Y pi, so no term is missing and none is
counted twice. The definition of pi also fixes which joints have parameters and to which of them a following
joint adds.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.algebra.residues import CONSTANT
from linegraph.components.forces import Damper, Friction
from linegraph.components.parameters import names_in
from linegraph.components.scalar.forces import forces_of
from linegraph.dynamics.applied_forces import depends_on_inputs
from linegraph.identification.standard_parameters import MOMENTS, axes, homes, led_by
from linegraph.kinematics.tree_state import TreeState
from linegraph.spatial.vector import ZERO
from linegraph.verification.golden.bodies import NOISE, Heavy

if TYPE_CHECKING:
    from linegraph.components.forces import Element
    from linegraph.dynamics.network_state import EdgeMotion, Exchange
    from linegraph.identification.standard_parameters import Axis
    from linegraph.verification.golden.bodies import Bodies
    from linegraph.verification.golden.walk import Moved, Valued, Walk

    Array = Any

UPPER = ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2))
"""Row and column of xx, xy, yy, xz, yz, zz."""


@dataclass(frozen=True)
class Parameters:
    """Standard parameters and regressor at a state.

    Attributes:
        walk: the motion of all links.
        bodies: Newton's and Euler's equations.
        a: v̇, n.
        tau: M a + h, n, with sizes.
    """

    walk: Walk
    bodies: Bodies
    a: Array
    tau: Valued

    @cached_property
    def _axes(self) -> list[Axis]:
        return axes(self.walk.tree)

    @cached_property
    def regressor(self) -> Valued:
        """Regressor Y, n x npi, at q, v and the given v̇."""
        np, tree = self.walk.np, self.walk.tree
        columns, sizes = [], []
        for link, home in enumerate(homes(tree)):
            moved = self.walk.moved(link, home.pose.at, home.pose.rotation)
            for column, size in self._of_link(moved):
                columns.append(column)
                sizes.append(np.maximum(size, NOISE * size.max(initial=0.0)))
        for axis in self._axes:
            rate, second = self.walk.along(axis.joint)
            row, own = rate[:-1], rate[-1]
            width = float(self.walk.numeric.resolve(axis.width))
            for unit in (own, np.tanh(own / width), row @ self.a + second):
                columns.append(row * unit)
                sizes.append(np.abs(row) * max(abs(unit), NOISE * (np.abs(row) @ np.abs(self.a))))
        return np.array(columns).T, np.array(sizes).T

    def _of_link(self, moved: Moved) -> list[Valued]:
        """Columns of a link's ten moments, for the given motion of the frame they refer to."""
        np = self.walk.np
        linear, angular = moved.linear[:, :-1], moved.angular[:, :-1]
        gravity = np.array(self.walk.tree.gravity, float)
        pull = moved.pull + linear @ self.a - gravity
        moved = moved._replace(spin=moved.spin + angular @ self.a)
        reach, turn = np.linalg.norm(linear, axis=0), np.linalg.norm(angular, axis=0)
        fast = np.linalg.norm(moved.spin) + np.linalg.norm(moved.angular[:, -1]) ** 2
        far = np.linalg.norm(moved.pull) + np.linalg.norm(gravity) + reach @ np.abs(self.a)
        found = []
        for k in range(len(MOMENTS)):
            mass, first, inertia = float(k == 0), np.zeros(3), np.zeros((3, 3))
            if 1 <= k < 4:
                first[k - 1] = 1.0
            elif k >= 4:
                row, column = UPPER[k - 4]
                inertia[row, column] = inertia[column, row] = 1.0
            turned = moved.rotation
            unit = Heavy(mass, turned @ first, turned @ inertia @ turned.T, moved)
            force, torque = self.bodies.required(unit, pull)
            of_force, of_torque = ((far, 0.0), (fast, far), (0.0, fast))[(k > 0) + (k > 3)]
            along = linear.T @ force + angular.T @ torque
            found.append((along, reach * of_force + turn * of_torque))
        return found

    @cached_property
    def values(self) -> Valued:
        """Standard parameters pi, npi: ten of each link, then three of each joint, in SI units."""
        np = self.walk.np
        moments = self._moments()
        values = [x for found, _ in moments for x in found]
        sizes = [x for _, found in moments for x in found]
        damping, friction = self._worn()
        rotors = self._rotors()
        for axis in self._axes:
            values += [damping[axis.joint], friction[axis.joint], rotors[axis.joint]]
            sizes += [damping[axis.joint], friction[axis.joint], rotors[axis.joint]]
        return np.array(values), np.abs(sizes)

    def _moments(self) -> list[tuple[list[float], list[float]]]:
        """For each link its ten moments about its home frame, and their sizes."""
        np, resolve, tree = self.walk.np, self.walk.numeric.resolve, self.walk.tree
        model = self.walk.tree.system
        assert model is not None
        found = homes(tree)
        mass, first, inertia = (np.zeros((len(found), *x)) for x in ((), (3,), (3, 3)))
        of_first, of_inertia = np.zeros(len(found)), np.zeros(len(found))
        for body in model.bodies.values():
            link, pose = tree.bodies[body.name]
            if link < 0:
                continue
            home = found[link].pose
            back = np.array(home.rotation, float).T
            turn = back @ np.array(pose.rotation, float)
            center = np.array([float(resolve(x)) for x in body.center or ZERO])
            arm = back @ (np.array(pose.at, float) - np.array(home.at, float)) + turn @ center
            m = float(resolve(body.mass))
            b = turn @ np.array([float(resolve(x)) for x in body.first or ZERO])
            xx, xy, xz, yy, yz, zz = (float(resolve(x)) for x in body.inertia)
            own = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
            # ∫ (r² 1 - r rᵀ) dm with r = arm + r', r' from the body's own reference point.
            mixed = np.outer(arm, b)
            moved = (m * arm @ arm + 2 * arm @ b) * np.eye(3)
            moved -= m * np.outer(arm, arm) + mixed + mixed.T
            mass[link] += m
            first[link] += m * arm + b
            inertia[link] += turn @ own @ turn.T + moved
            of_first[link] += np.linalg.norm(m * arm) + np.linalg.norm(b)
            of_inertia[link] += np.linalg.norm(own) + np.linalg.norm(moved)
        rows = []
        for m, b, J, *of in zip(mass, first, inertia, of_first, of_inertia, strict=True):
            entries = [J[place] for place in UPPER]
            rows.append(([m, *b, *entries], [m, *[of[0]] * 3, *[of[1]] * 6]))
        return rows

    def _worn(self) -> tuple[dict[str, float], dict[str, float]]:
        """Viscous and dry friction by joint, as far as they are constants for which Y has columns."""
        model, resolve = self.walk.tree.system, self.walk.numeric.resolve
        assert model is not None
        known = {axis.joint: axis for axis in self._axes}
        damping, friction = dict.fromkeys(known, 0.0), dict.fromkeys(known, 0.0)
        for element in model.force_elements:
            if not isinstance(element, Damper | Friction) or element.joint is None:
                continue
            values = element.values()
            constant = all(names_in(x) <= set(model.parameters) for x in values)
            seat = self._seat(known, element)
            if seat is None or not constant or depends_on_inputs(model, values):
                continue
            axis, ratio = seat
            if isinstance(element, Damper):
                damping[axis.joint] += ratio**2 * float(resolve(element.damping))
                continue
            dry = float(resolve(element.coulomb))
            same = resolve(element.width) == resolve(axis.width) and abs(ratio) == 1
            if dry == 0 or same:
                friction[axis.joint] += dry
                damping[axis.joint] += ratio**2 * float(resolve(element.viscous))
        return damping, friction

    def _rotors(self) -> dict[str, float]:
        """By joint, the constant inertia of network rotors that turn with it, from their stored energy.

        With one edge in mechanics moving at w and all else at rest, ``E = J w² / 2``; terms linear in w
        cancel in ``E(1) + E(-1) - 2 E(0)``.
        """
        walk, model = self.walk, self.walk.tree.system
        known = {axis.joint: axis for axis in self._axes}
        found = dict.fromkeys(known, 0.0)
        at = walk.numeric.exchange(walk.q, [0.0] * len(walk.v))
        if at is None or model is None:
            return found
        joints = {e.name: e.joint for e in forces_of(model.components)}
        for k, port in enumerate(at.network.ports):
            entry = at.network.mass.get(2 * (len(at.network.states) + k,))
            joint = joints[port.name]
            seat = None if joint is None else self._led(known, joint)
            if entry is None or seat is None or not self._constant(at, entry):
                continue
            energies = [float(_moving(at, port.name, w).energy()) for w in (1.0, -1.0, 0.0)]
            axis, ratio = seat
            found[axis.joint] += ratio**2 * (energies[0] + energies[1] - 2 * energies[2])
        return found

    @staticmethod
    def _constant(at: Exchange, entry: Any) -> bool:
        """Whether an inertia depends on parameters only; otherwise it is no parameter of the joint."""
        support = at.network.laws.calculus.support(entry)
        return {symbol[0] for symbol in support} <= {"p", CONSTANT}

    def _seat(self, known: dict[str, Axis], element: Element) -> tuple[Axis, float] | None:
        """The joint whose parameters an element adds to, and the ratio of the rates of both joints."""
        assert element.joint is not None
        return self._led(known, element.joint)

    def _led(self, known: dict[str, Axis], joint: str) -> tuple[Axis, float] | None:
        """A joint that has parameters itself, or the one it follows and the ratio of their rates."""
        if joint in known:
            return known[joint], 1.0
        found = led_by(self.walk.tree, known, joint)
        if found is None:
            return None
        # The ratio is measured from the motion, not read from the coupling, which the derivation uses.
        (own, _), (other, _) = (self.walk.along(x) for x in (joint, found[0].joint))
        place = int(self.walk.np.argmax(self.walk.np.abs(other[:-1])))
        return found[0], float(own[place] / other[place])

    @cached_property
    def rest(self) -> Valued:
        """``tau - Y pi``, n: generalised forces that are not linear in the parameters."""
        np = self.walk.np
        (Y, of_Y), (values, _), (tau, size) = self.regressor, self.values, self.tau
        return tau - Y @ values, size + of_Y @ np.abs(values)


def _moving(at: Exchange, port: str, w: float) -> Exchange:
    """The networks with one edge in mechanics moving at w and all other edges and states at rest."""

    def motion(name: str) -> EdgeMotion:
        return replace(at.motion(name), w=w if name == port else 0.0)

    still = TreeState(at.state.tree, at.state.q, [0.0] * len(at.state.v))
    return replace(at, state=still, motion=motion, _motions={})
