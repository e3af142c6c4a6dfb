"""Which standard parameters no motion can tell apart: exact, link by link from the leaves to the root.

Moments P of a link, against the opposite ones on its parent, change no equation of motion if the energies
of both together stay what they are at all positions and velocities. With x -> w x x + u the velocity field
that the joint's unit velocity gives the link, D the change of moments that this motion makes, and f(P) any
linear function of moments that energies of the parent can consist of, as seen from the joint's near frame,

    (1)  T_φφ(P) + armature = 0           kinetic energy of the joint's own rate
    (2)  T_φv(P) = 0                      for every velocity v that the parent can have, at every q
    (3)  f(D P) = 0                       for every f, kinetic or of weight, at every q

T_vw is the bilinear kinetic energy. "At every q" is the span closed under the motion of the joint; what the
parent can have follows from the root outward in the same way: velocities are those of the parent and the
joint's own, functions f those of the parent, T_φv and T_φφ. A leaf's share has to satisfy this by itself,
then the tree without the leaf, so for joints with velocities of their own these are all relations.

Joints that follow one another and have one parent are taken together. Others that follow, and joints in
prescribed motion, may have further relations.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations_with_replacement
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.algebra.sampled import Row, closed, kernel, reduced
from linegraph.identification.standard_parameters import MOMENTS
from linegraph.spatial.inertia import Moments, carried
from linegraph.spatial.placement import inverse
from linegraph.spatial.rotation import Full, Rotation
from linegraph.spatial.vector import ZERO, Matrix, Vector, add, cross, dot, scale, subtract

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.spatial.placement import Placement

PAIRS = tuple(combinations_with_replacement(range(3), 2))
"""The places of xx, xy, xz, yy, yz, zz."""

PREFERRED = ("m", "mz", "my", "mx", "Iyy", "Ixx", "Izz", "Iyz", "Ixz", "Ixy")
"""Which of a link's parameters go first: for a joint about z those that Khalil's rules let go."""

TEN = range(10)


class Twist(NamedTuple):
    """A velocity field: angular velocity, and velocity of the origin."""

    w: Vector
    u: Vector


class Member(NamedTuple):
    """A link as the relations see it.

    Attributes:
        parent: index of the link nearer to ground; -1 for ground.
        near: the joint's near frame in the parent's working frame.
        twists: what unit velocities of the joint give the link, from the tail outward.
        indices: the entries of v that these are; none where the motion is prescribed.
        ratio: of a joint of one freedom, how its rate follows from its entry.
        home: the frame of the link's parameters, in its working frame.
        armature: the place of the joint's rotor inertia among all parameters; None where it has none.
    """

    parent: int
    near: Placement
    twists: tuple[Twist, ...]
    indices: tuple[int, ...]
    ratio: Scalar
    home: Placement
    armature: int | None


@dataclass(frozen=True)
class Spans:
    """What a link can do: its velocities, and functions of moments that energies consist of."""

    twists: list[Row]
    functions: list[Row]


def null_vectors(members: Sequence[Member], gravity: Vector) -> dict[int, dict[int, Scalar]]:
    """All relations: by the place of a parameter that can go, what has to change so that nothing does.

    Each is 1 at its own parameter and 0 at those of all others.
    """
    spans: list[Spans | None] = [None] * len(members)
    ground = Spans([], reduced([_weight(gravity)])[0] if any(x != 0 for x in gravity) else [])
    moved: list[bool] = []
    for member in members:
        inward = member.parent >= 0 and moved[member.parent]
        moved.append(inward or bool(member.indices))
    found: dict[int, dict[int, Scalar]] = {}
    for group in _groups(members):
        parent = members[group[0]].parent
        near = [_seen(members[i], ground if parent < 0 else spans[parent]) for i in group]
        rows, outward = _conditions([members[i] for i in group], near)
        for i, own in zip(group, outward, strict=True):
            spans[i] = own
        share = _shares(members, group, rows if moved[group[0]] else None)
        found |= {place: without(vector, found) for place, vector in share.items()}
    return found


def handed(members: Sequence[Member]) -> dict[int, dict[int, dict[int, Scalar]]]:
    """Of each link on a joint of one freedom what its parent can carry as well, whatever that can do.

    The relations are between the link's own parameters and its parent's.
    """
    anything = Spans(_unit(6), _unit(10))
    found = {}
    for i, member in enumerate(members):
        if member.parent >= 0 and member.indices and len(member.twists) == 1:
            conditions, _ = _conditions([member], [anything])
            found[i] = _shares(members, [i], conditions)
    return found


def _unit(count: int) -> list[Row]:
    return [[int(i == k) for k in range(count)] for i in range(count)]


def _groups(members: Sequence[Member]) -> list[list[int]]:
    """Links taken together: those of one parent whose joints of one freedom have one entry of v."""
    found: dict[Any, list[int]] = {}
    for i, member in enumerate(members):
        single = len(member.twists) == 1 and member.indices
        key = (member.parent, member.indices) if single else i
        found.setdefault(key, []).append(i)
    return list(found.values())


def _seen(member: Member, spans: Spans | None) -> Spans:
    """What the parent can do, in the joint's near frame."""
    assert spans is not None
    r, at = Full(member.near.rotation), member.near.at
    twists = []
    for row in spans.twists:
        w, u = tuple(row[:3]), tuple(row[3:])
        twists.append([*r.into(w), *r.into(add(u, cross(w, at)))])
    matrix = carrying(member.near)
    functions = [_pulled(row, matrix) for row in spans.functions]
    # row by row the parent's, so that links side by side see the same
    return Spans(twists, functions)


