"""Values at random points: three walks that agree where forms are equal, and nowhere else."""

from __future__ import annotations

from typing import Any

import pytest
import sympy
from rings import PLACES, k, l, m, polynomial, u, x, y
from sympy import cos, sin, sqrt

from linegraph.algebra.sympy_scalars import evaluate
from linegraph.ir.dag import Dag
from linegraph.symbolic.simplification.polynomial import Ring
from linegraph.symbolic.simplification.proof import DIGITS, EXACT, Precise, SamplePoint


def point(seed: int = 0, **more: Any) -> tuple[Ring, SamplePoint]:
    ring = Ring()
    return ring, SamplePoint(ring, dict(PLACES), seed, **more)


FORMS = [
    m * sin(x + y) ** 2 - k * u,
    sqrt(m + k) / (l + cos(x) ** 2),
    sympy.Max(m, k) + sympy.Min(l, abs(m - k)),
    sympy.exp(-m) * sympy.atan2(k, l),
    sympy.Rational(1, 3) * m**-2,
    sympy.pi * m,
    sympy.Float(0.1) * m,
    sympy.sign(m - k) * sympy.log(l),
]


@pytest.mark.parametrize("e", FORMS)
@pytest.mark.parametrize("seed", [0, 1])
def test_nodes_terms_and_expressions_are_worth_the_same(e: Any, seed: int) -> None:
    """And the same as sympy finds at these values."""
    ring, at = point(seed)
    dag = Dag()
    node = evaluate(e, dag, {s.name: dag.symbol(*place) for s, place in PLACES.items()})
    terms = polynomial(ring, e).terms
    values = {s: sympy.Float(str(at.value(place)), 60) for s, place in PLACES.items()}
    expected = sympy.N(e.xreplace(values), 60)
    closeness = 1e-14 if e.has(sympy.Float, sympy.pi) else EXACT
    for found in (at.node(node), at.terms(terms)[0], at.expression(e)):
        assert abs(sympy.Float(str(found), 60) - expected) <= closeness * (1 + abs(expected))


def test_forms_that_differ_a_little_are_told_apart() -> None:
    _, at = point()
    a, b = m * sin(x) ** 2, m * sin(x) ** 2 * (1 + sympy.Rational(1, 10**38))
    assert abs(at.expression(a) - at.expression(b)) > EXACT


def test_the_size_of_a_sum_is_that_of_its_terms() -> None:
    ring, at = point()
    value, scale = at.terms(polynomial(ring, m - k).terms)
    assert value == at.value(("p", "m")) - at.value(("p", "k"))
    assert scale == at.value(("p", "m")) + at.value(("p", "k"))
    assert at.terms({}) == (0, 0)


def test_values_depend_on_the_symbol_and_the_seed_alone() -> None:
    (_, first), (_, again), (_, other) = point(3), point(3), point(4)
    again.value(("p", "k"))
    assert first.value(("p", "m")) == again.value(("p", "m"))
    assert first.value(("p", "m")) != other.value(("p", "m"))
    assert first.value(("q", 0)) != first.value(("q", 1))
    assert 0 < first.value(("v", 0)) < 2


def test_symbols_of_a_unit_vector_have_the_length_one() -> None:
    units = [[("q", n) for n in range(4)]]
    _, at = point(units=units)
    length = sum(at.value(("q", n)) ** 2 for n in range(4))
    assert abs(length - 1) < 10 ** -(DIGITS - 2)


def test_a_defined_symbol_has_the_value_of_its_expression() -> None:
    _, at = point()
    at.define(("constant", 0), sin(m) + 1)
    assert at.value(("constant", 0)) == at.expression(sin(m) + 1)


def test_a_replay_takes_other_values_of_symbols() -> None:
    _, at = point()
    dag = Dag()
    node = dag.symbol("p", "m") * 3 + dag.symbol("q", 0)
    found = at.replay({("p", "m"): 5, ("q", 0): 7}.__getitem__)(node)
    assert found == 22


def test_functions_have_fifty_digits() -> None:
    algebra = Precise()
    root = algebra.sqrt(algebra.context.mpf(2))
    assert abs(root * root - 2) < 10 ** -(DIGITS - 2)
    assert algebra.function("abs", -3) == 3
    assert algebra.function("max", algebra.context.mpf(1), algebra.context.mpf(4)) == 4
    assert algebra.sqrt(algebra.context.mpf(-4)).imag == 2
    with pytest.raises(KeyError):
        algebra.symbol("p", "m")
