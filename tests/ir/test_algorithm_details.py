"""Details of algorithms that only few models show: quaternions, margins, scales, ends of iterations."""

from __future__ import annotations

import contextlib
import math
from typing import Any

import numpy as np
import pytest
from particle import Bead, Particle, Sheet, filled
from test_algorithm_newton import Loop, loop
from test_algorithms import System, array
from test_algorithms_of_a_bead import Counted
from test_algorithms_of_a_particle import NEAR, SMALL, Odd, called, refused

from linegraph.ir.algorithms.complete import complete
from linegraph.ir.algorithms.constrained import SOLVED
from linegraph.ir.algorithms.dynamics import constrained_dynamics
from linegraph.ir.algorithms.elimination import eliminate
from linegraph.ir.algorithms.language import Failed, ints, reals
from linegraph.ir.algorithms.linearization import free_changes, linearization
from linegraph.ir.algorithms.newton import descend, is_only
from linegraph.ir.algorithms.project import approach, close, project
from linegraph.ir.algorithms.reduction import differ, reduction
from linegraph.ir.statuses import CONTRADICTION, NOT_FINITE, SINGULAR_POSITION


class Turning(Bead):
    """A bead with an orientation, which turns when the bead moves: quaternions in use are of length 1."""

    NQ = 7
    quaternions = (3,)

    def at(self, q: Any = None, v: Any = None) -> tuple[Any, Any]:
        if q is not None:
            assert math.sqrt(sum(q[3 + k] ** 2 for k in range(4))) == pytest.approx(1.0, abs=1e-14)
        return super().at(q, v)

    def coordinate_rates(self, qdot: Any, **given: Any) -> None:
        v = self.at(**given)[1]
        filled(qdot, [*v, v[1], -v[2], 0.5, v[0]])


def test_quaternions_have_length_one_wherever_they_are_used() -> None:
    p = Turning(0.7, 1.5)
    given = np.array([*(1.1 * p.q), 1.0, -2.0, 0.5, 3.0])
    for algorithm, more in ((project, (p.v,)), (complete, (p.q[1:2], p.v[1:2]))):
        q, _ = called(algorithm, p, given, *more, sizes=(7, 3))
        assert p.gap(q[:3]) == pytest.approx([0.0, 0.0], abs=1e-13)
        assert np.linalg.norm(q[3:]) == pytest.approx(1.0, abs=1e-14)


class TurningCross(Particle):
    """The same for the state beside the centre of a cross."""

    NQ = 6
    quaternions = (2,)
    turned = False

    def at(self, q: Any = None, v: Any = None) -> tuple[Any, Any]:
        if q is not None:
            self.turned = True
            assert math.sqrt(sum(q[2 + k] ** 2 for k in range(4))) == pytest.approx(1.0, abs=1e-14)
        return super().at(q, v)

    def coordinate_rates(self, qdot: Any, **given: Any) -> None:
        v = self.at(**given)[1]
        filled(qdot, [*v, 0.3, 0.1, -0.2, 0.5])


def test_so_have_those_of_a_state_beside() -> None:
    p = TurningCross((SMALL, 0.0), (1.0, 0.0), cross=True)
    called(constrained_dynamics, p, [*p.q, 0.0, 0.0, 0.0, 1.0], p.v, sizes=(2, 1))
    assert p.turned


# ---- margins and scales


def test_the_margin_of_inertia_is_the_smallest_of_all_free_motions() -> None:
    smallest = set()
    for seed in range(12):
        s = System(seed, 6, 2, 0)
        scales = np.array([1.0, 1.0, 0.1, 1.0, 0.05, 1.0])
        s.M = s.M - 0.9 * 6 * np.diag(scales)
        if np.linalg.eigvalsh(s.M).min() <= 0:
            s.M = s.M + 6 * np.eye(6)
        assert s.solved() == SOLVED
        pure = s.J * s.of_v / s.sizes[:, None]
        A, rows, columns = array(pure), ints(2), ints(6)
        assert eliminate(2, 6, 2, A, rows, columns, 1e-7) == 2
        own, free = [columns[k] for k in range(2)], [columns[k] for k in range(2, 6)]
        T = np.zeros((6, 4))
        T[free] = np.eye(4)
        T[own] = -np.linalg.solve(pure[:, own], pure[:, free])
        scaled = s.M * s.of_v * s.of_v[:, None]
        pivots = np.diag(np.linalg.cholesky(T.T @ scaled @ T)) ** 2
        parts = pivots / np.diag(abs(T).T @ abs(scaled) @ abs(T))
        assert s.margin[1] == pytest.approx(parts.min(), rel=1e-9)
        smallest.add(int(parts.argmin()))
    assert len(smallest) > 1


