"""How everything moves, from where it is: positions differentiated along the motion.

Where every link is at q is all that is taken from the derivation. Velocities and accelerations are the
derivatives of that place, by jets: for every unit velocity, and for the velocities of the state. No velocity
or bias of a joint, no frame turned or shortened and no node of the DAG enters.
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
"""An array, and for each entry how large what it is made of is."""


class Moved(NamedTuple):
    """A frame in ground axes, for n velocities.

    Attributes:
        rotation: 3 x 3, to ground axes.
        origin: 3.
        angular, linear: 3 x (n + 1), its angular velocity and its origin's velocity for unit velocities, then
            for those of the state.
        spin, pull: 3, its angular acceleration and its origin's acceleration at v̇ = 0.
    """

    rotation: Array
    origin: Array
    angular: Array
    linear: Array
    spin: Array
    pull: Array


def coordinate_rates(tree: KinematicTree, algebra: Algebra, q: Any, v: Any) -> list[Any]:
    """``q̇ = N(q) v`` by the algebra of quaternions, for scalars or arrays of velocities."""
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
    """A joint's own q̇: a quaternion turns by ``q (ω/2, 0)``, vectors in head axes by ``q (v, 0) q*``."""
    if len(q) > len(v):
        turn, spin = q[-4:], v[-3:]
        half = tuple(x / 2 for x in spin)
        inverse = (*negate(turn[:3]), turn[3])
        ahead = _quaternion(_quaternion(turn, (*v[:-3], 0)), inverse)[:3] if len(v) > 3 else ()
        return (*ahead, *_quaternion(turn, (*half, 0)))
    if joint.kind == "planar":
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
    """A model at a state, and how its links move.

    Attributes:
        numeric: the model in numbers, at a time and for inputs.
        q, v: the state.
    """

    numeric: Numeric
    q: Sequence[float]
    v: Sequence[float]

    @property
    def tree(self) -> KinematicTree:
        """What the coordinates are, and where they put the links."""
        return self.numeric.tree

    @cached_property
    def np(self) -> Any:
        """NumPy, loaded when it is needed."""
        import numpy

        return numpy

    @cached_property
    def number(self) -> Any:
        """What it calculates with: float, or complex where it is a little beside a state (`steps`)."""
        return complex if isinstance(self.numeric.algebra, Complexes) else float

    @cached_property
    def _directions(self) -> Array:
        """The velocities by direction, n x (n + 1): each one alone, then the state's."""
        own = self.np.array([self.v], self.number).T
        return self.np.hstack([self.np.eye(len(self.v)), own])

    @cached_property
    def rates(self) -> Valued:
        """``N v``."""
        np = self.np
        by_direction = self.rates_by_direction
        return by_direction[:, -1], np.abs(by_direction[:, :-1]) @ np.abs(self.v)

    @cached_property
    def rates_by_direction(self) -> Array:
        """``N``, a column for each velocity, then ``N v``."""
        np, size = self.np, len(self.v) + 1
        found = coordinate_rates(self.tree, self.numeric.algebra, self.q, list(self._directions))
        rows = [np.broadcast_to(np.asarray(x, self.number), size) for x in found]
        return np.array(rows).reshape(len(self.q), size)

    @cached_property
    def _coordinates(self) -> tuple[Jet, ...]:
        """The coordinates as they move in each direction; second derivatives are right for the last one."""
        rates = self.rates_by_direction
        number, jets = self.number, Jets(self.numeric.algebra)
        pairs = zip(self.q, rates[:, -1], strict=True)
        moving = [Jet(number(x), number(dx), 0.0) for x, dx in pairs]
        second = coordinate_rates(self.tree, jets, moving, list(map(number, self.v)))
        return tuple(
            Jet(number(x), dx, lifted(change).dx)
            for x, dx, change in zip(self.q, rates, second, strict=True)
        )

    def along(self, joint: str) -> tuple[Array, float]:
        """The rate of a joint's one coordinate, by direction, and its second derivative at v̇ = 0."""
        place = self.tree.layout.own(joint)
        assert place is not None
        (at,), _ = coordinates(place, self._coordinates, (0.0,) * len(self.v))
        _, rate, second = self.parts([at])
        return rate[0], float(second[0, -1])

    def given(self, x: Jet) -> Jet:
        """What moves as prescribed: not at all where one velocity is looked at alone."""
        alone = self.np.zeros(len(self.v) + 1, self.number)
        alone[-1] = x.dx
        return Jet(x.x, alone, x.ddx)

    @cached_property
    def links(self) -> list[Pose]:
        """Where the links are, as jets."""
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
            whole = rotation if link.in_space else product(near.rotation, rotation)
            found.append(Pose(whole, add(near.origin, times(near.rotation, shift))))
        return found

    def at(self, links: Sequence[Pose], link: int, at: Any, rotation: Any) -> Pose:
        """A place on a link, -1 for ground."""
        near = links[link] if link >= 0 else Pose(IDENTITY_MATRIX, ZERO)
        origin = add(near.origin, times(near.rotation, at))
        return Pose(product(near.rotation, rotation), origin)

    def moved(self, link: int, at: Any = ZERO, rotation: Any = IDENTITY_MATRIX) -> Moved:
        """How a place on a link moves: the derivatives of where it is."""
        np, number = self.np, self.number
        arm, axes = np.array(at, number), np.array(rotation, number)
        turns, shifts = self._places[link]
        turn, turning, bending = (np.einsum("ijd,jk->ikd", x, axes) for x in turns)
        origin, going, pull = (
            x + np.einsum("ijd,j->id", y, arm) for x, y in zip(shifts, turns, strict=True)
        )
        turn = turn[:, :, 0]
        # Ω = Ṙ Rᵀ, and its derivative along the state's own motion
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
        """Values, first and second derivatives of jets, by direction."""
        np, size = self.np, len(self.v) + 1
        x, dx, ddx = (np.empty((len(entries), size), self.number) for _ in range(3))
        for k, entry in enumerate(entries):
            jet = lifted(entry)
            x[k], dx[k], ddx[k] = jet.x, jet.dx, jet.ddx
        return x, dx, ddx

    def _axial(self, skew: Array) -> Array:
        """The vector of a skew-symmetric matrix."""
        half = (skew - self.np.swapaxes(skew, 0, 1)) / 2
        return self.np.array([half[2, 1], half[0, 2], half[1, 0]])
