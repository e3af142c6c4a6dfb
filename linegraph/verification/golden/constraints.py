"""Constraints, computed from the positions of their two ends.

An equation of position φ(q, t) = 0 is differentiated, once for J and twice for γ. A constraint on
velocities only is evaluated on the velocities of its ends and differentiated once.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.algebra.jets import Jet, Jets, lifted
from linegraph.components.constraints.base import Instant, Prescribed
from linegraph.dynamics.chords import equations
from linegraph.dynamics.reaction_rows import rows_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linegraph.components.constraints.base import ReactionRow
    from linegraph.dynamics.chords import ChordEquation, Chords
    from linegraph.kinematics.links import Closure, Seat
    from linegraph.verification.golden.walk import Moved, Valued, Walk

    Array = Any

MISSES = 1e13
"""Factor by which gaps left at a legal state enlarge sizes: loops that miss do so everywhere."""

LEGAL = 1e-8
"""Gaps of this size or more belong to states that close no loop; they do not enlarge sizes."""


@dataclass(frozen=True)
class Constraints:
    """The constraints of a model at a state: ``φ(q, t)``, ``J v - b``, and γ in ``J v̇ = γ``.

    Attributes:
        walk: the motion of all links at that state.
    """

    walk: Walk

    @cached_property
    def _rows(self) -> dict[str, tuple[ReactionRow, ...]]:
        """The reaction rows of every chord, as jets along the motion."""
        jets, resolve = Jets(self.walk.numeric.algebra), self.walk.numeric.resolve
        found = {}
        for closure in self.walk.tree.closures:
            tail, head = (
                self.walk.at(self.walk.links, *end) for end in (closure.tail, closure.head)
            )
            drive = [
                None
                if x is None
                else Prescribed(self.walk.given(x), self.walk.given(Jet(x.dx, x.ddx, 0.0)))
                for x in closure.drive
            ]
            at = Instant(jets, lambda x: lifted(resolve(x)), tail, head, drive)
            found[closure.component.name] = rows_of(closure, at)
        return found

    @cached_property
    def position(self) -> Valued:
        """φ (m or rad) of the constraints on position.

        The size of an entry is the displacement that unit velocities would give one of its ends alone.
        """
        found = [row.position for row in self._holonomic()]
        x, _, _ = self.walk.parts(found)
        return x[:, 0], self.jacobian[1][: len(found)].sum(axis=1)

    def _holonomic(self) -> Iterator[ReactionRow]:
        for e in equations(self.walk.tree):
            if e.holonomic:
                yield self._rows[e.component][e.place]

    @cached_property
    def _constrained(self) -> tuple[Array, Array, Array]:
        """J, rates and γ of all constraints, from derivatives along the motion."""
        np, n = self.walk.np, len(self.walk.v)
        found = [self._derived(k, e) for k, e in enumerate(equations(self.walk.tree))]
        number = self.walk.number
        J = np.array([row for row, _, _ in found], number).reshape(-1, n)
        rates, bias = (np.array([x[k] for x in found], number) for k in (1, 2))
        return J, rates, bias

    def _derived(self, k: int, equation: ChordEquation) -> tuple[Array, float, float]:
        """One row of J, its rate ``J v - b`` and its γ."""
        name = equation.component
        if any(relation.name == name for relation in self.walk.tree.relations):
            # Relations between coordinates are formulas of the model; there are no ends to measure.
            known = self._relations
            return known.jacobian()[k], known.rates()[k], known.bias()[k]
        row = self._rows[name][equation.place]
        if equation.holonomic:
            # φ̈ = J v̇ + φ̈ at v̇ = 0, and φ̈ must vanish: γ is the latter with opposite sign.
            _, dx, ddx = self.walk.parts([row.position])
            return dx[0, :-1], dx[0, -1], -ddx[0, -1]
        (closure,) = (c for c in self.walk.tree.closures if c.component.name == name)
        return self._slipping(closure, row)

    @cached_property
    def _relations(self) -> Chords:
        return self.walk.numeric.chords(self.walk.q, self.walk.v)

    def _slipping(self, closure: Closure, row: ReactionRow) -> tuple[Array, float, float]:
        """A row of a velocity constraint, ``f . u + m . w - b``, and less its time derivative."""
        np = self.walk.np
        tail, head = self._seated(closure.tail), self._seated(closure.head)
        f, df, _ = self.walk.parts(row.force)
        m, dm, _ = self.walk.parts(row.torque)
        b, db, _ = self.walk.parts([row.rate])
        line = head.origin - tail.origin
        arms = np.broadcast_to(line[:, None], tail.angular.shape)
        # Velocity of the head relative to the tail's axes, which turn: the last term is the velocity of the
        # point fixed in the tail that is at the head's place.
        u = head.linear - tail.linear - np.cross(tail.angular, arms, axis=0)
        w = head.angular - tail.angular
        along = f[:, 0] @ u + m[:, 0] @ w
        apart = head.linear[:, -1] - tail.linear[:, -1]
        du = head.pull - tail.pull - np.cross(tail.spin, line)
        du -= np.cross(tail.angular[:, -1], apart)
        change = df[:, -1] @ u[:, -1] + f[:, 0] @ du
        change += dm[:, -1] @ w[:, -1] + m[:, 0] @ (head.spin - tail.spin) - db[0, -1]
        return along[:-1], along[-1] - b[0, 0], -change

    def _seated(self, seat: Seat) -> Moved:
        return self.walk.moved(seat.link, seat.at, seat.rotation)

    @cached_property
    def jacobian(self) -> Valued:
        """J (c x n), ``J v̇ = γ``, and the size of each row: its largest entry for either end moving alone.

        Where one hinge is placed next to another the contributions of the two ends cancel, and only
        rounding is left.
        """
        np, (J, _, _) = self.walk.np, self._constrained
        largest = np.abs(J).max(axis=1, initial=0.0)
        apart = [self._apart(equation) for equation in equations(self.walk.tree)]
        size = np.maximum(largest, np.array(apart).reshape(-1))
        size = size * self.doubt
        return J, np.repeat(size, len(self.walk.v)).reshape(J.shape)

    @cached_property
    def doubt(self) -> float:
        """Factor >= 1 on sizes of reactions where the ends of loops miss each other."""
        apart = [self._apart(equation) for equation in equations(self.walk.tree)]
        return 1 + MISSES * self._gap(self.walk.np.array(apart).reshape(-1))

    def _gap(self, size: Array) -> float:
        """The largest gap of a legal state relative to its size; 0 at states that close no loop."""
        x, _, _ = self.walk.parts([row.position for row in self._holonomic()])
        np, known = self.walk.np, size[: len(x)]
        gap = np.max(np.abs(x[:, 0]) / np.where(known > 0, known, np.inf), initial=0.0)
        return float(gap) if gap < LEGAL else 0.0

    def _apart(self, equation: ChordEquation) -> float:
        """How fast unit velocities would move a row if each of its ends moved alone."""
        np = self.walk.np
        closure = next(
            (c for c in self.walk.tree.closures if c.component.name == equation.component), None
        )
        if closure is None:
            return 0.0
        row = self._rows[equation.component][equation.place]
        f, m = (
            float(np.linalg.norm([abs(lifted(x).x) for x in part]))
            for part in (row.force, row.torque)
        )
        ends = [self._seated(closure.tail), self._seated(closure.head)]
        line = float(np.linalg.norm(ends[1].origin - ends[0].origin))
        shift = turn = 0.0
        for end in ends:
            w = np.linalg.norm(end.angular[:, :-1], axis=0)
            u = np.linalg.norm(end.linear[:, :-1], axis=0)
            arm = float(np.linalg.norm(end.origin)) + line
            shift += float((u + w * arm).max(initial=0.0))
            turn += float(w.max(initial=0.0))
        return f * shift + m * turn

    @property
    def rates(self) -> Valued:
        """``J v - b`` (m/s or rad/s); its size is that of J for velocities as fast as the fastest."""
        np, (_, rates, _) = self.walk.np, self._constrained
        fastest = np.abs(self.walk.v).max(initial=0.0)
        return rates, self.jacobian[1].sum(axis=1) * fastest + np.abs(rates)

    @property
    def bias(self) -> Valued:
        """γ in ``J v̇ = γ`` (m/s^2 or rad/s^2); of the size of J v², of which much may cancel."""
        np, (_, _, bias) = self.walk.np, self._constrained
        fastest = np.abs(self.walk.v).max(initial=0.0)
        return bias, self.jacobian[1].sum(axis=1) * fastest * fastest + np.abs(bias)
