"""Linear equations over the DAG: every value that is found is put into the rows it came from, exactly."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from support.plain_values import value

from linegraph.algebra.residues import Residues
from linegraph.ir.dag import Dag
from linegraph.networks.elimination import Elimination, LinearRow, eliminate

X, Y, Z = ("X", "x"), ("X", "y"), ("X", "z")
KEYS = (X, Y, Z)


def solved(rows: list[LinearRow], dag: Dag | None = None, last: Any = ()) -> Elimination:
    return eliminate(rows, dag or Dag(), Residues(), last)


def test_two_rows_of_numbers_give_two_numbers() -> None:
    """X + y = 3 and x - y = 1."""
    found = solved([LinearRow({X: 1, Y: 1}, -3), LinearRow({X: 1, Y: -1}, -1)])
    assert found.values == {X: 2, Y: 1}
    assert found.left == []
    assert found.pivots == []


matrices = st.lists(st.lists(st.integers(-3, 3), min_size=4, max_size=4), min_size=1, max_size=3)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(matrices)
def test_rows_in_letters_are_solved_as_the_same_rows_in_fractions(rows: list[list[int]]) -> None:
    """Each entry k is k times a letter of its own; letters have values, and so has the solution."""
    dag = Dag()
    at = {
        ("p", f"p{i}{j}"): Fraction(7 * i + 3 * j + 2, i + j + 3)
        for i in range(3)
        for j in range(4)
    }
    letters = [
        [k * dag.symbol("p", f"p{i}{j}") for j, k in enumerate(row)] for i, row in enumerate(rows)
    ]
    given_rows = [LinearRow({key: row[j] for j, key in enumerate(KEYS)}, row[3]) for row in letters]
    found = solved(given_rows, dag)
    numbers = [[value(x, at) for x in row] for row in letters]
    rank = sympy.Matrix(
        [[sympy.Rational(x.numerator, x.denominator) for x in row[:3]] for row in numbers]
    ).rank()
    assert len(found.values) == rank
    assert len(found.left) == len(rows) - rank
    free = {key: Fraction(5 + n) for n, key in enumerate(KEYS) if key not in found.values}
    point = {key: value(x, {**at, **free}) for key, x in found.values.items()} | free
    held = [sum(row[j] * point[key] for j, key in enumerate(KEYS)) + row[3] for row in numbers]
    if not found.left:
        assert set(held) == {0}
    else:
        left = [value(x, at) for x in found.left]
        assert any(held) == any(left)


def test_entries_of_whole_numbers_cancel_exactly() -> None:
    """2 - 49 (2/49) is not zero in floats: as a pivot what is left there would ruin y."""
    rows = [[49, 2, 10, 7], [147, 6, 7, 6], [6, 2, 49, 6]]
    found = solved([LinearRow(dict(zip(KEYS, row[:3], strict=True)), row[3]) for row in rows])
    exact = sympy.Matrix([row[:3] for row in rows]).LUsolve(-sympy.Matrix([r[3] for r in rows]))
    values = [value(found.values[key], {}) for key in KEYS]
    assert values == [Fraction(int(x.p), int(x.q)) for x in exact]


def test_pivots_of_one_come_before_letters_so_that_nothing_is_divided_by() -> None:
    """A resistor behind a source: x - R y = 0 and x = u."""
    dag = Dag()
    R, u = dag.symbol("p", "R"), dag.symbol("u", "u")
    found = solved([LinearRow({X: 1, Y: -R}, 0), LinearRow({X: 1}, -u)], dag)
    assert found.pivots == [-R]
    assert found.values[X] is u
    assert value(found.values[Y], {("p", "R"): 4, ("u", "u"): 10}) == Fraction(5, 2)


def test_what_is_zero_by_identity_is_no_pivot() -> None:
    dag = Dag()
    a, b = dag.symbol("p", "a"), dag.symbol("p", "b")
    nothing = (a + b) * (a - b) - (a * a - b * b)
    found = solved([LinearRow({X: nothing, Y: a}, -b)], dag)
    assert list(found.values) == [Y]
    assert found.pivots == [a]


def test_what_cancels_while_rows_are_subtracted_is_no_pivot_either() -> None:
    """The second row is the first times b: its rest says what must be zero."""
    dag = Dag()
    a, b, c = (dag.symbol("p", name) for name in "abc")
    found = solved([LinearRow({X: a, Y: 1}, c), LinearRow({X: a * b, Y: b}, 0)], dag)
    assert len(found.values) == 1
    (left,) = found.left
    assert value(left, {("p", "a"): 2, ("p", "b"): 3, ("p", "c"): 5}) in (15, -15)


def test_an_unknown_kept_for_last_is_left_to_the_others() -> None:
    row = LinearRow({X: 1, Y: 1}, -3)
    assert list(solved([row]).values) == [X]
    assert list(solved([row], last={X}).values) == [Y]
    both = solved([row, LinearRow({X: 1, Y: -1}, -1)], last={X})
    assert both.values == {X: 2, Y: 1}


@pytest.mark.parametrize(("owner", "unknown"), [("", X), ("x", X), ("y", Y)])
def test_a_law_is_solved_for_a_variable_of_its_own_edge(owner: str, unknown: Any) -> None:
    assert list(solved([LinearRow({X: 1, Y: 1}, 1, owner)]).values) == [unknown]


def test_the_pivot_that_fills_least_is_taken() -> None:
    """Solving the first row for x would put y and z into both other rows."""
    rows = [
        LinearRow({X: 1, Y: 1, Z: 1}, -6),
        LinearRow({X: 1, Y: -1}, 1),
        LinearRow({X: 1, Z: -1}, 2),
    ]
    found = solved(rows)
    assert found.values == {X: 1, Y: 2, Z: 3}
    assert found.steps[0][0] != X
