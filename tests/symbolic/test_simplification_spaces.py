"""Polynomials as sympy's: cleared of denominators, and without common factors."""

from __future__ import annotations

from typing import Any

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from rings import expression, k, l, m, polynomial, x
from sympy import cos, sin, sqrt

from linegraph.symbolic.simplification.polynomial import Ring
from linegraph.symbolic.simplification.spaces import Space, coprime


def space_of(*given_expressions: Any) -> tuple[Ring, Space, list[Any]]:
    ring = Ring()
    row = [polynomial(ring, sympy.sympify(e)) for e in given_expressions]
    space = Space(ring, row)
    return ring, space, space.cleared(row)


def back(ring: Ring, space: Space, element: Any) -> Any:
    return expression(ring, space.terms(element)[0])


@pytest.mark.parametrize(
    "row",
    [
        (m, k / 2),
        (m / k, l),
        (1 / (m + k), 1),
        (m / (m + k) + 1 / l, k),
        (1 / (m + k) ** 2, 1 / (m + k)),
        (1 / (1 + 1 / (m + k)), l),
        (sympy.Rational(2, 3) * m, sympy.Rational(1, 4)),
        ((m + k) ** 2 / l, 1 / (m + k) + m),
    ],
)
def test_a_row_is_cleared_by_one_factor_for_all_of_it(row: Any) -> None:
    ring, space, cleared = space_of(*row)
    first, second = (back(ring, space, element) for element in cleared)
    assert sympy.simplify(first * row[1] - second * row[0]) == 0
    for element in cleared:
        assert all(isinstance(int(c), int) and int(c) == c for c in element.values())
        assert all(exponent >= 0 for monomial in element for exponent in monomial)


def test_ties_between_generators_are_put_in_on_the_way_back() -> None:
    ring, space, (sine, cosine, root) = space_of(sin(x), cos(x), sqrt(m + k))
    terms, changed = space.terms(sine**2 + cosine**2)
    assert changed
    assert terms == {0: 1}
    assert back(ring, space, root**2) == m + k
    assert space.terms(sine * cosine)[1] is False


factors = st.sampled_from([m, k, m + k, m - k, 2 * m + l, m * k + 1, l**2 + 1, sympy.Integer(6)])


@settings(derandomize=True, deadline=None, max_examples=40)
@given(st.lists(factors, min_size=1, max_size=3), st.lists(factors, min_size=1, max_size=3))
def test_common_factors_are_those_of_sympy(above: list[Any], below: list[Any]) -> None:
    p, q = sympy.prod(above), sympy.prod(below)
    ring, space, (a, b) = space_of(p, q)
    found = [back(ring, space, part) for part in space.cancelled(a, b)]
    assert sympy.expand(found[0] * q - found[1] * p) == 0
    assert sympy.gcd(*map(sympy.expand, found)) in (1, -1)


@settings(derandomize=True, deadline=None, max_examples=40)
@given(st.lists(factors, min_size=1, max_size=2), st.lists(factors, min_size=1, max_size=2))
def test_what_is_coprime_has_no_common_factor_with_a_letter(
    above: list[Any], below: list[Any]
) -> None:
    p, q = sympy.expand(sympy.prod(above)), sympy.expand(sympy.prod(below))
    _, _, (a, b) = space_of(p, q)
    assert coprime(a, b) is not bool(sympy.gcd(p, q).free_symbols)


def test_floats_are_the_decimals_they_are_written_as() -> None:
    ring, space, (a, b) = space_of(0.1 * m, k)
    assert back(ring, space, a) == m
    assert back(ring, space, b) == 10 * k


def test_generators_within_denominators_belong_to_the_space() -> None:
    """Neither k nor l stands in a numerator."""
    _, space, (element,) = space_of(m / (k + l))
    assert len(element.ring.gens) == 3
    assert not space.zero
