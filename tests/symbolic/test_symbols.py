"""sympy, the face: expressions walked in and nodes shown as expressions, both against plain numbers."""

from __future__ import annotations

import math
from typing import Any

import pytest
import sympy
from support.dag_values import value

from linegraph import Model, ModelError, Parameter, derive
from linegraph.algebra.protocol import Floats
from linegraph.algebra.sympy_scalars import Sympy, evaluate, to_sympy
from linegraph.ir.dag import Dag, Node
from linegraph.symbolic.simplification.plain import simplify

x, y = sympy.symbols("x y")
VALUES = {"x": 1.7, "y": -0.6}
EXACT = 1e-15  # relative; measured 2e-16


def check(expression: Any, expected: float) -> None:
    """The same number over floats and over nodes."""
    assert evaluate(expression, Floats(), VALUES) == pytest.approx(expected, rel=EXACT)
    dag = Dag()
    nodes = {name: dag.symbol("p", name) for name in VALUES}
    found = value(evaluate(expression, dag, nodes), p=VALUES)
    assert found == pytest.approx(expected, rel=EXACT)


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (x, 1.7),
        (sympy.Integer(3), 3),
        (sympy.Rational(1, 3), 1 / 3),
        (sympy.Float(0.1), 0.1),
        (sympy.pi, math.pi),
        (sympy.E, math.e),
        (x + y + 2, 1.7 - 0.6 + 2),
        (x * y * 3, 1.7 * -0.6 * 3),
        (x - y, 1.7 + 0.6),
        (-x, -1.7),
        (x / y, 1.7 / -0.6),
        (x**0, 1),
        (x**2, 1.7 * 1.7),
        (y**3, (-0.6) ** 3),
        (y**-1, 1 / -0.6),
        (y**-3, (-0.6) ** -3),
        (x**64, 1.7**64),
        (sympy.sqrt(x), math.sqrt(1.7)),
        (x ** sympy.Rational(3, 2), 1.7**1.5),
        (x ** sympy.Rational(-1, 2), 1.7**-0.5),
        (x ** sympy.Rational(-5, 2), 1.7**-2.5),
        (sympy.sqrt(2), math.sqrt(2)),
        (x**0.5, math.sqrt(1.7)),
        (x**2.0, 1.7 * 1.7),
        (x**-1.5, 1.7**-1.5),
        (sympy.sqrt(x**2 + y**2), math.hypot(1.7, -0.6)),
        (sympy.sin(x), math.sin(1.7)),
        (sympy.cos(x - y), math.cos(2.3)),
        (sympy.sin(x) ** 2 / sympy.cos(y), math.sin(1.7) ** 2 / math.cos(-0.6)),
        (sympy.sin(sympy.sqrt(x) * sympy.pi), math.sin(math.sqrt(1.7) * math.pi)),
    ],
    ids=str,
)
def test_expressions_are_walked(expression: Any, expected: float) -> None:
    # many-factored powers round once a factor: measured 5e-16 for the 64th
    if expression == x**64:
        assert evaluate(expression, Floats(), VALUES) == pytest.approx(expected, rel=5e-15)
    else:
        check(expression, expected)


def test_exact_numbers_stay_exact() -> None:
    found = evaluate(sympy.Integer(3), Floats(), {})
    assert found == 3
    assert isinstance(found, int)
    assert evaluate(2 * x, Floats(), {"x": 3}) == 6
    assert isinstance(evaluate(2 * x, Floats(), {"x": 3}), int)


def test_integer_powers_cost_one_product_each() -> None:
    dag = Dag()
    node = evaluate(x**3, dag, {"x": dag.symbol("p", "x")})
    assert isinstance(node, Node)
    assert (node.op, node.a.op, node.b.op) == ("mul", "symbol", "mul")


@pytest.mark.parametrize("expression", [x + sympy.Symbol("z"), sympy.sin(sympy.Symbol("z")) * x])
def test_an_undeclared_symbol_is_named(expression: Any) -> None:
    with pytest.raises(ModelError, match='parameter "z": is used but not declared; declare it wi'):
        evaluate(expression, Floats(), VALUES)


