"""The same algorithms for a bead on a curve in space, whose masses and sizes are all different."""

from __future__ import annotations

import contextlib
import math
from typing import Any

import numpy as np
import pytest
from particle import BETA, Bead, Particle, Sheet, on_circle
from test_algorithms_of_a_particle import ANGLES, called, dynamics, refused

from linegraph.ir.algorithms.complete import complete
from linegraph.ir.algorithms.constrained import SOLVED, constrained, pure_rows
from linegraph.ir.algorithms.dynamics import (
    accelerations_differ,
    constrained_dynamics,
    equations_beside,
    largest_force,
)
from linegraph.ir.algorithms.language import Failed, reals
from linegraph.ir.algorithms.linearization import input_matrix, linearization, state_matrix
from linegraph.ir.algorithms.project import project
from linegraph.ir.algorithms.reduction import differ, reduced_equations, reduction
from linegraph.ir.statuses import NOT_CLOSED, NOT_DETERMINED

array = Particle.list


def taken(values: Any) -> Any:
    return np.array([values[i] for i in range(len(values))])


def test_accelerations_and_multipliers_of_a_bead() -> None:
    for angle in ANGLES:
        p = Bead(angle, 1.5)
        a, lam = called(constrained_dynamics, p, p.q, p.v, sizes=(3, 2))
        assert a == pytest.approx(p.expected()[0], rel=1e-11)
        assert lam == pytest.approx(p.expected()[1], rel=1e-11)


def test_a_bead_is_projected_with_the_least_kinetic_energy() -> None:
    for angle in ANGLES:
        p = Bead(angle, 1.5)
        off = p.q * 1.1 + np.array([0.02, 0.05, -0.03])
        v_off = p.v + np.array([0.2, -0.3, 0.1])
        p.q, p.v = off, v_off
        q, v = called(project, p, off, v_off, sizes=(3, 3))
        assert p.gap(q) == pytest.approx([0.0, 0.0], abs=1e-14)
        J = p.normal(q)
        assert J @ v == pytest.approx([0.0, 0.0], abs=1e-13)
        multipliers = np.linalg.lstsq(J.T, p.M @ (v - v_off), rcond=None)[0]
        assert J.T @ multipliers == pytest.approx(p.M @ (v - v_off), abs=1e-12)


def test_a_bead_is_completed_from_one_coordinate() -> None:
    for angle in (0.5, 1.2, 2.2, -0.7):
        p = Bead(angle, 1.5)
        guess = p.q + np.array([0.2, 0.4, 0.1])
        q, v = called(complete, p, guess, p.q[1:2], p.v[1:2], sizes=(3, 3))
        assert q == pytest.approx(p.q, abs=1e-13)
        assert v == pytest.approx(p.v, abs=1e-12)


class Carried(Bead):
    """A bead whose curve moves: the rates of constraints are not zero at rest."""

    moving = np.array([0.3, -0.5])

    def constraint_rates(self, rates: Any, **given: Any) -> None:
        super().constraint_rates(rates, **given)
        for k in range(2):
            rates[k] -= self.moving[k]


def test_a_moving_curve_carries_the_bead() -> None:
    p = Carried(0.7, 1.5)
    _, v = called(complete, p, p.q, p.q[1:2], [0.4], sizes=(3, 3))
    assert p.normal(p.q) @ v == pytest.approx(p.moving, abs=1e-12)
    assert v[1] == pytest.approx(0.4)
    _, v = called(project, p, p.q, p.v, sizes=(3, 3))
    assert p.normal(p.q) @ v == pytest.approx(p.moving, abs=1e-12)


class Unbounded(Bead):
    """A bead with one function whose results are no numbers, or too large."""

    name, bad = "", math.nan

    def spoil(self, name: str, array: Any) -> None:
        if name == self.name:
            array[len(array) - 1] = self.bad

    def constraints(self, phi: Any, **given: Any) -> None:
        super().constraints(phi, **given)
        self.spoil("phi", phi)

    def constraint_jacobian(self, J: Any, **given: Any) -> None:
        super().constraint_jacobian(J, **given)
        self.spoil("J", J)

    def constraint_rates(self, rates: Any, **given: Any) -> None:
        super().constraint_rates(rates, **given)
        self.spoil("rates", rates)

    def constraint_bias(self, gam: Any, **given: Any) -> None:
        super().constraint_bias(gam, **given)
        self.spoil("gam", gam)


