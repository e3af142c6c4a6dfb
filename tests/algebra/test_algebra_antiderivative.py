"""Antiderivatives: differentiated in forty digits, each is what was integrated."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.plain_values import slope, value

from linegraph.algebra.antiderivative import antiderivative
from linegraph.algebra.differentiation import Calculus
from linegraph.algebra.formula import parse
from linegraph.ir.dag import Dag

X = ("x", None)


def integrated(text: str) -> tuple[Any, Any]:
    """An expression of x with parameters k and m, and its antiderivative."""
    dag = Dag()
    names = {"x": dag.symbol(*X), "k": dag.symbol("p", "k"), "m": dag.symbol("p", "m")}
    f = parse(text).evaluate(dag, names)
    return f, antiderivative(Calculus(dag), f, X)


def at(x: float) -> dict[Any, float]:
    return {X: x, ("p", "k"): 1.3, ("p", "m"): 0.7}


INTEGRABLE = (
    "5",
    "k*m",
    "3*x**2 - k*x + 1",
    "(x + k)*(x - 1)**2",
    "x**3/m",
    "(k*x + m + 2)**1.5",
    "x*abs(x)",
    "(2*x - k)*abs(2*x - k)",
    "sign(x)*sqrt(abs(x))",
    "max(x, 0)**1.5",
    "max(x - k, 0)**2",
    "max(k*x, m)",
    "min(2*x + 1, x - m)",
    "min(k, max(-m, 2*x))",
    "max(-m, min(k, 2*x))",
    "min(m, min(k, x))",
    "sin(k*x + m)",
    "cos(x)/k",
    "exp(-k*x)",
    "sinh(x) + cosh(2*x)",
    "tanh(k*x)",
    "tan(x/4)",
    "atan(2*x)",
    "asin(x/4)",
    "acos(x/4)",
    "sqrt(x + 4)",
    "x*exp(-x*x)",
    "x/(1 + x*x)",
    "x/sqrt(1 + k*x*x)",
    "cos(x)*exp(sin(x))",
    "x*sqrt(1 + x*x)",
)


@pytest.mark.parametrize("text", INTEGRABLE)
@pytest.mark.parametrize("x", [-1.1, 0.37, 1.9])
def test_the_derivative_of_an_antiderivative_is_what_was_integrated(text: str, x: float) -> None:
    f, found = integrated(text)
    assert found is not None
    expected = float(value(f, at(x)))
    assert math.isclose(slope(found, at(x), X), expected, rel_tol=1e-9, abs_tol=1e-9)


@pytest.mark.parametrize("text", INTEGRABLE)
def test_it_is_zero_where_the_symbol_is(text: str) -> None:
    _, found = integrated(text)
    assert abs(float(value(found, at(0)))) < 1e-12


@pytest.mark.parametrize(
    "text", ["1/x", "k/x**2", "(1 + x)/x", "x**(-1.5)", "log(x)", "1/(k*x + 1)", "log(2*x + 1)"]
)
def test_what_may_be_infinite_is_integrated_where_it_is_finite(text: str) -> None:
    f, found = integrated(text)
    assert math.isclose(slope(found, at(1.7), X), float(value(f, at(1.7))), rel_tol=1e-9)


@pytest.mark.parametrize(
    "text", ["exp(x*x)", "sin(x)/x", "exp(x)*x", "sin(exp(x))", "1/(1 + x**4)"]
)
def test_what_no_rule_gives_has_none(text: str) -> None:
    _, found = integrated(text)
    assert found is None


@pytest.mark.parametrize(
    "text",
    [
        "sinh(3 - x)*sign(k*x)",
        "sqrt(abs(x))*sign(k*x - m)",
        "sin(max(x, -1))",
        "atan(min(x, 1))",
        "sign(x - 1)/min(m, -x)",
    ],
)
def test_what_jumps_is_no_constant_though_its_derivative_is_zero(text: str) -> None:
    _, found = integrated(text)
    assert found is None


LINEAR = ("x", "x - 1", "2*x + 3", "k*x - m", "3 - x")
INNER = (*LINEAR, "max(x, -1)", "min(m, 3 - x)", "abs(x - 1)", "x*x + 1")
FACTORS = (
    *INNER,
    *(f"{f}({u})" for f in ("sign", "sin", "tanh", "atan") for u in INNER),
    "sqrt(abs(x))",
    "1/(1 + x*x)",
)


@settings(derandomize=True, deadline=None, max_examples=150)
@given(st.lists(st.sampled_from(FACTORS), min_size=1, max_size=3))
def test_any_antiderivative_that_is_found_is_one(factors: list[str]) -> None:
    f, found = integrated("*".join(f"({factor})" for factor in factors))
    for x in (-1.37, 0.43, 1.91) if found is not None else ():
        expected = float(value(f, at(x)))
        assert math.isclose(slope(found, at(x), X), expected, rel_tol=1e-8, abs_tol=1e-8)


@settings(derandomize=True, deadline=None, max_examples=40)
@given(st.lists(st.integers(-4, 4), min_size=1, max_size=5), st.integers(-3, 3))
def test_polynomials_are_integrated_exactly(coefficients: list[int], shift: int) -> None:
    dag = Dag()
    x = dag.symbol(*X)
    f: Any = 0
    for c in coefficients:
        f = f * (x + shift) + c
    found = antiderivative(Calculus(dag), f, X)
    # with y = x + shift from shift to 2 + shift
    n = len(coefficients)
    expected = sum(
        c * ((2 + shift) ** (n - i) - shift ** (n - i)) / (n - i)
        for i, c in enumerate(coefficients)
    )
    assert float(value(found, {X: 2})) == pytest.approx(expected, rel=1e-12, abs=1e-12)


def test_the_integral_of_tanh_does_not_overflow() -> None:
    _, found = integrated("tanh(x)")
    assert float(value(found, {X: 1e6})) == pytest.approx(1e6 - math.log(2))
