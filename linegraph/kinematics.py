"""Stage 3: the links of a mechanical tree, each in the frame in which its equations are shortest.

A *link* is all bodies welded together beyond one moving joint. Its working frame has its origin at that
joint and z along the joint's axis. Whatever is constant is folded here once: placements, alignments,
rotated and shifted mass distributions.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from linegraph import vector
from linegraph.algebra import Algebra, Constants
from linegraph.body import GROUND, Body, Placement
from linegraph.domains import TRANSLATION
from linegraph.errors import ModelError
from linegraph.joints import Joint, Moments
from linegraph.layout import Freedom, Layout, Place, layout_of
from linegraph.parameters import resolver
from linegraph.rotation import IDENTITY_MATRIX, Rotation, product, rotation_of, snapped
from linegraph.topology import Step, Topology, choose_forest
from linegraph.vector import ZERO, Scalar, Vector

if TYPE_CHECKING:
    from linegraph.graph import SystemGraph
    from linegraph.model import Model
    from linegraph.program import Quantity

Resolve = Callable[[Any], Scalar]
_NO_MOMENTS = Moments(0, ZERO, (0, 0, 0, 0, 0, 0))


@dataclass(frozen=True)
class Link:
    """A rigid body of the reduced tree.

    Attributes:
        name: the bodies welded into it.
        parent: index of the link nearer to ground; -1 for ground.
        joint: what connects it to its parent.
        forward: whether the joint's edge points away from ground.
        rotation, at: the joint's near frame in the parent's working frame; constant.
        place: where the joint's q and v come from.
        moments: mass distribution about the working origin, in working axes.
    """

    name: str
    parent: int
    joint: Joint
    forward: bool
    rotation: Rotation
    at: Vector
    place: Place
    moments: Moments

    @property
    def velocities(self) -> tuple[Freedom, ...]:
        """Where the joint's velocities stand in the state; none where its motion is prescribed."""
        return self.place.velocities

    @property
    def numeric(self) -> bool:
        """Whether the mass distribution is made of numbers."""
        scalars = (self.moments.mass, *self.moments.first, *self.moments.inertia)
        return all(isinstance(x, (int, float)) for x in scalars)


@dataclass(frozen=True)
class KinematicTree:
    """All links, every parent before its children, and what state and inputs consist of.

    Attributes:
        layout: coordinates and inputs, and which joint reads which.
        bodies: where each body's frame is: its link, -1 for ground, and its placement there.
    """

    links: tuple[Link, ...]
    gravity: Vector
    layout: Layout
    bodies: Mapping[str, tuple[int, Placement]]

    @property
    def positions(self) -> tuple[Quantity, ...]:
        """The coordinates q."""
        return tuple(self.layout.positions)

    @property
    def velocities(self) -> tuple[Quantity, ...]:
        """The velocities v."""
        return tuple(self.layout.velocities)

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """The inputs u."""
        return tuple(self.layout.inputs)

    @property
    def coupled(self) -> bool:
        """Whether two joints share a coordinate."""
        places = [freedom.index for link in self.links for freedom in link.velocities]
        return len(places) > len(set(places))

    @property
    def outward(self) -> list[int]:
        """Independent velocities from the root to the leaves."""
        order: dict[int, None] = {}
        for link in self.links:
            order.update((freedom.index, None) for freedom in link.velocities)
        return list(order)

    def normalise(self, q: list[float]) -> None:
        """Give the quaternions among the coordinates length 1, in place."""
        for link in self.links:
            places = [freedom.index for freedom in link.place.positions]
            if len(places) > len(link.velocities):
                length = math.hypot(*(q[i] for i in places[-4:]))
                for i in places[-4:]:
                    q[i] /= length

    def regrouped(self) -> KinematicTree:
        """The same M and h from fewer parameters: what a parent can carry is handed to it, leaf to root.

        Exact for the equations of motion, not for joint reactions. Only numbers are moved: of symbols
        the sums would be computed anew at every call.
        """
        links = list(self.links)
        for i in reversed(range(len(links))):
            link = links[i]
            parent = links[link.parent] if link.parent >= 0 else None
            fixed = all(isinstance(x, (int, float)) for x in link.at)
            if not (fixed and link.numeric and (parent is None or parent.numeric)):
                continue
            kept, handed = link.joint.regroup(link.moments)
            links[i] = replace(link, moments=kept)
            if parent is not None:
                shifted = carried(handed, link.rotation, link.at)
                links[link.parent] = replace(parent, moments=joined(parent.moments, shifted))
        return replace(self, links=tuple(links))


