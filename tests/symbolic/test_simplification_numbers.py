"""Coefficients: exact where they are, and free of rounding where they are not."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linegraph.symbolic.simplification.numbers import gather, near, plain, readable, reciprocal


@settings(derandomize=True, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 3), st.fractions(-3, 3, max_denominator=5)), max_size=12))
def test_gathered_terms_are_sums_without_zeros(parts: list[tuple[int, Fraction]]) -> None:
    terms: dict[int, Any] = {}
    for term, k in parts:
        gather(terms, term, k)
    sums = {n: sum(k for term, k in parts if term == n) for n in range(4)}
    assert terms == {n: total for n, total in sums.items() if total}


def test_what_rounding_leaves_of_floats_is_no_term() -> None:
    terms: dict[int, Any] = {0: 0.1 + 0.2}
    gather(terms, 0, -0.3)
    assert terms == {}
    gather(terms, 0, 0.3)
    gather(terms, 0, -0.3 + 1e-9)
    assert terms == {0: pytest.approx(1e-9)}


@pytest.mark.parametrize(
    ("given_number", "expected"),
    [
        (2.0, 2),
        (Fraction(6, 3), 2),
        (0.5, 0.5),
        (Fraction(1, 3), Fraction(1, 3)),
        (1e16, 1e16),
        (True, 1),
    ],
)
def test_whole_numbers_are_integers(given_number: Any, expected: Any) -> None:
    found = plain(given_number)
    assert found == expected
    assert type(found) is type(expected)


@pytest.mark.parametrize(
    ("given_number", "expected"),
    [
        (Fraction(2.4), 2.4),
        (1 / Fraction(2.4), 1 / 2.4),
        (Fraction(355, 113), Fraction(355, 113)),
        (Fraction(2**41), 2**41),
        (-Fraction(0.1), -0.1),
    ],
)
def test_fractions_of_floats_are_decimals_again(given_number: Any, expected: Any) -> None:
    found = readable(given_number)
    assert found == expected
    assert type(found) is type(expected)


@pytest.mark.parametrize(
    ("given_number", "expected"),
    [
        (3 * (1 - 1e-15), 3),
        (2.0000001, 2.0000001),
        (1e-15, 1e-15),
        (Fraction(1, 2), Fraction(1, 2)),
        (-7.0, -7),
    ],
)
def test_a_float_beside_a_whole_number_is_that(given_number: Any, expected: Any) -> None:
    found = near(given_number)
    assert found == expected
    assert type(found) is type(expected)


@pytest.mark.parametrize(
    ("given_number", "expected"),
    [(4, Fraction(1, 4)), (Fraction(1, 3), 3), (-1, -1), (0.3, 1 / 0.3)],
)
def test_reciprocals_are_exact_where_numbers_are(given_number: Any, expected: Any) -> None:
    found = reciprocal(given_number)
    assert found == expected
    assert type(found) is type(expected)
