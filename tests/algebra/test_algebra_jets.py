"""Jets against differences in forty digits: every smooth function of a motion, twice differentiated."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import pytest
from support.plain_values import PRECISE

from linegraph.algebra.jets import Jet, Jets, derivatives, lifted
from linegraph.algebra.protocol import Floats
from linegraph.errors import ModelError
from linegraph.ir.functions import ARITY

SMOOTH = ("sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log", "sqrt")
T = 0.4


def motion(t: Any) -> Any:
    """A value between 0 and 1 near t = 0.4, with rates of its own."""
    return (
        t * t / 2 + t / 3 + Fraction(1, 5) if isinstance(t, Jet) else t * t / 2 + t / 3 + t**0 / 5
    )


def moving() -> Any:
    return motion(Jet(T, 1, 0))


def expected(f: Any) -> list[float]:
    """The value and two derivatives of a function of t."""
    return [float(PRECISE.diff(f, PRECISE.mpf(T), order)) for order in range(3)]


def parts(jet: Jet) -> list[float]:
    return [float(x) for x in (jet.x, jet.dx, jet.ddx)]


@pytest.mark.parametrize("name", SMOOTH)
def test_a_function_of_a_motion_has_its_rates(name: str) -> None:
    found = Jets(Floats()).function(name, moving())
    assert parts(found) == pytest.approx(expected(lambda t: getattr(PRECISE, name)(motion(t))))


@pytest.mark.parametrize("name", SMOOTH)
def test_derivatives_of_a_function_are_its_slopes(name: str) -> None:
    x = 0.37
    found = derivatives(name, Floats(), x, getattr(math, name)(x))
    slopes = [float(PRECISE.diff(getattr(PRECISE, name), PRECISE.mpf(x), n)) for n in (1, 2)]
    assert list(found or ()) == pytest.approx(slopes)


@pytest.mark.parametrize(
    ("of_jets", "of_numbers"),
    [
        (lambda x: x * x * x - 2 / x, lambda x: x**3 - 2 / x),
        (lambda x: (1 - x) / (x + 3), lambda x: (1 - x) / (x + 3)),
        (lambda x: -x / 4 + 5 * x, lambda x: -x / 4 + 5 * x),
    ],
)
def test_arithmetic_follows_the_rules_of_products_and_quotients(
    of_jets: Any, of_numbers: Any
) -> None:
    assert parts(of_jets(moving())) == pytest.approx(expected(lambda t: of_numbers(motion(t))))


def test_an_angle_turns_as_the_point_does() -> None:
    """Of the point (cos - 2, sin): not on a circle about the origin."""
    jets = Jets(Floats())
    x, y = jets.cos(moving()) - 2, jets.sin(moving())
    found = jets.function("atan2", y, x)
    angle = expected(lambda t: PRECISE.atan2(PRECISE.sin(motion(t)), PRECISE.cos(motion(t)) - 2))
    assert parts(found) == pytest.approx(angle)


@pytest.mark.parametrize("exponent", [Fraction(3, 2), Fraction(5, 2), Fraction(-1, 2)])
def test_half_integer_powers_have_the_rates_of_powers(exponent: Fraction) -> None:
    found = Jets(Floats()).power(moving(), exponent)
    power = PRECISE.mpf(exponent.numerator) / exponent.denominator
    assert parts(found) == pytest.approx(expected(lambda t: motion(t) ** power))


def test_a_power_of_five_halves_has_finite_rates_at_zero() -> None:
    """Its root has none."""
    assert parts(Jets(Floats()).power(Jet(0.0, 3.0, 1.0), Fraction(5, 2))) == [0, 0, 0]


def test_the_time_runs_and_other_symbols_rest() -> None:
    jets = Jets(Floats(t=2.0, p={"m": 3.0}))
    assert jets.symbol("t") == Jet(2.0, 1, 0)
    assert jets.symbol("p", "m") == Jet(3.0, 0, 0)
    assert lifted(5) == Jet(5, 0, 0)


@pytest.mark.parametrize("name", sorted(ARITY.keys() - {*SMOOTH, "atan2"}))
def test_functions_with_a_kink_prescribe_no_motion(name: str) -> None:
    with pytest.raises(ModelError, match="it is not smooth"):
        Jets(Floats()).function(name, *[moving()] * ARITY[name])
    assert derivatives(name, Floats(), 1.0, 1.0) is None