def carried(moments: Moments, rotation: Rotation, at: Vector) -> Moments:
    """Moments about an inner origin, resolved about an outer one and in outer axes.

    With b the rotated first moment and m the mass, the inertia gains
    2 (at . b) 1 - at b^T - b at^T + m (at . at 1 - at at^T).
    """
    m = moments.mass
    b = rotation.out(moments.first)
    xx, xy, xz, yy, yz, zz = rotation.congruence(moments.inertia)
    first = vector.add(b, vector.scale(m, at))
    # at . (b + first) collects both the first-moment and the mass term
    c = vector.add(b, first)
    px, py, pz = (at[k] * c[k] for k in range(3))
    return Moments(
        m,
        first,
        (
            xx + (py + pz),
            xy - (at[0] * b[1] + at[1] * first[0]),
            xz - (at[0] * b[2] + at[2] * first[0]),
            yy + (px + pz),
            yz - (at[1] * b[2] + at[2] * first[1]),
            zz + (px + py),
        ),
    )


def joined(a: Moments, b: Moments) -> Moments:
    """The moments of two bodies together, about one origin and in one frame."""
    inertia = tuple(x + y for x, y in zip(a.inertia, b.inertia, strict=True))
    return Moments(a.mass + b.mass, vector.add(a.first, b.first), inertia)


def body_moments(body: Body, resolve: Resolve) -> Moments:
    """A body's mass distribution about its own frame's origin."""
    mass = resolve(body.mass)
    inertia = tuple(resolve(x) for x in body.inertia)
    if body.first is not None:
        return Moments(mass, _resolved(body.first, resolve), inertia)
    central = Moments(mass, ZERO, inertia)
    return carried(central, Rotation(), _resolved(body.center or ZERO, resolve))


def compose(outer: Placement, inner: Placement, snap: float) -> Placement:
    """A frame given in an inner frame, seen from the outer one."""
    at = vector.add(outer.at, _swept(rotation_of(outer.rotation).out(inner.at), inner.at))
    return Placement(at, snapped(product(outer.rotation, inner.rotation), snap))


def inverse(placement: Placement) -> Placement:
    """The outer frame seen from the inner one."""
    back = vector.transpose(placement.rotation)
    return Placement(vector.negate(rotation_of(back).out(placement.at)), back)


def moved(near: Placement, joint: Joint, value: Any, snap: float) -> Placement:
    """The head frame of a one-freedom joint at a fixed value of its coordinate."""
    alignment = Placement(ZERO, joint.alignment())
    motion = joint.motion(Constants(), (value,), (0,))
    turn = Placement(motion.displacement, snapped(motion.rotation.matrix(), snap))
    there = compose(compose(near, alignment, snap), turn, snap)
    return compose(there, inverse(alignment), snap)


def mechanical_topology(model: Model, graph: SystemGraph) -> Topology:
    """The tree of joint coordinates: arms and joints are branches, inertia edges chords.

    Raises:
        ModelError: a joint closes a loop, or a body hangs on nothing.
    """
    if not model.bodies:
        raise ModelError(f'model "{model.name}"', "has no bodies: there is nothing to derive")
    weights = {joint.name: float(joint.freedoms) for joint in model.joints}
    weights |= {f"{name}/inertia": 7.0 for name in model.bodies}
    weights |= {element.name: math.inf for element in model.elements}
    projection = graph[TRANSLATION.name]
    topology = choose_forest(projection, weights, roots=(GROUND,))
    joints = {joint.name for joint in model.joints}
    for edge in topology.chords:
        if edge.name in joints:
            raise ModelError(f'joint "{edge.name}"', "closes a loop; only trees can be derived")
    for edge in topology.branches:
        if edge.name.endswith("/inertia") and edge.name not in joints:
            problem = "nothing connects it to ground; add a joint, a free one if it floats"
            raise ModelError(f'body "{edge.component}"', problem)
    return topology