@pytest.mark.parametrize(
    ("expression", "message"),
    [
        (sympy.gamma(x), r"gamma\(\.\.\.\) in gamma\(x\) has no counterpart in emitted code"),
        (sympy.erf(x), r"erf\(\.\.\.\) in erf\(x\) has no counterpart"),
        (sympy.floor(x), r"floor\(\.\.\.\) in floor\(x\) has no counterpart"),
        (sympy.Function("f")(x), r"f\(\.\.\.\) in f\(x\) has no counterpart"),
        (sympy.I * x, r"ImaginaryUnit\(\.\.\.\) in I has no counterpart"),
        (sympy.Piecewise((x, x > 0), (y, True)), "has no counterpart in emitted code"),
        (x**y, "the power y has no counterpart in emitted code"),
        (x ** sympy.Rational(1, 3), "the power 1/3 has no counterpart"),
        (x**65, "the power 65 has no counterpart"),
        (x**-65, "the power -65 has no counterpart"),
        (2**x, "the power x has no counterpart"),
    ],
    ids=str,
)
def test_what_emitted_code_has_no_word_for_is_refused(expression: Any, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        evaluate(expression, Floats(), VALUES)


@pytest.mark.parametrize("text", ["x + 1", "__import__('os').getpid()", ""])
def test_text_is_never_evaluated(text: str) -> None:
    with pytest.raises((sympy.SympifyError, ModelError)):
        evaluate(text, Floats(), VALUES)


# ---- parameters


def test_parameters_calculate_as_their_symbols() -> None:
    m, other = Parameter("x", 2.0, "kg", "a mass"), Parameter("y")
    assert m + other == x + y
    assert m + 1 == 1 + m == x + 1
    assert m - other == x - y
    assert m - 1 == x - 1
    assert 1 - m == 1 - x
    assert m * other == x * y
    assert 2 * m == m * 2 == 2 * x
    assert m / other == x / y
    assert m / 2 == x / 2
    assert 1 / m == 1 / x
    assert -m == -x
    assert m**2 == x**2
    assert sympy.sin(m) == sympy.sin(x)
    assert x + other == x + y


def test_parameters_go_through_a_model() -> None:
    """M of a rod on a hinge, with its length and mass as symbols: m l^2 / 3."""
    model = Model("rod")
    m = model.parameter("m", 2.0, "kg")
    length = model.parameter("l", 0.5, "m")
    across = m * length**2 / 12
    rod = model.body("rod", mass=m, mass_center=(length / 2, 0, 0), inertia=(0, across, across))
    model.revolute("hinge", between=("ground", rod), axis=(0, 1, 0))
    derivation = derive(model)
    ((entry,),) = derivation.symbolic.mass_matrix.tolist()
    assert sympy.simplify(entry - sympy.Symbol("m") * sympy.Symbol("l") ** 2 / 3) == 0
    assert derivation.numeric().mass_matrix([0.2])[0][0] == pytest.approx(2 * 0.25 / 3, rel=EXACT)
    other = derivation.numeric({"m": 3.0, "l": 2.0}).mass_matrix([0.2])[0][0]
    assert other == pytest.approx(4.0, rel=EXACT)


def test_a_parameter_with_the_name_of_a_coordinate_is_refused() -> None:
    model = Model("m")
    body = model.body("b", mass=model.parameter("slide", 1.0))
    model.prismatic("slide", between=("ground", body))
    with pytest.raises(
        ModelError, match='its coordinate "slide" has the name of a parameter; rename'
    ):
        _ = derive(model).symbolic


# ---- nodes shown as sympy


def named(names: dict[str, list[str]]) -> Any:
    return lambda symbol: Sympy(names).symbol(*symbol)


def test_every_operation_of_a_node_is_shown() -> None:
    dag = Dag()
    a, b = dag.symbol("q", 0), dag.symbol("p", "mass")
    names = {"q": ["alpha"]}
    alpha, mass = sympy.symbols("alpha mass")
    shown = [
        (a, alpha),
        (b, mass),
        (dag.symbol("t"), sympy.Symbol("t")),
        (-a, -alpha),
        (a + b, alpha + mass),
        (a - b, alpha - mass),
        (2 - a, 2 - alpha),
        (a * b, alpha * mass),
        (a / b, alpha / mass),
        (1 / a, 1 / alpha),
        (a / 3, alpha / 3),
        (dag.sin(a), sympy.sin(alpha)),
        (dag.cos(a), sympy.cos(alpha)),
        (dag.sqrt(a), sympy.sqrt(alpha)),
        (7, sympy.Integer(7)),
    ]
    for node, expected in shown:
        assert to_sympy(node, named(names)) == expected


@pytest.mark.parametrize(
    "expression",
    [
        x * y + 3,
        (x - y) * sympy.sin(x) / (2 + sympy.cos(y)),
        sympy.sqrt(x**2 + y**4) * sympy.pi.evalf(17),
        (x + y) ** 5 - (x - y) ** -2,
    ],
    ids=str,
)
def test_from_sympy_to_nodes_and_back(expression: Any) -> None:
    dag = Dag()
    node = evaluate(expression, dag, {n: dag.symbol("p", n) for n in ("x", "y")})
    shown = to_sympy(node, named({}))
    for numbers in ({x: 1.3, y: 0.4}, {x: 0.7, y: 2.9}):
        difference = (shown - expression).subs(numbers)
        assert abs(float(difference)) < 1e-14 * abs(float(expression.subs(numbers)))
    again = evaluate(shown, dag, {n: dag.symbol("p", n) for n in ("x", "y")})
    assert value(again, p={"x": 1.3, "y": 0.4}) == pytest.approx(
        value(node, p={"x": 1.3, "y": 0.4}), rel=1e-15
    )


def test_deep_nodes_are_shown_without_recursion() -> None:
    dag = Dag()
    node: Any = dag.symbol("q", 0)
    for _ in range(3000):
        node = node / (dag.symbol("q", 1))
    shown = to_sympy(node, named({"q": ["a", "b"]}))
    assert shown == sympy.Symbol("a") / sympy.Symbol("b") ** 3000


def test_the_algebra_of_sympy_names_its_symbols() -> None:
    algebra = Sympy({"q": ["first", "second"]})
    assert algebra.symbol("q", 1) == sympy.Symbol("second")
    assert algebra.symbol("p", "mass") == sympy.Symbol("mass")
    assert algebra.symbol("t") == sympy.Symbol("t")
    assert algebra.sin(0) == 0
    assert algebra.sqrt(4) == 2


def test_simplified_expands_merges_and_collects() -> None:
    assert simplify(sympy.sin(x) ** 2 + sympy.cos(x) ** 2) == 1
    assert simplify(0) == 0
    assert simplify(2.0 * x) == 2 * x
    assert not simplify(2.0 * x + 4.0 * y).atoms(sympy.Float)
    kept = simplify(0.25 * x)
    assert kept == 0.25 * x
