"""Forward dynamics without a mass matrix: articulated inertias, with a cost linear in n.

This is H with a factorisation inside: on the way from the leaves to the root each joint's freedom is
eliminated from the inertia that is passed on, so the parent carries only the part that cannot give way
[Featherstone 2008, sec. 7.3]. About a link's origin the articulated inertia relates forces to
accelerations by

    n = A α + B a + n0        f = Bᵀ α + C a + f0

with the accelerations (α, a) that v̇ causes; the inertia forces at v̇ = 0, gravity included, are in
(n0, f0). Whether this or a factored mass matrix takes fewer operations depends on the tree, so
`programs.register` counts both.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.algebra.factorization import Solution
from linegraph.algebra.protocol import set_label
from linegraph.dynamics.orthogonality import applied_to, gathered
from linegraph.kinematics.accelerations import inertia_forces, together
from linegraph.spatial import vector
from linegraph.spatial.rotation import square
from linegraph.spatial.vector import ZERO, Matrix, Vector, add, cross, dot, subtract

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.accelerations import Wrench
    from linegraph.kinematics.arms import Arm
    from linegraph.kinematics.tree_state import TreeState
    from linegraph.spatial.inertia import Moments
    from linegraph.spatial.rotation import Inertia, Rotation


class Articulated(NamedTuple):
    """Articulated inertia: the symmetric 6 x 6 map from (α, a) to (n, f), about a link's origin.

    Attributes:
        a: rotational block A, symmetric (kg m²).
        b: coupling block B, not symmetric (kg m).
        c: translational block C, symmetric (kg); not m times the unit matrix once a freedom is
            eliminated.
    """

    a: Inertia
    b: Matrix
    c: Inertia

    def apply(self, angular: Vector, linear: Vector) -> tuple[Vector, Vector]:
        """Torque and force for given accelerations: ``n = A α + B a``, ``f = Bᵀ α + C a``.

        Args:
            angular: α (rad/s²).
            linear: a, of the origin (m/s²).

        Returns:
            Torque about the origin (N m) and force (N), in this order.
        """
        b = self.b
        torque = add(applied_to(self.a, angular), vector.times(b, linear))
        force = add(vector.times(vector.transpose(b), angular), applied_to(self.c, linear))
        return torque, force

    def without(self, freed: Freed) -> Articulated:
        """The rest after one freedom has been eliminated: ``I - U Uᵀ / D`` with U = (torque, force).

        Applied to a motion along that freedom, the rest gives exactly zero.
        """
        (torque, force), inverse = freed.response, freed.inverse
        n = vector.scale(inverse, torque)
        f = vector.scale(inverse, force)
        b = tuple(subtract(self.b[i], vector.scale(n[i], force)) for i in range(3))
        rest = Articulated(_less(self.a, n, torque), b, _less(self.c, f, force))  # type: ignore[arg-type]
        return rest if freed.along is None else rest.free_along(*freed.along)

    def free_along(self, turn: int | None, shift: int | None) -> Articulated:
        """The map with exact zeros along a coordinate axis that is free.

        Subtraction would leave rounding there, and non-zero nodes in the DAG.

        Args:
            turn: axis (0, 1, 2) that the joint turns about; None if it does not turn.
            shift: axis that it slides along; None if it does not slide.
        """
        a, b, c = square(self.a), self.b, square(self.c)
        if turn is not None:
            a, b = _cleared(a, turn, rows=True, columns=True), _cleared(b, turn, rows=True)
        if shift is not None:
            c, b = _cleared(c, shift, rows=True, columns=True), _cleared(b, shift, columns=True)
        return Articulated(_upper(a), b, _upper(c))

    def turned(self, rotation: Rotation) -> Articulated:
        """The map in the axes of the parent."""
        return Articulated(
            rotation.congruence(self.a), rotation.similarity(self.b), rotation.congruence(self.c)
        )

    def shifted(self, at: Vector) -> Articulated:
        """The map about the parent's origin, `at` being the vector from there to this one (m)."""
        outer = _plus(self.b, _crossed(at, square(self.c)))
        # A' = A + [r] B^T - B' [r], the last by rows: (x B'[r])_i = B'_i x r
        moved = _plus(square(self.a), _crossed(at, vector.transpose(self.b)))
        full = tuple(subtract(moved[i], cross(outer[i], at)) for i in range(3))
        return Articulated(_upper(full), outer, self.c)  # type: ignore[arg-type]

    def joined(self, other: Articulated) -> Articulated:
        """The sum of two maps about the same origin and in the same axes."""
        a = tuple(x + y for x, y in zip(self.a, other.a, strict=True))
        c = tuple(x + y for x, y in zip(self.c, other.c, strict=True))
        return Articulated(a, _plus(self.b, other.b), c)


def rigid(moments: Moments) -> Articulated:
    """The map of a single rigid body about its origin: n = J α + b x a, f = α x b + m a."""
    m, (x, y, z), *_ = moments
    return Articulated(moments.inertia, ((0, -z, y), (z, 0, -x), (-y, x, 0)), (m, 0, 0, m, 0, m))