def kinematic_tree(
    model: Model, topology: Topology, algebra: Algebra, parameters: Mapping[str, Scalar]
) -> KinematicTree:
    """Walk the tree from ground outward and fold all that is constant into links.

    Raises:
        ModelError: a coupling is impossible.
    """
    layout = layout_of(model, algebra, parameters)
    return _Walk(model, layout, resolver(algebra, parameters)).along(topology.walk)


class _Walk:
    """Collects links on a walk from ground outward."""

    def __init__(self, model: Model, layout: Layout, resolve: Resolve) -> None:
        self._model = model
        self._layout = layout
        self._resolve = resolve
        self._joints = {joint.name: joint for joint in model.joints}
        self._terminals = model.terminals()
        self._links: list[Link] = []
        self._where = {GROUND: (-1, Placement(ZERO, IDENTITY_MATRIX))}

    def along(self, walk: tuple[Step, ...]) -> KinematicTree:
        """Take every joint branch in turn; arms lie within a body and are constant."""
        for step in walk:
            joint = self._joints.get(step.edge.name)
            if joint is not None and step.edge.component == joint.name:
                self._cross(joint, step)
        gravity = _resolved(self._model.gravity, self._resolve)
        return KinematicTree(tuple(self._links), gravity, self._layout, self._where)

    def _cross(self, joint: Joint, step: Step) -> None:
        joint = joint.resolved(self._resolve)
        body, placement = self._terminals[step.near]
        parent, pose = self._where[body]
        near = self._compose(pose, self._constant(placement))
        body, placement = self._terminals[step.far]
        far = self._constant(placement)
        if joint.freedoms == 0:
            self._enter(body, parent, self._compose(near, inverse(far)))
            return
        alignment = self._alignment(joint)
        near = self._compose(near, alignment)
        place = self._layout.places[joint.name]
        rotation = rotation_of(near.rotation)
        link = Link("", parent, joint, step.forward, rotation, near.at, place, _NO_MOMENTS)
        self._links.append(link)
        self._enter(body, len(self._links) - 1, inverse(self._compose(far, alignment)))

    def _enter(self, body: str, index: int, pose: Placement) -> None:
        """Note where a body is and add its mass distribution to its link."""
        self._where[body] = (index, pose)
        if index < 0:
            return
        link = self._links[index]
        own = body_moments(self._model.bodies[body], self._resolve)
        moments = joined(link.moments, carried(own, rotation_of(pose.rotation), pose.at))
        name = f"{link.name}, {body}" if link.name else body
        self._links[index] = replace(link, name=name, moments=moments)

    def _alignment(self, joint: Joint) -> Placement:
        try:
            return self._constant(Placement(ZERO, joint.alignment()))
        except ModelError as error:
            if error.thing:
                raise
            problem = f"its axis cannot be a direction: {error.problem}"
            raise ModelError(f'joint "{joint.name}"', problem) from None

    def _constant(self, placement: Placement) -> Placement:
        rows = (_resolved(row, self._resolve) for row in placement.rotation)
        return Placement(_resolved(placement.at, self._resolve), tuple(rows))  # type: ignore[arg-type]

    def _compose(self, outer: Placement, inner: Placement) -> Placement:
        return compose(outer, inner, self._model.snap)


def _swept(turned: Vector, original: Vector) -> Vector:
    """Drop rounding dust that a constant rotation leaves where an exact zero belongs."""
    if not all(isinstance(x, (int, float)) for x in (*turned, *original)):
        return turned
    scale = max(abs(x) for x in original)
    swept = tuple(0 if abs(x) <= 4e-16 * scale else x for x in turned)
    return swept  # type: ignore[return-value]


def _resolved(a: Vector, resolve: Resolve) -> Vector:
    return (resolve(a[0]), resolve(a[1]), resolve(a[2]))
