"""Algorithms of emitted code, run as they are: against NumPy, and where there is no result."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import pytest

from linegraph.ir.algorithms.beside import overshoot
from linegraph.ir.algorithms.constrained import (
    NO_INERTIA,
    NO_SOLUTION,
    RANK_TOO_LOW,
    SOLVED,
    TOO_LARGE,
    constrained,
    least_norm,
    pure_rows,
    report,
)
from linegraph.ir.algorithms.determined import determined
from linegraph.ir.algorithms.elimination import backward, eliminate, smallest_pivot
from linegraph.ir.algorithms.language import Failed, ints, larger, ratio, reals
from linegraph.ir.algorithms.sizes import is_rounding, largest_of, size_of, too_large, unit
from linegraph.ir.statuses import CONTRADICTION, NOT_FINITE, SINGULAR_INERTIA, SINGULAR_POSITION

if TYPE_CHECKING:
    from linegraph.ir.algorithms.language import ModuleAtState, Reals

NAN, INF = math.nan, math.inf
SHAPES = ((1, 1), (3, 3), (2, 5), (5, 2), (6, 6), (4, 7))


def array(values: Any) -> Reals:
    """An array of the algorithms."""
    flat = np.asarray(values, float).ravel()
    made = reals(flat.size)
    for place, value in enumerate(flat):
        made[place] = float(value)
    return made


def taken(values: Reals, *shape: int) -> Any:
    """An array of the algorithms as one of NumPy."""
    found = np.array([values[i] for i in range(len(values))])
    return found.reshape(shape) if shape else found


class Facts:
    """What algorithms know of a module that has no functions."""

    def __init__(self, NV: int, NC: int, quaternions: tuple[int, ...] = ()) -> None:
        """Of constraints and velocities there are so many."""
        self.NV, self.NC, self.quaternions = NV, NC, quaternions


def facts(NV: int, NC: int, quaternions: tuple[int, ...] = ()) -> ModuleAtState:
    return cast("ModuleAtState", Facts(NV, NC, quaternions))


# ---- numbers


def test_quotients_are_those_of_ieee() -> None:
    assert (ratio(1.0, 4.0), ratio(1.0, 0.0), ratio(-1.0, 0.0)) == (0.25, INF, -INF)
    assert ratio(1.0, -0.0) == -INF
    assert all(math.isnan(ratio(x, y)) for x, y in ((0.0, 0.0), (NAN, 0.0), (1.0, NAN)))


def test_the_larger_of_two_numbers_is_never_nan_if_one_is_a_number() -> None:
    assert (larger(1.0, 2.0), larger(2.0, 1.0), larger(-1.0, -3.0)) == (2.0, 2.0, -1.0)
    assert (larger(NAN, 1.0), larger(1.0, NAN)) == (1.0, 1.0)


def test_sizes_are_those_of_the_largest_entry() -> None:
    assert size_of(3, array([1.0, -4.0, 2.0])) == 4.0
    assert size_of(0, array([1.0])) == 0.0
    assert largest_of(3, array([1.0, -4.0, 2.0]), array([1.0, 8.0, 0.5])) == 4.0
    for bad in (NAN, INF, -INF):
        for place in range(3):
            x = array([1.0, 2.0, 3.0])
            x[place] = bad
            assert size_of(3, x) == INF
            assert largest_of(3, x, array([1.0, 1.0, 1.0])) == INF
            assert too_large(3, x) == 1
    assert largest_of(1, array([1.0]), array([0.0])) == INF


def test_numbers_whose_products_overflow_are_counted() -> None:
    assert too_large(4, array([1e99, -1e99, 0.0, 1e-300])) == 0
    assert too_large(4, array([1e101, -1e101, 0.0, NAN])) == 3


def test_rounding_is_a_small_part_of_the_terms() -> None:
    assert is_rounding(2, array([1e-14, -9e-14]), array([1.0, 1.0]))
    assert not is_rounding(2, array([1e-14, -2e-13]), array([1.0, 1.0]))
    assert not is_rounding(2, array([2e-13, 1e-14]), array([1.0, 1.0]))
    assert is_rounding(1, array([0.0]), array([0.0]))
    for r, s in ((NAN, 1.0), (0.0, NAN), (0.0, INF), (1e-30, 0.0)):
        assert not is_rounding(1, array([r]), array([s]))


def test_quaternions_get_length_one() -> None:
    q = array([5.0, 1.0, -2.0, 3.0, 4.0, 7.0, 0.0, 0.0, 3.0, -4.0])
    unit(facts(0, 0, (1, 6)), q)
    first = np.array([1.0, -2.0, 3.0, 4.0]) / math.sqrt(30)
    expected = [5.0, *first, 7.0, 0.0, 0.0, 0.6, -0.8]
    assert taken(q) == pytest.approx(expected, rel=1e-15)
    zero = array([0.0] * 4)
    unit(facts(0, 0, (0,)), zero)
    assert np.isnan(taken(zero)).all()


# ---- elimination


def test_the_factors_are_those_of_the_matrix() -> None:
    rng = np.random.default_rng(1)
    for m, n in SHAPES:
        given = rng.normal(size=(m, n))
        A, rows, columns = array(given), ints(m), ints(n)
        rank = eliminate(m, n, n, A, rows, columns, 1e-9)
        assert rank == min(m, n)
        at = np.ix_([rows[i] for i in range(m)], [columns[j] for j in range(n)])
        made = taken(A, m, n)[at]
        lower = np.tril(made[:, :rank], -1) + np.eye(m, rank)
        assert lower @ np.triu(made[:rank]) == pytest.approx(given[at], abs=1e-14)
        # complete pivoting: no factor exceeds 1, and no later entry of a row its pivot
        assert abs(lower).max() <= 1.0
        assert all(abs(made[i, i:]).max() == abs(made[i, i]) for i in range(rank))
        smallest = min(1.0, *(abs(made[i, i]) for i in range(rank)))
        assert smallest_pivot(n, rank, A, rows, columns) == smallest


def test_the_rank_is_that_of_the_matrix() -> None:
    rng = np.random.default_rng(2)
    for m, n, r in ((4, 4, 2), (5, 3, 1), (3, 6, 2), (4, 4, 0)):
        given = rng.normal(size=(m, r)) @ rng.normal(size=(r, n))
        for most in (1, n):
            A = array(given)
            assert eliminate(m, n, most, A, ints(m), ints(n), 1e-12) == min(r, most)
    assert eliminate(2, 2, 2, array([[1.0, 0.0], [0.0, 1e-3]]), ints(2), ints(2), 1e-3) == 1
    assert eliminate(2, 2, 2, array([[1.0, 0.0], [0.0, 2e-3]]), ints(2), ints(2), 1e-3) == 2


def test_solutions_are_those_of_numpy() -> None:
    rng = np.random.default_rng(3)
    for n in range(1, 7):
        A, b = rng.normal(size=(n, n)), rng.normal(size=n)
        factors, rows, columns, x = array(A), ints(n), ints(n), reals(n)
        assert eliminate(n, n, n, factors, rows, columns, 0.0) == n
        backward(n, n, factors, rows, columns, array(b), reals(n), x)
        assert taken(x) == pytest.approx(np.linalg.solve(A, b), rel=1e-10)


# ---- constraints


class System:
    """M a = f + J^T lam, J a = gam, drawn; the last `extra` rows follow from the first."""

    def __init__(self, seed: int, n: int, rows: int, extra: int) -> None:
        """Of n velocities; so many rows are independent."""
        rng = np.random.default_rng(seed)
        self.n, self.m, self.rank = n, rows + extra, rows
        B = rng.normal(size=(n, n))
        self.of_v = rng.uniform(0.5, 2.0, n)
        self.of_phi = rng.uniform(0.5, 2.0, self.m)
        self.of_phi[0] = 0.0  # a relation
        self.M = B @ B.T + n * np.eye(n)
        J = rng.normal(size=(rows, n))
        self.mix = rng.normal(size=(extra, rows))
        self.J = np.vstack([J, self.mix @ J])
        self.f = rng.normal(size=n)
        gam = rng.normal(size=rows)
        self.gam = np.concatenate([gam, self.mix @ gam])
        self.module = facts(n, self.m)

    def solved(self, *, strict: bool = True, independent: int | None = None) -> int:
        """What `constrained` returns; its outputs are attributes."""
        self.a, self.lam, self.pure = reals(self.n), reals(self.m), reals(self.m)
        self.margin = reals(2)
        given = (array(x) for x in (self.M, self.f, self.J, self.gam, self.of_phi, self.of_v))
        count = self.rank if independent is None else independent
        return constrained(
            *(self.module, self.m, count, strict, 1e-2, 0.0, *given, self.a, True),
            *(self.lam, self.pure, self.margin),
        )

    @property
    def sizes(self) -> Any:
        """Of the rows; that of a relation is its largest coefficient."""
        own = abs(self.J * self.of_v).max(axis=1)
        return np.where(self.of_phi > 0, self.of_phi, own)


SYSTEMS = ((4, 4, 2, 0), (5, 6, 3, 2), (6, 3, 1, 3), (7, 5, 4, 1), (8, 6, 6, 0), (9, 2, 1, 0))


def test_accelerations_are_those_of_the_whole_system_of_equations() -> None:
    for shape in SYSTEMS:
        s = System(*shape)
        assert s.solved() == SOLVED
        whole = np.block([[s.M, -s.J.T], [s.J, np.zeros((s.m, s.m))]])
        expected = np.linalg.lstsq(whole, np.concatenate([s.f, s.gam]), rcond=1e-10)[0]
        assert taken(s.a) == pytest.approx(expected[: s.n], rel=1e-9, abs=1e-11)
        # lstsq finds the multipliers of least norm
        assert taken(s.lam) == pytest.approx(expected[s.n :], rel=1e-8, abs=1e-10)
        forces = s.M @ expected[: s.n] - s.f
        scaled = np.linalg.lstsq((s.J / s.sizes[:, None]).T, forces, rcond=1e-10)[0]
        assert taken(s.pure) == pytest.approx(scaled, rel=1e-8, abs=1e-10)


def test_multipliers_are_found_only_if_they_are_asked_for() -> None:
    s = System(5, 6, 3, 2)
    given = [array(x) for x in (s.M, s.f, s.J, s.gam, s.of_phi, s.of_v)]
    a, lam = reals(6), array([7.0] * 5)
    found = constrained(s.module, 5, 3, True, 1e-2, 0.0, *given, a, False, lam, lam, reals(2))
    assert found == SOLVED
    assert taken(lam) == pytest.approx([7.0] * 5)


def test_margins_are_the_smallest_pivots() -> None:
    s = System(1, 2, 1, 0)
    s.J, s.of_v, s.of_phi = np.array([[0.25, 0.125]]), np.ones(2), np.array([1.0])
    s.M = np.array([[2.0, 0.0], [0.0, 3.0]])
    assert s.solved() == SOLVED
    # one motion is free, (-1/2, 1): its inertia is a sum of two terms of one sign
    assert taken(s.margin) == pytest.approx([0.25, 1.0])
    s.M = np.array([[2.0, 1.9], [1.9, 3.0]])
    assert s.solved() == SOLVED
    free = np.array([-0.5, 1.0])
    whole = abs(free) @ abs(s.M) @ abs(free)
    assert taken(s.margin) == pytest.approx([0.25, free @ s.M @ free / whole])


def test_what_cannot_be_solved_is_said() -> None:
    s = System(5, 6, 3, 2)
    assert s.solved(independent=4) == RANK_TOO_LOW
    assert s.solved(independent=4, strict=False) == SOLVED
    s.gam = s.gam + np.array([0, 0, 0, 0, 0.5])
    assert s.solved() == NO_SOLUTION
    s = System(5, 6, 3, 2)
    s.gam = s.gam + np.array([0, 0, 0, 0, 1e-4])  # less than a hundredth of its terms
    assert s.solved() == SOLVED
    s.M = np.zeros((6, 6))
    assert s.solved() == NO_INERTIA
    for name in ("M", "f", "J", "gam"):
        s = System(5, 6, 3, 2)
        for bad in (NAN, INF, -1e101):
            value = np.array(getattr(s, name), float)
            value.flat[-1] = bad
            setattr(s, name, value)
            assert s.solved() == TOO_LARGE


def test_no_motion_is_left_or_all_are() -> None:
    s = System(8, 3, 3, 0)
    assert s.solved() == SOLVED
    assert taken(s.a) == pytest.approx(np.linalg.solve(s.J, s.gam), rel=1e-9)
    s = System(8, 3, 1, 0)
    s.J, s.gam = np.zeros((1, 3)), np.zeros(1)
    assert s.solved(independent=0) == SOLVED
    assert taken(s.a) == pytest.approx(np.linalg.solve(s.M, s.f), rel=1e-9)
    assert taken(s.lam) == pytest.approx([0.0])


def test_results_are_reported_as_statuses() -> None:
    report(SOLVED)
    expected = {
        RANK_TOO_LOW: SINGULAR_POSITION,
        NO_INERTIA: SINGULAR_INERTIA,
        NO_SOLUTION: CONTRADICTION,
        TOO_LARGE: NOT_FINITE,
    }
    for result, status in expected.items():
        with pytest.raises(Failed) as caught:
            report(result)
        assert caught.value.status == status


def test_rows_become_pure_numbers() -> None:
    J = np.array([[1.0, -4.0], [3.0, 2.0], [0.0, 0.0]])
    A, size = reals(6), reals(3)
    pure_rows(facts(2, 3), 3, array(J), array([0.5, 0.0, 0.0]), array([2.0, 0.25]), A, size)
    assert taken(size) == pytest.approx([0.5, 6.0, 1.0])
    assert taken(A, 3, 2) == pytest.approx(np.array([[4.0, -2.0], [1.0, 0.5 / 6], [0.0, 0.0]]))


def test_the_least_norm_leaves_the_forces_as_they_are() -> None:
    rng = np.random.default_rng(6)
    m, n, r = 6, 4, 2
    A = rng.normal(size=(m, r)) @ rng.normal(size=(r, n))
    size, lam = rng.uniform(0.1, 10.0, m), rng.normal(size=m)
    factors, rows, columns = array(A), ints(m), ints(n)
    assert eliminate(m, n, r, factors, rows, columns, 1e-9) == r
    found = array(lam)
    least_norm(facts(n, m), m, r, factors, array(size), rows, columns, found)
    J = A * size[:, None]
    assert taken(found) @ J == pytest.approx(lam @ J, rel=1e-9)
    assert taken(found) == pytest.approx(np.linalg.pinv(J.T) @ (J.T @ lam), rel=1e-8)


def test_some_velocities_determine_all() -> None:
    rng = np.random.default_rng(7)
    n, m, own = 5, 3, (1, 4)
    J = rng.normal(size=(m, n))
    of_phi, of_v = rng.uniform(0.5, 2.0, m), rng.uniform(0.5, 2.0, n)
    right = rng.normal(size=(m + 2, 2))
    B, margin = array(np.vstack([right, np.zeros((n, 2))])), reals(1)
    given = (array(J), array(of_phi), array(of_v))
    assert determined(facts(n, m), m, *given, 2, own, 2, B, margin)
    expected = np.linalg.solve(np.vstack([J, np.eye(n)[list(own)]]), right)
    assert taken(B, m + 2 + n, 2)[:n] == pytest.approx(expected, rel=1e-9)
    pure = np.vstack([J * of_v / of_phi[:, None], np.eye(n)[list(own)]])
    rows, columns = ints(n), ints(n)
    factors = array(pure)
    eliminate(n, n, n, factors, rows, columns, 0.0)
    assert margin[0] == pytest.approx(smallest_pivot(n, n, factors, rows, columns))
    kept = array([7.0] * 10)
    assert not determined(facts(n, m), 2, *given, 2, own, 1, kept, margin)
    assert taken(kept) == pytest.approx([7.0] * 10)


def test_errors_are_taken_to_the_other_side() -> None:
    change = reals(3)
    overshoot(3, array([0.5, -0.5, 0.0]), 0.25, array([1.0, 2.0, 4.0]), change)
    assert taken(change) == pytest.approx([-0.75, 1.0, -1.0])
