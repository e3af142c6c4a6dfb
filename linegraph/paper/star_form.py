"""The paper's equations (12)-(15) on its star tree, as printed but for corrections.

`star_tree` describes the tree. Three things are corrected in the print [Boiadzhiev and Lilov 1993]: P*, which
is not defined there, Z_1, and B, in which terms of translational joints are missing. Vectors are in ground
axes.
"""

from __future__ import annotations

from dataclasses import fields
from functools import reduce
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.errors import ModelError
from linegraph.paper.joint_form import (
    Resolved,
    angular_remainder,
    arm_vectors,
    head_remainder,
    linear_remainder,
    resolved,
    turned,
)
from linegraph.paper.star_tree import (
    NO_TENSOR,
    Column,
    Integers,
    PrintedMatrices,
    Rows,
    StarTree,
)
from linegraph.spatial import vector
from linegraph.spatial.rotation import Full
from linegraph.spatial.vector import ZERO, Matrix, Vector, add, cross, dot, negate, scale

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.applied_forces import Applied
    from linegraph.kinematics.links import KinematicTree
    from linegraph.kinematics.tree_state import TreeState


def printed_matrices(state: TreeState, applied: Applied | None = None) -> PrintedMatrices:
    """The star tree at a state and its equations (12)-(15).

    Args:
        state: of a tree on one basement, which is ground and all that only prescribed joints connect to it.
        applied: forces and torques on the links besides weight, and efforts in the joints; None for none.

    Raises:
        ModelError: not exactly one body is on the basement, or a link without mass has a first moment.
    """
    return equations(_star_tree(state, applied))


def equations(star: StarTree) -> PrintedMatrices:
    """The equations (13)-(15), A v̇ = B, term by term as printed but for the corrections.

    With Λ = S H P* x diag X + K,

        A   = (S H) I (S H)^T + Λ H m H^T Λ^T                                               (13), (15)
        B   = S [B_1 + Z_1 + H P* x diag X Z_2 - H I H^T W] + S Y_c^r + K Y_c^t
              + (S H P* x diag X) H m H^T [diag X x (H P*)^T W]
              + K [B_3 + H E Y_E^t + Z_2 + H m H^T (diag X x (H P*)^T W)]                         (14)
        B_1 = H P* x diag X (B_3 + H E Y_E^t) + H I H^T 1 Ẋ_1^r + B_2
        B_2 = H E Y_E^r - H [ω x I] H^T (X_c^r - 1 X_1^r)
        B_3 = H m H^T [1 Ẍ_1^t - diag X x (H P*)^T 1 Ẋ_1^r - w x (w x X) - 2 w x K^T q̇ - W^t]
        Z_1 = -H I H^T V                    printed as H P* x diag X Z_2, which (14) has already
        Z_2 = -H m H^T (H P* x diag X)^T V

    Here w = (H P*)^T (X_c^r - 1 X_1^r) is the angular velocity of each tail and W^t is `W_slide`. The last
    two terms of B_3 are not in print; with Z_1 as printed, S H I H^T V would be missing and the term in m
    would count twice.
    """
    h = Operators(star)
    rest = zeros(len(star.chords) - 1)
    given, start = [star.X_1_r_dot, *rest], [star.X_1_ddot, *rest]
    spin = summed(star.X_r, [negate(star.X_1_r), *rest])
    w = h.tail(spin)
    v = each(cross, w, star.X_r)
    z_1, z_2 = negated(h.inertia(v)), negated(h.mass(h.swept(v)))
    whirl = each(cross, w, each(cross, w, star.X))
    coriolis = [scale(2, x) for x in each(cross, w, star.X_slide)]
    known = (negated(x) for x in (whirl, coriolis, star.W_slide))
    # - diag X x (H P*)^T is the transpose of H P* x diag X
    b_3 = h.mass(summed(start, h.swept(given), *known))
    pull = h.gathered(star.Y_t)
    omega = h.spread(spin)
    gyroscopic = each(cross, omega, each(vector.times, star.I, omega))
    b_2 = summed(h.gathered(star.Y_r), negated(h.gathered(gyroscopic)))
    b_1 = summed(h.moment(summed(b_3, pull)), h.inertia(given), b_2)
    bent = negated(h.mass(h.swept(star.W)))
    turning = summed(b_1, z_1, h.moment(z_2), negated(h.inertia(star.W)), h.moment(bent))
    sliding = summed(b_3, pull, z_2, bent)
    b = [
        projected(s, turning) + projected(k, sliding) + effort
        for s, k, effort in zip(star.S, star.K, star.Y_c, strict=True)
    ]
    own = {field.name: getattr(star, field.name) for field in fields(StarTree)}
    return PrintedMatrices(
        **own, V=v, Z_1=z_1, Z_2=z_2, B_1=b_1, B_2=b_2, B_3=b_3, A=_square_form(star, h), B=b
    )


