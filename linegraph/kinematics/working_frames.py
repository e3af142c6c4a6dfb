"""Working frames in which the equations of motion take the fewest operations.

A link's working frame may be turned about and slid along its joint's axis without changing the motion.
So joints of several axes are taken apart first (`expansion`), and then each link's frame is

    turned   so that the constant rotation or the arm to a child has fewer components;
    slid     so that as many components of the arms as possible are zero;
    still    at the end of a limb and in a run of parallel axes: its axes do not turn with the link, and
             sine and cosine of sums of angles replace products of rotations.

Moments that a parent can carry are passed on to it. M, h, inverse and forward dynamics stay the same.
Reactions do not, so everything about single bodies uses the frames of the walk.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from linegraph.kinematics.expansion import expanded
from linegraph.kinematics.links import (
    KinematicTree,
    Link,
    handed_on,
    links_in_plane,
    parallel,
    upright,
)
from linegraph.spatial import vector
from linegraph.spatial.inertia import carried
from linegraph.spatial.placement import Placement, compose, swept
from linegraph.spatial.rotation import (
    IDENTITY_MATRIX,
    Rotation,
    Turn,
    deviation,
    product,
    rotation_of,
    snapped,
)
from linegraph.spatial.vector import ZERO, Matrix, Vector, add, cross, subtract

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.arms import Arm
    from linegraph.spatial.inertia import Moments

DUST = 4e-15
"""Rounding of a product of constant rotations."""

WELL_APART = 0.1
"""Least sine of the angle between two axes, or cosine to a direction, that decides on a turn or a slide:
nearly parallel axes would lose digits."""

FULL = 6
"""Number of non-zero moments (of ten) of a leaf link from which on turning them is cheaper than turning
the forces that they cause."""

LONG = 5
"""Number of links in a plane, counted from ground, from which on angles to ground are cheaper than angles
between links."""

SWEEPS = 3
"""Passes over all links: sliding one frame changes the arms on both of its sides."""


class Shortened(NamedTuple):
    """A tree in its shortest working frames.

    Attributes:
        tree: the links; its `bodies` and `ends` still refer to the links of the walk.
        places: for each link of the walk, the link here that has its bodies.
        poses: for each link of the walk, the working frame of that link in its own.
        at_rest: moments that links on ground pass on to it, each with its link.
    """

    tree: KinematicTree
    places: tuple[int, ...]
    poses: tuple[Placement, ...]
    at_rest: tuple[tuple[Moments, Link], ...] = ()

    def rehoused(
        self, wrenches: Iterable[tuple[Vector, Vector]], arms: Sequence[Arm]
    ) -> list[tuple[Vector, Vector]]:
        """Wrenches in the frames of the walk, transformed to the frames of this tree.

        Args:
            wrenches: force (N) and torque about the origin (N m) for each link of the walk.
            arms: the joints of this tree at the state.
        """
        found = [(ZERO, ZERO)] * len(self.tree.links)
        for (force, torque), place, pose in zip(wrenches, self.places, self.poses, strict=True):
            turned, turn = rotation_of(pose.rotation), arms[place].turn
            about = subtract(torque, cross(pose.at, force))
            found[place] = (turn.out(turned.into(force)), turn.out(turned.into(about)))
        return found


def shortened(tree: KinematicTree, *, whole: bool = False, turning: bool = True) -> Shortened:
    """The tree in working frames that give the same M and h with fewer operations.

    Args:
        tree: the links of the walk.
        whole: keep moments that neither M nor h depends on, so that momentum stays the same too.
        turning: whether links that are welded to others turn with them; otherwise only their origins
            and velocities are right, and their axes are arbitrary.
    """
    if tree.levelled:
        # an angle measured from ground fixes its link's axes: nothing is left to choose
        same = (Placement(ZERO, IDENTITY_MATRIX),) * len(tree.links)
        short, at_rest = _regrouped(tree, whole)
        return Shortened(short, tuple(range(len(tree.links))), same, at_rest)
    apart = expanded(tree)
    children = _children(apart.tree.links)
    links, turns = _turned(list(apart.tree.links), children)
    links, shifts = _slid(links, children)
    poses = []
    for k, turn in zip(apart.last, apart.turns, strict=True):
        moved = Placement(rotation_of(turns[k]).out(shifts[k]), turns[k])
        poses.append(compose(Placement(ZERO, turn.matrix()), moved, DUST))
    short, at_rest = _regrouped(replace(tree, links=tuple(links)), whole)
    return Shortened(_stilled(short, children, turning), apart.last, tuple(poses), at_rest)


def _regrouped(
    tree: KinematicTree, whole: bool
) -> tuple[KinematicTree, tuple[tuple[Moments, Link], ...]]:
    planar = [False] * len(tree.links) if whole else links_in_plane(tree.links)
    links, at_rest = handed_on(tree.links, planar)
    return replace(tree, links=tuple(links)), tuple(at_rest)


def _children(links: Sequence[Link]) -> list[list[int]]:
    found: list[list[int]] = [[] for _ in links]
    for i, link in enumerate(links):
        if link.parent >= 0:
            found[link.parent].append(i)
    return found


def _weights(links: Sequence[Link]) -> list[int]:
    """Estimated cost of a component of each arm: motion, forces, moments, and the columns of M beyond it."""
    columns = [len(link.velocities) for link in links]
    for i in reversed(range(len(links))):
        if links[i].parent >= 0:
            columns[links[i].parent] += columns[i]
    return [18 + 4 * n if link.parent >= 0 else 0 for n, link in zip(columns, links, strict=True)]


def _oriented(link: Link) -> bool:
    """Whether a link's constant rotation is numeric; arms and moments may be sums made by `prepare`."""
    return _known(x for row in link.rotation.matrix() for x in row)


