"""Trees for the kinematics of named frames.

Each requested frame becomes a massless link welded to the link that carries it. The working frames
along the way are then turned and slid until the chain from ground to that frame is short, not only the
chain to the joints. If no masses matter, links off these chains are dropped.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from linegraph.components.body import MASS_CENTER
from linegraph.components.body_mass import mass_center, resolved
from linegraph.components.joints import Fixed
from linegraph.components.validation import nearest
from linegraph.errors import ModelError
from linegraph.kinematics.links import KinematicTree, Link, Seat
from linegraph.kinematics.state_layout import Place
from linegraph.kinematics.working_frames import DUST, shortened
from linegraph.model.terminal_graphs import terminals_of
from linegraph.spatial import vector
from linegraph.spatial.inertia import NO_MOMENTS, carried
from linegraph.spatial.placement import Placement, compose
from linegraph.spatial.rotation import IDENTITY_MATRIX, Rotation, rotation_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.model.system import System
    from linegraph.spatial.inertia import Moments
    from linegraph.spatial.vector import Vector


class Tipped(NamedTuple):
    """A tree whose last links are the requested frames.

    Attributes:
        tree: the links in their shortest working frames.
        tips: the link of each frame; its working frame coincides with the frame itself.
        mass: the mass of all that moves (kg); 0 if masses were left out.
        at_rest: first moment (kg m) that links on ground have passed on to it and that never moves; the
            links' own moments lack it.
    """

    tree: KinematicTree
    tips: tuple[int, ...]
    mass: Scalar = 0
    at_rest: Vector = vector.ZERO


class NamedFrame(NamedTuple):
    """A requested frame: its identifier in emitted code, and its name in the model."""

    identifier: str
    name: str


def require_frame(system: System, frame: str) -> None:
    """Refuse a name that is neither a body nor a frame of a body.

    Args:
        system: the bodies and their frames.
        frame: ``body``, ``body.frame`` or ``body.mass_center``.

    Raises:
        ModelError: there is no such frame; suggests a similar name.
    """
    known = [name for name, (body, _) in terminals_of(system).items() if body in system.bodies]
    body = frame.removesuffix(f".{MASS_CENTER}")
    if frame not in known and (body == frame or body not in system.bodies):
        raise ModelError(
            f'frame "{frame}"', f"is no body and no frame of one; {nearest(frame, known)}"
        )


def seat_of(tree: KinematicTree, frame: str) -> Seat:
    """The link that carries a frame, -1 for ground, and the frame's constant place on it.

    Args:
        tree: the links of the walk.
        frame: ``body``, ``body.frame`` or ``body.mass_center``; a mass centre has its body's axes.
    """
    resolve, terminals = tree.resolve, terminals_of(tree.system)
    if frame in terminals:
        body, placement = terminals[frame]
        x, y, z = (resolved(row, resolve) for row in placement.rotation)
        placement = Placement(resolved(placement.at, resolve), (x, y, z))
    else:
        body = frame.removesuffix(f".{MASS_CENTER}")
        placement = Placement(mass_center(tree.system.bodies[body], resolve), IDENTITY_MATRIX)
    link, pose = tree.bodies[body]
    whole = compose(pose, placement, DUST)
    return Seat(link, whole.at, whole.rotation)


def tipped(
    tree: KinematicTree, seats: Sequence[Seat], *, masses: bool, turning: bool = True
) -> Tipped:
    """A tree for the kinematics of some frames.

    Args:
        tree: the links of the walk.
        seats: the frames.
        masses: whether the centre of mass or momentum is needed; otherwise only the links between
            ground and the frames are kept, without masses.
        turning: whether the frames' axes are needed; otherwise only their origins and velocities are
            right, and their axes are arbitrary.
    """
    links = list(tree.links)
    mass: Scalar = sum((link.moments.mass for link in links), start=0)
    if not masses:
        links, seats = _on_the_way(links, seats)
    count = len(links)
    links += [
        Link(
            "",
            seat.link,
            Fixed("frame", ("", "")),
            True,
            rotation_of(seat.rotation if turning else IDENTITY_MATRIX),
            seat.at,
            Place(),
            NO_MOMENTS,
        )
        for seat in seats
    ]
    short = shortened(replace(tree, links=tuple(links)), whole=True, turning=turning)
    tips = short.places[count:]
    if not turning:
        parts = list(short.tree.links)
        for tip in tips:
            parts[tip] = replace(parts[tip], rotation=Rotation())
        return Tipped(replace(short.tree, links=tuple(parts)), tips)
    if not masses:
        return Tipped(short.tree, tips)
    return Tipped(short.tree, tips, mass, _resting(short.at_rest))


def _on_the_way(links: Sequence[Link], seats: Sequence[Seat]) -> tuple[list[Link], list[Seat]]:
    """The links between ground and some frames, without their masses."""
    kept: set[int] = set()
    for seat in seats:
        i = seat.link
        while i >= 0 and i not in kept:
            kept.add(i)
            i = links[i].parent
    place = {old: new for new, old in enumerate(sorted(kept))} | {-1: -1}
    found = [
        replace(links[old], parent=place[links[old].parent], moments=NO_MOMENTS)
        for old in sorted(kept)
    ]
    return found, [seat._replace(link=place[seat.link]) for seat in seats]


def _resting(handed: Sequence[tuple[Moments, Link]]) -> Vector:
    """First moment of mass (kg m) that links on ground have passed on to it, in ground axes."""
    total = vector.ZERO
    for moments, link in handed:
        total = vector.add(total, carried(moments, link.rotation, link.at).first)
    return total