@pytest.mark.parametrize("bad", [math.nan, math.inf, 1e101])
def test_what_is_no_number_ends_with_a_status(bad: float) -> None:
    expected: dict[tuple[Any, str], str] = {
        (complete, "phi"): "NOT_CLOSED",
        (complete, "J"): "NOT_CLOSED",
        (complete, "rates"): "NOT_FINITE",
        (reduction, "J"): "NOT_FINITE",
        (reduction, "gam"): "NOT_FINITE",
        (project, "phi"): "NOT_CLOSED",
        (project, "J"): "NOT_CLOSED",
        (project, "rates"): "NO_VELOCITY",
    }
    for (algorithm, name), status in expected.items():
        p = Unbounded(0.7, 1.5)
        p.name, p.bad = name, bad
        given = (p.q * 1.01, p.q[1:2], p.v[1:2]) if algorithm is complete else (p.q * 1.01, p.v)
        sizes = (3, 3)
        with pytest.raises(Failed) as caught:
            called(algorithm, p, *given, sizes=sizes)
        assert caught.value.status.name == status, (algorithm, name)


def test_a_bead_in_its_independent_coordinate() -> None:
    for angle in ANGLES:
        p = Bead(angle, 1.5)
        T, rest = called(reduction, p, p.q, p.v, sizes=(3, 3))
        assert pytest.approx(p.tangent(), rel=1e-11) == T
        whole = np.vstack([p.normal(p.q), [0.0, 1.0, 0.0]])
        expected = np.linalg.solve(whole, [*p.bend(p.v), 0.0])
        assert rest == pytest.approx(expected, rel=1e-11, abs=1e-13)
        Mr, hr = called(reduced_equations, p, sizes=(1, 1))
        assert Mr == pytest.approx([T @ p.M @ T], rel=1e-11)
        assert hr == pytest.approx([T @ (p.M @ expected - p.force + [0, p.u, 0])], rel=1e-11)


def acceleration(x: float, w: float, u: float) -> float:
    """x¨ of the bead on the upper half of its curve."""
    y = math.sqrt(1 - x * x)
    p = Bead(math.atan2(y, x), -w / y, u)
    return float(p.expected()[0][1])


def test_the_linearised_bead_is_that_of_differences() -> None:
    p = Bead(0.7, 1.5)
    A, B = called(linearization, p, p.v, sizes=(4, 2))
    given = np.array([p.q[1], p.v[1], p.u])
    slopes = [
        (acceleration(*(given + s)) - acceleration(*(given - s))) / 2e-5 for s in 1e-5 * np.eye(3)
    ]
    assert A.reshape(2, 2) == pytest.approx(np.array([[0.0, 1.0], slopes[:2]]), rel=1e-6, abs=1e-9)
    assert pytest.approx([0.0, slopes[2]], rel=1e-6) == B


STATES = (((0.4, 0.9), (1.5, -0.7)), ((-1.2, 0.3), (0.2, 0.5)))


@pytest.mark.parametrize("state", STATES)
def test_two_independent_coordinates_on_a_surface(state: Any) -> None:
    p = Sheet(*state)
    a, lam = called(constrained_dynamics, p, p.q, p.v, sizes=(3, 1))
    assert a == pytest.approx(p.expected()[0], rel=1e-11)
    assert lam == pytest.approx(p.expected()[1], rel=1e-11)
    T, rest = called(reduction, p, p.q, p.v, sizes=(6, 3))
    T = T.reshape(3, 2)
    assert pytest.approx(p.tangent(), rel=1e-11) == T
    assert rest == pytest.approx([p.v[1] * p.v[2], 0.0, 0.0], rel=1e-11)
    Mr, hr = called(reduced_equations, p, sizes=(4, 2))
    assert Mr.reshape(2, 2) == pytest.approx(T.T @ p.M @ T, rel=1e-11)
    assert hr == pytest.approx(T.T @ (p.M @ rest - p.force + [0, p.u, 0]), rel=1e-11)
    guess = p.q + np.array([0.4, 0.3, -0.2])
    q, v = called(complete, p, guess, p.q[1:], p.v[1:], sizes=(3, 3))
    assert q == pytest.approx(p.q, abs=1e-13)
    assert v == pytest.approx(p.v, abs=1e-12)


