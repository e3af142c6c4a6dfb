"""Gradients, supports, sizes and replays of the DAG: against differences in forty digits."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from support.plain_values import slope, value

from linegraph.algebra.differentiation import Calculus, Replay, TermSizes, substitute
from linegraph.algebra.protocol import Floats
from linegraph.errors import ModelError
from linegraph.ir.dag import Dag, Node
from linegraph.ir.functions import ARITY

X, Y = ("x", None), ("y", 1)
UNARY = sorted(name for name, count in ARITY.items() if count == 1)


def drawn(draw: st.DrawFn, dag: Dag, depth: int) -> Any:
    """A random scalar of x and y."""
    if depth == 0:
        return draw(st.sampled_from([dag.symbol(*X), dag.symbol(*Y), 2, 3]))
    op = draw(st.sampled_from("+-*/fF"))
    if op == "f":
        name = draw(st.sampled_from(["sin", "cos", "atan", "tanh", "exp", "abs", "sqrt"]))
        inner = drawn(draw, dag, depth - 1)
        if name == "sqrt":
            inner = 1 + inner * inner
        return dag.function(name, dag.function("tanh", inner) if name == "exp" else inner)
    a, b = drawn(draw, dag, depth - 1), drawn(draw, dag, depth - 1)
    if op == "F":
        return dag.function(draw(st.sampled_from(["min", "max", "atan2"])), a, 1 + b * b)
    return {"+": a + b, "-": a - b, "*": a * b}[op] if op != "/" else a / (2 + b * b)


@st.composite
def scalars(draw: st.DrawFn) -> tuple[Dag, Any]:
    dag = Dag()
    return dag, drawn(draw, dag, draw(st.integers(1, 4)))


@settings(derandomize=True, deadline=None, max_examples=60)
@given(scalars())
def test_gradients_are_slopes(made: tuple[Dag, Any]) -> None:
    dag, x = made
    at = {X: 0.83, Y: -1.37}
    found = Calculus(dag)
    for by in (X, Y):
        expected = slope(x, at, by)
        assume(math.isfinite(expected) and abs(expected) < 1e8)
        got = float(value(found.derivative(x, by), at))
        assert math.isclose(got, expected, rel_tol=1e-8, abs_tol=1e-8)


@settings(derandomize=True, deadline=None, max_examples=40)
@given(scalars())
def test_a_replay_over_floats_is_the_value(made: tuple[Dag, Any]) -> None:
    _, x = made
    at = {X: 0.83, Y: -1.37}
    found = float(Replay(Floats(), at.__getitem__)(x))
    assert math.isclose(found, float(value(x, at)), rel_tol=1e-9, abs_tol=1e-9)


@pytest.mark.parametrize("name", [name for name in UNARY if name != "sign"])
def test_each_function_has_its_slope(name: str) -> None:
    dag = Dag()
    f = dag.function(name, 0.9 * dag.symbol(*X))
    found = value(Calculus(dag).derivative(f, X), {X: 0.7})
    assert float(found) == pytest.approx(slope(f, {X: 0.7}, X))


@pytest.mark.parametrize(
    ("name", "a", "b", "slopes"),
    [
        ("max", 2, 1, (1, 0)),
        ("max", 1, 2, (0, 1)),
        ("max", 1, 1, (1, 0)),
        ("min", 2, 1, (0, 1)),
        ("min", 1, 2, (1, 0)),
        ("min", 1, 1, (1, 0)),
    ],
)
def test_the_smaller_or_larger_one_counts_and_the_first_of_equals(
    name: str, a: int, b: int, slopes: tuple[int, int]
) -> None:
    dag = Dag()
    calculus = Calculus(dag)
    f = dag.function(name, dag.symbol(*X), dag.symbol(*Y))
    assert tuple(value(calculus.derivative(f, by), {X: a, Y: b}) for by in (X, Y)) == slopes


@pytest.mark.parametrize(("x", "expected"), [(2, 1), (-2, -1), (0, 1)])
def test_the_slope_of_an_absolute_value_at_zero_is_that_of_positive_numbers(
    x: int, expected: int
) -> None:
    dag = Dag()
    s = dag.symbol(*X)
    for size in (dag.function("abs", s), dag.sqrt(s * s)):
        assert value(Calculus(dag).derivative(size, X), {X: x}) == expected


def test_a_power_of_three_halves_is_flat_at_zero() -> None:
    dag = Dag()
    x = dag.symbol(*X)
    assert value(Calculus(dag).derivative(x * dag.sqrt(x), X), {X: 0}) == 0


@pytest.mark.parametrize(("x", "expected"), [(-1, 0.0), (4, 0.25)])
def test_the_root_of_what_is_cut_off_is_flat_where_it_is_cut(x: int, expected: float) -> None:
    """Of sqrt(max(x, 0)): not zero over zero."""
    dag = Dag()
    f = dag.sqrt(dag.function("max", dag.symbol(*X), 0))
    assert float(value(Calculus(dag).derivative(f, X), {X: x})) == expected


@pytest.mark.parametrize("name", ["asin", "acos"])
def test_angles_of_what_is_limited_have_their_slope_inside_of_the_limits(name: str) -> None:
    dag = Dag()
    f = dag.function(name, dag.function("max", dag.symbol(*X), -1))
    found = Calculus(dag).derivative(f, X)
    assert float(value(found, {X: 0.3})) == pytest.approx(slope(f, {X: 0.3}, X))
    assert value(found, {X: -2}) == 0


def test_supports_hold_the_symbols_and_gradients_those_that_matter() -> None:
    dag = Dag()
    x, y, c = dag.symbol(*X), dag.symbol(*Y), dag.symbol("c", "1/3")
    calculus = Calculus(dag, ("c",))
    assert calculus.support(c * x + dag.function("sign", y)) == {X, Y}
    assert set(calculus.gradient(c * x + dag.function("sign", y))) == {X}
    assert calculus.support(5) == frozenset()
    assert calculus.gradient(c) == {}


def test_a_chain_differentiates_symbols_that_depend_on_others() -> None:
    """Y is x squared."""
    dag = Dag()
    x, y = dag.symbol(*X), dag.symbol(*Y)
    calculus = Calculus(dag, chain={Y: {X: 2 * x}})
    assert value(calculus.derivative(y * y * x, X), {X: 3, Y: 9}) == 5 * 81


def test_a_function_without_a_rule_is_refused() -> None:
    dag = Dag()
    unknown = Node(dag, "gamma", dag.symbol(*X), None)
    with pytest.raises(ModelError, match=r"gamma.* has no derivative"):
        Calculus(dag).gradient(unknown)


def test_sizes_add_up_what_sums_cancel() -> None:
    dag = Dag()
    x, y = dag.symbol(*X), dag.symbol(*Y)
    size = TermSizes(Calculus(dag))
    at = {X: 3, Y: -5}
    assert value(size(x - y), at) == 8
    assert value(size(x * (x + y)), at) == 3 * 8
    assert value(size((x + y) / y), at) == value(8 / dag.function("abs", y), at)
    assert size(-7) == 7
    assert value(size(-(x + y)), at) == 8


def test_an_error_of_a_factor_counts_by_the_value_of_the_other() -> None:
    """Of (x + y)(x - 2) at x = 3, y = -5: 8 of the first times 1, and 5 of the second times 2."""
    dag = Dag()
    x, y = dag.symbol(*X), dag.symbol(*Y)
    size = TermSizes(Calculus(dag))
    at = {X: 3, Y: -5}
    assert value(size((x + y) * (x - 2)), at) == 8 * 1 + 5 * 2
    # the quotient is -2: (8 + 2 * 5) / 1
    assert value(size((x + y) / (x - 2)), at) == 18


def test_the_size_of_a_function_is_its_own_and_that_of_its_argument_by_the_slope() -> None:
    dag = Dag()
    x, y = dag.symbol(*X), dag.symbol(*Y)
    found = float(value(TermSizes(Calculus(dag))(dag.sin(x + y)), {X: 3, Y: -2.9}))
    assert found == pytest.approx(math.sin(0.1) + math.cos(0.1) * 5.9)


def test_the_size_of_an_angle_grows_as_the_point_comes_near() -> None:
    """An error e of x - y turns the point (2, x - y) by 2 e over its distance squared."""
    dag = Dag()
    x, y = dag.symbol(*X), dag.symbol(*Y)
    size = TermSizes(Calculus(dag))
    found = float(value(size(dag.function("atan2", x - y, 2)), {X: 3, Y: 2.9}))
    assert found == pytest.approx(math.atan2(0.1, 2) + (2 * 5.9 + 0.1 * 2) / (2**2 + 0.1**2))
    assert value(size(dag.function("atan2", x, y)), {X: 0, Y: 0}) == 0
    assert value(size(dag.function("max", x, y)), {X: 3, Y: -4}) == 7


def test_what_no_unknown_is_in_is_one_term() -> None:
    dag = Dag()
    x, y = dag.symbol(*X), dag.symbol(*Y)
    found = TermSizes(Calculus(dag), ("x",))((y - 3) + x)
    assert value(found, {X: -2, Y: 4}) == 1 + 2


def test_the_size_of_a_root_stays_finite_at_zero() -> None:
    """An error e of x = y = 1 is one of sqrt(e) in the root: at 1e-10 not more than 1e-5 of it."""
    dag = Dag()
    x, y = dag.symbol(*X), dag.symbol(*Y)
    size = float(value(TermSizes(Calculus(dag))(dag.sqrt(x - y)), {X: 1, Y: 1}))
    assert size == pytest.approx(math.sqrt(2) * 1e5)


@pytest.mark.parametrize("name", ["asin", "acos"])
def test_the_size_of_an_angle_stays_finite_at_the_end_of_its_range(name: str) -> None:
    dag = Dag()
    angle = dag.function(name, dag.symbol(*X))
    size = TermSizes(Calculus(dag))(angle)
    inside = abs(getattr(math, name)(0.6)) + 0.6 / (0.8 + 1e-5 * math.sqrt(0.6))
    assert float(value(size, {X: 0.6})) == pytest.approx(inside)
    assert float(value(size, {X: 1})) == pytest.approx(getattr(math, name)(1) + 1e5)


def test_substitution_puts_scalars_in_place_of_symbols() -> None:
    dag = Dag()
    x, y = dag.symbol(*X), dag.symbol(*Y)
    found = substitute(x * x + y, dag, {X: y + 1})
    assert value(found, {Y: 2}) == 11
    assert substitute(x - y, dag, {X: y}) == 0
