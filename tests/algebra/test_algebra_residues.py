"""Residues keep the arithmetic of fractions, and spans that of linear algebra."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from linegraph.algebra.residues import PRIME, Residues, Span, inverse, of_number, rank
from linegraph.ir.dag import Dag

fractions = st.fractions(-50, 50, max_denominator=40)


@settings(derandomize=True, deadline=None)
@given(fractions, fractions)
def test_residues_of_numbers_add_and_multiply_as_the_numbers_do(a: Fraction, b: Fraction) -> None:
    assert of_number(a + b) == (of_number(a) + of_number(b)) % PRIME
    assert of_number(a * b) == of_number(a) * of_number(b) % PRIME
    assert (of_number(a) == of_number(b)) == (a == b)


def test_a_float_is_what_its_digits_say() -> None:
    assert of_number(0.1) == of_number(Fraction(1, 10))
    assert of_number(1e-12) == of_number(Fraction(1, 10**12))


def test_an_inverse_times_its_residue_is_one_and_that_of_zero_is_zero() -> None:
    assert [inverse(x) * x % PRIME for x in (1, 2, 12345, PRIME - 1)] == [1] * 4
    assert inverse(0) == 0


DAG = Dag()
X, Y = DAG.symbol("x"), DAG.symbol("y")


@pytest.mark.parametrize(
    "zero",
    [
        (X + Y) * (X + Y) - X * X - 2 * (X * Y) - Y * Y,
        (X * X - Y * Y) / (X - Y) - X - Y,
        DAG.sin(X) * DAG.sin(X) + DAG.cos(X) * DAG.cos(X) - 1,
        DAG.sin(-X) + DAG.sin(X),
        1 / (1 / X) - X,
        DAG.symbol("c", "1/3") * 3 - 1,
        DAG.function("exp", X + Y) - DAG.function("exp", Y + X),
        -(X - Y) - (Y - X),
    ],
)
def test_what_is_zero_by_identity_has_residue_zero(zero: Any) -> None:
    assert Residues()(zero) == 0


@pytest.mark.parametrize(
    "other",
    [
        X - Y,
        DAG.sin(X) - DAG.cos(X),
        DAG.sin(X) * DAG.sin(X) + DAG.cos(Y) * DAG.cos(Y) - 1,
        DAG.symbol("c", "1/3") * 2 - 1,
        DAG.symbol("x", 1) - DAG.symbol("x", 2),
        DAG.function("exp", X) - DAG.function("log", X),
        DAG.function("max", X, Y) - DAG.function("max", X, X),
        X / Y - Y / X,
    ],
)
def test_what_is_not_zero_has_another(other: Any) -> None:
    assert Residues()(other) != 0


def test_residues_do_not_depend_on_the_order_of_questions() -> None:
    first, second = Residues(), Residues()
    second(X * Y)
    assert first((X + 1) / Y) == second((X + 1) / Y)


matrices = st.lists(st.lists(st.integers(-3, 3), min_size=3, max_size=3), min_size=1, max_size=5)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(matrices)
def test_the_rank_is_that_of_sympy(rows: list[list[int]]) -> None:
    assert rank([dict(enumerate(row)) for row in rows]) == sympy.Matrix(rows).rank()


@settings(derandomize=True, deadline=None, max_examples=60)
@given(matrices)
def test_dependent_rows_come_with_the_combination_that_vanishes(rows: list[list[int]]) -> None:
    span = Span()
    for name, row in enumerate(rows):
        size = len(span)
        made = span.add(dict(enumerate(row)), name)
        assert len(span) == size + (made is None)
        assert span.holds(dict(enumerate(row)))
        if made is not None:
            assert made[name] == 1
            total = [sum(k * rows[n][j] for n, k in made.items()) % PRIME for j in range(3)]
            assert total == [0, 0, 0]


def test_a_span_holds_what_it_spans_only() -> None:
    span = Span()
    span.add({"a": 1, "b": 2}, 0)
    span.add({"b": 1, "c": -1}, 1)
    assert span.holds({"a": 1, "c": 2})
    assert span.holds({})
    assert not span.holds({"c": 1})
