"""Which combinations of standard parameters have no effect: exact, link by link from the leaves to the root.

Moments P of a link, with opposite ones on its parent, leave all equations of motion unchanged if the
energies of both together stay the same at all positions and velocities. Let x -> w x x + u be the velocity
field that the joint's unit velocity gives the link, D the rate at which this motion changes moments, and
f(P) any linear function of moments that occurs in the parent's energies, expressed in the joint's near
frame. Then

    (1)  T_φφ(P) + armature = 0           kinetic energy of the joint's own rate
    (2)  T_φv(P) = 0                      for every velocity v that the parent can have, at every q
    (3)  f(D P) = 0                       for every f, kinetic or of weight, at every q

T_vw is the bilinear kinetic energy. "At every q" is the span closed under the motion of the joint. The
parent's span is found the same way from the root outward: its velocities are those of its own parent and
its joint, its functions f are those of its own parent, T_φv and T_φφ. A leaf must satisfy this by itself,
then the tree without the leaf; so for joints with velocities of their own these are all relations. [Wensing
et al. 2017] finds such undetectable transfers of inertia across joints recursively, too, in numbers.

Joints that follow one another and have the same parent are treated together. Other followers, and joints in
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
"""Row and column of xx, xy, xz, yy, yz, zz."""

PREFERRED = ("m", "mz", "my", "mx", "Iyy", "Ixx", "Izz", "Iyz", "Ixz", "Ixy")
"""Order in which a link's parameters are eliminated.

For a joint about z, m, mz and Iyy can go, as in [Khalil and Dombre 2002]; the others follow for special
geometry.
"""

TEN = range(10)


class Twist(NamedTuple):
    """A velocity field: angular velocity w (rad/s) and velocity u of the origin (m/s)."""

    w: Vector
    u: Vector


class Member(NamedTuple):
    """A link with the geometry that relations depend on.

    Attributes:
        parent: index of the link nearer to ground; -1 for ground.
        near: the joint's near frame in the parent's working frame.
        twists: motions of the link for unit velocities of the joint, from the tail outward.
        indices: indices of these velocities in v; empty where the motion is prescribed.
        ratio: for a joint of one freedom, its rate divided by that entry of v.
        home: the frame of the link's parameters, in its working frame.
        armature: index of the joint's rotor inertia among all parameters; None where it has none.
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
    """Bases of a link's velocities and of the functions of moments that occur in energies.

    Attributes:
        twists: rows of 6, angular then linear.
        functions: rows of 10, coefficients of the moments.
    """

    twists: list[Row]
    functions: list[Row]


def null_vectors(members: Sequence[Member], gravity: Vector) -> dict[int, dict[int, Scalar]]:
    """All relations between standard parameters: changes of them that leave every motion unchanged.

    Args:
        members: the links, parents first.
        gravity: 3, acceleration of free fall in ground axes (m/s^2).

    Returns:
        For the index of each parameter that can be eliminated, the change of all parameters by index. It is
        1 at that parameter and 0 at all others that can be eliminated.
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
    """Relations between a link's parameters and its parent's that hold for any motion of the parent.

    Args:
        members: the links, parents first; only those on joints of one freedom have such relations here.

    Returns:
        For each link, the relations as in `null_vectors`.
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
    """Links to treat together: same parent, joints of one freedom, same entry of v."""
    found: dict[Any, list[int]] = {}
    for i, member in enumerate(members):
        single = len(member.twists) == 1 and member.indices
        key = (member.parent, member.indices) if single else i
        found.setdefault(key, []).append(i)
    return list(found.values())


def _seen(member: Member, spans: Spans | None) -> Spans:
    """The parent's spans, expressed in the joint's near frame."""
    assert spans is not None
    r, at = Full(member.near.rotation), member.near.at
    twists = []
    for row in spans.twists:
        w, u = tuple(row[:3]), tuple(row[3:])
        twists.append([*r.into(w), *r.into(add(u, cross(w, at)))])
    matrix = carrying(member.near)
    functions = [_pulled(row, matrix) for row in spans.functions]
    # Rows keep the parent's order, so that rows of links side by side belong together.
    return Spans(twists, functions)


def _conditions(members: Sequence[Member], near: Sequence[Spans]) -> tuple[list[Row], list[Spans]]:
    """Linear conditions on moments and armature of a group, and the spans of its links."""
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
    """Conditions (1) to (3) for joints that move together, each row followed by the factor of the armature.

    All joints share the parent's motion, so its velocities and functions are placed side by side.
    """
    count = len(twists)
    rows: list[Row] = []
    if free:
        own = [[r * r * x for x in _kinetic(t, t)] for t, r in zip(twists, ratios, strict=True)]
        # A rotor's inertia appears in the kinetic energy of the joint's own rate only.
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
    """Concatenate the rows that each of several links has of the same thing."""
    return [[x for row in rows for x in row] for rows in zip(*parts, strict=True)]


