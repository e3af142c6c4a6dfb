"""Rows in rates of which some follow from others: what they fix is put in, and solutions stay solutions."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from support.plain_values import value

from linegraph.algebra.differentiation import Calculus
from linegraph.errors import ModelError
from linegraph.ir.dag import Dag
from linegraph.ir.program import Quantity
from linegraph.networks.network import RATE, State
from linegraph.networks.rates import Rates
from linegraph.networks.reduction import Reduction

A, B, C = ("X", "a"), ("X", "b"), ("X", "c")


class Case:
    """Three states with their rates, and an input."""

    def __init__(self, count: int, owners: list[int | None] | None = None) -> None:
        """Take the first of a, b and c."""
        self.dag = dag = Dag()
        keys = (A, B, C)[:count]
        states = [State(Quantity(str(key[1]), "V"), key) for key in keys]
        calculus = Calculus(dag)
        self.rates = Rates("model", calculus, states, ())
        self.reduction = Reduction(self.rates, calculus, states, owners or list(range(count)))
        self.x = [dag.symbol(*key) for key in keys]
        self.dx = [dag.symbol(RATE, k) for k in range(count)]
        self.u = dag.symbol("u", "u")


def test_regular_rows_stay_and_nothing_is_fixed() -> None:
    case = Case(2)
    (a, b), (da, db) = case.x, case.dx
    rows = [2 * da + db - a, da - db + b]
    before = list(rows)
    assert case.reduction.reduce(rows, {}) == set()
    assert rows == before


def test_rows_go_to_the_states_that_they_are_of() -> None:
    """The first row has the rate of b alone."""
    case = Case(2, [None, None])
    (a, b), (da, db) = case.x, case.dx
    first, second = db - a, da + db - b
    rows = [first, second]
    case.reduction.reduce(rows, {})
    assert rows == [second, first]


def test_a_null_combination_fixes_a_state_and_its_rate_everywhere() -> None:
    """Da + db = -a and 2 da + 2 db = 4 b - 2 a... say 4 b = 0 a: b = a / 2 here, and db = da / 2."""
    case = Case(2)
    (a, b), (da, db) = case.x, case.dx
    rows = [da + db + a, 2 * da + 2 * db + 4 * b]
    variables = {"R": (b, db)}
    gone = case.reduction.reduce(rows, variables)
    assert gone == {1}
    at: dict[Any, Any] = {A: 6, (RATE, 0): -4}
    assert value(case.rates.replaced[B], at) == 3
    assert [value(x, at) for x in variables["R"]] == [3, -2]
    assert len(rows) == 1
    assert value(rows[0], at) == 0  # -4 - 2 + 6


def test_an_input_in_a_constraint_brings_its_rate() -> None:
    """0 = b - u: the rate of b is that of u."""
    case = Case(2)
    (a, b), (da, db) = case.x, case.dx
    rows = [da + db + a, b - case.u]
    assert case.reduction.reduce(rows, {}) == {1}
    assert value(rows[0], {A: 1, (RATE, 0): 2, ("du", "u"): 10}) == 13


def test_constraints_are_found_in_turn() -> None:
    """From b = 2 c follows that db - 2 dc is zero, and from that c = a."""
    case = Case(3)
    (a, b, c), (da, db, dc) = case.x, case.dx
    rows = [da + a, b - 2 * c, db - 2 * dc + c - a]
    gone = case.reduction.reduce(rows, {})
    assert len(gone) == 2
    assert 0 not in gone
    at = {A: 5, (RATE, 0): -5}
    assert [value(row, at) for row in rows] == [0]
    later = case.reduction.later
    assert [value(later(x), at) for x in (b, c)] == [10, 5]


def test_values_that_name_each_other_are_put_in_until_none_is_left() -> None:
    case = Case(3)
    a, b, _ = case.x
    case.rates.replaced[C] = b + 1
    case.rates.replaced[B] = 3 * a
    assert value(case.reduction.later(case.x[2]), {A: 2}) == 7


def test_a_row_of_a_letter_is_solved_for_its_state() -> None:
    """0 = k b - a with a parameter: b = a / k."""
    case = Case(2)
    (a, b), (da, db) = case.x, case.dx
    k = case.dag.symbol("p", "k")
    assert case.reduction.reduce([da + db + a, k * b - a], {}) == {1}
    assert value(case.rates.replaced[B], {A: 6, ("p", "k"): 4}) == Fraction(3, 2)


def test_a_constraint_on_an_input_alone_is_refused() -> None:
    case = Case(1)
    with pytest.raises(ModelError, match="fix an input"):
        case.reduction.reduce([case.u - 1], {})


def test_a_constraint_in_which_no_state_is_linear_is_refused() -> None:
    case = Case(2)
    (a, b), (da, _) = case.x, case.dx
    with pytest.raises(ModelError, match=r"its states \(a, b\) are not determined"):
        case.reduction.reduce([da, a * a + b * b - 1], {})