def _conditions(members: Sequence[Member], near: Sequence[Spans]) -> tuple[list[Row], list[Spans]]:
    """What moments of a group's links, and then its armature, have to satisfy; and what the links can do."""
    if len(members) > 1:
        return _together(members, near)
    (member,), (spans,) = members, near
    rows: list[Row] = []
    free = bool(member.indices)
    for twist in member.twists:
        rows += _crossed([twist], [1], [spans], free)
        spans = _beyond(twist, spans)
    return rows, [spans]


def _together(members: Sequence[Member], near: Sequence[Spans]) -> tuple[list[Row], list[Spans]]:
    twists, ratios = [m.twists[0] for m in members], [m.ratio for m in members]
    rows = _crossed(twists, ratios, near, True)
    return rows, [_beyond(t, s) for t, s in zip(twists, near, strict=True)]


def _crossed(
    twists: Sequence[Twist], ratios: Sequence[Scalar], near: Sequence[Spans], free: bool
) -> list[Row]:
    """(1) to (3) for joints that move together, each row followed by the factor of the armature.

    What their parent does they all see at once, so its velocities and functions are put side by side.
    """
    count = len(twists)
    rows: list[Row] = []
    if free:
        own = [[r * r * x for x in _kinetic(t, t)] for t, r in zip(twists, ratios, strict=True)]
        rows.append([x for part in own for x in part] + [1])

    def shifted(row: Row) -> Row:
        parts = (_bracket(t, row[6 * k : 6 * k + 6]) for k, t in enumerate(twists))
        return [r * x for part, r in zip(parts, ratios, strict=True) for x in part]

    def changed(row: Row) -> Row:
        parts = (_pulled(row[10 * k : 10 * k + 10], changing(t)) for k, t in enumerate(twists))
        return [r * x for part, r in zip(parts, ratios, strict=True) for x in part]

    for row in closed(_beside([s.twists for s in near]), shifted):
        fields = [_twist(row[6 * k : 6 * k + 6]) for k in range(count)]
        mixed = [_kinetic(t, v) for t, v in zip(twists, fields, strict=True)]
        parts = zip(ratios, mixed, strict=True)
        rows.append([r * x for r, part in parts for x in part] + [0])
    for row in closed(_beside([s.functions for s in near]), changed):
        rows.append([*changed(row), 0])
    return rows


def _beside(parts: Sequence[Sequence[Row]]) -> list[Row]:
    """What each of several links sees of one thing, side by side."""
    return [[x for row in rows for x in row] for rows in zip(*parts, strict=True)]


def _beyond(twist: Twist, near: Spans) -> Spans:
    """What a link can do beyond a joint of one freedom."""
    twists = closed(near.twists, lambda row: _bracket(twist, row))
    functions = closed(near.functions, lambda row: _pulled(row, changing(twist)))
    functions += [_kinetic(twist, _twist(row)) for row in twists]
    functions.append(_kinetic(twist, twist))
    return Spans(reduced([*twists, [*twist.w, *twist.u]])[0], reduced(functions)[0])


def _shares(
    members: Sequence[Member], group: Sequence[int], conditions: list[Row] | None
) -> dict[int, dict[int, Scalar]]:
    """The relations of a group: of its own parameters, armature last, with its parent's.

    Without conditions nothing of it moves freely, so that none of its parameters has an effect.
    """
    count = 10 * len(group)
    places = [10 * i + k for i in group for k in TEN]
    places += [place for i in group if (place := members[i].armature) is not None]
    parent = members[group[0]].parent
    out = [carrying(members[i].near) for i in group]
    home = [carrying(inverse(members[i].home)) for i in group]
    vectors: list[Row] = []
    for x in kernel([row[: len(places)] for row in conditions or ()], len(places)):
        shares = [x[10 * n : 10 * n + 10] for n in range(len(group))]
        vector = [
            entry
            for matrix, share in zip(home, shares, strict=True)
            for entry in _standard(_times(matrix, share))
        ]
        vector += x[count:]
        if parent >= 0 and conditions is not None:
            moved = [_times(matrix, share) for matrix, share in zip(out, shares, strict=True)]
            total = [-_sum(parts) for parts in zip(*moved, strict=True)]
            vector += _standard(_times(carrying(inverse(members[parent].home)), total))
        vectors.append(vector)
    if not vectors:
        return {}
    kinds = [(n, len(part)) for n in range(len(group)) for part in MOMENTS] + [(-1, 0)]
    done, pivots = reduced(vectors, _order(members, group, len(places) > count), kinds)
    places += [10 * parent + k for k in TEN]
    return {
        places[pivot]: {places[k]: x for k, x in enumerate(row) if x != 0}
        for row, pivot in zip(done, pivots, strict=True)
    }


