"""The links of a mechanical tree, each in a frame of its joint.

A *link* is all bodies that are welded together beyond one moving joint. Its working frame has its
origin at that joint and z along the joint's axis. Everything constant is folded here once: placements,
alignments, rotated and shifted mass distributions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.components.joints import Joint
from linegraph.components.parameters import resolver
from linegraph.spatial.inertia import Moments, carried, joined, point_apart

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.algebra.jets import Jet
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.constraints import Constraint
    from linegraph.components.constraints.relation import Relation
    from linegraph.components.joints.base import Restriction
    from linegraph.graph.forest import Step
    from linegraph.ir.program import Quantity
    from linegraph.kinematics.state_layout import Freedom, Layout, Place
    from linegraph.model.system import System
    from linegraph.networks import Network
    from linegraph.spatial.placement import Placement
    from linegraph.spatial.rotation import Rotation
    from linegraph.spatial.vector import Matrix, Vector


@dataclass(frozen=True)
class Link:
    """A rigid body of the reduced tree, with the joint that connects it to its parent.

    Attributes:
        name: the names of the bodies welded into it.
        parent: index of the next link towards ground; -1 for ground.
        joint: connects it to its parent.
        forward: whether the joint's edge points away from ground.
        rotation, at: the joint's near frame in the parent's working frame (at in m); constant.
        place: the source of the joint's q and v.
        moments: mass distribution about the joint's origin, in axes that turn with the link.
        still: whether the working axes keep the orientation of the joint's near side and do not turn
            with the link.
        in_plane: whether the link turns about its own z only; the entry xx of the second moments then
            holds its inertia about z, and all other second moments are zero.
    """

    name: str
    parent: int
    joint: Joint
    forward: bool
    rotation: Rotation
    at: Vector
    place: Place
    moments: Moments
    still: bool = False
    in_plane: bool = False

    @property
    def velocities(self) -> tuple[Freedom, ...]:
        """The entries of v that move the joint; none if its motion is prescribed."""
        return self.place.velocities

    @property
    def caption(self) -> str:
        """Label in comments of emitted code: the joint and the bodies."""
        return f"{self.joint.name} -> {self.name}"

    @property
    def in_space(self) -> bool:
        """Whether the joint's rotation is that from the link to ground axes, not to its parent's."""
        return self.place.in_space


class Seat(NamedTuple):
    """A constant place on a link, -1 for ground: origin (m) and axes in the link's working frame."""

    link: int
    at: Vector
    rotation: Matrix


@dataclass(frozen=True)
class Closure:
    """A chord of the tree: a joint that closes a loop, or a constraint.

    Attributes:
        component: the joint, with its values in the tree's algebra, or the constraint.
        tail, head: the places of its ends, in aligned axes.
        drive: the values it prescribes, with two time derivatives each.
        restrictions: the joint's reaction directions; only the rotational ones if the joint is a chord
            in rotation alone.
    """

    component: Joint | Constraint
    tail: Seat
    head: Seat
    drive: tuple[Jet | None, ...] = ()
    restrictions: tuple[Restriction, ...] = ()


