"""Programs run as they are, over floats."""

from __future__ import annotations

import math
from typing import Any

import pytest
from small_programs import at, program, returned

from linegraph.errors import ModelError
from linegraph.ir.dag import Dag
from linegraph.ir.functions import ARITY
from linegraph.ir.interpreter import run
from linegraph.ir.program import Argument, Result, assemble

DAG = Dag()
Q = [DAG.symbol("q", n) for n in range(4)]
M = DAG.symbol("p", "m")


def test_operations_follow_one_another() -> None:
    x, y = Q[0], Q[1]
    made = program((x + y) * M - x / y, -(x - y), 3 - x, 5)
    given = (2.0, 4.0, 0.0, 0.0)
    assert run(made, {"q": given, "p": {"m": 10.0}}) == [[59.5, 2.0, 1.0, 5.0]]
    assert run(made, {"q": given, "p": {"m": 10.0}})[0] == returned(made, at(given, m=10.0))


@pytest.mark.parametrize("name", sorted(ARITY))
def test_each_function_is_that_of_the_standard_library(name: str) -> None:
    x = (0.3, 0.8)[: ARITY[name]]
    own: dict[str, Any] = {"abs": abs, "min": min, "max": max, "sign": lambda x: 1.0}
    expected = own[name](*x) if name in own else getattr(math, name)(*x)
    made = program(DAG.function(name, *Q[: ARITY[name]]))
    assert run(made, {"q": [0.3, 0.8]}) == [[expected]]


def test_each_result_has_its_entries_and_the_time_is_a_number() -> None:
    t = DAG.symbol("t")
    results = (Result("a", (2,), (t, 1), ""), Result("b", (1,), (t * Q[3],), ""))
    made = assemble("f", "", (Argument("t", None, ""), Argument("q", 4, "")), results)
    assert run(made, {"t": 2.0, "q": [0, 0, 0, 7.0]}) == [[2.0, 1.0], [14.0]]


def test_a_function_without_a_finite_value_is_refused() -> None:
    with pytest.raises(ModelError, match="not a finite number"):
        run(program(DAG.function("log", Q[0])), {"q": [-1.0]})
