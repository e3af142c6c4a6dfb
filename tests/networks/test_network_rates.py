"""Total derivatives: every symbol of a network changes at the rate that belongs to its kind."""

from __future__ import annotations

import math
from typing import Any

import pytest
from support.plain_values import slope, value

from linegraph.algebra.differentiation import Calculus
from linegraph.errors import ModelError
from linegraph.ir.dag import Dag
from linegraph.ir.program import Quantity
from linegraph.networks.network import RATE, State
from linegraph.networks.rates import Rates

C, L = ("X", "C"), ("Y", "L")


def rates_of(*dependent: str) -> tuple[Dag, Rates]:
    """The chain rule with two states, C and L."""
    dag = Dag()
    states = [State(Quantity("v_C", "V"), C), State(Quantity("i_L", "A"), L)]
    return dag, Rates('capacitor "D"', Calculus(dag), states, dependent)


@pytest.mark.parametrize(
    ("symbol", "follows"),
    [
        (C, (RATE, 0)),
        (L, (RATE, 1)),
        (("x", "motor"), ("w", "motor")),
        (("w", "motor"), ("dw", "motor")),
        (("u", "V"), ("du", "V")),
        (("du", "V"), ("ddu", "V")),
        (("name", "hinge"), ("name", "der(hinge)")),
    ],
)
def test_each_symbol_has_its_rate(symbol: Any, follows: Any) -> None:
    dag, rates = rates_of()
    assert rates.of(dag.symbol(*symbol)) is dag.symbol(*follows)


def test_the_time_runs_and_parameters_stay() -> None:
    dag, rates = rates_of()
    assert rates.of(dag.symbol("t") * 3) == 3
    assert rates.of(dag.symbol("p", "m") * dag.symbol("c", "1/3")) == 0
    assert rates.of(5) == 0


def test_the_rate_of_a_product_of_everything_is_that_along_a_motion() -> None:
    """All symbols follow smooth functions of the time; the rate is the difference quotient along them."""
    dag, rates = rates_of()
    v, i, t = dag.symbol(*C), dag.symbol(*L), dag.symbol("t")
    u, x, m = dag.symbol("u", "V"), dag.symbol("x", "motor"), dag.symbol("p", "m")
    quantity = m * v * dag.sin(i) + u * x * t / (1 + v * v)

    def along(s: Any) -> dict[Any, Any]:
        return {
            C: 2 + s,
            L: 1 - 3 * s,
            ("t", None): s,
            ("u", "V"): 4 * s + 1,
            ("x", "motor"): 5 - s,
        }

    at = {key: along(0.5)[key] for key in along(0)} | {("p", "m"): 7}
    now = {(RATE, 0): 1, (RATE, 1): -3, ("du", "V"): 4, ("w", "motor"): -1}
    total = sum(
        slope(quantity, at, key) * rate
        for key, rate in zip(along(0), (1, -3, 1, 4, -1), strict=True)
    )
    assert math.isclose(float(value(rates.of(quantity), at | now)), total, rel_tol=1e-12)


def test_a_state_that_a_constraint_has_fixed_changes_as_its_value_does() -> None:
    """Y(L) = X(C)^2, so that its rate is 2 X(C) times that of C."""
    dag, rates = rates_of()
    rates.replaced[L] = dag.symbol(*C) * dag.symbol(*C)
    assert value(rates.of(dag.symbol(*L)), {C: 5, (RATE, 0): 3}) == 30


def test_a_rate_that_a_static_law_gives_is_written_as_such() -> None:
    dag, rates = rates_of()
    rates.known[C] = dag.symbol(*L) * 2
    assert value(rates.of(3 * dag.symbol(*C)), {L: 7}) == 42


def test_a_slope_that_is_zero_by_identity_asks_for_no_rate() -> None:
    dag, rates = rates_of()
    v, d, k = dag.symbol(*C), dag.symbol("d", "D"), dag.symbol("p", "k")
    seeming = v + d * ((k + 1) * (k - 1)) - d * (k * k - 1)
    assert value(rates.of(seeming), {(RATE, 0): 9}) == 9


@pytest.mark.parametrize(
    ("symbol", "words"),
    [
        (("ddu", "V"), "the third derivative of input V"),
        (("loop", 0), "the derivative of an algebraic loop"),
        (("d", "D"), "what flows in D"),
        (("name", "der(hinge)"), r"the derivative of der\(hinge\)"),
    ],
)
def test_what_has_no_rate_is_refused_with_the_stores_at_fault(symbol: Any, words: str) -> None:
    dag, rates = rates_of("D", "E")
    with pytest.raises(ModelError, match=words) as caught:
        rates.of(dag.symbol(*symbol))
    assert "the stores D, E depend on others" in str(caught.value)
    assert caught.value.thing == 'capacitor "D"'