@dataclass(frozen=True)
class KinematicTree:
    """All links, parents before children, with the layout of state and inputs.

    A tree belongs to one algebra: all its constants are scalars of it.

    Attributes:
        system: bodies, elements, loads and outputs.
        algebra: where its scalars live.
        parameters: their scalars, by name.
        links: every parent before its children.
        gravity: the acceleration of free fall in ground axes (m/s²).
        layout: coordinates and inputs, and which joint reads which.
        bodies: for each body its link, -1 for ground, and the pose of its frame in the link's working
            frame.
        closures: the chords that are constraints.
        relations: constraints without edges, linear in velocities.
        ends: for every joint and constraint, branch or chord, the places of its ends.
        network: the scalar networks; None if there are none.
        walk: the branches of the translational tree, from ground outward.
    """

    system: System
    algebra: Algebra
    parameters: Mapping[str, Scalar]
    links: tuple[Link, ...]
    gravity: Vector
    layout: Layout
    bodies: Mapping[str, tuple[int, Placement]]
    closures: tuple[Closure, ...] = ()
    relations: tuple[Relation, ...] = ()
    ends: Mapping[str, Closure] = field(default_factory=dict)
    network: Network | None = None
    walk: tuple[Step, ...] = ()

    @property
    def resolve(self) -> Callable[[Any], Scalar]:
        """Converts model values, numbers or formulas of parameters, to scalars of the algebra."""
        return resolver(self.algebra, self.parameters)

    @property
    def closed(self) -> bool:
        """Whether there are constraints: relations, or chords that restrict or prescribe motion."""
        held = (
            c.restrictions or c.drive or not isinstance(c.component, Joint) for c in self.closures
        )
        return bool(self.relations) or any(held)

    @property
    def positions(self) -> tuple[Quantity, ...]:
        """The coordinates q, with names and units."""
        return tuple(self.layout.positions)

    @property
    def velocities(self) -> tuple[Quantity, ...]:
        """The velocities v, with names and units; states of networks last."""
        return tuple(self.layout.velocities)

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """The inputs u, with names and units."""
        return tuple(self.layout.inputs)

    @property
    def coupled(self) -> bool:
        """Whether two joints depend on the same velocity, as with gears."""
        places = [freedom.index for link in self.links for freedom in link.velocities]
        return len(places) > len(set(places))

    @property
    def levelled(self) -> bool:
        """Whether the orientation of some link is measured from ground and not from its parent."""
        return any(link.place.level for link in self.links)

    @property
    def outward(self) -> list[int]:
        """The order of elimination: velocities from the root to the leaves, then the states of networks."""
        order: dict[int, None] = {}
        for link in self.links:
            order.update((freedom.index, None) for freedom in link.velocities)
        order.update((k, None) for k in range(self.layout.mechanical, len(self.velocities)))
        return list(order)

    def normalise(self, q: list[float]) -> None:
        """Scale the quaternions among the coordinates to length 1, in place."""
        for places in self.quaternions:
            length = math.hypot(*(q[i] for i in places))
            for i in places:
                q[i] /= length

    @property
    def quaternions(self) -> list[tuple[int, ...]]:
        """For each unit quaternion the places of its entries x, y, z, w in q."""
        found = [(link, [freedom.index for freedom in link.place.positions]) for link in self.links]
        return [tuple(places[-4:]) for link, places in found if len(places) > len(link.velocities)]

    def regrouped(self) -> KinematicTree:
        """A tree with the same M and h and fewer non-zero moments: the base-parameter regrouping.

        Moments of a link that its parent can carry instead are passed on, from the leaves to the root.
        This is exact for the equations of motion, but not for joint reactions. Places and masses of
        links depend at most on parameters, so with symbols the sums are computed once, in `prepare`.
        """
        return replace(self, links=tuple(handed_on(self.links, links_in_plane(self.links))[0]))


def handed_on(
    links: Sequence[Link], planar: Sequence[bool]
) -> tuple[list[Link], list[tuple[Moments, Link]]]:
    """Pass moments that a parent can carry on to it, from the leaves to the root.

    Args:
        links: with their own moments.
        planar: for each link, whether it moves in a plane, so that only its inertia about z matters to
            M and h and only this is kept.

    Returns:
        The links, and the moments passed on to ground, each with the link that they come from. If no
            link is planar, links and ground together keep mass, first moment and momentum.
    """
    found = list(links)
    at_rest = []
    for i in reversed(range(len(found))):
        link = found[i]
        # a link that does not turn with its parent can pass on no more than its mass
        split = point_apart if link.place.level else link.joint.regroup
        kept, handed = split(link.moments)
        if planar[i]:
            about = kept.inertia[5]
            kept = kept._replace(second=(about, 0, 0, 0, 0, 0), about=(None, None, about))
        found[i] = replace(link, moments=kept, in_plane=planar[i])
        if link.parent < 0:
            at_rest.append((handed, link))
            continue
        parent = found[link.parent]
        shifted = carried(handed, link.rotation, link.at)
        found[link.parent] = replace(parent, moments=joined(parent.moments, shifted))
    return found, at_rest


def links_in_plane(links: Sequence[Link]) -> list[bool]:
    """For each link, whether it turns only about its own z, since all joints before it have parallel axes."""
    still: list[bool] = []
    found: list[bool] = []
    for link in links:
        outer = link.parent
        at_rest = outer < 0 or still[outer]
        free = not (link.place.level or link.place.drive)
        slides = len(link.joint.slides) == 3
        still.append(at_rest and slides and free)
        found.append(link.joint.turns and free and (at_rest or (found[outer] and parallel(link))))
    return found


def parallel(link: Link) -> bool:
    """Whether a link turns about the direction of its parent's z, in either sense."""
    return link.joint.turns and upright(link)


def upright(link: Link) -> bool:
    """Whether a link's z is parallel to its parent's before its joint moves, in either sense."""
    return link.rotation.out((0, 0, 1)) in ((0, 0, 1), (0, 0, -1))
