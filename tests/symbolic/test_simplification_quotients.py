"""Linear equations between polynomials, and quotients in lowest terms: against sympy."""

from __future__ import annotations

from typing import Any

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from rings import expression, k, l, m, polynomial, same, x, y
from sympy import cos, sin, sqrt

from linegraph.symbolic.simplification.generators import Swollen
from linegraph.symbolic.simplification.polynomial import Ring
from linegraph.symbolic.simplification.proof import SamplePoint
from linegraph.symbolic.simplification.quotients import Quotients, Singular


def made(budget: float = float("inf")) -> tuple[Ring, Quotients]:
    ring = Ring(budget)
    return ring, Quotients(ring, SamplePoint(ring, {}, 0))


def lowest(e: Any) -> tuple[Any, Any]:
    """Numerator and denominator of an expression."""
    ring, quotients = made()
    above, below = quotients.of(polynomial(ring, e))
    return expression(ring, above), expression(ring, below)


def solved(rows: Any, rights: Any, through: Any = (), direct: Any = ()) -> Any:
    """The solution of equations in expressions."""
    ring, quotients = made()

    def polys(given_rows: Any) -> Any:
        return [[polynomial(ring, sympy.sympify(e)) for e in row] for row in given_rows]

    found = quotients.solve(polys(rows), polys(rights), polys(through), polys(direct))
    return tuple([[expression(ring, p.terms) for p in row] for row in part] for part in found)


@pytest.mark.parametrize(
    ("e", "above", "below"),
    [
        ((m**2 + m * k) / (m * k), m + k, k),
        ((m**2 - k**2) / (m + k), m - k, sympy.Integer(1)),
        (1 / m + 1 / k, m + k, m * k),
        (1 / (m + k) - 1 / (m - k), -2 * k, m**2 - k**2),
        (2 * m / (4 * k), m, 2 * k),
        (m / (m + k) + k / (m + k) - 1, sympy.Integer(0), sympy.Integer(1)),
        (cos(x) * m / (cos(x) * k * l), m, k * l),
        (1 / (1 + 1 / m), m, m + 1),
        (sin(x) * m / (sin(x) * k), m, k),
    ],
)
def test_quotients_come_in_lowest_terms(e: Any, above: Any, below: Any) -> None:
    found = lowest(e)
    assert sympy.simplify(found[0] * below - above * found[1]) == 0
    assert sympy.count_ops(found[0]) <= sympy.count_ops(above)
    assert sympy.count_ops(found[1]) <= sympy.count_ops(below)


def test_a_root_in_the_denominator_goes_above_where_that_is_no_longer() -> None:
    assert lowest(m / sqrt(k)) == (m * sqrt(k), k)
    assert lowest(m / sqrt(k + l)) == (m, sqrt(k + l))


entries = st.sampled_from([0, 1, -2, m, k, m + k, m * l, sin(x), cos(x), m / (k + l), x * y])


@settings(derandomize=True, deadline=None, max_examples=25)
@given(st.lists(entries, min_size=4, max_size=4), st.lists(entries, min_size=2, max_size=2))
def test_two_equations_have_the_solution_of_cramers_rule(
    matrix: list[Any], right: list[Any]
) -> None:
    a, b, c, d = map(sympy.sympify, matrix)
    e, f = map(sympy.sympify, right)
    det = a * d - b * c
    rows, rights = [[a, b], [c, d]], [[e], [f]]
    if sympy.simplify(det) == 0:
        with pytest.raises(Singular):
            solved(rows, rights)
        return
    (first,), (second,) = solved(rows, rights)[0]
    assert same(first, (e * d - b * f) / det)
    assert same(second, (a * f - e * c) / det)


def test_outputs_come_from_the_same_elimination() -> None:
    """Y = C X + D: m of both cancels, and nothing is left in the denominator."""
    X, Y = solved([[m, 0], [0, k + m]], [[1], [k + m]], [[m, 2]], [[l]])
    assert [same(a[0], b) for a, b in zip(X, (1 / m, 1), strict=True)] == [True, True]
    assert sympy.expand(Y[0][0]) == 3 + l


def test_denominators_begin_with_a_positive_number() -> None:
    ring, quotients = made()
    rows, rights = [[polynomial(ring, -k - l)]], [[polynomial(ring, m)]]
    (((solution,),), _) = quotients.solve(rows, rights)
    above, below = quotients.of(solution)
    assert (expression(ring, above), expression(ring, below)) == (-m, k + l)


def test_several_right_hand_sides_are_solved_at_once() -> None:
    (X, _) = solved([[2, 1], [1, 1]], [[1, 0], [0, 1]])
    assert X == [[1, -1], [-1, 2]]


@pytest.mark.parametrize(
    ("rows", "left"),
    [
        ([[m, k], [2 * m, 2 * k]], 1),
        ([[sin(x) ** 2 + cos(x) ** 2 - 1, 0], [0, 1]], 1),
        ([[0, 0], [0, 0]], 2),
        ([[cos(x), 1 + sin(x)], [1 - sin(x), cos(x)]], 1),
        ([[sqrt(m + k), m + k], [1, sqrt(m + k)]], 1),
    ],
)
def test_equations_that_repeat_each_other_are_singular(rows: Any, left: int) -> None:
    with pytest.raises(Singular) as caught:
        solved(rows, [[1], [1]])
    assert len(caught.value.rows) == left


def test_a_sum_that_is_zero_by_identity_vanishes() -> None:
    ring, quotients = made()
    assert quotients.vanishes(polynomial(ring, 1 / (m + k) + 1 / (m - k) - 2 * m / (m**2 - k**2)))
    assert not quotients.vanishes(polynomial(ring, 1 / (m + k) + 1 / (m - k)))


def test_the_greatest_common_factor_is_shared_and_divides() -> None:
    ring, quotients = made()
    parts = [polynomial(ring, sympy.expand(e * (m + k))).terms for e in (m * (m + l), k * (m + l))]
    factor = quotients.shared(parts)
    assert sympy.expand(expression(ring, factor) - (m + k) * (m + l)) == 0
    rests = [expression(ring, quotients.divided(part, factor)) for part in parts]
    assert rests == [m, k]
    assert quotients.divided(parts[0], {0: 1}) is parts[0]


def test_a_quotient_is_one_polynomial_with_its_denominator_as_a_generator() -> None:
    ring, quotients = made()
    given_quotient = quotients.of(polynomial(ring, m / (m + k) + l))
    found = quotients.poly(given_quotient)
    assert same(expression(ring, found.terms), m / (m + k) + l)
    assert quotients.of(found) is given_quotient


def test_elimination_keeps_to_the_budget() -> None:
    ring, quotients = made(budget=200)
    names = [[ring.symbol("p", f"{i}{j}") for j in range(5)] for i in range(5)]
    with pytest.raises(Swollen):
        quotients.solve(names, [[ring.poly(1)] for _ in range(5)])


def test_zero_is_judged_less_strictly_among_floats() -> None:
    ring, quotients = made()
    exact = quotients.zero
    _ = polynomial(ring, 0.1 * m)
    assert quotients.zero > exact
    rounded = 0.1 + 0.2
    assert quotients.vanishes(polynomial(ring, rounded * m / (m + k) + rounded * k / (m + k) - 0.3))
    assert not quotients.vanishes(polynomial(ring, m / (m + k) + k / (m + k) - 1.00001))