def _square_form(star: StarTree, h: Operators) -> list[list[Scalar]]:
    """A of (13) and (15), entry by entry."""
    turned_by = [h.spread(row) for row in star.S]
    moved_by = [summed(h.swept(s), k) for s, k in zip(star.S, star.K, strict=True)]
    turning = [each(vector.times, star.I, row) for row in turned_by]
    moving = [h.mass(row) for row in moved_by]
    n = range(len(star.S))
    return [
        [projected(turned_by[i], turning[j]) + projected(moved_by[i], moving[j]) for j in n]
        for i in n
    ]


class Operators:
    """The products of matrices in (13)-(15), applied to columns with one vector for each edge."""

    def __init__(self, star: StarTree) -> None:
        """Prepare H^T and H P*, both of integers."""
        self._star = star
        self._back = transposed(star.H)
        columns = transposed(star.P_star)
        self._tails = [
            [sum(x * y for x, y in zip(row, column, strict=True)) for column in columns]
            for row in star.H
        ]
        self._tails_back = transposed(self._tails)

    def gathered(self, x: Column) -> Column:
        """``H x``: sums of a quantity of branches, for each chord over all that it carries."""
        return _product(self._star.H, x)

    def spread(self, x: Column) -> Column:
        """``H^T x``: sums of a quantity of chords, for each branch along the path to its end."""
        return _product(self._back, x)

    def mass(self, x: Column) -> Column:
        """``H m H^T x``: inertia forces of accelerations x of chords, summed towards the root."""
        return self.gathered(each(scale, self._star.m, self.spread(x)))

    def inertia(self, x: Column) -> Column:
        """``H I H^T x``: torques of angular accelerations x of chords, summed towards the root."""
        return self.gathered(each(vector.times, self._star.I, self.spread(x)))

    def tail(self, x: Column) -> Column:
        """``(H P*)^T x``: an angular quantity of the tail of each chord."""
        return _product(self._tails_back, x)

    def moment(self, x: Column) -> Column:
        """``H P* x diag X x``: torques of forces at the heads of the arms, summed towards the root."""
        return _product(self._tails, each(cross, self._star.X, x))

    def swept(self, x: Column) -> Column:
        """``(H P* x diag X)^T x``: how the heads of arms move that turn with their tails."""
        return each(cross, self.tail(x), self._star.X)


def _star_tree(state: TreeState, applied: Applied | None) -> StarTree:
    """The edges of the star tree, (1)-(5), with their terminal and connecting equations, (6)-(7)."""
    tree = state.tree
    links, parents = _bodies(tree)
    bodies = resolved(state)
    c = arm_vectors(state, bodies)
    ends, chords = ["C_1"], ["C_1 -> B_1"]
    for j, parent in enumerate(parents[1:], 2):
        ends += [f"B_{j}", f"C_{j}"]
        chords += [f"C_{parent + 1} -> B_{j}", f"C_{j} -> B_{j}"]
    p, h = _topology(parents)
    edges: list[_Edge] = []
    for j, i in enumerate(links):
        # the first body has no inner chord: branch 1 carries its translation
        edges += [_inner(state, bodies, c, i)] if j > 0 else []
        edges.append(_outer(state, bodies, c, i, applied))
    s, k = _axes(state, bodies, links)
    spin, spin_rate, pull = _basement_motion(state, bodies, c, links[0])
    return StarTree(
        [f"0 -> {end}" for end in ends],
        chords,
        [tree.links[i].name for i in links],
        P=p,
        H=h,
        P_star=[[max(-entry, 0) for entry in row] for row in p],
        S=s,
        K=k,
        X=[edge.x for edge in edges],
        X_r=[edge.x_r for edge in edges],
        X_slide=[edge.x_slide for edge in edges],
        W=[edge.w for edge in edges],
        W_slide=[edge.w_slide for edge in edges],
        X_1_r=spin,
        X_1_r_dot=spin_rate,
        X_1_ddot=pull,
        m=[edge.mass for edge in edges],
        I=[edge.inertia for edge in edges],
        Y_t=[edge.y_t for edge in edges],
        Y_r=[edge.y_r for edge in edges],
        Y_c=[0] * len(tree.velocities) if applied is None else list(applied.efforts),
    )


class _Edge(NamedTuple):
    """A chord with the branch that ends at its head: their entries in the columns of the star tree."""

    x: Vector = ZERO
    x_r: Vector = ZERO
    x_slide: Vector = ZERO
    w: Vector = ZERO
    w_slide: Vector = ZERO
    mass: Scalar = 0
    inertia: Matrix = NO_TENSOR
    y_t: Vector = ZERO
    y_r: Vector = ZERO


def _inner(state: TreeState, bodies: list[Resolved], c: Rows, i: int) -> _Edge:
    """The chord from the mass centre before a joint to the joint, with its translation."""
    arm, out = state.arms[i], Full(bodies[i].rotation).out
    return _Edge(
        x=c[state.tree.links[i].parent][i],
        x_slide=out(vector.combine(arm.rates, arm.motion.linear)),
        w_slide=out(linear_remainder(arm)),
    )


