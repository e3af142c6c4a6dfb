"""The regressor: what a unit of each of a link's ten moments asks of every joint.

Inverse dynamics is linear in the moments about a point of the link. By orthogonality the share of a link's
wrench along a velocity is its product with the motion that this velocity gives the link: with (s, k) the
angular velocity of the link and the velocity of its origin for a unit of the velocity, and ω, ε, a those of
the actual motion, a less gravity,

    k . f + s . n        f = m a + U b        n = b x a + J ε + ω x J ω        U = [ε x] + [ω x][ω x]

is linear in m, b and J, with the coefficients

    m:  k . a            b:  U^T k + a x s            J:  s^T N(ω, ε)

so that not ten wrenches are carried inward for each link but one motion outward for each velocity, and the
entries of N are those of U and differences of squares of ω. Wrenches are better where joints of many
freedoms stand far inward, as under a floating base: their projections there are free. Both are here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.algebra.protocol import set_label
from linegraph.dynamics.orthogonality import gathered, projection
from linegraph.kinematics.accelerations import Spin, accelerated, spins
from linegraph.spatial import vector
from linegraph.spatial.rotation import IDENTITY_MATRIX, Rotation, rotation_of
from linegraph.spatial.vector import ZERO, Vector, add, cross, dot

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.arms import Arm
    from linegraph.kinematics.tree_state import TreeState
    from linegraph.spatial.placement import Placement

Columns = dict[int, list["Scalar"]]
"""Of a link, by velocity, the coefficients of its ten moments."""


class Station(NamedTuple):
    """Where the moments of a link are told.

    Attributes:
        link: its index in the tree.
        pose: the frame they are told in, in the link's own axes.
    """

    link: int
    pose: Placement


def by_motions(
    state: TreeState, stations: Sequence[Station], acceleration: Sequence[Scalar]
) -> list[Columns]:
    """Of each station the coefficients of m, b and J (xx, xy, yy, xz, yz, zz) along each velocity.

    Args:
        state: the links and where they are.
        stations: of each link in question the frame its moments are told in.
        acceleration: v̇.
    """
    motions = spins(state, acceleration)
    screws = _screws(state)
    found = []
    for station in stations:
        set_label(state.algebra, f"parameters of {state.tree.links[station.link].name}")
        rotation, at = _seat(state.arms, station)
        into, table = rotation.into, _table(motions[station.link], rotation, at)
        found.append(
            {
                k: table.along(into(s), into(add(u, cross(s, at))))
                for k, (s, u) in screws[station.link].items()
            }
        )
    return found


def by_wrenches(
    state: TreeState, stations: Sequence[Station], acceleration: Sequence[Scalar]
) -> list[Columns]:
    """The same, the wrench of a unit of each moment carried inward."""
    motions = spins(state, acceleration)
    found = []
    for station in stations:
        set_label(state.algebra, f"parameters of {state.tree.links[station.link].name}")
        rotation, at = _seat(state.arms, station)
        wrenches = []
        for f, n in _table(motions[station.link], rotation, at).wrenches():
            force = rotation.out(f)
            wrenches.append((force, add(rotation.out(n), cross(at, force))))
        columns: Columns = {}
        i = station.link
        while i >= 0:
            link, arm = state.tree.links[i], state.arms[i]
            for a, freedom in enumerate(link.velocities):
                known = columns.setdefault(freedom.index, [0] * len(wrenches))
                for c, wrench in enumerate(wrenches):
                    known[c] = known[c] + freedom.ratio * projection(arm.motion, a, *wrench)
            wrenches = [gathered(arm, *wrench) for wrench in wrenches]
            i = link.parent
        found.append(columns)
    return found


def _seat(arms: Sequence[Arm], station: Station) -> tuple[Rotation, Vector]:
    """A station's axes and origin in the working axes of its link."""
    turn = arms[station.link].turn
    return turn @ rotation_of(station.pose.rotation), turn.out(station.pose.at)


def _table(spin: Spin, rotation: Rotation, at: Vector) -> _Table:
    """How a station moves, and what its moments ask for."""
    into = rotation.into
    linear = into(add(spin.linear, accelerated(spin, at)))
    return _Table(Spin(into(spin.velocity), into(spin.angular), linear))


Screw = tuple[Vector, Vector]
"""The angular velocity of a link and the velocity of its origin."""


def _screws(state: TreeState) -> list[dict[int, Screw]]:
    """How each link moves for a unit of each velocity, in its working frame; those that do not left out."""
    found: list[dict[int, Screw]] = []
    for link, arm in zip(state.tree.links, state.arms, strict=True):
        set_label(state.algebra, f"motion by unit velocities, {link.caption}")
        into = arm.rotation.into
        here: dict[int, Screw] = {}
        for k, (s, u) in (found[link.parent] if link.parent >= 0 else {}).items():
            linear = into(add(u, cross(s, arm.at)))
            here[k] = (ZERO if arm.level else into(s), linear)
        motion = arm.motion
        # where the motion is prescribed there are no velocities
        for freedom, s, u in zip(link.velocities, motion.angular, motion.linear, strict=False):
            own = (vector.scale(freedom.ratio, s), vector.scale(freedom.ratio, u))
            before = here.get(freedom.index, (ZERO, ZERO))
            here[freedom.index] = (add(before[0], own[0]), add(before[1], own[1]))
        found.append({k: x for k, x in here.items() if not all(map(vector.is_zero, x))})
    return found


class _Table:
    """What a unit of each moment asks for, of a link in a given motion."""

    def __init__(self, spin: Spin) -> None:
        x, y, z = spin.velocity
        a, b, c = spin.angular
        xx, yy, zz, xy, xz, yz = x * x, y * y, z * z, x * y, x * z, y * z
        self._linear = spin.linear
        self._field = (
            (-(yy + zz), xy - c, xz + b),
            (xy + c, -(xx + zz), yz - a),
            (xz - b, yz + a, -(xx + yy)),
        )
        self._torques: tuple[Vector, ...] = (
            (a, xz, -xy),
            (b - xz, a + yz, xx - yy),
            (-yz, b, xy),
            (c + xy, zz - xx, a - yz),
            (yy - zz, c - xy, b + xz),
            (yz, -xz, c),
        )

    def along(self, s: Vector, k: Vector) -> list[Scalar]:
        """The ten coefficients along a velocity that moves the link so."""
        columns = vector.transpose(self._field)
        first = add(vector.times(columns, k), cross(self._linear, s))
        return [dot(k, self._linear), *first, *(dot(s, n) for n in self._torques)]

    def wrenches(self) -> list[tuple[Vector, Vector]]:
        """Force and torque about the origin that each of the ten asks for."""
        columns = vector.transpose(self._field)
        first = zip(columns, (cross(e, self._linear) for e in IDENTITY_MATRIX), strict=True)
        return [(self._linear, ZERO), *first, *((ZERO, n) for n in self._torques)]