@pytest.mark.parametrize("state", STATES)
def test_the_linearised_surface_is_that_of_differences(state: Any) -> None:
    p = Sheet(*state)
    A, B = called(linearization, p, p.v, sizes=(16, 4))
    given = np.array([*state[0], *state[1], p.u])

    def acceleration(x: Any) -> Any:
        return Sheet(x[:2], x[2:4], x[4]).expected()[0][1:]

    slopes = np.array(
        [(acceleration(given + s) - acceleration(given - s)) / 2e-5 for s in 1e-5 * np.eye(5)]
    ).T
    upper = np.hstack([np.zeros((2, 2)), np.eye(2)])
    expected = np.vstack([upper, slopes[:, :4]])
    assert A.reshape(4, 4) == pytest.approx(expected, rel=1e-6, abs=1e-9)
    assert pytest.approx([0.0, 0.0, *slopes[:, 4]], rel=1e-6, abs=1e-9) == B


class Large:
    """Counts of a linearisation, all different."""

    NT, NI, NDX, NU, NV = 5, 2, 5, 3, 4
    d_at, w_at = (1, 4, 2), (0, 3)


def test_the_matrices_of_the_linearisation_are_put_together() -> None:
    rng = np.random.default_rng(1)
    m: Any = Large()
    free, sides = list(m.d_at), m.NDX + m.NU
    T, drift = rng.normal(size=(m.NT, m.NI)), rng.normal(size=(m.NT, m.NT))
    D, S = rng.normal(size=(m.NT, 3)), rng.normal(size=(m.NT, 3))
    found = rng.normal(size=(m.NI, sides))
    A, B = reals(m.NDX * m.NDX), array([7.0] * (m.NDX * m.NU))
    state_matrix(m, *(array(x.ravel()) for x in (T, drift, D, S, found)), A)
    upper = np.hstack([(S + drift @ D)[free], T[free]])
    expected = np.vstack([upper, found[:, : m.NDX]])
    assert taken(A).reshape(m.NDX, m.NDX) == pytest.approx(expected)
    input_matrix(m, array(found.ravel()), B)
    expected = np.vstack([np.zeros((3, m.NU)), found[:, m.NDX :]])
    assert taken(B).reshape(m.NDX, m.NU) == pytest.approx(expected)


# ---- the estimate of errors


def compared(p: Particle) -> bool:
    """Whether a second state is looked at."""
    p.evaluations = 0
    with contextlib.suppress(Failed):
        dynamics(p)
    return p.evaluations > 1


@pytest.mark.parametrize(("u", "vx"), [(0.7, 1.0), (40.0, 0.5), (0.7, 0.0), (1e-4, 1.0)])
def test_the_estimate_decides_whether_a_second_state_is_looked_at(u: float, vx: float) -> None:
    """Of a cross the pivot is x; rounding / (pivot/4)³, and more where speeds are large, reaches 1e-6."""
    size = max(u / 2, 0.01 * vx * vx)
    share = 1 + vx * vx / size if vx else 1.0
    pivot = 4 * (share * 5e-16 / 1e-6) ** (1 / 3)
    for factor, expected in ((1.02, False), (0.98, True)):
        assert compared(Particle((factor * pivot, 0.0), (vx, 0.0), u, cross=True)) is expected


@pytest.mark.parametrize(("gap", "slip"), [(3e-10, 0.0), (0.0, 2e-10), (3e-8, 0.0), (0.0, -2e-8)])
def test_errors_beyond_rounding_are_in_the_estimate(gap: float, slip: float) -> None:
    """Where the gap is more than 1e-9, accelerations may be wrong in proportion."""
    vx = 0.5
    off = abs(gap) or abs(slip) / vx
    within = 1e-6 * max(1.0, off / 1e-9)
    share = 1 + vx * vx / 20
    pivot = 4 * (share * off / within) ** (1 / 3)
    for factor, expected in ((1.02, False), (0.98, True)):
        x = factor * pivot
        # the gap is x y, the slip y vx + x vy
        y = gap / x
        p = Particle((x, y), (vx, (slip - y * vx) / x), 40.0, cross=True)
        assert compared(p) is expected


def test_a_state_far_off_is_not_judged() -> None:
    for gap, expected in ((0.99e-2, True), (1.01e-2, False)):
        assert compared(Particle((0.02, gap / 0.02), (1.0, -gap / 4e-4), cross=True)) is expected


