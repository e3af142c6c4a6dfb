"""The ring of polynomials against sympy: what is equal has equal terms, and each is worth what it was."""

from __future__ import annotations

from typing import Any

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from rings import expression, k, l, m, polynomial, same, x, y, z
from sympy import cos, sin, sqrt

from linegraph.symbolic.simplification.generators import ZERO_DIGIT, Swollen, TooHigh, unit
from linegraph.symbolic.simplification.polynomial import MOST_ANGLES, Ring, frozen


@st.composite
def expressions(draw: st.DrawFn) -> Any:
    """Sums, products and quotients of symbols, sines and cosines of sums of angles."""
    parts: list[Any] = [x, m, k, sin(x), cos(x - y), sin(2 * y), sympy.Rational(1, 2), sqrt(m + 1)]
    for _ in range(draw(st.integers(1, 6))):
        a, b = draw(st.sampled_from(parts)), draw(st.sampled_from(parts))
        form = draw(st.integers(0, 3))
        parts.append((a + b, a - b, a * b, a / (2 + m * m))[form])
    return parts[-1]


@settings(derandomize=True, deadline=None, max_examples=40)
@given(expressions())
def test_a_polynomial_is_worth_what_it_was_made_of(e: Any) -> None:
    ring = Ring()
    assert same(expression(ring, polynomial(ring, e).terms), e)


@settings(derandomize=True, deadline=None, max_examples=40)
@given(expressions())
def test_an_expression_less_itself_multiplied_out_has_no_terms(e: Any) -> None:
    ring = Ring()
    assert polynomial(ring, e).terms == polynomial(ring, sympy.expand(e)).terms


@pytest.mark.parametrize(
    ("a", "b"),
    [
        ((m + k) ** 2, m**2 + 2 * m * k + k**2),
        (sin(x) ** 2 + cos(x) ** 2, 1),
        (sin(x + y), sin(x) * cos(y) + cos(x) * sin(y)),
        (cos(x - y), cos(x) * cos(y) + sin(x) * sin(y)),
        (sin(3 * x), 3 * sin(x) - 4 * sin(x) ** 3),
        (cos(-2 * x), 1 - 2 * sin(x) ** 2),
        (sin(m - k), -sin(k - m)),
        (cos(m - k), cos(k - m)),
        (sqrt(m + k) ** 2, m + k),
        (sqrt(m) ** 3 / m, sqrt(m)),
        (1 / (2 * m + 2 * k), 1 / (m + k) / 2),
        (m / (m * m + m * k), 1 / (m + k)),
        ((x + y) / (x + y), 1),
        (cos(x) ** 4, 1 - 2 * sin(x) ** 2 + sin(x) ** 4),
    ],
)
def test_what_is_equal_has_the_same_terms(a: Any, b: Any) -> None:
    ring = Ring()
    assert polynomial(ring, a).terms == polynomial(ring, sympy.sympify(b)).terms


def test_the_sine_of_the_other_difference_is_the_negative() -> None:
    ring = Ring()
    a, b = ring.symbol("p", "a"), ring.symbol("p", "b")
    assert (ring.poly(ring.sin(a - b)) + ring.sin(b - a)).terms == {}
    assert (ring.poly(ring.cos(a - b)) - ring.cos(b - a)).terms == {}


def test_an_angle_with_a_number_has_its_sine_and_cosine_outside() -> None:
    ring = Ring()
    turned = ring.sin(ring.symbol("q", 0) + 2)
    assert len(ring.poly(turned).terms) == 2
    assert float(sympy.N(expression(ring, ring.poly(turned).terms).subs(x, 0.5))) == pytest.approx(
        float(sin(2.5))
    )


def test_sums_of_parameters_and_long_sums_stay_one_angle() -> None:
    ring = Ring()
    assert len(polynomial(ring, sin(m + k)).terms) == 1
    long = sum((ring.symbol("q", n) for n in range(MOST_ANGLES + 1)), ring.poly(0))
    assert len(ring.poly(ring.cos(long)).terms) == 1