def _known(entries: Iterable[Scalar]) -> bool:
    return all(isinstance(x, (int, float)) for x in entries)


# axes that do not turn


def _stilled(
    tree: KinematicTree, children: Sequence[Sequence[int]], turning: bool
) -> KinematicTree:
    """Decide for each link whether its working axes turn with it."""
    links = tree.links
    lengths = _lengths_in_plane(links)
    found = []
    for i, link in enumerate(links):
        short = link.in_plane and lengths[i] < LONG
        if children[i]:
            loose = (not turning and links[c].joint.freedoms == 0 for c in children[i])
            pairs = zip(children[i], loose, strict=True)
            still = not short and all(free or parallel(links[c]) for c, free in pairs)
        else:
            given = [x != 0 for x in (*link.moments.first, *link.moments.second)]
            still = all(given[:2]) if short else link.in_plane or sum(given) >= FULL
        found.append(replace(link, still=still and link.joint.turns))
    return replace(tree, links=tuple(found))


def _lengths_in_plane(links: Sequence[Link]) -> list[int]:
    """For each link that moves in a plane, the number of links on the longest way through it."""
    inward = [0] * len(links)
    for i, link in enumerate(links):
        if link.in_plane:
            inward[i] = 1 + (inward[link.parent] if link.parent >= 0 else 0)
    longest = list(inward)
    for i in reversed(range(len(links))):
        if links[i].in_plane and links[i].parent >= 0:
            longest[links[i].parent] = max(longest[links[i].parent], longest[i])
    return longest


# turning about the joint's axis


def _turned(
    links: list[Link], children: Sequence[Sequence[int]]
) -> tuple[list[Link], list[Matrix]]:
    """Turn working frames about their joints' axes; offsets of the joints' angles compensate."""
    weights = _weights(links)
    turns: list[Matrix] = [IDENTITY_MATRIX] * len(links)
    for i, link in enumerate(links):
        carried_by = [links[c] for c in children[i]]
        if link.joint.turns and all(map(_oriented, (link, *carried_by))):
            angle = _best_angle(link, carried_by, [weights[c] for c in children[i]])
            turns[i] = _about_z(angle)
            if angle:
                moments = _seen_turned(link.moments, turns[i])
                links[i] = replace(_angle_shifted(link, angle), moments=moments)
        back = vector.transpose(turns[i])
        for c in children[i]:
            if _oriented(links[c]):
                links[c] = _seen_from(links[c], back)
    for i, link in enumerate(links):
        if link.parent < 0 and _oriented(link):
            links[i] = _seen_from(link, IDENTITY_MATRIX)
    return links, turns


