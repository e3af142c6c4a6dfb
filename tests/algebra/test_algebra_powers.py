"""Integer and half-integer powers, exact where numbers are."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.plain_values import value

from linegraph.algebra.jets import Jet, Jets
from linegraph.algebra.powers import power, quotient
from linegraph.algebra.protocol import Floats
from linegraph.errors import ModelError
from linegraph.ir.dag import Dag

FLOATS = Floats()


@settings(derandomize=True, deadline=None)
@given(st.fractions(-5, 5, max_denominator=9).filter(bool), st.integers(-12, 12))
def test_powers_of_fractions_are_exact(base: Fraction, exponent: int) -> None:
    assert power(base, exponent, FLOATS) == base**exponent


@pytest.mark.parametrize("exponent", [Fraction(n, 2) for n in (-7, -3, -1, 1, 3, 9)])
def test_half_integer_powers_have_one_root(exponent: Fraction) -> None:
    assert power(2.25, exponent, FLOATS) == pytest.approx(2.25 ** float(exponent), rel=1e-14)


@settings(derandomize=True, deadline=None, max_examples=30)
@given(st.integers(1, 64))
def test_powers_take_as_many_products_as_repeated_squaring(exponent: int) -> None:
    dag = Dag()
    found = power(dag.symbol("x"), exponent, dag)
    assert value(found, {("x", None): 3}) == 3**exponent
    products = exponent.bit_length() - 1 + exponent.bit_count() - 1
    assert dag.count == 1 + products


def test_an_algebra_with_derivatives_takes_half_integer_powers_itself() -> None:
    found = power(Jet(0.0, 2.0, 0.0), Fraction(5, 2), Jets(Floats()))
    assert found == Jet(0, 0, 0)


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [(1, 3, Fraction(1, 3)), (Fraction(3, 2), 3, Fraction(1, 2)), (1.0, 4, 0.25)],
)
def test_quotients_are_exact_where_both_numbers_are(
    a: Fraction, b: Fraction, expected: Fraction
) -> None:
    found = quotient(a, b)
    assert found == expected
    assert type(found) is type(expected)


@pytest.mark.parametrize("zero", [0, 0.0, Fraction(0)])
def test_nothing_is_divided_by_zero(zero: float) -> None:
    with pytest.raises(ModelError, match="division by zero"):
        quotient(Dag().symbol("x"), zero)
    with pytest.raises(ModelError, match="division by zero"):
        power(zero, -2, FLOATS)


def test_numbers_that_would_explode_are_refused_before_they_do() -> None:
    assert power(2, 2048, FLOATS) == 2**2048
    with pytest.raises(ModelError, match="too large"):
        power(2, 2049, FLOATS)
    with pytest.raises(ModelError, match="too large"):
        power(Fraction(1, 10**6), 1000, FLOATS)
