"""Trigonometric forms: fewer terms, worth the same."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from rings import expression, k, m, polynomial, same, u, w, x, y, z
from sympy import cos, sin

from linegraph.symbolic.simplification.angles import fewest, harmonic_sum, merged, spread
from linegraph.symbolic.simplification.polynomial import Ring

if TYPE_CHECKING:
    from collections.abc import Callable


def rewritten(e: Any, how: Callable[..., Any] = merged, **more: Any) -> Any:
    """What a rewriting makes of an expression, as a sum."""
    ring = Ring()
    return expression(ring, how(ring, polynomial(ring, e).terms, **more))


@pytest.mark.parametrize(
    ("e", "expected"),
    [
        (m - m * sin(x) ** 2, m * cos(x) ** 2),
        (m - 2 * m * sin(x) ** 2, m * cos(2 * x)),
        (cos(x) * cos(y) - sin(x) * sin(y), cos(x + y)),
        (cos(x) * cos(y) + sin(x) * sin(y), cos(x - y)),
        (k * sin(x) * cos(y) + k * cos(x) * sin(y), k * sin(x + y)),
        (sin(x) * cos(y) - cos(x) * sin(y), sin(x - y)),
        (-sin(x) * cos(y) + cos(x) * sin(y), -sin(x - y)),
        (6 * sin(x) * cos(x), 3 * sin(2 * x)),
        (u * cos(x + y) * cos(z) - u * sin(x + y) * sin(z), u * cos(x + y + z)),
        (0.1 - 0.1 * sin(x) ** 2, 0.1 * cos(x) ** 2),
    ],
)
def test_two_terms_that_are_one_are_put_together(e: Any, expected: Any) -> None:
    assert rewritten(e) - expected == 0


@pytest.mark.parametrize(
    "e", [m - k * sin(x) ** 2, cos(x) * cos(y) + 2 * sin(x) * sin(y), m + m * sin(x) ** 2, sin(x)]
)
def test_what_fits_no_rule_stays(e: Any) -> None:
    assert sympy.expand(rewritten(e) - e) == 0


def test_double_angles_arise_only_where_they_may() -> None:
    e = sin(x) * cos(x)
    assert rewritten(e, doubled=True) == sin(2 * x) / 2
    assert rewritten(e, doubled=False) == e


@st.composite
def sums(draw: st.DrawFn) -> Any:
    """A few products of sines and cosines, rates and numbers."""
    waves = [sin(x), cos(x), sin(y), cos(y), sin(x + y), cos(x - y), cos(z)]
    total = sympy.Integer(0)
    for _ in range(draw(st.integers(1, 4))):
        product = draw(st.sampled_from([1, -1, 2, m, u * w]))
        for _ in range(draw(st.integers(1, 3))):
            product = product * draw(st.sampled_from(waves))
        total += product
    return total


@settings(derandomize=True, deadline=None, max_examples=40)
@given(sums(), st.sampled_from([merged, fewest, spread]))
def test_no_value_changes(e: Any, how: Any) -> None:
    assert same(rewritten(e, how), e)


@settings(derandomize=True, deadline=None, max_examples=30)
@given(sums())
def test_no_form_has_more_terms_than_the_one_before(e: Any) -> None:
    ring = Ring()
    terms = polynomial(ring, e).terms
    together = merged(ring, terms)
    assert len(together) <= len(terms)
    assert len(fewest(ring, terms)) <= len(together)


@settings(derandomize=True, deadline=None, max_examples=30)
@given(sums())
def test_spread_terms_have_one_sine_or_cosine_at_most(e: Any) -> None:
    ring = Ring()
    for term in spread(ring, polynomial(ring, e).terms):
        waves = [e for place, e in ring.exponents(term) if ring.is_wave(place)]
        assert sum(waves) <= 1


def test_other_angles_are_found_where_they_leave_fewer_terms() -> None:
    """The heights of a chain in joint angles, multiplied out."""
    chain = m * sin(x) + k * sin(x + y) + m * k * cos(x + y) * cos(z) - m * k * sin(x + y) * sin(z)
    ring = Ring()
    found = fewest(ring, polynomial(ring, chain).terms)
    assert len(found) == 3
    assert same(expression(ring, found), chain)


@pytest.mark.parametrize(
    ("e", "together", "least"),
    [
        (k * sin(x) + m * sin(x + y) ** 2, 4, 2),
        (m * cos(x + y) ** 3, 5, 1),
        (m * sin(x - y) ** 2 + k * cos(x - y), 4, 2),
    ],
)
def test_powers_of_sums_of_angles_are_found_in_these_sums(
    e: Any, together: int, least: int
) -> None:
    ring = Ring()
    terms = polynomial(ring, e).terms
    assert len(merged(ring, terms)) == together
    found = fewest(ring, terms)
    assert len(found) == least
    assert same(expression(ring, found), e)


def test_the_search_takes_no_more_work_than_it_may() -> None:
    ring = Ring()
    terms = polynomial(ring, (sin(x) + cos(y) + sin(z) + m) ** 4).terms
    begin = ring.work
    fewest(ring, terms)
    assert ring.work - begin < 200_000


@pytest.mark.parametrize(
    ("a", "b", "sign", "total"),
    [
        (((0, 1),), ((1, 2),), 1, ((0, 1), (1, 2))),
        (((0, 1),), ((0, 1),), -1, ()),
        (((0, 1), (2, 3)), ((0, 1), (1, 1)), -1, ((1, -1), (2, 3))),
        (((1, 1),), ((0, 2),), -1, ((0, -2), (1, 1))),
    ],
)
def test_harmonics_add_angle_by_angle(a: Any, b: Any, sign: int, total: Any) -> None:
    assert harmonic_sum(a, b, sign) == total