class Freed(NamedTuple):
    """One freedom of a joint after its elimination.

    Attributes:
        response: torque (N m) and force (N) for its unit acceleration, in this order.
        inverse: of the pivot D = sᵀ I s, plus an armature if there is one.
        net: its effort less the bias force along it, divided by the pivot (rad/s² or m/s²).
        along: the coordinate axes that it turns about and slides along, if the freedom is one such axis
            and has no armature; these entries then become exact zeros.
    """

    response: tuple[Vector, Vector]
    inverse: Scalar
    net: Scalar
    along: tuple[int | None, int | None] | None


def forward_dynamics(
    state: TreeState,
    efforts: Sequence[Scalar],
    armatures: Mapping[int, Scalar] | None = None,
) -> Solution:
    """Accelerations v̇ of a tree for given generalised forces, by articulated inertias.

    Args:
        state: the tree at (q, v); no two joints may share a velocity, and no orientation may be
            measured from ground.
        efforts: generalised forces along v (N m or N).
        armatures: inertia that moves with one velocity alone, such as a rotor behind its gear, by
            velocity; it is added to the pivot (kg m² or kg).

    Returns:
        v̇, and the pivots, which are positive if M is positive definite.
    """
    tree, arms = state.tree, state.arms
    pivots: list[Scalar] = [0] * len(tree.velocities)
    maps = [rigid(arm.moments) for arm in arms]
    wrenches = inertia_forces(state)
    freed: list[list[Freed]] = [[] for _ in tree.links]
    for i in reversed(range(len(tree.links))):
        link, arm = tree.links[i], arms[i]
        set_label(state.algebra, f"articulated inertia, {link.caption}")
        body, wrench = maps[i], wrenches[i]
        for a, freedom in enumerate(link.velocities):
            k = freedom.index
            beside = (armatures or {}).get(k, 0)
            pivots[k], found = _free(body, wrench, arm, a, efforts[k], beside)
            wrench = _passed_on(wrench, found, arm, a, efforts[k])
            body = body.without(found)
            freed[i].append(found)
        if link.parent >= 0:
            p = link.parent
            maps[p] = maps[p].joined(body.turned(arm.rotation).shifted(arm.at))
            wrenches[p] = together(wrenches[p], gathered(arm, *wrench))
    return Solution(_accelerations(state, freed), pivots)


def _free(
    body: Articulated, wrench: Wrench, arm: Arm, a: int, effort: Scalar, beside: Scalar
) -> tuple[Scalar, Freed]:
    """The pivot of a freedom, and the quantities that its elimination needs."""
    s, u = arm.motion.angular[a], arm.motion.linear[a]
    force, torque = wrench
    n, f = body.apply(s, u)
    pivot = dot(s, n) + dot(u, f) + beside
    inverse = 1 / pivot
    net = (effort - (dot(s, torque) + dot(u, force))) * inverse
    axes = [x != 0 for x in (*s, *u)]
    along = None
    if sum(axes) == 1 and beside == 0 and all(x in (0, 1, -1) for x in (*s, *u)):
        place = axes.index(True)
        along = (place, None) if place < 3 else (None, place - 3)
    return pivot, Freed((n, f), inverse, net, along)


def _passed_on(wrench: Wrench, freed: Freed, arm: Arm, a: int, effort: Scalar) -> Wrench:
    """Wrench that a link passes on, with a freedom's own acceleration; along the freedom it is the effort."""
    n, f = freed.response
    force = list(add(wrench[0], vector.scale(freed.net, f)))
    torque = list(add(wrench[1], vector.scale(freed.net, n)))
    turn, shift = freed.along or (None, None)
    if turn is not None:
        torque[turn] = arm.motion.angular[a][turn] * effort
    if shift is not None:
        force[shift] = arm.motion.linear[a][shift] * effort
    return (force[0], force[1], force[2]), (torque[0], torque[1], torque[2])


def _accelerations(state: TreeState, freed: list[list[Freed]]) -> list[Scalar]:
    """Accelerations from the root to the leaves, each freedom responding to that of its near link.

    Accelerations that do not depend on v̇ are part of the forces, so ground does not accelerate here.
    """
    tree = state.tree
    result: list[Scalar] = [0] * len(tree.velocities)
    reached: list[tuple[Vector, Vector]] = []
    for i, link in enumerate(tree.links):
        set_label(state.algebra, f"accelerations, {link.caption}")
        arm = state.arms[i]
        inner = incoming = ZERO
        if link.parent >= 0:
            outer, origin = reached[link.parent]
            inner = arm.rotation.into(outer)
            incoming = arm.rotation.into(add(origin, cross(outer, arm.at)))
        # elimination in reverse: the freedom eliminated last accelerates first, and moves those before it
        for a in reversed(range(len(link.velocities))):
            k, (response, inverse, net, _) = link.velocities[a].index, freed[i][a]
            n, f = response
            result[k] = net - inverse * (dot(n, inner) + dot(f, incoming))
            inner = add(inner, vector.scale(result[k], arm.motion.angular[a]))
            incoming = add(incoming, vector.scale(result[k], arm.motion.linear[a]))
        reached.append((inner, incoming))
    return result


def _cleared(m: Matrix, k: int, *, rows: bool = False, columns: bool = False) -> Matrix:
    """A matrix with zeros in row or column k."""
    x, y, z = (
        tuple(0 if (rows and i == k) or (columns and j == k) else m[i][j] for j in range(3))
        for i in range(3)
    )
    return (x, y, z)  # type: ignore[return-value]


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