def _order(members: Sequence[Member], group: Sequence[int], armature: bool) -> list[int]:
    """Columns of a group's parameters, those first that should go: followers, armature, then the leader."""
    leads = [n for n, i in enumerate(group) if members[i].armature is not None]
    order: list[int] = []
    for n in sorted(range(len(group)), key=lambda n: n in leads):
        if armature and n in leads:
            order.append(10 * len(group))
        order += [10 * n + MOMENTS.index(part) for part in PREFERRED]
    return order


def without(vector: dict[int, Scalar], known: dict[int, dict[int, Scalar]]) -> dict[int, Scalar]:
    """A relation in which the parameters of relations farther in do not appear."""
    found = dict(vector)
    for place in vector:
        if place in known:
            factor = found.pop(place)
            for other, x in known[place].items():
                if other != place:
                    found[other] = found.get(other, 0) - factor * x
    return {place: x for place, x in found.items() if x != 0}


# ---- moments and functions of them: m, b and S (xx, xy, xz, yy, yz, zz)


def _moments(x: Row) -> Moments:
    m, bx, by, bz, *second = x
    return Moments(m, (bx, by, bz), tuple(second))


def carrying(placement: Placement) -> list[Row]:
    """The matrix that takes moments from a frame to the one it is placed in, by columns."""
    rotation = Rotation((Full(placement.rotation),))
    columns = []
    for k in TEN:
        moved = carried(_moments([int(n == k) for n in TEN]), rotation, placement.at)
        columns.append([moved.mass, *moved.first, *moved.second])
    return columns


def changing(twist: Twist) -> list[Row]:
    """D: the change of moments that a motion makes, by columns."""
    columns = []
    for k in TEN:
        m, first, second = _parts([int(n == k) for n in TEN])
        moved = add(cross(twist.w, first), scale(m, twist.u))
        turned = [cross(twist.w, column) for column in second]
        entries = []
        for i, j in PAIRS:
            spread = twist.u[i] * first[j] + first[i] * twist.u[j]
            entries.append(turned[j][i] + turned[i][j] + spread)
        columns.append([0, *moved, *entries])
    return columns


def _parts(x: Row) -> tuple[Scalar, Vector, Matrix]:
    """M, b and S as a matrix."""
    m, bx, by, bz, xx, xy, xz, yy, yz, zz = x
    return m, (bx, by, bz), ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))


def _times(columns: Sequence[Row], x: Row) -> Row:
    total: Row = [0] * 10
    for column, factor in zip(columns, x, strict=True):
        if factor != 0:
            total = [a + factor * b for a, b in zip(total, column, strict=True)]
    return total


def _pulled(row: Row, columns: Sequence[Row]) -> Row:
    """A function of moments, of moments that are changed first."""
    return [_sum(a * b for a, b in zip(row, column, strict=True)) for column in columns]


def _sum(parts: Any) -> Scalar:
    total: Scalar = 0
    for part in parts:
        total = total + part
    return total


def _kinetic(a: Twist, b: Twist) -> Row:
    """T_ab, a function of moments: ∫ (w_a x r + u_a) . (w_b x r + u_b) dm."""
    first = subtract(ZERO, add(cross(a.w, b.u), cross(b.w, a.u)))
    both = dot(a.w, b.w)
    second = [
        both - a.w[i] * b.w[i] if i == j else -(a.w[i] * b.w[j] + a.w[j] * b.w[i]) for i, j in PAIRS
    ]
    return [dot(a.u, b.u), *first, *second]


def _weight(gravity: Vector) -> Row:
    """The potential energy of weight, up to sign."""
    return [0, *gravity, 0, 0, 0, 0, 0, 0]


def _bracket(a: Twist, row: Row) -> Row:
    """How a velocity changes, seen from a frame that moves."""
    w, u = _twist(row)
    return [*cross(a.w, w), *add(cross(a.w, u), cross(a.u, w))]


def _twist(row: Row) -> Twist:
    return Twist((row[0], row[1], row[2]), (row[3], row[4], row[5]))


def _standard(x: Row) -> Row:
    """Moments as ten standard parameters: m, b and J (xx, xy, yy, xz, yz, zz)."""
    m, bx, by, bz, xx, xy, xz, yy, yz, zz = x
    return [m, bx, by, bz, yy + zz, -xy, xx + zz, -xz, -yz, xx + yy]