def _best_angle(link: Link, children: Sequence[Link], weights: Sequence[int]) -> float:
    """The angle about z at which a link's working frame makes its children cheapest.

    A link without children is turned towards its mass centre, which leaves one component of its first
    moment.
    """
    x, y, _ = link.moments.first
    if not children:
        return math.atan2(y, x) if _known((x, y)) and x != 0 and y != 0 else 0.0
    return min(_candidates(children), key=lambda b: round(_cost(b, children, weights), 6))


def _seen_turned(moments: Moments, turn: Matrix) -> Moments:
    """Moments in axes that are turned."""
    seen = carried(moments, rotation_of(vector.transpose(turn)), ZERO)
    return seen._replace(first=swept(seen.first, moments.first, DUST))


def _candidates(children: Sequence[Link]) -> list[float]:
    """Angles about z that may make a child's rotation or arm simpler; zero comes first and wins ties."""
    found = [0.0]
    for child in children:
        m = child.rotation.matrix()
        if any(x not in (0, 1, -1) for row in m for x in row):
            if _apart(m):
                found.append(math.atan2(m[0][2], -m[1][2]))
            elif child.joint.freedoms == 0 and upright(child):
                # welded links have no joint to turn them: only the parent's angle can
                found.append(math.atan2(m[1][0], m[0][0]))
        if _known(child.at) and child.at[0] != 0 and child.at[1] != 0:
            found.append(math.atan2(child.at[1], child.at[0]))
    return found


def _cost(angle: float, children: Sequence[Link], weights: Sequence[int]) -> float:
    """Estimated cost of the rotations and arms of the children in axes turned by an angle."""
    back = vector.transpose(_about_z(angle))
    total = 0.0
    for child, weight in zip(children, weights, strict=True):
        seen = _seen_from(child, back)
        turns = sum(isinstance(factor, Turn) for factor in seen.rotation.factors)
        total += weight * (3 * turns + sum(x != 0 for x in seen.at))
    return total


def _seen_from(link: Link, back: Matrix) -> Link:
    """A link whose parent's axes are turned: `back` takes old components to new ones."""
    m = product(back, link.rotation.matrix()) if back != IDENTITY_MATRIX else None
    at = link.at if m is None else swept(vector.times(back, link.at), link.at, DUST)
    m = snapped(m if m is not None else link.rotation.matrix(), DUST)
    rotation = rotation_of(m)
    constant = all(x in (0, 1, -1) for row in m for x in row) or deviation(m) > DUST
    if constant or not (_apart(m) or parallel(link)) or not _many(rotation, link):
        return replace(link, rotation=rotation, at=at)
    outer, middle, inner = _angles(m)
    factors = [_about_z(outer), _about_x(middle)]
    if link.joint.turns:
        link = _angle_shifted(link, inner)
    else:
        factors.append(_about_z(inner))
    parts = [f for matrix in factors for f in rotation_of(snapped(matrix, DUST)).factors]
    return replace(link, rotation=Rotation(tuple(parts)), at=at)


def _apart(m: Matrix) -> bool:
    """Whether the z axes of a rotation differ enough to define their common normal."""
    return bool(math.hypot(m[2][0], m[2][1]) > WELL_APART)


def _many(rotation: Rotation, link: Link) -> bool:
    """Whether a constant rotation could be cheaper: a turn about z is free where the joint turns anyway."""
    (factor,) = rotation.factors
    return not isinstance(factor, Turn) or (factor.axis == 2 and link.joint.turns)


