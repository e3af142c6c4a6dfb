"""The expression DAG: equal operations are one node, and simplification changes no value."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_programs import OPERATIONS
from support.plain_values import value

from linegraph.ir.dag import Dag, Node

AT = {("x", None): Fraction(7, 3), ("y", None): Fraction(-5, 2)}

numbers = st.sampled_from([0, 1, -1, 2, -3, Fraction(1, 2)])
steps = st.lists(
    st.tuples(st.sampled_from("+-*/n"), st.integers(0, 9), st.integers(0, 9)), max_size=8
)


@settings(derandomize=True, deadline=None, max_examples=150)
@given(steps, numbers, numbers)
def test_arithmetic_of_nodes_is_arithmetic_of_their_values(
    made: list[tuple[str, int, int]], k: Any, m: Any
) -> None:
    """Random operations on two symbols, two numbers and what came of operations before."""
    dag = Dag()
    nodes: list[Any] = [dag.symbol("x"), dag.symbol("y"), Fraction(k), Fraction(m)]
    exact: list[Any] = [AT["x", None], AT["y", None], Fraction(k), Fraction(m)]
    for op, first, second in made:
        i, j = first % len(nodes), second % len(nodes)
        if op == "n":
            nodes.append(-nodes[i])
            exact.append(-exact[i])
        elif op != "/" or exact[j] != 0:
            nodes.append(OPERATIONS[op](nodes[i], nodes[j]))
            exact.append(OPERATIONS[op](exact[i], exact[j]))
        assert value(nodes[-1], AT) == exact[-1]


DAG = Dag()
X, Y, Z = (DAG.symbol(name) for name in "xyz")


@pytest.mark.parametrize(
    ("made", "expected"),
    [
        (X + 0, X),
        (X * 1, X),
        (X * 0, 0),
        (X - X, 0),
        (X / X, 1),
        (0 / X, 0),
        (0 - -X, X),
        (X * -1, -X),
        (X + Y, Y + X),
        (X * Y, Y * X),
        (X + X, 2 * X),
        (X + -Y, X - Y),
        (-X + Y, Y - X),
        (-X - Y, -(X + Y)),
        (X - -Y, X + Y),
        (X * -Y, -(X * Y)),
        (-X / Y, -(X / Y)),
        (X / -Y, -(X / Y)),
        (Y - X, -(X - Y)),
        (2 * (3 * X), 6 * X),
        (X / 4, X * Fraction(1, 4)),
        (0 - X, -X),
        (-X + 3, 3 - X),
        (DAG.cos(-X), DAG.cos(X)),
        (DAG.sin(-X), -DAG.sin(X)),
        (DAG.function("sin", -X), -DAG.sin(X)),
        (DAG.function("max", X, Y), DAG.function("max", X, Y)),
    ],
)
def test_equal_forms_are_one_node(made: Any, expected: Any) -> None:
    assert (made is expected) if isinstance(expected, Node) else made == expected


@pytest.mark.parametrize(
    ("a", "b"),
    [
        (X - Y, X + Y),
        (X / Y, Y / X),
        (DAG.sin(X), DAG.cos(X)),
        (DAG.symbol("q", 0), DAG.symbol("q", 1)),
        (DAG.symbol("q", 0), DAG.symbol("v", 0)),
        (DAG.function("atan2", X, Y), DAG.function("atan2", Y, X)),
        (X + 1, X + 2),
    ],
)
def test_other_operations_are_other_nodes(a: Any, b: Any) -> None:
    assert a is not b


def test_a_number_is_not_the_node_that_has_its_index() -> None:
    dag = Dag()
    x, y = dag.symbol("x"), dag.symbol("y")
    assert x * y is not x * y.index
    assert y + 1 is not y + y
    assert 1 - x is not y - x
    assert y / x is not 1 / x


def test_functions_of_numbers_are_numbers() -> None:
    dag = Dag()
    assert dag.cos(0) == 1
    assert dag.sqrt(4) == 2.0
    assert dag.function("max", 2, 5) == 5
    assert dag.count == 0


def test_nodes_are_numbered_as_they_are_made_and_labelled() -> None:
    dag = Dag()
    x = dag.symbol("q", 2)
    dag.label = "arm"
    y = dag.sin(x)
    assert [x.index, y.index, dag.count] == [0, 1, 2]
    assert [x.label, y.label] == ["", "arm"]
    assert [repr(x), repr(y), repr(dag.symbol("t"))] == ["q[2]", "n1", "t"]


def test_released_operations_are_made_anew() -> None:
    dag = Dag()
    x = dag.symbol("x")
    before = dag.sin(x)
    dag.release()
    assert dag.sin(x) is not before


def test_a_copy_is_the_same_operation_of_another_dag() -> None:
    other = Dag()
    copies: dict[int, Any] = {X.index: other.symbol("x"), Y.index: other.symbol("y")}
    product = X * Y
    found = other.copied(product, copies)
    assert isinstance(found, Node)
    assert found.dag is other
    assert found is other.symbol("x") * other.symbol("y")


def test_division_by_the_number_zero_raises() -> None:
    with pytest.raises(ZeroDivisionError):
        _ = X / 0


def test_what_is_no_operand_calculates_itself() -> None:
    class Other:
        def __radd__(self, x: Any) -> str:
            return "mine"

    assert X + Other() == "mine"
