"""Sums collected: fewer operations, the same values, and terms that meet."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_programs import at, program, returned
from support.plain_values import value

from linegraph.ir.dag import Dag, Node
from linegraph.ir.program import Check, Routine
from linegraph.ir.sums import Sums, collected, with_sums_collected

DAG = Dag()
X, Y, Z, W = (DAG.symbol("q", n) for n in range(4))
P = DAG.symbol("p", "m")
POINT = at((Fraction(7, 3), Fraction(-5, 2), Fraction(11, 13), Fraction(17, 19)), m=Fraction(3, 7))


@pytest.mark.parametrize(
    ("entry", "operations"),
    [
        (X + Y - X, 0),
        ((X + Y) + (X - Y), 1),
        (3 * X + 2 * X, 1),
        ((X + 2) + (Y + 3), 2),
        (2 * X + 2 * Y + 2 * Z, 3),
        (2 * X - 2 * Y, 2),
        ((2 * X) * Y + (3 * X) * Y, 2),
        ((X * Y + Z) - X * Y, 0),
        (5 * (X * 2) / Y, 2),
        (((Y - X) - Y) + (Y - X), 2),
    ],
)
def test_terms_that_are_alike_meet(entry: Any, operations: int) -> None:
    found = collected(program(entry))
    assert found.operations == operations
    assert returned(found, POINT) == [value(entry, POINT)]


@pytest.mark.parametrize("entry", [X + Y - Z, X * 3 + Y, X * Y + Y * Z, (X + 1) * (Y + 1), 2 * X])
def test_what_repeats_nothing_stays_as_it_is(entry: Any) -> None:
    made = program(entry)
    assert collected(made) is made


def test_a_sum_that_others_need_is_taken_apart_where_that_saves() -> None:
    """3 z is a product that the other entry has already."""
    made = program((Z + P) + ((Z + P) + (Z - 2)), -3 * Z)
    assert collected(made).operations == 4


def test_a_sum_that_others_need_is_not_taken_apart_at_a_cost() -> None:
    inner = X + Y + Z
    made = program(inner * W, inner + W)
    assert collected(made).operations <= made.operations


def test_a_constant_that_makes_differences_small_stays_in_them() -> None:
    """(x - p) + (y - p) keeps its digits where x + y - 2 p would lose them."""
    made = program((X - P) + (Y - P))
    assert collected(made) is made


def test_what_rounding_leaves_of_floats_is_nothing() -> None:
    found = collected(program(0.1 * X + 0.2 * X + Y - 0.3 * X + Z))
    assert returned(found, POINT) == [POINT["q", 1] + POINT["q", 2]]


def test_entries_of_checks_are_collected_too() -> None:
    check = Check(X + Y + X, Z + Z + Z, 1, "singular")
    (found,) = collected(program(W, checks=(check,))).checks
    assert isinstance(found.node, Node)
    assert value(found.node, POINT) == value(check.node, POINT)
    assert value(found.bound, POINT) == 3 * POINT["q", 2]


def test_programs_share_what_is_the_same() -> None:
    first, second = with_sums_collected([program(X + Y - X + Z), program((Z + Y) * 2)])
    entry = first.results[0].entries[0]
    assert entry in second.live  # type: ignore[union-attr]


def test_routines_have_no_sums() -> None:
    routine = Routine("solve", "", (), (), "newton", (), ())
    assert with_sums_collected([routine]) == (routine,)


@st.composite
def entries(draw: st.DrawFn) -> list[Any]:
    """Sums and products of a few symbols and small numbers, with shared parts."""
    nodes: list[Any] = [X, Y, Z, P, 2, -3]
    for _ in range(draw(st.integers(2, 10))):
        a, b = draw(st.sampled_from(nodes)), draw(st.sampled_from(nodes))
        nodes.append(
            draw(st.sampled_from([lambda a, b: a + b, lambda a, b: a - b, lambda a, b: a * b]))(
                a, b
            )
        )
    return nodes[-3:]


@settings(derandomize=True, deadline=None, max_examples=150)
@given(entries())
def test_collecting_changes_no_value_and_adds_no_operation(given_entries: list[Any]) -> None:
    made = program(*given_entries)
    found = collected(made)
    assert found.operations <= made.operations
    assert returned(found, POINT) == returned(made, POINT)


@settings(derandomize=True, deadline=None, max_examples=80)
@given(entries())
def test_collecting_twice_is_collecting_once(given_entries: list[Any]) -> None:
    found = collected(program(*given_entries))
    assert Sums(found).plans() == {}
    assert collected(found) is found
