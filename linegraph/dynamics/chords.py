"""Chords: the edges that a tree leaves out become constraints, by the circuit equations.

The circuit that a chord closes gives the relative motion of its ends. Projected on the chord's reaction
directions, where the across variable is known and the through variable is not, this is a constraint,
with the through variable as its multiplier:

    φ(q, t) = 0        J v = b        J v̇ = γ        M v̇ + h = Q + Jᵀ λ

All four follow from one formula per constraint. A *row* is a unit force and torque (f, m) between tail
and head. By orthogonality its product with the relative motion is the constraint, c = f·u + m·ω - b,
its projection on the velocities of the tree is the row of J, and the derivative of c at v̇ = 0 is -γ.
Closed loops as constraints on a tree: [Featherstone 2008, ch. 8].
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.algebra.jets import Jet, Jets, lifted
from linegraph.algebra.protocol import set_label
from linegraph.components.constraints.base import Constraint, Instant, Pose, Prescribed, ReactionRow
from linegraph.components.joints import Free
from linegraph.components.joints.base import TORQUES
from linegraph.dynamics.law_names import relations
from linegraph.dynamics.reaction_rows import rows_of, where
from linegraph.errors import ModelError
from linegraph.ir.program import Quantity
from linegraph.kinematics.ground_frames import (
    GroundFrame,
    Pair,
    along_velocities,
    frames,
    relative_motion,
    seated,
    seen,
)
from linegraph.spatial.vector import (
    ZERO,
    Matrix,
    Vector,
    add,
    cross,
    dot,
    scale,
    subtract,
    times,
    transpose,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.joints import Joint
    from linegraph.kinematics.links import Closure, KinematicTree
    from linegraph.kinematics.tree_state import TreeState


@dataclass(frozen=True)
class ChordEquation:
    """One constraint, independent of the state.

    Attributes:
        multiplier: name and unit of its multiplier (N or N m for joints).
        component: name of the chord or relation.
        place: which of the chord's rows it is.
        holonomic: whether it has an equation of position φ.
    """

    multiplier: Quantity
    component: str
    place: int
    holonomic: bool


def equations(tree: KinematicTree) -> list[ChordEquation]:
    """All constraints in the order of J's rows: first the holonomic ones, each group in declared order."""
    found = [
        ChordEquation(quantity, closure.component.name, k, holonomic)
        for closure in tree.closures
        for k, (quantity, holonomic) in enumerate(_quantities(closure))
    ]
    found += [ChordEquation(r.equation(), r.name, 0, False) for r in tree.relations]
    return [e for e in found if e.holonomic] + [e for e in found if not e.holonomic]