class Noisy(Particle):
    """A constraint twice, the second time with an error in what its acceleration must be."""

    noise = 0.0

    def constrained_equations(self, M: Any, f: Any, J: Any, gam: Any, **given: Any) -> None:
        super().constrained_equations(M, f, J, gam, **given)
        gam[1] += 2 * self.noise


def test_contradictions_are_rounding_of_the_square_of_speeds() -> None:
    for part, status in ((0.9, None), (1.1, CONTRADICTION)):
        p = Noisy((1.0, 0.0), (10.0, 0.0), cross=True, twice=True)
        p.noise = part * 1e-7 * 100 / 0.99
        if status is None:
            a, _ = called(constrained_dynamics, p, p.q, p.v, sizes=(2, 2))
            assert a[0] == pytest.approx(p.u / 2)
        else:
            refused(status, constrained_dynamics, p, p.q, p.v, sizes=(2, 2))


def test_multipliers_of_small_forces_are_judged_by_these() -> None:
    p = Particle((SMALL, 0.0), (1.0, 0.0), 0.7e-4, cross=True)
    p.weight, p.M = 0.0, 1e-4 * p.M
    refused(SINGULAR_POSITION, constrained_dynamics, p, p.q, p.v, sizes=(2, 1))


@pytest.mark.parametrize("y", [1e-6, -1e-6])
def test_a_gap_without_slip_is_seen(y: float) -> None:
    p = Particle((SMALL, y), (1.0, -y / SMALL), cross=True)
    refused(SINGULAR_POSITION, constrained_dynamics, p, p.q, p.v, sizes=(2, 1))


class Dragged(Counted):
    """A circle whose bias is odd in the velocities, in part."""

    def bend(self, v: Any) -> float:
        return super().bend(v) + 0.3 * v[1]


def test_velocities_beside_are_not_reversed() -> None:
    p = Dragged(NEAR)
    _, rest = called(reduction, p, p.q, p.v, sizes=(2, 2))
    assert p.biases > 1
    assert rest[1] == pytest.approx(p.bend(p.v) / p.q[1], rel=1e-6)


@pytest.mark.parametrize(("gap", "slip"), [(1e-8, 0.0), (0.0, 1e-8), (3e-10, 0.0), (0.0, 3e-10)])
def test_errors_are_in_the_estimate_of_the_reduction(gap: float, slip: float) -> None:
    """In proportion to the speed; where they are more than 1e-9, results may be wrong as much more."""
    off = gap or slip / 1.5
    sine = 4 * (off / (1e-6 * max(1.0, off / 1e-9))) ** (1 / 3)
    for factor in (1.02, 0.98):
        p = Counted(math.asin(factor * sine))
        p.q, p.v = p.q * math.sqrt(1 + 2 * gap), p.v + slip * p.q
        with contextlib.suppress(Failed):
            called(reduction, p, p.q, p.v, sizes=(2, 2))
        assert (p.biases > 1) is (factor < 1)


def test_only_rest_is_compared_with_the_square_of_speeds() -> None:
    p: Any = Bead(0.7, 1.5)
    of_v, B = array([1.0, 1.0, 1.0]), np.array([[1.0, 0.0], [0.5, 0.01], [0.2, 0.0]])
    for column, allowed in ((0, 1e-3), (1, 1e-3 * 0.01 * 900)):
        for factor, expected in ((0.98, False), (1.02, True)):
            other = np.array(B)
            other[0, column] += factor * allowed
            assert differ(p, 30.0, 1e-3, of_v, array(B), array(other)) is expected


# ---- linearisation


def test_changes_of_positions_change_velocities_so_that_constraints_are_kept() -> None:
    p = Sheet((0.4, 0.9), (1.5, -0.7))
    J, of_phi, of_v, slopes = reals(3), reals(1), reals(3), reals(3)
    p.constraint_jacobian(J)
    p.constraint_sizes(of_phi, of_v)
    vx, vy = p.v[1:]
    filled(slopes, [0.0, -vy / 2, -vx / 2])
    D, S = reals(12), reals(12)
    free_changes(p, J, of_phi, of_v, slopes, D, S)  # type: ignore[arg-type]
    assert [D[i] for i in range(6)] == pytest.approx(p.tangent().ravel())
    assert [S[i] for i in range(6)] == pytest.approx([vy / 2, vx / 2, 0, 0, 0, 0], abs=1e-15)


