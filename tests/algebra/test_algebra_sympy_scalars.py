"""sympy's expressions walked into other algebras and back."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
import sympy

from linegraph.algebra.protocol import Floats
from linegraph.algebra.sympy_scalars import Sympy, evaluate, number, power, to_sympy
from linegraph.errors import ModelError
from linegraph.ir.dag import Dag
from linegraph.ir.functions import ARITY

a, b = sympy.symbols("a b", real=True)
VALUES = {"a": 0.7, "b": 0.3}


@pytest.mark.parametrize(
    "e",
    [
        a + b - 3,
        a * b / 2,
        a**3 * b**-2,
        sympy.sqrt(a) + a ** sympy.Rational(-3, 2),
        sympy.sin(a) * sympy.cos(b) + sympy.tan(a),
        sympy.atan2(a, b),
        abs(a - 1) + sympy.sign(b),
        sympy.Min(a, b, 1) + sympy.Max(a, b),
        sympy.exp(-a) + sympy.log(b),
        sympy.pi * a + sympy.Float(0.25),
        a**1.5,
    ],
)
def test_an_expression_is_worth_the_same_in_floats(e: Any) -> None:
    expected = float(e.subs({a: VALUES["a"], b: VALUES["b"]}))
    assert evaluate(e, Floats(), VALUES) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(
    "e", [a * b - 3, a / b, a**2 + sympy.sqrt(b), sympy.sin(a) - abs(b), sympy.Max(a, b) / 3]
)
def test_an_expression_comes_back_from_a_dag(e: Any) -> None:
    dag = Dag()
    node = evaluate(e, dag, {"a": dag.symbol("p", "a"), "b": dag.symbol("p", "b")})
    back = to_sympy(node, lambda symbol: {"a": a, "b": b}[symbol[1]])
    assert sympy.simplify(back - e) == 0


@pytest.mark.parametrize("name", sorted(ARITY))
def test_each_function_is_sympys(name: str) -> None:
    x = [sympy.Rational(1, 3), sympy.Rational(1, 2)][: ARITY[name]]
    expected = Floats().function(name, *map(float, x))
    assert float(Sympy().function(name, *x)) == pytest.approx(float(expected))


def test_symbols_have_the_names_of_their_entries() -> None:
    algebra = Sympy({"q": ["x", "phi"]})
    assert algebra.symbol("q", 1) == sympy.Symbol("phi")
    assert algebra.symbol("p", "m") == sympy.Symbol("m")
    assert algebra.symbol("t") == sympy.Symbol("t")


@pytest.mark.parametrize(
    ("e", "expected"),
    [
        (sympy.Integer(4), 4),
        (sympy.Rational(2, 3), Fraction(2, 3)),
        (sympy.Float(0.5), 0.5),
        (sympy.pi, 3.141592653589793),
    ],
)
def test_numbers_are_exact_where_sympys_are(e: Any, expected: Any) -> None:
    found = number(e)
    assert found == expected
    assert type(found) is type(expected)


@pytest.mark.parametrize("twice", range(-5, 8))
def test_powers_of_halves_are_powers(twice: int) -> None:
    found = power(2.3, sympy.Rational(twice, 2), Floats())
    assert found == pytest.approx(2.3 ** (twice / 2), rel=1e-14)


@pytest.mark.parametrize("exponent", [sympy.Rational(1, 3), a, sympy.Integer(65), sympy.Float(0.3)])
def test_other_powers_are_refused(exponent: Any) -> None:
    with pytest.raises(ModelError, match="has no counterpart in emitted code"):
        power(2.0, exponent, Floats())


@pytest.mark.parametrize(
    ("e", "words"),
    [
        (sympy.Symbol("zeta"), "used but not declared"),
        (sympy.gamma(a), r"gamma\(\.\.\.\)"),
        (1 / (a - sympy.Float(0.7)), "division by zero"),
    ],
)
def test_what_cannot_be_evaluated_is_refused(e: Any, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        evaluate(e, Floats(), VALUES)