def _beyond(twist: Twist, near: Spans) -> Spans:
    """Spans of a link beyond a joint of one freedom."""
    twists = closed(near.twists, lambda row: _bracket(twist, row))
    functions = closed(near.functions, lambda row: _pulled(row, changing(twist)))
    functions += [_kinetic(twist, _twist(row)) for row in twists]
    functions.append(_kinetic(twist, twist))
    return Spans(reduced([*twists, [*twist.w, *twist.u]])[0], reduced(functions)[0])


def _shares(
    members: Sequence[Member], group: Sequence[int], conditions: list[Row] | None
) -> dict[int, dict[int, Scalar]]:
    """Relations of a group, between its own parameters, armature last, and its parent's.

    Without conditions the group does not move freely, and none of its parameters has an effect.
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
    """Columns of a group's parameters in order of elimination: followers, armature, then the leader."""
    leads = [n for n, i in enumerate(group) if members[i].armature is not None]
    order: list[int] = []
    for n in sorted(range(len(group)), key=lambda n: n in leads):
        if armature and n in leads:
            order.append(10 * len(group))
        order += [10 * n + MOMENTS.index(part) for part in PREFERRED]
    return order


def without(vector: dict[int, Scalar], known: dict[int, dict[int, Scalar]]) -> dict[int, Scalar]:
    """Substitute relations nearer to ground into a relation, to remove parameters eliminated there.

    Args:
        vector: change of parameters by index.
        known: relations nearer to ground, each 1 at its key.

    Returns:
        The equivalent change, zeros left out.
    """
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
    """Matrix that transforms moments from a frame to the frame it is placed in, as ten columns."""
    rotation = Rotation((Full(placement.rotation),))
    columns = []
    for k in TEN:
        moved = carried(_moments([int(n == k) for n in TEN]), rotation, placement.at)
        columns.append([moved.mass, *moved.first, *moved.second])
    return columns


def changing(twist: Twist) -> list[Row]:
    """D: rate of change of moments under a velocity field, as ten columns."""
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
    """Split ten moments into m, b and S, the matrix of second moments."""
    m, bx, by, bz, xx, xy, xz, yy, yz, zz = x
    return m, (bx, by, bz), ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))


def _times(columns: Sequence[Row], x: Row) -> Row:
    total: Row = [0] * 10
    for column, factor in zip(columns, x, strict=True):
        if factor != 0:
            total = [a + factor * b for a, b in zip(total, column, strict=True)]
    return total


def _pulled(row: Row, columns: Sequence[Row]) -> Row:
    """Coefficients of a function of moments after a linear change of the moments."""
    return [_sum(a * b for a, b in zip(row, column, strict=True)) for column in columns]


def _sum(parts: Any) -> Scalar:
    total: Scalar = 0
    for part in parts:
        total = total + part
    return total


def _kinetic(a: Twist, b: Twist) -> Row:
    """T_ab as coefficients of moments: ∫ (w_a x r + u_a) . (w_b x r + u_b) dm."""
    first = subtract(ZERO, add(cross(a.w, b.u), cross(b.w, a.u)))
    both = dot(a.w, b.w)
    second = [
        both - a.w[i] * b.w[i] if i == j else -(a.w[i] * b.w[j] + a.w[j] * b.w[i]) for i, j in PAIRS
    ]
    return [dot(a.u, b.u), *first, *second]


def _weight(gravity: Vector) -> Row:
    """Potential energy of weight as coefficients of moments, up to its sign."""
    return [0, *gravity, 0, 0, 0, 0, 0, 0]


def _bracket(a: Twist, row: Row) -> Row:
    """Lie bracket of two velocity fields: change of one as seen from a frame that moves with the other."""
    w, u = _twist(row)
    return [*cross(a.w, w), *add(cross(a.w, u), cross(a.u, w))]


def _twist(row: Row) -> Twist:
    return Twist((row[0], row[1], row[2]), (row[3], row[4], row[5]))


def _standard(x: Row) -> Row:
    """Convert m, b and S to the ten standard parameters m, b and J (xx, xy, yy, xz, yz, zz)."""
    m, bx, by, bz, xx, xy, xz, yy, yz, zz = x
    return [m, bx, by, bz, yy + zz, -xy, xx + zz, -xz, -yz, xx + yy]
