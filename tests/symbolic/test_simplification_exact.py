"""Exact values of functions: what sympy says, and letters for what it leaves."""

from __future__ import annotations

from typing import Any

import pytest
import sympy
from sympy import Rational, cos, pi, sin, sqrt

from linegraph.errors import ModelError
from linegraph.symbolic.simplification import Simplifier
from linegraph.symbolic.simplification.exact import Exact

h = sympy.Symbol("h", positive=True)
a, b = sympy.symbols("a b")


def exact() -> tuple[Simplifier, Exact]:
    simplifier = Simplifier(lambda symbol: sympy.Symbol(str(symbol[1])))
    return simplifier, Exact(simplifier)


def written(e: Any) -> Any:
    """An expression as a polynomial, and written again."""
    simplifier, algebra = exact()
    return simplifier.of_terms(algebra.value(sympy.sympify(e)).terms)


@pytest.mark.parametrize(
    "e",
    [
        sin(pi / 6),
        cos(pi / 6),
        sin(pi),
        sqrt(h**2),
        a * b + Rational(1, 3),
        a**2 / b,
        sqrt(a + 1),
        1 / sqrt(a),
        sin(a) * cos(b),
        sympy.exp(a),
        sin(Rational(1, 4)),
        pi * a,
        sympy.atan2(a, b),
        sympy.Float(0.25) * a,
    ],
)
def test_a_value_is_written_as_what_it_was(e: Any) -> None:
    assert sympy.simplify(written(e) - e) == 0


@pytest.mark.parametrize(
    ("name", "argument", "expected"),
    [
        ("cos", 0, 1),
        ("exp", 0, 1),
        ("atan", 1, pi / 4),
        ("sqrt", 12, 2 * sqrt(3)),
        ("acos", Rational(1, 2), pi / 3),
    ],
)
def test_functions_of_numbers_are_exact(name: str, argument: Any, expected: Any) -> None:
    simplifier, algebra = exact()
    found = algebra.function(name, algebra.value(sympy.sympify(argument)))
    assert sympy.simplify(simplifier.of_terms(found.terms) - expected) == 0


def test_sums_of_known_angles_have_known_sines() -> None:
    simplifier, algebra = exact()
    found = algebra.sin(algebra.value(pi / 3) + algebra.value(pi / 6))
    assert simplifier.of_terms(found.terms) == 1


def test_a_letter_beside_a_known_angle_turns_with_it() -> None:
    simplifier, algebra = exact()
    found = algebra.sin(algebra.value(a) + algebra.value(pi / 2))
    assert simplifier.of_terms(found.terms) == cos(a)


def test_the_root_of_a_positive_square_is_no_absolute_value() -> None:
    simplifier, algebra = exact()
    found = algebra.sqrt(algebra.value(h) * algebra.value(h))
    assert simplifier.of_terms(found.terms) == h


def test_floats_stay_floats() -> None:
    simplifier, algebra = exact()
    found = algebra.sin(algebra.value(sympy.Float(0.5)))
    assert simplifier.of_terms(found.terms) == pytest.approx(float(sin(0.5)), rel=1e-15)
    assert simplifier.ring.inexact


def test_a_float_that_is_whole_makes_what_follows_inexact_too() -> None:
    _, algebra = exact()
    found = algebra.cos(algebra.value(sympy.Float(1.0)))
    assert found.terms == {0: pytest.approx(float(cos(1.0)))}


def test_squares_of_sine_and_cosine_of_what_sympy_leaves_are_one() -> None:
    """Of one quarter: both become letters, which stay tied."""
    _, algebra = exact()
    quarter = algebra.value(Rational(1, 4))
    s, c = algebra.sin(quarter), algebra.cos(quarter)
    assert (s * s + c * c).terms == {0: 1}


def test_what_sympy_leaves_has_its_value_where_forms_are_compared() -> None:
    simplifier, algebra = exact()
    found = algebra.value(sympy.exp(Rational(1, 4)) + pi)
    expected = sympy.N(sympy.exp(Rational(1, 4)) + pi, 60)
    for point in simplifier.points:
        value = sympy.Float(str(point.terms(found.terms)[0]), 60)
        assert abs(value - expected) < 1e-45


@pytest.mark.parametrize("e", [sqrt(-1), sympy.zoo, sympy.oo, a + sympy.I])
def test_what_is_no_real_number_is_refused(e: Any) -> None:
    with pytest.raises(ModelError, match="no real number"):
        exact()[1].value(sympy.sympify(e))


def test_letters_are_parameters_unless_they_are_known() -> None:
    simplifier, algebra = exact()
    simplifier.define(("q", 0), b)
    assert algebra.value(a).terms == simplifier.ring.symbol("p", "a").terms
    assert algebra.value(b).terms == simplifier.ring.symbol("q", 0).terms
    assert algebra.symbol("v", 3).terms == simplifier.ring.symbol("v", 3).terms
