"""Motion of all links, by differentiating their positions along the motion.

Only the positions of links at q are taken from the derivation. Velocities and accelerations are derivatives
of these by jets: for each unit velocity, and for the velocities of the state. Joint velocities and bias
accelerations, reduced frames and nodes of the DAG are not used, so errors in these show.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.algebra.jets import Jet, Jets, lifted
from linegraph.components.constraints.base import Pose
from linegraph.kinematics.state_layout import coordinates
from linegraph.spatial.rotation import IDENTITY_MATRIX, product
from linegraph.spatial.vector import ZERO, add, negate, times, transpose
from linegraph.verification.golden.steps import Complexes

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.protocol import Algebra
    from linegraph.components.joints import Joint
    from linegraph.kinematics.links import KinematicTree
    from linegraph.numeric.reference import Numeric

    Array = Any

Valued = tuple[Any, Any]
"""An array, and an array of the same shape with the sizes of its entries.

The size is the magnitude of the terms that an entry is summed from. Rounding errors are proportional to it,
also where the terms cancel and the entry is zero.
"""


class Moved(NamedTuple):
    """Motion of a frame in ground axes, for n velocities.

    Attributes:
        rotation: 3 x 3, from the frame's axes to ground axes.
        origin: 3, position of its origin (m).
        angular, linear: 3 x (n + 1), angular velocity and velocity of its origin for each unit velocity,
            then for those of the state.
        spin, pull: 3, angular acceleration and acceleration of its origin at v̇ = 0.
    """

    rotation: Array
    origin: Array
    angular: Array
    linear: Array
    spin: Array
    pull: Array


def coordinate_rates(tree: KinematicTree, algebra: Algebra, q: Any, v: Any) -> list[Any]:
    """Coordinate rates ``q̇ = N(q) v`` by quaternion algebra.

    Args:
        tree: the links and their coordinates.
        algebra: sine and cosine for the scalars used.
        q: nq coordinates.
        v: n velocities; each may be an array, for many directions at once.

    Returns:
        nq rates, of the type of the velocities.
    """
    rates: list[Any] = [0.0] * len(tree.positions)
    for link in tree.links:
        places = link.place.positions
        if any(f.ratio != 1 or f.offset != 0 for f in places):
            continue  # it follows another joint
        at = tuple(q[f.index] for f in places)
        own = tuple(v[f.index] for f in link.place.velocities)
        for f, rate in zip(places, own_rates(link.joint, algebra, at, own), strict=True):
            rates[f.index] = rate
    return rates


def own_rates(joint: Joint, algebra: Algebra, q: tuple[Any, ...], v: tuple[Any, ...]) -> Any:
    """A joint's own q̇ from its own q and v.

    A quaternion's rate is ``q (ω/2, 0)``, with ω in head axes; a free joint's position changes by ``q (v,
    0) q*``.

    Args:
        joint: the joint type.
        algebra: sine and cosine for the scalars used.
        q: the joint's coordinates; quaternions are (x, y, z, w).
        v: its velocities; linear and angular velocities in head axes.
    """
    if len(q) > len(v):
        turn, spin = q[-4:], v[-3:]
        half = tuple(x / 2 for x in spin)
        inverse = (*negate(turn[:3]), turn[3])
        ahead = _quaternion(_quaternion(turn, (*v[:-3], 0)), inverse)[:3] if len(v) > 3 else ()
        return (*ahead, *_quaternion(turn, (*half, 0)))
    if joint.kind == "planar":
        # Position and angle are in tail axes, but velocities in head axes.
        c, s = algebra.cos(q[2]), algebra.sin(q[2])
        return (c * v[0] - s * v[1], s * v[0] + c * v[1], v[2])
    if joint.kind == "compound":
        found: list[Any] = []
        for part, _ in joint.sequence():
            here = slice(len(found), len(found) + part.freedoms)
            found += own_rates(part, algebra, q[here], v[here])
        return found
    return v


def _quaternion(a: Any, b: Any) -> tuple[Any, ...]:
    """The product of two quaternions (x, y, z, w)."""
    x, y, z, w = a
    i, j, k, r = b
    return (
        w * i + x * r + y * k - z * j,
        w * j + y * r + z * i - x * k,
        w * k + z * r + x * j - y * i,
        w * r - x * i - y * j - z * k,
    )


@dataclass(frozen=True)
class Walk:
    """A model at a state, and the motion of its links there.

    Attributes:
        numeric: the model in numbers, at a time and for inputs.
        q, v: nq coordinates and n velocities.
    """

    numeric: Numeric
    q: Sequence[float]
    v: Sequence[float]

    @property
    def tree(self) -> KinematicTree:
        """The kinematic tree over this algebra."""
        return self.numeric.tree

    @cached_property
    def np(self) -> Any:
        """NumPy, imported when first needed."""
        import numpy

        return numpy

    @cached_property
    def number(self) -> Any:
        """The scalar type: float, or complex for a shifted state (`steps`)."""
        return complex if isinstance(self.numeric.algebra, Complexes) else float

    @cached_property
    def _directions(self) -> Array:
        """Velocities by direction, n x (n + 1): each unit velocity, then the state's."""
        own = self.np.array([self.v], self.number).T
        return self.np.hstack([self.np.eye(len(self.v)), own])

    @cached_property
    def rates(self) -> Valued:
        """q̇ = N v, nq, with sizes ``|N| |v|``."""
        np = self.np
        by_direction = self.rates_by_direction
        return by_direction[:, -1], np.abs(by_direction[:, :-1]) @ np.abs(self.v)

    @cached_property
    def rates_by_direction(self) -> Array:
        """N, nq x n, followed by the column ``N v``."""
        np, size = self.np, len(self.v) + 1
        found = coordinate_rates(self.tree, self.numeric.algebra, self.q, list(self._directions))
        rows = [np.broadcast_to(np.asarray(x, self.number), size) for x in found]
        return np.array(rows).reshape(len(self.q), size)

    @cached_property
    def _coordinates(self) -> tuple[Jet, ...]:
        """Coordinates as jets in each direction; second derivatives are valid for the last direction only."""
        rates = self.rates_by_direction
        number, jets = self.number, Jets(self.numeric.algebra)
        pairs = zip(self.q, rates[:, -1], strict=True)
        moving = [Jet(number(x), number(dx), 0.0) for x, dx in pairs]
        # q̈ at v̇ = 0 is the rate of N(q) v with v held.
        second = coordinate_rates(self.tree, jets, moving, list(map(number, self.v)))
        return tuple(
            Jet(number(x), dx, lifted(change).dx)
            for x, dx, change in zip(self.q, rates, second, strict=True)
        )

    def along(self, joint: str) -> tuple[Array, float]:
        """Rate of a joint's one coordinate by direction (n + 1), and its second derivative at v̇ = 0."""
        place = self.tree.layout.own(joint)
        assert place is not None
        (at,), _ = coordinates(place, self._coordinates, (0.0,) * len(self.v))
        _, rate, second = self.parts([at])
        return rate[0], float(second[0, -1])

    def given(self, x: Jet) -> Jet:
        """A prescribed variable as a jet: at rest in each unit direction, moving only in the state's own."""
        alone = self.np.zeros(len(self.v) + 1, self.number)
        alone[-1] = x.dx
        return Jet(x.x, alone, x.ddx)

    @cached_property
    def links(self) -> list[Pose]:
        """Poses of all links in ground axes, as jets."""
        jets = Jets(self.numeric.algebra)
        found: list[Pose] = []
        for link in self.tree.links:
            if link.place.drive:
                at = tuple(map(self.given, link.place.drive))
            else:
                at, _ = coordinates(link.place, self._coordinates, (0.0,) * len(self.v))
            motion = link.joint.motion(jets, at, (0.0,) * link.joint.freedoms)
            rotation, shift = motion.rotation.matrix(), motion.displacement
            if not link.forward:
                rotation = transpose(rotation)
                shift = negate(times(rotation, shift))
            near = self.at(found, link.parent, link.at, link.rotation.matrix())
            # Absolute angles are measured from ground, not from the link before.
            whole = rotation if link.in_space else product(near.rotation, rotation)
            found.append(Pose(whole, add(near.origin, times(near.rotation, shift))))
        return found

    def at(self, links: Sequence[Pose], link: int, at: Any, rotation: Any) -> Pose:
        """Pose of a place on a link in ground axes.

        Args:
            links: poses of the links so far.
            link: index of the link, -1 for ground.
            at: 3, position in the link's frame (m).
            rotation: 3 x 3, from the place's axes to the link's axes.
        """
        near = links[link] if link >= 0 else Pose(IDENTITY_MATRIX, ZERO)
        origin = add(near.origin, times(near.rotation, at))
        return Pose(product(near.rotation, rotation), origin)

    def moved(self, link: int, at: Any = ZERO, rotation: Any = IDENTITY_MATRIX) -> Moved:
        """Motion of a place on a link: derivatives of its pose, with ``Ω = Ṙ Rᵀ``.

        Args:
            link: index of the link, -1 for ground.
            at: 3, position in the link's frame (m).
            rotation: 3 x 3, from the place's axes to the link's axes.
        """
        np, number = self.np, self.number
        arm, axes = np.array(at, number), np.array(rotation, number)
        turns, shifts = self._places[link]
        turn, turning, bending = (np.einsum("ijd,jk->ikd", x, axes) for x in turns)
        origin, going, pull = (
            x + np.einsum("ijd,j->id", y, arm) for x, y in zip(shifts, turns, strict=True)
        )
        # The position itself is the same in all directions.
        turn = turn[:, :, 0]
        # Ω = Ṙ Rᵀ, and its derivative R̈ Rᵀ + Ṙ Ṙᵀ along the state's own motion.
        omega = np.einsum("ijd,kj->ikd", turning, turn)
        last = turning[:, :, -1]
        alpha = bending[:, :, -1] @ turn.T + last @ last.T
        return Moved(turn, origin[:, 0], self._axial(omega), going, self._axial(alpha), pull[:, -1])

    @cached_property
    def _places(self) -> list[tuple[list[Array], list[Array]]]:
        """Rotation and origin of every link, then of ground, each with its derivatives by direction."""
        found = []
        for pose in [*self.links, Pose(IDENTITY_MATRIX, ZERO)]:
            parts = self.parts([*(x for row in pose.rotation for x in row), *pose.origin])
            found.append(([x[:9].reshape(3, 3, -1) for x in parts], [x[9:] for x in parts]))
        return found

    def parts(self, entries: Sequence[Any]) -> tuple[Array, Array, Array]:
        """Split jets into values, first and second derivatives, each entries x (n + 1)."""
        np, size = self.np, len(self.v) + 1
        x, dx, ddx = (np.empty((len(entries), size), self.number) for _ in range(3))
        for k, entry in enumerate(entries):
            jet = lifted(entry)
            x[k], dx[k], ddx[k] = jet.x, jet.dx, jet.ddx
        return x, dx, ddx

    def _axial(self, skew: Array) -> Array:
        """Return the axial vector of a skew-symmetric matrix, ``ω x r = Ω r``."""
        half = (skew - self.np.swapaxes(skew, 0, 1)) / 2
        return self.np.array([half[2, 1], half[0, 2], half[1, 0]])