class Spoilt(Sheet):
    """A linearisation with one number that is none."""

    which = 0

    def constrained_slopes(self, *slopes: Any, **given: Any) -> None:
        super().constrained_slopes(*slopes, **given)
        array_ = slopes[self.which]
        array_[len(array_) - 1] = math.inf


@pytest.mark.parametrize("which", range(4))
def test_slopes_that_are_no_numbers_end_with_a_status(which: int) -> None:
    p = Spoilt((0.4, 0.9), (1.5, -0.7))
    p.which = which
    refused(NOT_FINITE, linearization, p, p.v, sizes=(16, 4))


class NoisySlopes(Particle):
    """A constraint twice; inputs change the second one, which nothing does."""

    noise = 0.0

    def constrained_slopes(self, f: Any, gam: Any, rates: Any, drift: Any, **given: Any) -> None:
        super().constrained_slopes(f, gam, rates, drift, **given)
        gam[9] = 2 * self.noise


def test_contradictions_of_slopes_are_rounding_of_speeds_and_accelerations() -> None:
    q = np.array([math.cos(0.7), math.sin(0.7)])
    v = 100 * np.array([-q[1], q[0]])
    p = NoisySlopes(q, v, twice=True)
    a, _ = called(constrained_dynamics, p, p.q, p.v, sizes=(2, 2))
    still = max(abs(v)) ** 2 + max(abs(a))
    direction = np.array([-q[1], q[0]])
    x = direction * direction[0] / (direction @ p.M @ direction)
    for part, status in ((0.9, None), (1.1, CONTRADICTION)):
        # the slack of a hundredth is one of all terms, those of the row included
        p.noise = 1e-2 * abs(q) @ abs(x) + part * 1e-7 * still
        if status is None:
            called(linearization, p, p.v, sizes=(4, 2))
        else:
            refused(status, linearization, p, p.v, sizes=(4, 2))


# ---- ends of iterations


def test_nothing_is_done_where_nothing_is_left_to_do() -> None:
    for law, found in (
        (lambda x, a, b: np.array([x[0] - 1]), True),
        (lambda x, a, b: np.array([x[0] + math.inf]), False),
    ):
        m = loop(1, law)
        assert descend(m, 0.0, 0.0, array([1.0])) is found
        assert len(m.seen) == 1


class Lazy(Loop):
    """A loop that says three times its slopes, so that a third of the residual goes in each step."""

    def loop_equations(self, r: Any, K: Any, s: Any, *, loop: Any, ease: Any) -> None:
        super().loop_equations(r, K, s, loop=loop, ease=ease)
        K[0] = 3 * K[0]


def test_rounding_is_followed_only_while_it_halves() -> None:
    m: Any = Lazy(1, lambda x, a, b: np.array([x[0]]))
    assert descend(m, 0.0, 0.0, array([1e-14]))
    assert len(m.seen) == 2


def test_rounding_is_not_left_for_more_of_it() -> None:
    """What is solved moves only to where less is left."""
    m = loop(1, lambda x, a, b: np.array([1e-14 * (x[0] if x[0].real == 1.0 else 5 + x[0])]))
    at = array([1.0])
    assert descend(m, 0.0, 0.0, at)
    assert at[0] == 1.0


def test_terms_of_no_size_do_not_hide_another_solution() -> None:
    assert not is_only(loop(1, lambda x, a, b: np.array([b * x[0]]), 0.0), array([7.0]))


class CountedCurve(Odd):
    """It counts how often gaps are asked for."""

    asked = 0

    def constraints(self, phi: Any, **given: Any) -> None:
        self.asked += 1
        super().constraints(phi, **given)


def test_a_step_is_what_was_taken_of_it() -> None:
    p: Any = CountedCurve((0.2, 1.0), (1.0, 0.0))
    whole = -p.gap(p.q) / p.normal(p.q)[1]
    step, phi, at = array([0.0, whole]), reals(1), array(p.q)
    after = approach(p, p.gap(p.q), array([1.0]), step, phi, at)
    count = p.asked - 1
    assert count > 1
    assert step[1] == pytest.approx(whole * 0.5**count)
    assert at[1] == pytest.approx(1 + whole * 0.5**count)
    assert after == abs(phi[0]) == pytest.approx(abs(p.gap([0.2, at[1]])))


class Stuck(CountedCurve):
    """The slope of its gap has the wrong sign."""

    def normal(self, q: Any) -> Any:
        return -super().normal(q)


def test_where_no_step_helps_the_search_ends() -> None:
    p: Any = Stuck((0.2, 1.0), (1.0, 0.0))
    with pytest.raises(Failed):
        close(p, array([1.0]), array([1.0, 1.0]), array(p.q))
    assert p.asked == 1 + 12
