"""The star tree of the paper, Figs. 10 and 11, and all that its equations (1)-(15) are made of.

Vertices are the inertial frame 0, the mass centres C_1 .. C_n and a terminal B_j for each joint. The tree is
a star [Boiadzhiev and Lilov 1993]:

    branches   2k-1: 0 -> B_k    2k: 0 -> C_k
    chords     C_1 -> B_1, and for every other body j the pair C_p -> B_j (inner), C_j -> B_j (outer)

Branch 1, at which the basement's reaction acts, is left out of the matrices: 2n-1 branches and 2n-1 chords
remain, so that P is square. All vectors are resolved in ground axes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.spatial.vector import ZERO, Matrix, Vector

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar

Integers = list[list[int]]
Column = list[Vector]
Rows = list[Column]
NO_TENSOR: Matrix = (ZERO, ZERO, ZERO)


@dataclass(frozen=True)
class StarTree:
    """All that (13)-(15) are made of, at a state. Lists run over branches or chords as noted.

    Attributes:
        branches, chords: names of the edges, "0 -> C_1" and so on, with numbers as in `bodies`.
        bodies: for body 1, 2, ... the bodies welded into it.
        P: branches x chords, of (2): -1 where the branch ends at the chord's tail, +1 at its head.
        H: its inverse: on the path to the branch's end an inner chord has +1, an outer one -1.
        P_star: max(-P, 0), which selects a chord's tail.
        S: coordinates x chords, axes of rotation with the sign of the chord: negative on outer chords.
        K: coordinates x chords, directions of translation on inner chords; joint 1 has no inner chord, so
            that its directions are on its outer chord, with negative sign.
        X: chords, X_c^t: the arm from tail to head (m), on inner chords with the joint's translation.
        X_r: chords, X_c^r: angular velocity of the head relative to the tail (rad/s).
        X_slide: inner chords, K^T q̇: velocity of the head relative to the tail's body (m/s).
        W: chords, the derivative of X_c^r at q̈ = 0, as seen in a body that the chord connects.
        W_slide: inner chords, the derivative of X_slide at q̈ = 0, as seen in the tail.
        X_1_r, X_1_r_dot: angular velocity and acceleration of the basement.
        X_1_ddot: acceleration of B_1, at q̈ = 0 where joint 1 slides on the basement.
        m, I: branches, mass and central inertia; 0 at B_k.
        Y_t, Y_r: branches, E Y_E: the external forces, weight included, and torques about C_k.
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
    """The star tree with all that the paper computes from it.

    Attributes:
        V: chords, ω of the tail x X_c^r: the other part of the derivative of X_c^r.
        Z_1, Z_2, B_1, B_2, B_3: chords, terms of (14) as abbreviated there.
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
