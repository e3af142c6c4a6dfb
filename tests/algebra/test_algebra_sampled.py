"""Linear algebra over scalars with samples, against the same in fractions."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from support.plain_values import value

from linegraph.algebra.sampled import Traced, closed, kernel, reduced, size, traced
from linegraph.algebra.sampled import given as sampled
from linegraph.ir.dag import Dag

SAMPLES = ((0.7, -1.3), (1.9, 0.4))
"""Values of x and of y at two samples."""


def letters() -> tuple[Any, Any]:
    dag = Dag()
    return tuple(
        sampled(dag.symbol(name), [sample[n] for sample in SAMPLES], 0.0)
        for n, name in enumerate("xy")
    )  # type: ignore[return-value]


def worth(x: Any, sample: int = 0) -> float:
    """The value of an expression, by its node."""
    node = x.node if isinstance(x, Traced) else x
    x0, y0 = SAMPLES[sample]
    return float(value(node, {("x", None): x0, ("y", None): y0}))


@pytest.mark.parametrize(
    "f",
    [
        lambda x, y: x * y + 3 * x - y / 2,
        lambda x, y: (x - y) / (x + y),
        lambda x, y: 1 / x - 2 / y,
        lambda x, y: 5 - x * (x - Fraction(1, 3)),
        lambda x, y: -(x + 1) * (1 + y),
    ],
)
def test_values_go_with_expressions(f: Any) -> None:
    found = f(*letters())
    for n, sample in enumerate(SAMPLES):
        assert found.values[n] == pytest.approx(f(*sample), rel=1e-14)
        assert worth(found, n) == pytest.approx(f(*sample), rel=1e-14)


def test_what_cancels_is_zero_and_what_is_whole_is_that_number() -> None:
    x, y = letters()
    assert (x + y) * (x - y) - x * x + y * y == 0
    assert (x + 3) * (1 / (x + 3)) == 1
    assert x - x == 0
    assert x + 0 is x
    assert 0 * x == 0


def test_bounds_of_errors_hold() -> None:
    """Against the same sums in fractions of the floats that were given."""
    x, y = letters()
    found = (x * y - y) * x + x / y
    a, b = (Fraction(value) for value in SAMPLES[0])
    exact = (a * b - b) * a + a / b
    error = abs(Fraction(found.values[0]) - exact)
    assert error <= 16 * Fraction(found.errors[0])
    assert found.errors[0] < 1e-14


def test_errors_of_factors_are_errors_of_products_and_quotients() -> None:
    """To first order: of x y the error of y times x and that of x times y, of 1/x that of x over x^2."""
    dag = Dag()
    x, y = sampled(dag.symbol("x"), [2.1], 1e-6), sampled(dag.symbol("y"), [5.1], 1e-3)
    assert (x * y).errors[0] == pytest.approx(2.1e-3 + 5.1e-6)
    assert (x + y).errors[0] == pytest.approx(1e-3 + 1e-6)
    assert (1 / x).errors[0] == pytest.approx(1e-6 / 2.1**2)


def test_a_number_within_its_error_is_whole_at_all_samples_or_none() -> None:
    assert traced("n", [2.0 + 1e-12, 2.0], [1e-12, 1e-15]) == 2
    assert isinstance(traced("n", [2.0 + 1e-10, 2.0], [1e-12, 1e-15]), Traced)
    assert isinstance(traced("n", [2.0, 3.0], [1e-15, 1e-15]), Traced)
    assert isinstance(traced("n", [100.0, 100.0], [1e-15, 1e-15]), Traced)


def test_sizes_are_those_at_the_first_sample() -> None:
    _, y = letters()
    assert size(y) == 1.3
    assert size(-3) == 3.0


matrices = st.lists(st.lists(st.integers(-3, 3), min_size=4, max_size=4), min_size=1, max_size=4)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(matrices)
def test_kernels_of_numbers_are_those_of_sympy(rows: list[list[int]]) -> None:
    found = kernel(rows, 4)
    assert len(found) == len(sympy.Matrix(rows).nullspace())
    for x in found:
        assert all(sum(a * b for a, b in zip(row, x, strict=True)) == 0 for row in rows)
    assert not found or sympy.Matrix(found).rank() == len(found)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(matrices)
def test_reduced_rows_span_the_same_space_with_one_entry_in_each_pivot_column(
    rows: list[list[int]],
) -> None:
    done, pivots = reduced(rows)
    rank = sympy.Matrix(rows).rank()
    assert len(done) == len(pivots) == rank
    for n, pivot in enumerate(pivots):
        assert [row[pivot] for row in done] == [int(k == n) for k in range(rank)]
    assert not done or sympy.Matrix([*rows, *done]).rank() == rank


def test_the_kernel_of_letters_is_orthogonal_to_them_at_every_sample() -> None:
    x, y = letters()
    rows = [[x, y, 1], [x * x, x * y, x + y]]
    (found,) = kernel(rows, 3)
    for n in range(len(SAMPLES)):
        for row in rows:
            total = sum(worth(a, n) * worth(b, n) for a, b in zip(row, found, strict=True))
            assert math.isclose(total, 0, abs_tol=1e-12)


def test_pivots_come_from_the_columns_asked_for_first() -> None:
    _, free = reduced([[3, 1, 0]])
    _, asked = reduced([[3, 1, 0]], order=[0, 1, 2])
    assert (free, asked) == ([1], [0])


def test_a_small_entry_among_its_kind_is_no_pivot() -> None:
    _, pivots = reduced([[1, 10]], order=[0, 1], kinds=["m", "m"])
    assert pivots == [1]
    _, pivots = reduced([[1, 10]], order=[0, 1], kinds=["m", "rad"])
    assert pivots == [0]


def test_a_space_is_closed_when_the_action_leads_nowhere_else() -> None:
    """Turning about the third axis: two directions from one, and the axis stays alone."""

    def turn(row: list[Any]) -> list[Any]:
        return [-row[1], row[0], 0]

    assert len(closed([[1, 2, 0]], turn)) == 2
    assert closed([[0, 0, 1]], turn) == [[0, 0, 1]]