class Chords:
    """The constraints of a tree at a state, over any algebra; computed on demand.

    Args:
        state: the tree at (q, v).
    """

    def __init__(self, state: TreeState) -> None:
        """Keep the state; frames and rows are computed when they are first needed."""
        self.state = state
        self._tree = state.tree
        self._algebra = state.algebra
        self._ends: dict[str, tuple[GroundFrame, GroundFrame]] = {}

    @cached_property
    def frames(self) -> list[GroundFrame]:
        """The working frames of all links in ground axes, with accelerations at v̇ = 0."""
        return frames(self.state)

    @cached_property
    def _relations(self) -> dict[str, tuple[list[Scalar], Scalar, Scalar]]:
        """The coefficients a, the right-hand side b and γ of every relation."""
        names = (relation.name for relation in self._tree.relations)
        return dict(zip(names, relations(self.state), strict=True))

    def ends(self, name: str) -> tuple[GroundFrame, GroundFrame]:
        """Tail and head frame of a joint or constraint in ground axes, aligned with its axis."""
        if name not in self._ends:
            end = self._tree.ends[name]
            self._ends[name] = (seated(self.frames, end.tail), seated(self.frames, end.head))
        return self._ends[name]

    def seen(self, name: str) -> tuple[Matrix, Vector]:
        """Pose of a joint's head relative to its tail: rotation, and displacement in the tail's axes (m)."""
        return seen(*self.ends(name))

    @cached_property
    def rows(self) -> dict[str, tuple[ReactionRow, ...]]:
        """The reaction rows of each chord, by its name."""
        found = {}
        for closure in self._tree.closures:
            set_label(self._algebra, f"chord {closure.component.name}")
            tail, head = (Pose(f.rotation, f.origin) for f in self.ends(closure.component.name))
            drive = [None if x is None else Prescribed(x.x, x.dx) for x in closure.drive]
            at = Instant(self._algebra, self._tree.resolve, tail, head, drive)
            found[closure.component.name] = rows_of(closure, at)
        return found

    def position(self) -> list[Scalar]:
        """Residuals φ(q, t) of the holonomic constraints (m, rad or pure numbers)."""
        return [self.rows[e.component][e.place].position for e in self.equations if e.holonomic]

    def jacobian(self) -> list[list[Scalar]]:
        """Jacobian J(q, t), constraints x velocities."""
        size = len(self._tree.velocities)
        closures = {closure.component.name: closure for closure in self._tree.closures}
        found = []
        for equation in self.equations:
            row: list[Scalar] = [0] * size
            if equation.component in self._relations:
                row = list(self._relations[equation.component][0])
            else:
                set_label(
                    self._algebra, f"chord {equation.component}, its direction {equation.place + 1}"
                )
                closure = closures[equation.component]
                pair = self._pair(closure, self.rows[equation.component][equation.place])
                for freedom, entry in self.along(pair):
                    row[freedom.index] = row[freedom.index] + entry
            found.append(row)
        return found

    def along(self, pair: Pair) -> Any:
        """Generalised forces of opposite wrenches on two links, as (freedom, force) pairs."""
        return along_velocities(self.state, self.frames, pair)

    def rates(self) -> list[Scalar]:
        """Residuals ``J v - b`` of the constraints of velocity.

        They are computed from the motion of the chords' ends, which contains prescribed motions of
        branches; J times v alone does not.
        """
        found = []
        for equation in self.equations:
            if equation.component in self._relations:
                row, right, _ = self._relations[equation.component]
                products = (entry * x for entry, x in zip(row, self.state.v, strict=True))
                found.append(sum(products, start=-right))
                continue
            u, w = relative_motion(*self.ends(equation.component))
            row_of = self.rows[equation.component][equation.place]
            found.append(dot(row_of.force, u) + dot(row_of.torque, w) - row_of.rate)
        return found

    def bias(self) -> list[Scalar]:
        """Right-hand side γ of the constraints of acceleration, ``J v̇ = γ``."""
        known: dict[str, list[Scalar]] = {name: [r[2]] for name, r in self._relations.items()}
        for closure in self._tree.closures:
            name = closure.component.name
            set_label(self._algebra, f"chord {name}, accelerations")
            known[name] = self._derived(closure, *self.ends(name))
        return [known[e.component][e.place] for e in self.equations]

    def effort(self, closure: Closure, efforts: Sequence[Scalar]) -> Pair:
        """Wrench on the head of a joint that is a chord, for efforts along its velocities.

        Args:
            closure: the joint.
            efforts: one per velocity of the joint (N m or N); positive efforts drive the head in the
                positive direction.

        Returns:
            Force and torque about the head's origin in ground axes, with the links that they act on.
        """
        joint: Any = closure.component
        tail, head = self.ends(joint.name)
        force = torque = ZERO
        for effort, (m, f) in zip(efforts, _duals(self._algebra, joint, tail, head), strict=True):
            force, torque = add(force, scale(effort, f)), add(torque, scale(effort, m))
        return Pair(force, torque, head.origin, closure.head.link, closure.tail.link)

    def coordinates(self, closure: Closure) -> tuple[tuple[Scalar, ...], tuple[Scalar, ...]]:
        """The coordinates and velocities of a joint that is a chord, measured from the motion of its ends."""
        joint: Any = closure.component
        tail, head = self.ends(joint.name)
        u, w = relative_motion(tail, head)
        duals = _duals(self._algebra, joint, tail, head)
        rates = tuple(dot(m, w) + dot(f, u) for m, f in duals)
        return joint.measured(self._algebra, *seen(tail, head)), rates

    def named(self, closure: Closure) -> dict[str, Scalar]:
        """Names that laws may use for a joint that is a chord: coordinates x and rates ``der(x)``.

        A quaternion cannot be measured by a formula, so a free joint offers its position only: the
        displacement of its ends.
        """
        joint: Any = closure.component
        tail, head = self.ends(joint.name)
        try:
            at, rates = self.coordinates(closure)
            changes = joint.rates(self._algebra, at, rates)
        except ModelError:
            if not isinstance(joint, Free):
                return {}
            _, at = seen(tail, head)
            u, _ = relative_motion(tail, head)
            changes = times(transpose(tail.rotation), u)
        names = [quantity.name for quantity in joint.positions()[: len(at)]]
        found = dict(zip(names, at, strict=True))
        return found | {f"der({x})": dx for x, dx in zip(names, changes, strict=True)}

    @cached_property
    def equations(self) -> list[ChordEquation]:
        """All constraints in the order of J's rows, the holonomic ones first."""
        return equations(self._tree)

    def _pair(self, closure: Closure, row: ReactionRow) -> Pair:
        origin = self.ends(closure.component.name)[1].origin
        return Pair(row.force, row.torque, origin, closure.head.link, closure.tail.link)

    def _derived(self, closure: Closure, tail: GroundFrame, head: GroundFrame) -> list[Scalar]:
        """``-d/dt (f·u + m·ω - b)`` at v̇ = 0; the rows are differentiated by evaluating them with jets."""
        jets = Jets(self._algebra)
        base = self._tree.resolve
        drive = [None if x is None else Prescribed(x, Jet(x.dx, x.ddx, 0)) for x in closure.drive]
        at = Instant(jets, lambda x: lifted(base(x)), _in_motion(tail), _in_motion(head), drive)
        moving = rows_of(closure, at)
        u, w = relative_motion(tail, head)
        line, velocity = subtract(head.origin, tail.origin), subtract(head.linear, tail.linear)
        bent = add(cross(tail.spin, line), cross(tail.angular, velocity))
        du = subtract(subtract(head.pull, tail.pull), bent)
        dw = subtract(head.spin, tail.spin)
        found = []
        for row in moving:
            (f, df), (m, dm) = _split(row.force), _split(row.torque)
            change = dot(df, u) + dot(f, du) + (dot(dm, w) + dot(m, dw))
            found.append(lifted(row.rate).dx - change)
        return found