def _outer(
    state: TreeState, bodies: list[Resolved], c: Rows, i: int, applied: Applied | None
) -> _Edge:
    """The chord from a mass centre to its joint, with the joint's rotation and all that acts on the body."""
    arm, body = state.arms[i], bodies[i]
    out = Full(body.rotation).out
    x = negate(c[i][i])
    force, torque = scale(body.mass, state.tree.gravity), ZERO
    if applied is not None:
        push, twist = (out(part) for part in applied.wrenches[i])
        # about the mass centre instead of the link's origin
        force, torque = add(force, push), add(twist, cross(x, push))
    return _Edge(
        x=x,
        x_r=negate(out(vector.combine(arm.rates, arm.motion.angular))),
        w=negate(out(angular_remainder(arm))),
        mass=body.mass,
        inertia=body.inertia.rows,
        y_t=force,
        y_r=torque,
    )


def _bodies(tree: KinematicTree) -> tuple[list[int], list[int]]:
    """The links that are bodies and not basement, and the parent of each among them; -1 for the basement.

    Raises:
        ModelError: not exactly one body is connected to the basement.
    """
    number: dict[int, int] = {}
    parents: list[int] = []
    for i, link in enumerate(tree.links):
        if link.place.drive and link.parent not in number:
            continue
        number[i] = len(number)
        parents.append(number.get(link.parent, -1))
    count = parents.count(-1)
    if count != 1:
        raise ModelError("basement", f"carries {count} bodies; the paper's star tree takes one")
    return list(number), parents


def _topology(parents: list[int]) -> tuple[Integers, Integers]:
    """P of (2) and H = P^-1, whose column is the path of chords from B_1 to the branch's end."""
    size = 2 * len(parents) - 1
    p = [[0] * size for _ in range(size)]
    columns = [[0] * size for _ in range(size)]
    for j, parent in enumerate(parents):
        outer, inner = 2 * j, 2 * j - 1
        p[outer][outer] = -1
        if j > 0:
            p[2 * parent][inner] = -1
            p[inner][inner] = p[inner][outer] = 1
            columns[inner] = list(columns[2 * parent])
            columns[inner][inner] = 1
            columns[outer] = list(columns[inner])
        columns[outer][outer] = -1
    return p, transposed(columns)


def _axes(state: TreeState, bodies: list[Resolved], links: list[int]) -> tuple[Rows, Rows]:
    """S and K, in ground axes with the signs of the chords."""
    tree = state.tree
    chords = 2 * len(links) - 1
    s: Rows = [zeros(chords) for _ in tree.velocities]
    k: Rows = [zeros(chords) for _ in tree.velocities]
    for j, i in enumerate(links):
        motion, out = state.arms[i].motion, Full(bodies[i].rotation).out
        for a, freedom in enumerate(tree.links[i].velocities):
            s[freedom.index][2 * j] = scale(-freedom.ratio, out(motion.angular[a]))
            # branch 1 has no column: what moves B_1 counts against chord 1
            place, sign = (2 * j - 1, 1) if j > 0 else (0, -1)
            k[freedom.index][place] = scale(sign * freedom.ratio, out(motion.linear[a]))
    return s, k


def _basement_motion(
    state: TreeState, bodies: list[Resolved], c: Rows, first: int
) -> tuple[Vector, Vector, Vector]:
    """Angular velocity and acceleration of the basement and the acceleration of B_1."""
    tree = state.tree
    pull = head_remainder(state, bodies, c, first)
    base = i = tree.links[first].parent
    while i >= 0:
        step = add(head_remainder(state, bodies, c, i), turned(bodies[i], c[i][i]))
        pull = add(pull, step)
        i = tree.links[i].parent
    if base < 0:
        return ZERO, ZERO, pull
    return bodies[base].angular, bodies[base].remainder, pull


def zeros(count: int) -> Column:
    """A column of zero vectors, with so many entries."""
    return [ZERO] * count


def transposed(matrix: Integers) -> Integers:
    """A matrix of integers with rows and columns exchanged."""
    return [list(column) for column in zip(*matrix, strict=True)]


def _product(matrix: Integers, x: Column) -> Column:
    """A matrix of integers times a column of vectors; zeros are skipped to keep symbolic results short."""
    return [
        reduce(add, (scale(a, y) for a, y in zip(row, x, strict=True) if a != 0), ZERO)
        for row in matrix
    ]


def each(product: Callable[[Any, Vector], Vector], a: Iterable[Any], b: Column) -> Column:
    """A product of two columns, edge by edge.

    Args:
        product: of two entries, such as `cross`, `scale` or `times`.
        a: the left factors: vectors, scalars or matrices.
        b: the right factors, vectors.
    """
    return [product(x, y) for x, y in zip(a, b, strict=True)]


def summed(*columns: Column) -> Column:
    """The sum of columns, edge by edge."""
    return [reduce(add, entries) for entries in zip(*columns, strict=True)]


def negated(column: Column) -> Column:
    """A column with all signs reversed."""
    return [negate(x) for x in column]


def projected(axes: Column, column: Column) -> Scalar:
    """The sum of scalar products with a row of S or K: the projection on one coordinate.

    Args:
        axes: the row, one vector for each chord.
        column: forces or torques of the chords.
    """
    return sum(dot(a, x) for a, x in zip(axes, column, strict=True))