def test_light_free_motions_are_uncertain_too() -> None:
    p = Bead(0.7, 1.5)
    T = p.tangent()
    # almost nothing is left of the mass along the curve
    light = p.M - (1 - 4e-10) * np.outer(p.M @ T, T @ p.M) / (T @ p.M @ T)
    for M, expected in ((p.M, False), (light, True)):
        p.M, p.evaluations = M, 0
        try:
            called(constrained_dynamics, p, p.q, p.v, sizes=(3, 2))
        finally:
            assert (p.evaluations > 1) is expected


def test_the_estimate_of_the_reduction() -> None:
    for angle, expected in ((4 * (5e-16 / 1e-6) ** (1 / 3), None), (0.3, False)):
        for factor in (1.02, 0.98):
            p = Counted(factor * angle)
            called(reduction, p, p.q, p.v, sizes=(2, 2))
            assert (p.biases > 1) is (factor < 1 if expected is None else expected)


class Counted(Particle):
    """On the circle; it counts how often right-hand sides are asked for."""

    def __init__(self, angle: float) -> None:
        """At an angle."""
        q = np.array([math.cos(angle), math.sin(angle)])
        super().__init__(q, 1.5 * np.array([-q[1], q[0]]))
        self.biases = 0

    def constraint_bias(self, gam: Any, **given: Any) -> None:
        self.biases += 1
        super().constraint_bias(gam, **given)


def test_columns_differ_by_more_than_a_part_of_their_size() -> None:
    p: Any = Bead(0.7, 1.5)
    of_v = array([1.5, 0.7, 2.0])
    B = [[2.0, 1.0], [1.0, -3.0], [-4.0, 5.0]]
    for row in range(3):
        for column in range(2):
            # the given one is of_v[1] for the first column, 1 for the last; sizes are of rows
            given = (0.7, 1.0)[column]
            sizes = [abs(B[k][column]) * given / of_v[k] for k in range(3)]
            allowed = 1e-3 * max(sizes) * of_v[row] / given
            for factor, expected in ((0.98, False), (1.02, True), (-1.02, True)):
                other = np.array(B)
                other[row, column] += factor * allowed
                flat = (array(np.ravel(B)), array(other.ravel()))
                assert differ(p, 0.5, 1e-3, of_v, *flat) is expected
    other = np.array(B)
    other[1, 1] *= 0.89
    flat = (array(np.ravel(B)), array(other.ravel()))
    assert differ(p, 0.5, 1e3, of_v, *flat)  # never more than a tenth
    small = 1e-9 * np.array(B)
    flat = (array(small.ravel()), array((2 * small * [0, 1] + small * [1, 0]).ravel()))
    assert not differ(p, 2.0, 1e-3, of_v, *flat)  # rest is compared with speeds


def test_accelerations_differ_by_more_than_a_part_of_their_size() -> None:
    p: Any = Bead(0.7, 1.5)
    of_v, a, pure = array([1.5, 0.7, 2.0]), [1.0, 2.0, 3.0], [4.0, -5.0]
    for within, bound in ((1e-3, 1e-3), (1.0, 0.1)):
        for place in range(3):
            for factor, expected in ((0.98, False), (1.02, True)):
                other = np.array(a)
                other[place] -= factor * bound * 2.5 * of_v[place]
                given = (of_v, array(a), array(pure), array(other), array(pure))
                assert accelerations_differ(p, within, 2.5, 0.5, *given) is expected
        for least, force in ((0.5, 5.0), (7.0, 7.0)):
            for place in range(2):
                for factor, expected in ((0.98, False), (1.02, True)):
                    wrong = np.array(pure)
                    wrong[place] += factor * bound * force
                    given = (of_v, array(a), array(pure), array(a), array(wrong))
                    assert accelerations_differ(p, within, 2.5, least, *given) is expected


def test_the_largest_force_is_one_of_inertia_or_another() -> None:
    p: Any = Bead(0.7, 1.5)
    of_v = [1.5, 0.7, 2.0]
    rng = np.random.default_rng(3)
    for _ in range(20):
        f, a = rng.normal(size=3) * [3, 1, 0.3], rng.normal(size=3)
        expected = max(np.maximum(abs(p.M @ a), abs(f)) * of_v)
        found = largest_force(p, array(p.M.ravel()), array(f), array(of_v), array(a))
        assert found == pytest.approx(expected)