def _quantities(closure: Closure) -> list[tuple[Quantity, bool]]:
    """The multipliers of a chord, and whether each belongs to an equation of position."""
    component = closure.component
    if isinstance(component, Constraint):
        return list(component.equations())
    found, counts = [], {"f": 0, "t": 0}
    for restriction in closure.restrictions:
        turning = isinstance(restriction, TORQUES)
        letter = "t" if turning else "f"
        counts[letter] += 1
        name = f"{component.name}_{letter}{counts[letter]}"
        what, unit = ("torque", "N*m") if turning else ("force", "N")
        about = (
            f"reaction {what} of joint {component.name} on its head{where(restriction, component)}"
        )
        found.append((Quantity(name, unit, about), True))
    for given, velocity in zip(closure.drive, component.velocities(), strict=False):
        if given is not None:
            unit = {"rad/s": "N*m", "m/s": "N"}[velocity.unit]
            quantity = Quantity(f"{velocity.name}_drive", unit, f"drives {velocity.name}")
            found.append((quantity, True))
    return found


def _duals(
    algebra: Algebra, joint: Joint, tail: GroundFrame, head: GroundFrame
) -> list[tuple[Vector, Vector]]:
    """A joint's unit efforts as (torque, force) in ground axes."""
    duals = joint.duals(algebra, *seen(tail, head))
    return [(times(head.rotation, m), times(head.rotation, f)) for m, f in duals]


def _in_motion(frame: GroundFrame) -> Pose:
    """A frame's pose as jets: axes that turn and an origin that moves; second derivatives are not needed."""
    columns = [_jets(column, cross(frame.angular, column)) for column in transpose(frame.rotation)]
    x, y, z = columns
    return Pose(transpose((x, y, z)), _jets(frame.origin, frame.linear))


def _jets(a: Vector, da: Vector) -> Vector:
    return (Jet(a[0], da[0], 0), Jet(a[1], da[1], 0), Jet(a[2], da[2], 0))


def _split(a: Vector) -> tuple[Vector, Vector]:
    """Values and rates of a vector of jets."""
    x, y, z = (lifted(c) for c in a)
    return (x.x, y.x, z.x), (x.dx, y.dx, z.dx)
