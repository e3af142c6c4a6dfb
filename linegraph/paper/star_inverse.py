"""The paper's inverse scheme on its star tree: every variable of every edge once v̇ is known.

[Boiadzhiev and Lilov 1993] only mention it. Written out, it is the circuit equations forward, H^T, and the
cutset equations back, H. It is meant to be read, and to prove `dynamics.edge_variables`, from which code is
emitted.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.paper.star_form import (
    Operators,
    each,
    negated,
    summed,
    transposed,
    zeros,
)
from linegraph.spatial import vector
from linegraph.spatial.vector import Vector, add, cross, negate, scale

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.paper.star_tree import Column, PrintedMatrices


@dataclass(frozen=True)
class StarVariables:
    """Across and through variables of the star tree in motion, in ground axes.

    Attributes:
        X_b_r, X_b_r_dot: branches, angular velocity and acceleration of the branch's end.
        X_b_t_ddot: branches, acceleration of the branch's end (m/s²).
        Y_c_t, Y_c_r: chords, the force (N) and the torque (N m) that a joint's chord exerts on its head.
        Y_1_t, Y_1_r: force and torque of branch 1, the reaction of the basement.
    """

    X_b_r: Column
    X_b_r_dot: Column
    X_b_t_ddot: Column
    Y_c_t: Column
    Y_c_r: Column
    Y_1_t: Vector
    Y_1_r: Vector


def star_variables(star: PrintedMatrices, acceleration: Sequence[Scalar]) -> StarVariables:
    """The inverse scheme for given v̇.

        X_b^r = H^T (X_c^r - 1 X_1^r)           Ẋ_b^r = H^T (S^T v̇ + W + V - 1 Ẋ_1^r)
        Ẍ_c^t = ε x X + w x (w x X) + 2 w x K^T q̇ + W^t + K^T v̇      of the tail's ε and w
        Ẍ_b^t = H^T (Ẍ_c^t - 1 Ẍ_1^t)
        Y_c^t = H (m Ẍ_b^t - E Y_E^t)
        Y_c^r = H (I Ẋ_b^r + ω x I ω - E Y_E^r + P* (X x Y_c^t))
        Y_1   = -Y_{2n+1}

    Args:
        star: the tree at a state, with its matrices.
        acceleration: v̇, by coordinate.
    """
    h = Operators(star)
    rest = zeros(len(star.chords) - 1)
    spin = summed(star.X_r, [negate(star.X_1_r), *rest])
    bend = summed(_spread(star.S, acceleration), star.W, star.V, [negate(star.X_1_r_dot), *rest])
    w, epsilon = h.tail(spin), h.tail(bend)
    whirl = each(cross, w, each(cross, w, star.X))
    coriolis = [scale(2, x) for x in each(cross, w, star.X_slide)]
    pull = summed(
        each(cross, epsilon, star.X),
        whirl,
        coriolis,
        star.W_slide,
        _spread(star.K, acceleration),
        [negate(star.X_1_ddot), *rest],
    )
    omega, omega_dot, moved = h.spread(spin), h.spread(bend), h.spread(pull)
    force = h.gathered(summed(each(scale, star.m, moved), negated(star.Y_t)))
    momentum = each(vector.times, star.I, omega)
    levers = _at_tails(star, each(cross, star.X, force))
    spun = summed(each(vector.times, star.I, omega_dot), each(cross, omega, momentum))
    torque = h.gathered(summed(spun, negated(star.Y_r), levers))
    return StarVariables(
        omega, omega_dot, moved, force, torque, negate(force[0]), negate(torque[0])
    )


def _spread(rows: list[Column], v: Sequence[Scalar]) -> Column:
    """``S^T v``: relative angular velocities of the chords."""
    total = zeros(len(rows[0]))
    for row, x in zip(rows, v, strict=True):
        total = [add(y, scale(x, s)) for y, s in zip(total, row, strict=True)]
    return total


def _at_tails(star: PrintedMatrices, x: Column) -> Column:
    """``P* x``: a quantity of chords summed at the branches that end at their tails."""
    found = zeros(len(star.branches))
    for chord, row in enumerate(transposed(star.P_star)):
        for branch, entry in enumerate(row):
            if entry:
                found[branch] = add(found[branch], x[chord])
    return found