def test_what_stabilises_stays_that_of_the_given_state() -> None:
    p: Any = on_circle(0.7, 1.5, baumgarte=True)
    p.q = 1.1 * p.q
    outputs = [reals(4), reals(2), reals(2), reals(1), reals(1)]
    p.constrained_equations(*outputs[:4])
    back = taken(outputs[3])[0] - p.bend(p.v)
    assert abs(back) > 1.0
    assert back == pytest.approx(-(BETA**2) * p.gap(p.q))
    q, v = on_circle(0.8, 1.2).q, on_circle(0.8, 1.2).v
    equations_beside(p, array(q), array(v), *outputs)
    assert taken(outputs[2]) == pytest.approx(q)
    assert taken(outputs[3]) == pytest.approx([p.bend(v) + back])


# ---- limits


def test_contradictions_are_measured_in_sizes_of_rows() -> None:
    """Two rows that say the same: by a hundredth of their terms they may differ."""
    M, J = np.eye(2), np.array([[1.0, 0.5], [2.0, 1.0]])
    for scale in (1e-3, 1.0, 1e3):
        for row, factor in ((0, 0.9), (0, 1.1), (1, 0.9), (1, 1.1)):
            gam = np.array([3.0, 6.0])
            sizes = np.array([scale, 2 * scale])
            # one of the rows is solved; the other one is off by a part of a + |gam| = 2 |gam|
            gam[row] *= 1 + factor * 0.02
            p: Any = Bead(0.7, 0.0)
            p.NV, p.NC = 2, 2
            a, lam = reals(2), reals(2)
            given = (array(x.ravel()) for x in (M, np.zeros(2), J, gam, sizes, np.ones(2)))
            found = constrained(
                *(p, 2, 1, False, 1e-2, 0.0, *given, a, False, lam, lam, reals(2)),
            )
            assert (found == SOLVED) is (factor < 1)


def test_rounding_of_a_fast_state_is_no_contradiction() -> None:
    """Rows are compared with 1e-7 of what is still, of the accelerations too."""
    J = np.array([[1.0, 0.0], [1.0, 0.0]])
    for still, ax, factor in ((3.0, 0.0, 0.9), (3.0, 0.0, 1.1), (0.0, 3.0, 0.9), (0.0, 3.0, 1.1)):
        gam = np.array([0.0, factor * 3e-7])
        p: Any = Bead(0.7, 0.0)
        p.NV, p.NC = 2, 2
        given = (np.eye(2), np.array([0.0, ax]), J, gam, np.ones(2), np.ones(2))
        a, lam = reals(2), reals(2)
        found = constrained(
            *(p, 2, 1, False, 0.0, still, *(array(x.ravel()) for x in given)),
            *(a, False, lam, lam, reals(2)),
        )
        assert (found == SOLVED) is (factor < 1)


def test_steps_that_lead_too_far_are_refused() -> None:
    """A step of more than 1e4 corrects nothing."""
    step = (1 - 0.6**2) / 2 / 0.6
    p = Fine((0.6, 0.0), (0.0, 0.0))
    for p.size, closes in ((step / 0.9e4, True), (step / 1.1e4, False)):
        if closes:
            q, _ = called(project, p, p.q, p.v, sizes=(2, 2))
            assert q == pytest.approx([1.0, 0.0], abs=1e-14)
        else:
            refused(NOT_CLOSED, project, p, p.q, p.v, sizes=(2, 2))


class Fine(Particle):
    """A particle whose positions are measured in a small unit."""

    size = 1.0

    def constraint_sizes(self, of_phi: Any, of_v: Any) -> None:
        of_phi[0], of_v[0], of_v[1] = 1.0, self.size, self.size


def test_rows_of_zeros_have_the_size_one() -> None:
    A, size = reals(3), reals(1)
    p: Any = Bead(0.7, 1.5)
    pure_rows(p, 1, array([0.0] * 3), array([0.0]), array([1.0] * 3), A, size)
    assert size[0] == 1.0


def test_a_slip_is_measured_by_the_speed() -> None:
    p = on_circle(1e-3, 1.5)
    p.v = p.v * 1e6 + 1e-8 * p.q
    called(reduction, p, p.q, p.v, sizes=(2, 2))
    p.v = p.v * 1e-6 + 1e-8 * p.q
    refused(NOT_DETERMINED, reduction, p, p.q, p.v, sizes=(2, 2))
