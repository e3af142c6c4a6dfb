"""The paper's equations as printed, corrected: the star tree of Figs. 10 and 11 and its (1)-(15).

Boiadzhiev & Lilov, "The orthogonality principle", J. Theor. Appl. Mech. (Sofia) XXIV(1), 1993. Vertices are
the inertial frame 0, the mass centres C_1 .. C_n and a terminal B_j for each joint. The tree is a star:

    branches   2k-1: 0 -> B_k    2k: 0 -> C_k
    chords     C_1 -> B_1, and for every other body j the pair C_p -> B_j (inner), C_j -> B_j (outer)

Without branch 1, the basement's reaction, 2n-1 branches face 2n-1 chords. Corrected are P*, which the print
does not define, Z_1, and B, where translational joints are missing. Vectors are in ground axes.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import reduce
from typing import TYPE_CHECKING, Any

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
from linegraph.spatial import vector
from linegraph.spatial.rotation import Full
from linegraph.spatial.vector import ZERO, Matrix, Vector, add, cross, dot, negate, scale

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.applied_forces import Applied
    from linegraph.kinematics.links import KinematicTree
    from linegraph.kinematics.tree_state import TreeState

Integers = list[list[int]]
Column = list[Vector]
Rows = list[Column]
NO_TENSOR: Matrix = (ZERO, ZERO, ZERO)


@dataclass(frozen=True)
class StarTree:
    """What (13)-(15) are made of, at a state. Lists run over branches or chords as noted.

    Attributes:
        branches, chords: names of the edges, "0 -> C_1" and so on; numbers are those of `bodies`.
        bodies: for body 1, 2, ... the bodies welded into it.
        P: branches x chords, of (2): -1 where the branch ends at the chord's tail, +1 at its head.
        H: its inverse: on the path to the branch's end an inner chord has +1, an outer one -1.
        P_star: max(-P, 0), which selects a chord's tail.
        S: coordinates x chords, axes of rotation with the sign of the chord: on outer chords, negative.
        K: coordinates x chords, directions of translation: on inner chords; of joint 1, which has none, on
            its outer chord and negative.
        X: chords, X_c^t: the arm from tail to head, on inner chords with the joint's translation.
        X_r: chords, X_c^r: the angular velocity of the head less that of the tail.
        X_slide: inner chords, K^T q̇: how fast the head slides on the tail's body.
        W: chords, the derivative of X_c^r seen in a body it connects, with q̈ = 0.
        W_slide: inner chords, the derivative of X_slide seen in the tail, with q̈ = 0.
        X_1_r, X_1_r_dot: of the basement, angular velocity and acceleration.
        X_1_ddot: acceleration of B_1, with q̈ = 0 where joint 1 slides on the basement.
        m, I: branches, mass and central inertia; 0 at B_k.
        Y_t, Y_r: branches, E Y_E: the external forces, weight included, and torques.
        Y_c: coordinates, S Y_c^r + K Y_c^t: the efforts in the joints.
    """

    branches: list[str]
    chords: list[str]
    bodies: list[str]
    P: Integers
    H: Integers
    P_star: Integers
    S: Rows
    K: Rows
    X: Column
    X_r: Column
    X_slide: Column
    W: Column
    W_slide: Column
    X_1_r: Vector
    X_1_r_dot: Vector
    X_1_ddot: Vector
    m: list[Scalar]
    I: list[Matrix]  # noqa: E741 - the paper's own letter
    Y_t: Column
    Y_r: Column
    Y_c: list[Scalar]


@dataclass(frozen=True)
class PrintedMatrices(StarTree):
    """The star tree with what the paper computes from it.

    Attributes:
        V: chords, ω of the tail x X_c^r: the other part of the derivative of X_c^r.
        Z_1, Z_2, B_1, B_2, B_3: chords, as (14) abbreviates its terms.
        A, B: ``A v̇ = B``: A is the mass matrix, -B the bias.
    """

    V: Column
    Z_1: Column
    Z_2: Column
    B_1: Column
    B_2: Column
    B_3: Column
    A: list[list[Scalar]]
    B: list[Scalar]


def printed_matrices(state: TreeState, applied: Applied | None = None) -> PrintedMatrices:
    """The star tree at (q, v) and its equations (12)-(15).

    The basement is ground and what only prescribed joints connect to it. `applied` are forces and torques
    on the links besides weight, and efforts in the joints.

    Raises:
        ModelError: not exactly one body is on the basement; or a link without mass has a first moment.
    """
    return equations(_star_tree(state, applied))


def equations(star: StarTree) -> PrintedMatrices:
    """(13)-(15): A v̇ = B, term by term as printed but for the corrections.

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

    w = (H P*)^T (X_c^r - 1 X_1^r) is of each tail, W^t is `W_slide`. Two terms of B_3 are not in print.
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
    """A of (13) and (15)."""
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
    """The products of matrices that (13)-(15) are written with, applied to columns of vectors."""

    def __init__(self, star: StarTree) -> None:
        """Prepare H^T and H P*."""
        self._star = star
        self._back = transposed(star.H)
        columns = transposed(star.P_star)
        self._tails = [
            [sum(x * y for x, y in zip(row, column, strict=True)) for column in columns]
            for row in star.H
        ]
        self._tails_back = transposed(self._tails)

    def gathered(self, x: Column) -> Column:
        """``H x``: from branches to chords."""
        return _product(self._star.H, x)

    def spread(self, x: Column) -> Column:
        """``H^T x``: from chords to branches."""
        return _product(self._back, x)

    def mass(self, x: Column) -> Column:
        """``H m H^T x``."""
        return self.gathered(each(scale, self._star.m, self.spread(x)))

    def inertia(self, x: Column) -> Column:
        """``H I H^T x``."""
        return self.gathered(each(vector.times, self._star.I, self.spread(x)))

    def tail(self, x: Column) -> Column:
        """``(H P*)^T x``: what the tail of each chord has of a quantity of rotation."""
        return _product(self._tails_back, x)

    def moment(self, x: Column) -> Column:
        """``H P* x diag X x``: torques of forces at the heads of the arms, summed towards the root."""
        return _product(self._tails, each(cross, self._star.X, x))

    def swept(self, x: Column) -> Column:
        """``(H P* x diag X)^T x``: how arms move that turn with their tails."""
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
    x, x_r, w = (zeros(len(chords)) for _ in range(3))
    x_slide, w_slide, y_t, y_r = (zeros(len(chords)) for _ in range(4))
    masses: list[Scalar] = [0] * len(chords)
    inertias = [NO_TENSOR] * len(chords)
    for j, i in enumerate(links):
        arm, out = state.arms[i], Full(bodies[i].rotation).out
        outer, inner = 2 * j, 2 * j - 1
        masses[outer], inertias[outer] = bodies[i].mass, bodies[i].inertia.rows
        x[outer] = negate(c[i][i])
        x_r[outer] = negate(out(vector.combine(arm.rates, arm.motion.angular)))
        w[outer] = negate(out(angular_remainder(arm)))
        if j > 0:
            x[inner] = c[tree.links[i].parent][i]
            x_slide[inner] = out(vector.combine(arm.rates, arm.motion.linear))
            w_slide[inner] = out(linear_remainder(arm))
        y_t[outer] = scale(bodies[i].mass, tree.gravity)
        if applied is not None:
            force, torque = (out(part) for part in applied.wrenches[i])
            y_t[outer] = add(y_t[outer], force)
            # about the mass centre instead of the link's origin
            y_r[outer] = add(torque, cross(x[outer], force))
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
        X=x,
        X_r=x_r,
        X_slide=x_slide,
        W=w,
        W_slide=w_slide,
        X_1_r=spin,
        X_1_r_dot=spin_rate,
        X_1_ddot=pull,
        m=masses,
        I=inertias,
        Y_t=y_t,
        Y_r=y_r,
        Y_c=[0] * len(tree.velocities) if applied is None else list(applied.efforts),
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
    """S and K."""
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
    """Zeros."""
    return [ZERO] * count


def transposed(matrix: Integers) -> Integers:
    """Rows and columns exchanged."""
    return [list(column) for column in zip(*matrix, strict=True)]


def _product(matrix: Integers, x: Column) -> Column:
    """A matrix of integers times a column of vectors; zeros are skipped for the sake of symbols."""
    return [
        reduce(add, (scale(a, y) for a, y in zip(row, x, strict=True) if a != 0), ZERO)
        for row in matrix
    ]


def each(product: Callable[[Any, Vector], Vector], a: Iterable[Any], b: Column) -> Column:
    """A product chord by chord."""
    return [product(x, y) for x, y in zip(a, b, strict=True)]


def summed(*columns: Column) -> Column:
    """Columns added, edge by edge."""
    return [reduce(add, entries) for entries in zip(*columns, strict=True)]


def negated(column: Column) -> Column:
    """Signs turned."""
    return [negate(x) for x in column]


def projected(axes: Column, column: Column) -> Scalar:
    """The products with a row of S or K, summed up."""
    return sum(dot(a, x) for a, x in zip(axes, column, strict=True))
