"""The paper's matrices with one row and column for each joint, multiplied out: P, H, C, S, K and (13)-(15).

They are meant to be read, and to prove the recursive derivation in `dynamics.orthogonality`, from which code
is emitted. Vectors are resolved in ground axes [Boiadzhiev and Lilov 1993]; `star_form` has their star tree.

A moving basement, and any other joint in prescribed motion, is a link like the others. It has no row in S and
K; its motion enters the right-hand side, as ω̇_0 in ε and as r̈_0 in G.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from linegraph.errors import ModelError
from linegraph.spatial import vector
from linegraph.spatial.rotation import IDENTITY_MATRIX, Full, Inertia, product, square
from linegraph.spatial.vector import ZERO, Matrix, Vector, add, cross, dot, scale, subtract

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.arms import Arm
    from linegraph.kinematics.links import KinematicTree, Link
    from linegraph.kinematics.tree_state import TreeState

Integers = list[list[int]]
Vectors = list[list[Vector]]


@dataclass(frozen=True)
class PaperMatrices:
    """All matrices of the paper's final equations at a state, vectors in ground axes.

    Attributes:
        P: joints x joints, the cutset matrix: P_kk = 1, P_kj = -1 where joint j sits on body k.
        H: its inverse: H_kj = 1 where joint k lies on the path from ground to body j.
        C: bodies x joints, arms (m): C_kk from joint k to the mass centre of k, C_pk from that of p to k.
        S, K: coordinates x joints of unit vectors, rotational and translational; zero in the columns of
            joints in prescribed motion.
        A, B: ``A v̇ = B`` without joint efforts: A is the mass matrix, -B the bias.
    """

    P: Integers
    H: Integers
    C: Vectors
    S: Vectors
    K: Vectors
    A: list[list[Scalar]]
    B: list[Scalar]


class Resolved(NamedTuple):
    """A link at a state, resolved in ground axes.

    Attributes:
        rotation: its working components to those of ground, 3 x 3.
        center: its mass centre from its origin (m).
        mass: its mass (kg).
        inertia: its inertia tensor about the mass centre (kg m²).
        angular: its angular velocity ω (rad/s).
        remainder: ε, its angular acceleration at v̇ = 0 (rad/s²).
    """

    rotation: Matrix
    center: Vector
    mass: Scalar
    inertia: Full
    angular: Vector
    remainder: Vector


def paper_matrices(state: TreeState) -> PaperMatrices:
    """Build the matrices literally and multiply them out.

    With H = P^-1 and Λ = S x (H C) + K,

        A = (S H) I (S H)^T + Λ (H m H^T) Λ^T
        B = S H (T' - I ε - ω x I ω) + Λ H F' - Λ (H m H^T) G

    where F' is the weight and T' = 0 [Boiadzhiev and Lilov 1993, (13)-(15)].

    Args:
        state: the kinematic tree at a state.

    Raises:
        ModelError: a link without mass has a first moment, hence no mass centre.
    """
    tree = state.tree
    bodies = resolved(state)
    p, h = _topology(tree)
    c = arm_vectors(state, bodies)
    s, k = _axes(state, bodies)
    sh = _gather(s, h)
    lam = _lever(s, h, c, k)
    mass = _carried_mass(h, bodies)
    remainder = [
        add(head_remainder(state, bodies, c, x), turned(body, c[x][x]))
        for x, body in enumerate(bodies)
    ]
    size, n = len(s), range(len(bodies))
    a = [[_quadratic(sh[i], sh[j], bodies) for j in range(size)] for i in range(size)]
    b: list[Scalar] = []
    weights = [scale(body.mass, tree.gravity) for body in bodies]
    for i in range(size):
        for j in range(size):
            pairs = (mass[x][y] * dot(lam[i][x], lam[j][y]) for x in n for y in n)
            a[i][j] = a[i][j] + sum(pairs)
        torque = -sum(dot(sh[i][x], _euler(bodies[x])) for x in n)
        weight = sum(h[x][y] * dot(lam[i][x], weights[y]) for x in n for y in n)
        inertia = sum(mass[x][y] * dot(lam[i][x], remainder[y]) for x in n for y in n)
        b.append(torque + weight - inertia)
    return PaperMatrices(p, h, c, s, k, a, b)


def _topology(tree: KinematicTree) -> tuple[Integers, Integers]:
    """P and its inverse H, by substitution from the leaves."""
    size = len(tree.links)
    p = [[int(i == j) for j in range(size)] for i in range(size)]
    h = [[int(i == j) for j in range(size)] for i in range(size)]
    for j, link in enumerate(tree.links):
        if link.parent >= 0:
            p[link.parent][j] = -1
            for i in range(size):
                h[i][j] += h[i][link.parent]
    return p, h


def resolved(state: TreeState) -> list[Resolved]:
    """Orientation, ω and ε of every link in ground axes, from the root outward as by H^T.

    ε_i = Σ_j H_ji w_j with w_j = ω_p x s q̇ + Σ_ab (∂s_a/∂q_b) q̇_a q̇_b. The second term is the derivative
    of the relative rotation inside a joint of several axes, W in (14) of the paper; a prescribed joint adds s
    q̈, which is known.

    Args:
        state: the kinematic tree at a state.

    Raises:
        ModelError: a link without mass has a first moment, hence no mass centre.
    """
    bodies: list[Resolved] = []
    for link, arm in zip(state.tree.links, state.arms, strict=True):
        near = bodies[link.parent] if link.parent >= 0 else None
        outer = near.rotation if near else IDENTITY_MATRIX
        omega = near.angular if near else ZERO
        epsilon = near.remainder if near else ZERO
        rotation = product(outer, arm.rotation.matrix())
        out = Full(rotation).out
        relative = out(vector.combine(arm.rates, arm.motion.angular))
        w = add(cross(omega, relative), out(angular_remainder(arm)))
        mass, center, inertia = _central(link)
        tensor = Full(square(Full(rotation).congruence(inertia)))
        bodies.append(
            Resolved(rotation, out(center), mass, tensor, add(omega, relative), add(epsilon, w))
        )
    return bodies


def angular_remainder(arm: Arm) -> Vector:
    """The relative angular acceleration at v̇ = 0, as seen in the head: W, and s q̈ if prescribed."""
    known = vector.combine(arm.prescribed, arm.motion.angular) if arm.prescribed else ZERO
    return add(arm.motion.angular_bias, known)


def linear_remainder(arm: Arm) -> Vector:
    """The relative acceleration of the head's origin at v̇ = 0, as seen in the *tail* but in head axes.

    `Motion.linear_bias` is the derivative as seen in the head; w x u is what the tail sees in addition.
    """
    w = vector.combine(arm.rates, arm.motion.angular)
    u = vector.combine(arm.rates, arm.motion.linear)
    known = vector.combine(arm.prescribed, arm.motion.linear) if arm.prescribed else ZERO
    return add(add(arm.motion.linear_bias, cross(w, u)), known)


def _central(link: Link) -> tuple[Scalar, Vector, Inertia]:
    """Mass, mass centre and central inertia; a link without mass keeps its origin as centre.

    Raises:
        ModelError: it has a first moment but no mass.
    """
    m, first, *_ = link.moments
    xx, xy, xz, yy, yz, zz = link.moments.inertia
    if m == 0:
        if not vector.is_zero(first):
            raise ModelError(
                f'body "{link.name}"', "has a first moment but no mass, hence no centre"
            )
        return m, ZERO, link.moments.inertia
    x, y, z = (component / m for component in first)
    # Steiner's theorem, from the origin back to the mass centre
    return (
        m,
        (x, y, z),
        (
            xx - m * (y * y + z * z),
            xy + m * x * y,
            xz + m * x * z,
            yy - m * (x * x + z * z),
            yz + m * y * z,
            zz - m * (x * x + y * y),
        ),
    )


def arm_vectors(state: TreeState, bodies: list[Resolved]) -> Vectors:
    """C: the arms from each joint to the mass centre beyond it, and to it from the mass centre before it.

    Args:
        state: the kinematic tree at a state.
        bodies: its links in ground axes.

    Returns:
        Bodies x joints, vectors in ground axes (m).
    """
    size = len(bodies)
    c: Vectors = [[ZERO] * size for _ in range(size)]
    for k, (link, arm) in enumerate(zip(state.tree.links, state.arms, strict=True)):
        c[k][k] = bodies[k].center
        if link.parent >= 0:
            near = bodies[link.parent]
            c[link.parent][k] = subtract(Full(near.rotation).out(arm.at), near.center)
    return c


def _axes(state: TreeState, bodies: list[Resolved]) -> tuple[Vectors, Vectors]:
    """S and K: axes of rotation and directions of translation of each coordinate at each joint."""
    tree = state.tree
    size, n = len(tree.velocities), len(bodies)
    s: Vectors = [[ZERO] * n for _ in range(size)]
    k: Vectors = [[ZERO] * n for _ in range(size)]
    for j, link in enumerate(tree.links):
        out = Full(bodies[j].rotation).out
        for a, freedom in enumerate(link.velocities):
            motion = state.arms[j].motion
            s[freedom.index][j] = scale(freedom.ratio, out(motion.angular[a]))
            k[freedom.index][j] = scale(freedom.ratio, out(motion.linear[a]))
    return s, k


def _gather(s: Vectors, h: Integers) -> Vectors:
    """The product S H."""
    n = range(len(h))
    return [[_sum(scale(h[j][i], row[j]) for j in n) for i in n] for row in s]


def _lever(s: Vectors, h: Integers, c: Vectors, k: Vectors) -> Vectors:
    """The product Λ = S x (H C) + K: how each coordinate moves the mass centres."""
    n = range(len(h))
    hc = [[_sum(scale(h[j][i], c[i][x]) for i in n) for x in n] for j in n]
    return [
        [add(_sum(cross(row[j], hc[j][x]) for j in n), slide[x]) for x in n]
        for row, slide in zip(s, k, strict=True)
    ]


def _carried_mass(h: Integers, bodies: list[Resolved]) -> list[list[Scalar]]:
    """H m H^T: for each pair of joints the mass that both carry."""
    n = range(len(h))
    return [[sum(h[x][i] * bodies[i].mass * h[y][i] for i in n) for y in n] for x in n]


def head_remainder(state: TreeState, bodies: list[Resolved], c: Vectors, k: int) -> Vector:
    """The acceleration of joint k's head relative to the mass centre before it, at v̇ = 0.

    With that of the arm beyond the joint it is G_k: ε x C + ω x (ω x C) of the parent's arm, 2 ω x u, and the
    remainder of the joint itself.

    Args:
        state: the kinematic tree at a state.
        bodies: its links in ground axes.
        c: the arms C.
        k: index of the joint.

    Returns:
        A vector in ground axes (m/s²).
    """
    out = Full(bodies[k].rotation).out
    arm = state.arms[k]
    g = out(linear_remainder(arm))
    parent = state.tree.links[k].parent
    if parent >= 0:
        near = bodies[parent]
        u = out(vector.combine(arm.rates, arm.motion.linear))
        g = add(g, turned(near, c[parent][k]))
        g = add(g, scale(2, cross(near.angular, u)))
    return g


def turned(body: Resolved, arm: Vector) -> Vector:
    """The acceleration of the end of an arm fixed on a body at v̇ = 0: ε x arm + ω x (ω x arm).

    Args:
        body: with ω and ε.
        arm: in ground axes (m).
    """
    return add(cross(body.remainder, arm), cross(body.angular, cross(body.angular, arm)))


def _euler(body: Resolved) -> Vector:
    """The torque I ε + ω x I ω."""
    return add(
        body.inertia.out(body.remainder), cross(body.angular, body.inertia.out(body.angular))
    )


def _quadratic(a: list[Vector], b: list[Vector], bodies: list[Resolved]) -> Scalar:
    """One entry of (S H) I (S H)^T."""
    return sum(dot(x, body.inertia.out(y)) for x, y, body in zip(a, b, bodies, strict=True))


def _sum(vectors: Iterable[Vector]) -> Vector:
    total = ZERO
    for a in vectors:
        total = add(total, a)
    return total
