"""Writing terms: as books do, and worth what the terms are."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from rings import SYMBOLS, expression, k, l, m, polynomial, same, u, w, x, y
from sympy import cos, sin, sqrt

from linegraph.symbolic.simplification.factoring import SympyWriter, in_decimals, number
from linegraph.symbolic.simplification.polynomial import Ring


def writer(ring: Ring) -> SympyWriter:
    return SympyWriter(ring, SYMBOLS.__getitem__)


def written(e: Any) -> Any:
    ring = Ring()
    return writer(ring).written(polynomial(ring, e).terms)


@pytest.mark.parametrize(
    "book",
    [
        m * (k + l),
        l * m * sin(x) * (2 * u * w + w**2),
        (k + l**2 * m) * sin(x) ** 2,
        (k + l**2 * m) * sin(x) + m * u,
        -m * (k + l),
        2 * m * (k + l) / 3,
        m * l * u**2 * sin(x) - k * y,
        (k + m) * (k + l),
        m * sqrt(k + l),
        m / (k + l),
        k * m + l / k,
        k * sin(x) + l * cos(y) + m,
        m * sympy.Max(k, l),
    ],
)
def test_a_books_form_multiplied_out_is_written_as_the_book_has_it(book: Any) -> None:
    found = written(sympy.expand(book))
    assert same(found, book)
    assert sympy.count_ops(found) <= sympy.count_ops(book)


@st.composite
def sums(draw: st.DrawFn) -> Any:
    """Products of sums, multiplied out, with whole, broken or decimal numbers."""
    factors = [m + k, l - 2, m * k + 3 * l, u + w, sin(x) + m, u * w, cos(y), m * sin(x)]
    total = sympy.Integer(0)
    for _ in range(draw(st.integers(1, 3))):
        product = draw(st.sampled_from([1, -2, sympy.Rational(3, 4), 6]))
        for _ in range(draw(st.integers(1, 3))):
            product = product * draw(st.sampled_from(factors))
        total += product
    return sympy.expand(total)


@settings(derandomize=True, deadline=None, max_examples=50)
@given(sums())
def test_what_is_written_is_worth_its_terms_and_no_longer(e: Any) -> None:
    ring = Ring()
    terms = polynomial(ring, e).terms
    found = writer(ring).written(terms)
    assert same(found, e)
    assert sympy.count_ops(found) <= sympy.count_ops(expression(ring, terms))


@settings(derandomize=True, deadline=None, max_examples=30)
@given(sums())
def test_a_plain_sum_is_worth_its_terms(e: Any) -> None:
    ring = Ring()
    found = writer(ring).expanded(polynomial(ring, e).terms)
    assert same(found, e)


def test_terms_are_collected_in_products_of_rates() -> None:
    """Coriolis terms: one coefficient for both products."""
    e = m * l * sin(x) * u * w * 2 + m * l * sin(x) * w**2 + k * u
    found = written(e)
    assert found == l * m * w * (2 * u + w) * sin(x) + k * u


def test_an_inertia_that_two_functions_share_is_one_factor() -> None:
    e = sympy.expand((k + m * l**2) * (sin(x) + y))
    found = written(e)
    assert same(found, e)
    assert found.has(k + l**2 * m)


def test_the_sign_goes_where_fewer_are_left() -> None:
    assert str(written(-m * k - m * l)) == "-m*(k + l)"
    assert str(written(m * k - m * l)) in ("m*(k - l)", "-m*(l - k)", "m*(-l + k)")


def test_floats_that_agree_are_taken_out_together() -> None:
    found = written(9.81 * m + 9.81 * k)
    assert found.atoms(sympy.Float) == {sympy.Float(9.81)}
    assert len(list(sympy.preorder_traversal(found))) == 5


def test_parameters_are_constant_and_rates_move() -> None:
    ring = Ring()
    made = writer(ring)
    polynomial(ring, sqrt(m + k) + sqrt(m + x) + sin(x) + u)
    places = {
        str(made.generator(n)): (made.constant(n), made.moves(n))
        for n in range(len(ring.generators))
    }
    assert places["m"] == (True, False)
    assert places["x"] == (False, False)
    assert places["u"] == (False, True)
    assert places["sqrt(k + m)"] == (True, False)
    assert places["sqrt(m + x)"] == (False, False)
    assert places["sin(x)"] == (False, False)


@pytest.mark.parametrize(
    ("given_number", "expected"),
    [(3, sympy.Integer(3)), (Fraction(2, 3), sympy.Rational(2, 3)), (0.1, sympy.Float(0.1))],
)
def test_numbers_are_sympys(given_number: Any, expected: Any) -> None:
    assert number(given_number) == expected
    assert type(number(given_number)) is type(expected)


def test_fractions_that_came_of_floats_are_decimals_again() -> None:
    long = Fraction(0.1)
    e = sympy.Rational(long.numerator, long.denominator) * m + sympy.Rational(1, 3) * k
    assert in_decimals(e) == sympy.Float(0.1) * m + k / 3