def test_the_last_entry_of_a_unit_quaternion_is_the_rest_of_its_square() -> None:
    ring = Ring()
    ring.normalise([("q", n) for n in range(4)])
    a, b, c, d = (ring.symbol("q", n) for n in range(4))
    assert (a * a + b * b + c * c + d * d).terms == {0: 1}
    assert (d * d * d).terms == (d - d * (a * a + b * b + c * c)).terms


@pytest.mark.parametrize("exponent", [-7, -1, 1, 2, 300])
def test_exponents_are_the_digits_of_a_term(exponent: int) -> None:
    ring = Ring()
    first, second = (ring.generator("symbol", ("p", name)) for name in "ab")
    term = unit(first, exponent) + unit(second, -2)
    assert dict(ring.exponents(term)) == {first: exponent, second: -2}
    assert ring.exponent(term, first) == exponent
    assert ring.exponent(term, second) == -2


def test_a_sum_in_a_denominator_is_one_generator_whatever_its_factor() -> None:
    ring = Ring()
    made = polynomial(ring, 1 / (m + k) + l / (3 * m + 3 * k))
    inverses = [generator for generator in ring.generators if generator.kind == "inverse"]
    assert len(inverses) == 1
    assert len(made.terms) == 2


def test_a_quotient_by_zero_is_refused() -> None:
    ring = Ring()
    a = ring.symbol("p", "a")
    with pytest.raises(ZeroDivisionError):
        _ = 1 / (a - a)


def test_a_common_factor_comes_out_and_leaves_one_in_front() -> None:
    ring = Ring()
    common, inner = ring.primitive(polynomial(ring, 6 * m**2 * k + 4 * m * k * l).terms)
    whole = expression(ring, common) * expression(ring, inner)
    assert sympy.expand(whole - 6 * m**2 * k - 4 * m * k * l) == 0
    assert inner[min(inner)] == 1
    assert all(exponent >= 0 for term in inner for _, exponent in ring.exponents(term))
    ((factor, _),) = common.items()
    assert expression(ring, {factor: 1}) == k * m


def test_negative_powers_are_cleared_or_left_as_asked() -> None:
    ring = Ring()
    terms = polynomial(ring, m / k + m).terms
    cleared, kept = (ring.primitive(terms, clear=clear)[0] for clear in (True, False))
    assert [expression(ring, dict.fromkeys(c, 1)) for c in (cleared, kept)] == [m / k, m]


def test_work_beyond_the_budget_is_stopped() -> None:
    ring = Ring(budget=30)
    total = sum((ring.symbol("p", str(n)) for n in range(5)), ring.poly(1))
    assert (total + 0).terms
    with pytest.raises(Swollen):
        _ = total * total
    assert ring.work >= 30


def test_a_power_that_terms_cannot_hold_is_too_high() -> None:
    ring = Ring()
    big = ring.symbol("p", "a")
    while True:
        exponent = ring.exponent(max(big.terms), 0)
        if 2 * exponent >= ZERO_DIGIT:
            break
        big = big * big
    with pytest.raises(TooHigh):
        _ = big * big


def test_functions_of_numbers_are_numbers_and_others_one_term() -> None:
    ring = Ring()
    assert ring.function("max", 2, 5) == 5
    assert ring.cos(0) == 1
    a = ring.symbol("p", "a")
    found = ring.function("atan2", a, a * 2)
    assert len(ring.poly(found).terms) == 1
    assert frozen(ring.poly(found)) == frozen(ring.poly(ring.function("atan2", a, a + a)))
    assert frozen(ring.poly(found)) != frozen(ring.poly(ring.function("atan2", a * 2, a)))


def test_floats_that_are_not_whole_make_a_ring_inexact() -> None:
    ring = Ring()
    _ = ring.symbol("p", "a") * 2.0
    assert not ring.inexact
    _ = ring.symbol("p", "a") * 0.1
    assert ring.inexact


def test_sines_of_three_coordinates_are_taken_apart() -> None:
    ring = Ring()
    made = polynomial(ring, sin(x + y - 2 * z))
    assert same(expression(ring, made.terms), sin(x + y - 2 * z))
    assert len(made.terms) > 4
