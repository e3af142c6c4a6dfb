"""Constants brought together: the same values, and no more operations."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_programs import OPERATIONS, at, program, returned
from support.plain_values import value

from linegraph.errors import ModelError
from linegraph.ir.dag import Dag, Node
from linegraph.ir.parameter_constants import (
    Restructured,
    ends,
    is_constant,
    mapped,
    remade,
    rewritten,
)
from linegraph.ir.program import Check, operations_of

DAG = Dag()
X, Y, Z = (DAG.symbol("q", n) for n in range(3))
K, M = DAG.symbol("p", "k"), DAG.symbol("p", "m")
POINT = at((Fraction(7, 3), Fraction(-5, 2), Fraction(11, 13)), k=Fraction(3, 7), m=Fraction(2, 9))


def varying(made: Any) -> int:
    """How many operations depend on more than parameters."""
    return sum(node.op not in ("symbol", "neg") and not is_constant(node, {}) for node in made.live)


def restructured(*entries: Any) -> Any:
    """One program, put in order again."""
    (found,) = Restructured().programs([program(*entries)])
    return rewritten(found, lambda x: x)


@pytest.mark.parametrize(
    ("entry", "left"),
    [
        (X / K, 1),
        ((X * K) * M, 1),
        ((X * K) * Y * M, 2),
        (X * K + X * M, 1),
        (X * K - X * M, 1),
        (X * K + Y * K, 2),
        (X * K - Y * K, 2),
        (-(X * K) * M, 1),
        ((X / K) / M, 1),
        (K * M + 3, 0),
        (X + K, 1),
        ((X - K) + (Y - K), 3),
    ],
)
def test_constants_meet(entry: Any, left: int) -> None:
    found = restructured(entry)
    assert varying(found) == left
    assert returned(found, POINT) == [value(entry, POINT)]


def test_products_that_others_need_too_are_not_made_twice() -> None:
    assert varying(restructured(X * K, Y * K, X * K + Y * K)) == 3


@st.composite
def entries(draw: st.DrawFn) -> list[Any]:
    nodes: list[Any] = [X, Y, K, M, 2]
    for _ in range(draw(st.integers(2, 9))):
        a, b = draw(st.sampled_from(nodes)), draw(st.sampled_from(nodes))
        operation = draw(st.sampled_from("+-*/"))
        if operation == "/" and (not isinstance(b, Node) or value(b, POINT) == 0):
            continue
        nodes.append(OPERATIONS[operation](a, b))
    return nodes[-3:]


@settings(derandomize=True, deadline=None, max_examples=150)
@given(entries())
def test_no_value_changes_and_no_more_operations_vary(given_entries: list[Any]) -> None:
    made = program(*given_entries)
    found = restructured(*given_entries)
    assert returned(found, POINT) == returned(made, POINT)
    assert varying(found) <= varying(made)


@pytest.mark.parametrize(
    ("x", "constant"),
    [
        (K, True),
        (K * M + 2, True),
        (3, True),
        (DAG.sin(K), True),
        (X, False),
        (X * K, False),
        (DAG.symbol("t"), False),
        (DAG.sqrt(K + X), False),
    ],
)
def test_constants_depend_on_parameters_alone(x: Any, constant: bool) -> None:
    assert is_constant(x, {}) is constant


def test_an_operation_is_remade_of_what_its_operands_have_become() -> None:
    def of(x: Any) -> Any:
        return {X.index: Y, Y.index: 2 * Y}.get(x.index, x) if isinstance(x, Node) else x

    for node in (
        X + Y,
        X - Y,
        X * Y,
        Y / X,
        DAG.function("atan2", X, Y),
        DAG.sqrt(X),
        -X,
    ):
        swapped = {("q", 0): POINT["q", 1], ("q", 1): 2 * POINT["q", 1]}
        assert value(remade(DAG, node, of), POINT) == value(node, swapped)


def test_ends_are_entries_and_what_is_checked() -> None:
    made = program(X, 3, checks=(Check(Y, K, 1, ""),))
    assert ends(made) == [X, 3, Y, K]


def test_a_check_that_cannot_fail_is_left_out_and_one_that_always_does_is_refused() -> None:
    check = Check(X, 0, 1, "the mass is not positive")
    made = program(Y, checks=(check,))
    assert mapped(made, lambda x: 5 if x is X else x).checks == ()
    with pytest.raises(ModelError, match="the mass is not positive, whatever the state"):
        mapped(made, lambda x: -5 if x is X else x)
    (kept,) = mapped(made, lambda x: Y if x is X else x).checks
    assert kept == replace(check, node=Y)


def test_a_rewritten_program_is_in_order_again() -> None:
    found = rewritten(program(X * Y), lambda x: X + Y if isinstance(x, Node) else x)
    assert found.results[0].entries == (X + Y,)
    assert operations_of(found.results) == 1
    assert found.live[-1] is X + Y
