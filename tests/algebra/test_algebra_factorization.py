"""M = L^T D L, and the unsymmetric elimination, against exact solutions."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from support.plain_values import value

from linegraph.algebra.factorization import factored, singular, solve, solve_many
from linegraph.ir.dag import Dag

entries = st.integers(-4, 4)
squares = st.integers(1, 4).flatmap(
    lambda n: st.tuples(
        st.lists(st.lists(entries, min_size=n, max_size=n), min_size=n, max_size=n),
        st.lists(entries, min_size=n, max_size=n),
        st.permutations(range(n)),
    )
)


def exact(rows: list[list[int]]) -> list[list[Fraction]]:
    return [[Fraction(x) for x in row] for row in rows]


def definite(rows: list[list[int]]) -> list[list[Fraction]]:
    """A^T A + 1, which is positive definite."""
    size = range(len(rows))
    return [
        [Fraction(sum(rows[k][i] * rows[k][j] for k in size) + (i == j)) for j in size]
        for i in size
    ]


def times(rows: Any, x: Any) -> list[Any]:
    return [sum(a * b for a, b in zip(row, x, strict=True)) for row in rows]


@settings(derandomize=True, deadline=None, max_examples=50)
@given(squares)
def test_definite_systems_are_solved_in_any_order(made: Any) -> None:
    rows, right, outward = made
    M = definite(rows)
    found = solve(M, [Fraction(x) for x in right], outward)
    assert times(M, found.unknowns) == right
    assert all(pivot > 0 for pivot in found.pivots)


@settings(derandomize=True, deadline=None, max_examples=30)
@given(squares)
def test_pivots_multiply_to_the_determinant_and_factors_to_the_matrix(made: Any) -> None:
    rows, _, outward = made
    M = definite(rows)
    factors = factored(M, outward)
    n = len(M)
    L = [[factors.below[k].get(i, Fraction(i == k)) for i in range(n)] for k in range(n)]
    D = factors.pivots
    product = [
        [sum(L[k][i] * D[k] * L[k][j] for k in range(n)) for j in range(n)] for i in range(n)
    ]
    assert product == M
    assert [x * y for x, y in zip(D, factors.inverses, strict=True)] == [1] * n


@settings(derandomize=True, deadline=None, max_examples=30)
@given(squares)
def test_the_inverse_is_the_inverse(made: Any) -> None:
    rows, _, outward = made
    M = definite(rows)
    inverse = factored(M, outward).inverse()
    assert [times(M, column) for column in inverse] == [
        [Fraction(i == j) for i in range(len(M))] for j in range(len(M))
    ]


@settings(derandomize=True, deadline=None, max_examples=30)
@given(squares)
def test_halves_of_a_solution_give_its_products(made: Any) -> None:
    """``r . M^-1 r = y . D^-1 y`` with y from `reduced`."""
    rows, right, outward = made
    M, r = definite(rows), [Fraction(x) for x in right]
    factors = factored(M, outward)
    y = factors.reduced(r)
    x = factors.solve(r)
    assert times([r], x) == times([y], factors.scaled(y))


@settings(derandomize=True, deadline=None, max_examples=80)
@given(squares)
def test_matrices_that_are_not_symmetric_are_solved_where_no_pivot_vanishes(made: Any) -> None:
    rows, right, outward = made
    M = exact(rows)
    for size in range(1, len(M) + 1):
        block = [[M[i][j] for j in outward[-size:]] for i in outward[-size:]]
        assume(sympy.Matrix(block).det() != 0)
    rights = [[Fraction(x) for x in right], [Fraction(k) for k in range(len(M))]]
    found, pivots = solve_many(M, rights, outward, symmetric=False)
    assert [times(M, x) for x in found] == rights
    product = Fraction(1)
    for pivot in pivots:
        product *= pivot
    assert product == sympy.Matrix(rows).det()


def test_only_one_triangle_of_a_symmetric_matrix_is_read() -> None:
    M = [[Fraction(2), None], [Fraction(1), Fraction(3)]]
    assert solve(M, [Fraction(5), Fraction(10)], [0, 1]).unknowns == [1, 3]


def test_the_factor_of_a_tree_has_no_more_entries_than_its_matrix() -> None:
    """Two leaves on one root: eliminated from the leaves, nothing is put between them."""
    dag = Dag()
    m = {(i, j): dag.symbol("m", f"{i}{j}") for i in range(3) for j in range(i + 1)}
    M = [
        [m[max(i, j), min(i, j)] if 0 in (i, j) or i == j else 0 for j in range(3)]
        for i in range(3)
    ]
    factors = factored(M, [0, 1, 2])
    assert [set(row) for row in factors.below] == [set(), {0}, {0}]
    at = {("m", f"{i}{j}"): 10 * (i == j) + i + j + 1 for i, j in m}
    numbers = [[Fraction(value(x, at)) for x in row] for row in M]
    x = [value(x, at) for x in factors.solve([1, 2, 3])]
    assert times(numbers, x) == [1, 2, 3]


@pytest.mark.parametrize(
    ("rows", "first"),
    [
        ([[1.0, 2.0], [2.0, 5.0]], None),
        ([[0.0, 0.0], [0.0, 1.0]], 0),
        ([[1.0, 2.0], [2.0, 4.0]], 1),
        ([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]], 1),
    ],
)
@pytest.mark.parametrize("symmetric", [True, False])
def test_the_first_unknown_that_is_not_determined_is_named(
    rows: list[list[float]], first: int | None, symmetric: bool
) -> None:
    assert singular(rows, symmetric=symmetric) == first
