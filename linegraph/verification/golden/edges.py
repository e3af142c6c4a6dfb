"""Variables of all edges, in the order of emitted functions: reactions, across variables, drives and powers.

All are read from the cuts (`cuts`); the inverse scheme of the emitted program is not used.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.algebra.jets import Jet, Jets, lifted
from linegraph.components.body import GROUND, MASS_CENTER
from linegraph.components.constraints.base import Constraint
from linegraph.components.forces import PointForce
from linegraph.model.choices import GROUND_AXES, HEAD
from linegraph.model.terminal_graphs import terminals_of
from linegraph.verification.golden.constraints import Constraints
from linegraph.verification.golden.pulls import Pull
from linegraph.verification.golden.walk import own_rates

if TYPE_CHECKING:
    from linegraph.kinematics.links import Closure
    from linegraph.verification.golden.cuts import Cuts
    from linegraph.verification.golden.walk import Valued

    Array = Any


@dataclass(frozen=True)
class Edges:
    """Across and through variables of all edges at a state; each result is an array with sizes.

    Attributes:
        cuts: wrenches in all edges.
    """

    cuts: Cuts

    def reaction(self, name: str) -> tuple[Array, float, float]:
        """Wrench of a joint or constraint on its head, about the head's origin, in the axes the model chose.

        Returns:
            Force (N) then torque (N m), 6; the size of the force; the size of the torque.
        """
        tail, head = self.cuts.walk.tree.ends[name].component.between
        axes = {HEAD: head, GROUND_AXES: GROUND}.get(self.cuts.model.choices.reactions, tail)
        np, pull = self.cuts.walk.np, self.cuts.joints[name]
        turn = np.eye(3) if axes == GROUND else self.cuts.place(axes).rotation
        both = np.concatenate([turn.T @ pull.force, turn.T @ pull.torque])
        return both, self._doubt * pull.of_force, self._doubt * pull.of_torque

    @cached_property
    def _doubt(self) -> float:
        """Factor on sizes of reactions where the ends of loops miss each other slightly."""
        return Constraints(self.cuts.walk).doubt

    @property
    def reactions(self) -> Valued:
        """Wrenches of all joints and constraints (6 each), then through variables of networks."""
        np = self.cuts.walk.np
        found, sizes = [], []
        for name in self.cuts.walk.tree.ends:
            both, of_force, of_torque = self.reaction(name)
            found += [*both]
            sizes += [of_force] * 3 + [of_torque] * 3
        (_, _), (y, of_y) = self.network
        return np.array([*found, *y]), np.array([*sizes, *of_y])

    @property
    def across(self) -> Valued:
        """Across variables of all edges: of mechanics 6 each, then those of networks.

        An edge of mechanics has its head's velocity less its tail's, then the same of angular velocities,
        in ground axes (m/s, rad/s).
        """
        np = self.cuts.walk.np
        found, sizes = [], []
        for tail, head, rigid in self.ends.values():
            first, second = self.cuts.place(tail), self.cuts.place(head)
            found += [*(second.linear - first.linear)]
            found += [0.0] * 3 if rigid else [*(second.angular - first.angular)]
            sizes += [first.of_linear + second.of_linear] * 3
            sizes += [first.of_angular + second.of_angular] * 3
        (x, of_x), _ = self.network
        return np.array([*found, *x]), np.array([*sizes, *of_x])

    @cached_property
    def ends(self) -> dict[str, tuple[str, str, bool]]:
        """Tail and head of every edge of mechanics by name, and whether the edge is a rigid arm."""
        found = {
            f"{body}/inertia": (GROUND, f"{body}.{MASS_CENTER}", False)
            for body in self.cuts.model.bodies
        }
        joints = {name: end.component.between for name, end in self.cuts.walk.tree.ends.items()}
        found |= {name: (*between, False) for name, between in joints.items()}
        for element in self.cuts.model.elements:
            if isinstance(element, PointForce):
                found[element.name] = (GROUND, element.at, False)
            else:
                between = element.between or joints[str(element.joint)]
                found[element.name] = (*between, False)
        for terminal, (body, _) in terminals_of(self.cuts.model).items():
            if body in self.cuts.model.bodies:
                name = f"{body}/arm{terminal.removeprefix(body)}"
                found[name] = (f"{body}.{MASS_CENTER}", terminal, True)
        return found

    @cached_property
    def network(self) -> tuple[Valued, Valued]:
        """Across and through variables of the edges of networks, each with sizes.

        Their laws are evaluated in floats.
        """
        np, exchange = self.cuts.walk.np, self.cuts.acting.exchange
        empty = np.zeros(0)
        if exchange is None:
            return (empty, empty), (empty, empty)
        names = [b.name for b in exchange.network.branches if not b.port.spatial]
        found = []
        for place, kind in enumerate((exchange.across, exchange.through)):
            values = np.array([float(kind(name)) for name in names])
            sizes = np.array([exchange.size(name, place) for name in names])
            found.append((values, np.maximum(np.abs(values), sizes)))
        return found[0], found[1]

    @property
    def drives(self) -> Valued:
        """Effort along each prescribed coordinate, exerted by the joint on its head (N or N m).

        It is positive in the direction of the coordinate.
        """
        np, found, sizes = self.cuts.walk.np, [], []
        for name, closure in self.cuts.walk.tree.ends.items():
            joint: Any = closure.component
            if isinstance(joint, Constraint) or not any(x is not None for x in closure.drive):
                continue
            pull, tail = self.cuts.joints[name], self.cuts.seat(closure.tail)
            for turn, shift in self._motions(closure):
                along, about = tail.rotation @ shift, tail.rotation @ turn
                found.append(float(pull.force @ along + pull.torque @ about))
                size = pull.of_force * np.linalg.norm(along) + pull.of_torque * np.linalg.norm(
                    about
                )
                sizes.append(float(size))
        return np.array(found), np.array(sizes)

    def _motions(self, closure: Closure) -> list[tuple[Array, Array]]:
        """Unit motions of a prescribed joint: angular and linear velocity of its head, in its tail's axes."""
        np, joint = self.cuts.walk.np, closure.component
        algebra = self.cuts.walk.numeric.algebra
        at = tuple(float(x.x) for x in closure.drive if x is not None)
        found = []
        for unit in np.eye(joint.freedoms):  # type: ignore[union-attr]
            rates = own_rates(joint, algebra, at, tuple(map(float, unit)))  # type: ignore[arg-type]
            moving = tuple(Jet(x, float(dx), 0.0) for x, dx in zip(at, rates, strict=True))
            motion = joint.motion(Jets(algebra), moving, (0.0,) * len(unit))  # type: ignore[union-attr]
            jets = [[lifted(x) for x in row] for row in motion.rotation.matrix()]
            R, dR = (np.array([[getattr(x, k) for x in row] for row in jets]) for k in ("x", "dx"))
            spin = dR @ R.T
            shift = np.array([lifted(x).dx for x in motion.displacement], float)
            found.append((np.array([spin[2, 1], spin[0, 2], spin[1, 0]]), shift))
        return found

    # -- powers

    @property
    def powers(self) -> Valued:
        """Through times across of all edges (W), of mechanics 3 each: translation, rotation and lever.

        The lever is the moment of an edge's force about its tail, times the tail's angular velocity. One
        power for each edge of a network follows.
        """
        np, found, sizes = self.cuts.walk.np, [], []
        for name, (force, torque, tail) in self._exerted.items():
            first, second = self.cuts.place(self.ends[name][0]), self.cuts.place(self.ends[name][1])
            rigid = self.ends[name][2]
            turning = np.zeros(3) if rigid else second.angular - first.angular
            lever = -np.cross(second.origin - first.origin, force.force) if tail else np.zeros(3)
            # Ends that coincide are apart by the rounding of their positions.
            far = np.linalg.norm(second.origin) + np.linalg.norm(first.origin)
            reach = float(far) if tail else 0.0
            found += [
                float(force.force @ (second.linear - first.linear)),
                float(torque @ turning),
                float(lever @ first.angular),
            ]
            fast = first.of_angular + second.of_angular
            sizes += [
                force.of_force * (first.of_linear + second.of_linear),
                force.of_torque * fast,
                force.of_force * reach * first.of_angular,
            ]
        own, of_own = self._network_powers
        return np.array([*found, *own]), np.array([*sizes, *of_own])

    @cached_property
    def _network_powers(self) -> tuple[list[float], list[float]]:
        exchange = self.cuts.acting.exchange
        if exchange is None:
            return [], []
        network = exchange.network
        branches = [b for b in network.branches if not b.port.spatial]
        (x, of_x), (y, of_y) = self.network
        own = [k for k, b in enumerate(branches) if b.port.domain not in network.heats]
        return [float(-x[k] * y[k]) for k in own], [float(of_x[k] * of_y[k]) for k in own]

    @property
    def sums(self) -> Valued:
        """Sums of powers, all zero: in translation, in rotation with levers, and in each network."""
        np, exchange = self.cuts.walk.np, self.cuts.acting.exchange
        _, sizes = self.powers
        count = 3 * len(self._exerted)
        translation = float(sizes[:count:3].sum())
        rotation = float(sizes[1:count:3].sum() + sizes[2:count:3].sum())
        by_domain: dict[str, float] = {}
        if exchange is not None:
            network = exchange.network
            own = [b for b in network.branches if not b.port.spatial]
            own = [b for b in own if b.port.domain not in network.heats]
            for branch, size in zip(own, self._network_powers[1], strict=True):
                domain = branch.port.domain
                by_domain[domain] = by_domain.get(domain, 0.0) + size
        found = np.array([translation, rotation, *by_domain.values()])
        return np.zeros(len(found)), found

    @cached_property
    def _exerted(self) -> dict[str, tuple[Pull, Array, bool]]:
        """For each edge its wrench on the head, its torque, and whether its tail feels the lever.

        Inertia edges and loads end at ground, whose velocity is zero. By the vertex postulate a rigid arm
        carries the wrenches of all other edges at its terminal.
        """
        np = self.cuts.walk.np
        found: dict[str, tuple[Pull, Array, bool]] = {}
        for body in self.cuts.model.bodies:
            center = self.cuts.place(f"{body}.{MASS_CENTER}")
            pull = self.cuts.needed(body).about(center.origin).turned()
            found[f"{body}/inertia"] = (pull, pull.torque, False)
        for name, pull in self.cuts.joints.items():
            found[name] = (pull, pull.torque, True)
        loads = {
            element.name for element in self.cuts.model.elements if isinstance(element, PointForce)
        }
        for name, pull in self.cuts.elements.items():
            found[name] = (pull, pull.torque, name not in loads)
        received: dict[str, Pull] = {}
        for name, (tail, head, rigid) in self.ends.items():
            if rigid or name.endswith("/inertia"):
                continue
            pull = found[name][0]
            ends = ((head, pull), (tail, pull.turned().about(self.cuts.place(tail).origin)))
            for terminal, given in ends if name not in loads else ends[:1]:
                known = received.get(terminal)
                received[terminal] = given if known is None else known.with_(given)
        for name, (_, head, rigid) in self.ends.items():
            if rigid:
                zero, at = np.zeros(3), self.cuts.place(head).origin
                pull = received.get(head, Pull(zero, zero, at, 0.0, 0.0)).turned()
                found[name] = (pull, pull.torque, True)
        return found
