"""Joints of several axes replaced by joints of one axis each, with massless links in between.

The motion stays the same. Each axis gets a working frame of its own, and moments that only a turn about
the last axis would notice can be passed on to the links before it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from linegraph.components.joints.composition import joined
from linegraph.kinematics.links import KinematicTree, Link
from linegraph.kinematics.state_layout import Place
from linegraph.spatial.inertia import NO_MOMENTS, carried
from linegraph.spatial.rotation import Relabel, Rotation
from linegraph.spatial.vector import ZERO

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.components.joints import Joint


class Expanded(NamedTuple):
    """A tree whose joints of several axes have been taken apart.

    Attributes:
        tree: the longer tree; its `bodies` and `ends` still refer to the links of the original one.
        last: for each original link, the index of the new link that has its bodies.
        turns: for each original link, the working axes of the new link in those of the original.
    """

    tree: KinematicTree
    last: tuple[int, ...]
    turns: tuple[Rotation, ...]


def expanded(tree: KinematicTree) -> Expanded:
    """Take apart every joint that consists of parts whose axes are numbers."""
    links: list[Link] = []
    last: list[int] = []
    turns: list[Rotation] = []
    for before in tree.links:
        link = before
        if link.parent >= 0:
            back = turns[link.parent].inverse()
            rotation = joined(back, link.rotation)
            near = last[link.parent]
            link = replace(link, parent=near, rotation=rotation, at=back.out(link.at))
        parts = _parts(link)
        turn = Rotation()
        if parts:
            sequence, turn = _sequence(link, parts, len(links))
            links += sequence
        else:
            links.append(link)
        last.append(len(links) - 1)
        turns.append(turn)
    return Expanded(replace(tree, links=tuple(links)), tuple(last), tuple(turns))


def _parts(link: Link) -> tuple[tuple[Joint, Rotation], ...]:
    """The parts of a joint with their axes; none if taking them apart would cost operations.

    An oblique axis of anything but a hinge would need a rotation to it and one back. A hinge contains a
    rotation in any case, so it may have any constant axis.
    """
    parts = () if link.place.level else link.joint.sequence()
    apart = all(
        all(isinstance(x, (int, float)) for row in axes.matrix() for x in row)
        and (joint.turns or all(isinstance(factor, Relabel) for factor in axes.factors))
        for joint, axes in parts
    )
    return parts if apart else ()


def _sequence(
    link: Link, parts: Sequence[tuple[Joint, Rotation]], first: int
) -> tuple[list[Link], Rotation]:
    """The links of a joint's parts, and the axes of the last of them in those of the original link.

    With B the axes in which a part is about z and m its motion, the joint's motion is the product of
    all ``B m Bᵀ``.
    """
    shares = list(zip(parts, _places(link.place, [joint for joint, _ in parts]), strict=True))
    if not link.forward:
        shares.reverse()
    found: list[Link] = []
    near, at, parent = link.rotation, link.at, link.parent
    for (joint, axes), place in shares:
        rotation = joined(near, axes)
        inside = f"inside {link.joint.name}"
        found.append(Link(inside, parent, joint, link.forward, rotation, at, place, NO_MOMENTS))
        near, at, parent = axes.inverse(), ZERO, first + len(found) - 1
    moments = carried(link.moments, near, ZERO)
    found[-1] = replace(found[-1], name=link.name, moments=moments)
    return found, near.inverse()


def _places(place: Place, parts: Sequence[Joint]) -> list[Place]:
    """Each part's share of the joint's coordinates, in the order of the parts."""
    found = []
    at = rate = 0
    for joint in parts:
        q, v = len(joint.positions()), joint.freedoms
        if place.drive:
            found.append(Place(drive=place.drive[at : at + q]))
        else:
            found.append(Place(place.positions[at : at + q], place.velocities[rate : rate + v]))
        at, rate = at + q, rate + v
    return found
