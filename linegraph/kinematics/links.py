"""Stage 3: the links of a mechanical tree, each in a frame of its joint.

A *link* is all bodies welded together beyond one moving joint. Its working frame has its origin at that
joint and z along the joint's axis. Whatever is constant is folded here once: placements, alignments,
rotated and shifted mass distributions.
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
    """A rigid body of the reduced tree.

    Attributes:
        name: the bodies welded into it.
        parent: index of the link nearer to ground; -1 for ground.
        joint: what connects it to its parent.
        forward: whether the joint's edge points away from ground.
        rotation, at: the joint's near frame in the parent's working frame; constant.
        place: where the joint's q and v come from.
        moments: mass distribution about the joint's own origin and in axes that turn with the link.
        still: whether the working axes do not turn with the link but stay those of the joint's near side.
        in_plane: whether the link never turns but about its own z; xx then holds its inertia about z, and
            that is all it holds of second moments.
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
        """Where the joint's velocities stand in the state; none where its motion is prescribed."""
        return self.place.velocities

    @property
    def caption(self) -> str:
        """How comments in emitted code call it: its joint and its bodies."""
        return f"{self.joint.name} -> {self.name}"

    @property
    def in_space(self) -> bool:
        """Whether its joint's rotation is that to ground axes: an orientation in space of its own."""
        return self.place.in_space


class Seat(NamedTuple):
    """A constant place on a link, -1 for ground: its origin and its axes in the link's working frame."""

    link: int
    at: Vector
    rotation: Matrix


@dataclass(frozen=True)
class Closure:
    """A chord of the tree: a joint that closes a loop, or a constraint.

    Attributes:
        component: what it is; a joint as resolved in the algebra.
        tail, head: where its ends are, in aligned axes.
        drive: what it prescribes.
        restrictions: a joint's reaction directions; of a joint that is a chord in rotation only those there.
    """

    component: Joint | Constraint
    tail: Seat
    head: Seat
    drive: tuple[Jet | None, ...] = ()
    restrictions: tuple[Restriction, ...] = ()


@dataclass(frozen=True)
class KinematicTree:
    """All links, every parent before its children, and what state and inputs consist of.

    It belongs to one algebra: all its constants are scalars of that.

    Attributes:
        system: what was said: bodies, elements, loads, outputs.
        algebra: where its scalars live.
        parameters: their scalars, by name.
        links: every parent before its children.
        gravity: the acceleration of free fall in ground axes (m/s^2).
        layout: coordinates and inputs, and which joint reads which.
        bodies: where each body's frame is: its link, -1 for ground, and its placement there.
        closures: what the tree leaves out.
        relations: constraints without edges, linear in velocities.
        ends: of every joint and constraint, branch or chord, where it is.
        network: the scalar networks.
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
        """From values of the model, numbers or formulas of parameters, to scalars of the algebra."""
        return resolver(self.algebra, self.parameters)

    @property
    def closed(self) -> bool:
        """Whether there are constraints."""
        held = (
            c.restrictions or c.drive or not isinstance(c.component, Joint) for c in self.closures
        )
        return bool(self.relations) or any(held)

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
    def levelled(self) -> bool:
        """Whether some link's orientation is measured from ground and not from its parent."""
        return any(link.place.level for link in self.links)

    @property
    def outward(self) -> list[int]:
        """Independent velocities from the root to the leaves, then the states of networks."""
        order: dict[int, None] = {}
        for link in self.links:
            order.update((freedom.index, None) for freedom in link.velocities)
        order.update((k, None) for k in range(self.layout.mechanical, len(self.velocities)))
        return list(order)

    def normalise(self, q: list[float]) -> None:
        """Give the quaternions among the coordinates length 1, in place."""
        for places in self.quaternions:
            length = math.hypot(*(q[i] for i in places))
            for i in places:
                q[i] /= length

    @property
    def quaternions(self) -> list[tuple[int, ...]]:
        """The places in q of the entries x, y, z, w of each unit quaternion."""
        found = [(link, [freedom.index for freedom in link.place.positions]) for link in self.links]
        return [tuple(places[-4:]) for link, places in found if len(places) > len(link.velocities)]

    def regrouped(self) -> KinematicTree:
        """The same M and h from fewer parameters: what a parent can carry is handed to it, leaf to root.

        Exact for the equations of motion, not for joint reactions. Where links stand and what they weigh
        depends on parameters at most, so that of symbols the sums are computed once, by `prepare`.
        """
        return replace(self, links=tuple(handed_on(self.links, links_in_plane(self.links))[0]))


def handed_on(
    links: Sequence[Link], planar: Sequence[bool]
) -> tuple[list[Link], list[tuple[Moments, Link]]]:
    """What a parent can carry handed to it, leaf to root.

    Args:
        links: with moments of their own.
        planar: of which only the inertia about z is to be kept, since M and h feel no other.

    Returns:
        The links, and what those on ground hand to it, beside each the link it comes from. Where none is
        planar, all together have the mass, the first moment and the momentum of before.
    """
    found = list(links)
    at_rest = []
    for i in reversed(range(len(found))):
        link = found[i]
        # of a link that does not turn with its parent only the mass can be handed over
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
    """Whether a link never turns but about its own z, since all joints inward turn about that direction."""
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
    """Whether a link turns about the direction of its parent's z, either way round."""
    return link.joint.turns and upright(link)


def upright(link: Link) -> bool:
    """Whether a link's z has the direction of its parent's, either way round, before its joint moves."""
    return link.rotation.out((0, 0, 1)) in ((0, 0, 1), (0, 0, -1))