def _angles(m: Matrix) -> tuple[float, float, float]:
    """The angles of ``m = Rz(outer) Rx(middle) Rz(inner)``."""
    if not _apart(m):
        sign = 1 if m[2][2] > 0 else -1
        return 0.0, 0.0 if sign > 0 else math.pi, math.atan2(sign * m[1][0], m[0][0])
    middle = math.atan2(math.hypot(m[2][0], m[2][1]), m[2][2])
    return math.atan2(m[0][2], -m[1][2]), middle, math.atan2(m[2][0], m[2][1])


def _about_z(angle: float) -> Matrix:
    c, s = math.cos(angle), math.sin(angle)
    return snapped(((c, -s, 0), (s, c, 0), (0, 0, 1)), DUST)


def _about_x(angle: float) -> Matrix:
    c, s = math.cos(angle), math.sin(angle)
    return snapped(((1, 0, 0), (0, c, -s), (0, s, c)), DUST)


def _angle_shifted(link: Link, angle: float) -> Link:
    """A link whose joint's far frame is turned by an angle, or whose near frame by the opposite one."""
    place = link.place
    shift = angle if link.forward else -angle
    if place.drive:
        (jet,) = place.drive
        moved = replace(place, drive=(replace(jet, x=jet.x + shift),))
    else:
        (freedom,) = place.positions
        moved = replace(place, positions=(replace(freedom, offset=freedom.offset + shift),))
    return replace(link, place=moved)


# sliding along the joint's axis


def _slid(links: list[Link], children: Sequence[Sequence[int]]) -> tuple[list[Link], list[Vector]]:
    """Slide origins along their joints' axes."""
    weights = _weights(links)
    shifts = [ZERO] * len(links)
    for _ in range(SWEEPS):
        for i in reversed(range(len(links))):
            carried_by = [links[c] for c in children[i]]
            if not (links[i].joint.slides and all(map(_oriented, (links[i], *carried_by)))):
                continue
            costs = [weights[c] for c in children[i]]
            for axis in links[i].joint.slides:
                shift = _best_shift(links[i], carried_by, weights[i], costs, axis)
                if shift == ZERO:
                    continue
                links[i] = _moved_origin(links[i], shift)
                carried_by = [_seen_shifted(child, shift) for child in carried_by]
                shifts[i] = add(shifts[i], shift)
            for c, child in zip(children[i], carried_by, strict=True):
                links[c] = child
    return links, shifts


def _best_shift(
    link: Link, children: Sequence[Link], weight: int, weights: Sequence[int], axis: int
) -> Vector:
    """The shift along an axis of a link's frame that makes its arm and its children's cheapest."""
    along = link.rotation.out(IDENTITY_MATRIX[axis])
    found: list[Scalar] = [0]
    for x, d in zip(link.at, along, strict=True):
        if x != 0 and (abs(d) > WELL_APART if _known((x,)) else d in (1, -1)):
            found.append(-x / d)
    found += [child.at[axis] for child in children if child.at[axis] != 0]

    def cost(s: Scalar) -> float:
        shift = vector.scale(s, IDENTITY_MATRIX[axis])
        own = _moved_origin(link, shift)
        arms = [own.at, *(_seen_shifted(child, shift).at for child in children)]
        total = 4.0 * sum(own.moments.second[k] != 0 for k in (2, 4))
        for w, at in zip((weight, *weights), arms, strict=True):
            total += w * sum(x != 0 for x in at)
        return float(total)

    return vector.scale(min(found, key=cost), IDENTITY_MATRIX[axis])


def _moved_origin(link: Link, shift: Vector) -> Link:
    """A link with its origin shifted, on both the near and the far side."""
    at = swept(add(link.at, link.rotation.out(shift)), link.at, DUST)
    moments = carried(link.moments, Rotation(), vector.negate(shift))
    return replace(link, at=at, moments=moments)


def _seen_shifted(link: Link, shift: Vector) -> Link:
    """A link whose parent's origin is shifted."""
    return replace(link, at=swept(subtract(link.at, shift), link.at, DUST))
