"""Forward dynamics without a mass matrix: articulated inertias, in a number of operations linear in n.

H with a factorisation inside: on the way from the leaves to the root each joint's freedom is eliminated
from what is passed on, so the parent sees only the inertia that cannot give way (Featherstone 1983).
Seen from a link's origin, forces follow from accelerations by

    n = A α + B a + n0        f = B^T α + C a + f0
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph import vector
from linegraph.factorization import Solution
from linegraph.orthogonality import Arm, bias_accelerations, bias_force, caption, set_label
from linegraph.vector import Matrix, Scalar, Vector, add, cross, dot, subtract

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.algebra import Algebra
    from linegraph.joints import Moments
    from linegraph.kinematics import KinematicTree
    from linegraph.rotation import Inertia, Rotation

Wrench = tuple[Vector, Vector]
"""(torque about the origin, force)"""


class Articulated(NamedTuple):
    """The 6 x 6 symmetric map from (α, a) to (n, f): blocks A, B (not symmetric), C."""

    a: Inertia
    b: Matrix
    c: Inertia

    def apply(self, angular: Vector, linear: Vector) -> Wrench:
        """(n, f) of accelerations (α, a)."""
        b = self.b
        torque = add(_symmetric(self.a, angular), vector.times(b, linear))
        force = add(vector.times(vector.transpose(b), angular), _symmetric(self.c, linear))
        return torque, force

    def without(self, torque: Vector, force: Vector, inverse: Scalar) -> Articulated:
        """Less the part that one freedom yields: ``I - U U^T / D`` with U = (torque, force)."""
        n = vector.scale(inverse, torque)
        f = vector.scale(inverse, force)
        b = tuple(subtract(self.b[i], vector.scale(n[i], force)) for i in range(3))
        return Articulated(
            _less(self.a, n, torque),
            b,  # type: ignore[arg-type]
            _less(self.c, f, force),
        )

    def carried(self, rotation: Rotation, at: Vector) -> Articulated:
        """Seen from an outer origin and in outer axes."""
        a, c = rotation.congruence(self.a), rotation.congruence(self.c)
        rows = tuple(rotation.out(row) for row in self.b)
        b = vector.transpose(
            tuple(rotation.out(column) for column in vector.transpose(rows))  # type: ignore[arg-type]
        )
        outer = _plus(b, _crossed(at, _square(c)))
        # A' = A + [r] B^T - B' [r], the last by rows: (x B'[r])_i = B'_i x r
        moved = _plus(_square(a), _crossed(at, vector.transpose(b)))
        full = tuple(subtract(moved[i], cross(outer[i], at)) for i in range(3))
        return Articulated(_upper(full), outer, c)  # type: ignore[arg-type]

    def joined(self, other: Articulated) -> Articulated:
        """Two maps added."""
        a = tuple(x + y for x, y in zip(self.a, other.a, strict=True))
        c = tuple(x + y for x, y in zip(self.c, other.c, strict=True))
        return Articulated(a, _plus(self.b, other.b), c)


def rigid(moments: Moments) -> Articulated:
    """The map of a single rigid body: n = J α + b x a, f = α x b + m a."""
    m, (x, y, z), _ = moments
    return Articulated(moments.inertia, ((0, -z, y), (z, 0, -x), (-y, x, 0)), (m, 0, 0, m, 0, m))


def forward_dynamics(
    tree: KinematicTree,
    algebra: Algebra,
    crossed: Sequence[Arm],
    efforts: Sequence[Scalar],
    armatures: Mapping[int, Scalar] | None = None,
) -> Solution:
    """v̇ for the generalised forces `efforts` along v; joints must not be coupled.

    `armatures` are what moves with a velocity alone, as a rotor behind its gear does: they add to its pivot.
    """
    size = len(tree.velocities)
    beside = armatures or {}
    pivots: list[Scalar] = [0] * size
    inverse: list[Scalar] = [0] * size
    net: list[Scalar] = [0] * size
    spins, extra = bias_accelerations(tree, algebra, list(crossed))
    maps = [rigid(arm.moments) for arm in crossed]
    wrenches = [bias_force(arm.moments, spin) for arm, spin in zip(crossed, spins, strict=True)]
    responses: list[list[Wrench]] = [[] for _ in tree.links]
    for i in reversed(range(len(tree.links))):
        link, arm = tree.links[i], crossed[i]
        set_label(algebra, f"articulated inertia, {caption(link)}")
        body, (torque, force) = maps[i], wrenches[i]
        given = body.apply(*extra[i])
        torque, force = add(torque, given[0]), add(force, given[1])
        for a, freedom in enumerate(link.velocities):
            s, u = arm.motion.angular[a], arm.motion.linear[a]
            k = freedom.index
            n, f = body.apply(s, u)
            pivots[k] = dot(s, n) + dot(u, f) + beside.get(k, 0)
            inverse[k] = 1 / pivots[k]
            net[k] = (efforts[k] - (dot(s, torque) + dot(u, force))) * inverse[k]
            body = body.without(n, f, inverse[k])
            torque = add(torque, vector.scale(net[k], n))
            force = add(force, vector.scale(net[k], f))
            responses[i].append((n, f))
        if link.parent >= 0:
            force = arm.rotation.out(force)
            torque = add(arm.rotation.out(torque), cross(arm.at, force))
            p = link.parent
            maps[p] = maps[p].joined(body.carried(arm.rotation, arm.at))
            wrenches[p] = (add(wrenches[p][0], torque), add(wrenches[p][1], force))
    return Solution(_accelerations(tree, algebra, crossed, extra, responses, inverse, net), pivots)


def _accelerations(
    tree: KinematicTree,
    algebra: Algebra,
    crossed: Sequence[Arm],
    extra: list[tuple[Vector, Vector]],
    responses: list[list[Wrench]],
    inverse: list[Scalar],
    net: list[Scalar],
) -> list[Scalar]:
    """From the root to the leaves: each freedom answers the acceleration that reaches it."""
    result: list[Scalar] = [0] * len(tree.velocities)
    reached: list[tuple[Vector, Vector]] = []
    for i, link in enumerate(tree.links):
        set_label(algebra, f"accelerations, {caption(link)}")
        arm = crossed[i]
        angular, linear = extra[i]
        if link.parent >= 0:
            outer, origin = reached[link.parent]
            inner = arm.rotation.into(outer)
            incoming = arm.rotation.into(add(origin, cross(outer, arm.at)))
        else:
            inner = incoming = vector.ZERO
        # a freedom eliminated later passes its own acceleration to those before it
        for a in reversed(range(len(link.velocities))):
            k = link.velocities[a].index
            n, f = responses[i][a]
            result[k] = net[k] - inverse[k] * (dot(n, inner) + dot(f, incoming))
            inner = add(inner, vector.scale(result[k], arm.motion.angular[a]))
            incoming = add(incoming, vector.scale(result[k], arm.motion.linear[a]))
        reached.append((add(inner, angular), add(incoming, linear)))
    return result


def _symmetric(j: Inertia, a: Vector) -> Vector:
    return vector.times(_square(j), a)


def _square(j: Inertia) -> Matrix:
    xx, xy, xz, yy, yz, zz = j
    return ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))


def _upper(m: Matrix) -> Inertia:
    return (m[0][0], m[0][1], m[0][2], m[1][1], m[1][2], m[2][2])


def _less(j: Inertia, scaled: Vector, a: Vector) -> Inertia:
    """``J - scaled a^T``, which is symmetric because `scaled` is a multiple of `a`."""
    xx, xy, xz, yy, yz, zz = j
    return (
        xx - scaled[0] * a[0],
        xy - scaled[0] * a[1],
        xz - scaled[0] * a[2],
        yy - scaled[1] * a[1],
        yz - scaled[1] * a[2],
        zz - scaled[2] * a[2],
    )


def _plus(a: Matrix, b: Matrix) -> Matrix:
    return (add(a[0], b[0]), add(a[1], b[1]), add(a[2], b[2]))


def _crossed(r: Vector, m: Matrix) -> Matrix:
    """``[r x] M``, column by column."""
    columns = vector.transpose(m)
    return vector.transpose((cross(r, columns[0]), cross(r, columns[1]), cross(r, columns[2])))
