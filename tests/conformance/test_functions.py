"""Every elementary function means the same in every algebra and every language."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import mpmath
import numpy as np
import pytest
import sympy
from support.compiled import Compiled
from support.emitted import load

import codegen
from linegraph.algebra.formula import parse
from linegraph.algebra.jets import Jet, Jets
from linegraph.algebra.protocol import Floats
from linegraph.algebra.sympy_scalars import Sympy, evaluate
from linegraph.errors import ModelError
from linegraph.ir.dag import Dag
from linegraph.ir.functions import ARITY, of_numbers
from linegraph.ir.interpreter import run
from linegraph.ir.program import Argument, Module, Result, assemble

if TYPE_CHECKING:
    from pathlib import Path

POINTS = {"acos": (0.3, -0.7), "asin": (0.3, -0.7), "log": (0.3, 2.0), "sqrt": (0.3, 2.0)}
SMOOTH = [name for name, count in ARITY.items() if count == 1 and name not in ("abs", "sign")]


def points(name: str) -> list[tuple[float, ...]]:
    if ARITY[name] == 2:
        return [(0.7, -0.4), (-0.2, 1.3), (-1.5, -0.1)]
    return [(x,) for x in POINTS.get(name, (0.6, -1.1))]


def module() -> Module:
    """One function y(q) of all elementary functions."""
    dag = Dag()
    x = [dag.symbol("q", i) for i in range(3)]
    entries = tuple(
        dag.function(name, *([x[0]] if count == 1 else [x[1], x[2]]))
        for name, count in ARITY.items()
    )
    results = (Result("y", (len(entries),), entries, "all"),)
    program = assemble("every", "All functions.", (Argument("q", 3, "x"),), results)
    return Module("functions", (), (), (), (), (), False, (program,))


@pytest.mark.parametrize("name", ARITY)
def test_numbers_and_formulas_agree_with_the_standard_library(name: str) -> None:
    own = {"abs": abs, "min": min, "max": max, "sign": lambda x: math.copysign(1.0, x)}
    for x in points(name):
        expected = own[name](*x) if name in own else getattr(math, name)(*x)
        assert of_numbers(name, *x) == expected
        names = ("a", "b")[: len(x)]
        formula = parse(f"{name}({', '.join(names)})")
        assert formula.evaluate(Floats(), dict(zip(names, x, strict=True))) == expected


@pytest.mark.parametrize("name", ARITY)
def test_sympy_has_the_same_function_and_gives_it_back(name: str) -> None:
    symbols = sympy.symbols("a b", real=True)[: ARITY[name]]
    expression = Sympy().function(name, *symbols)
    for x in points(name):
        values = dict(zip(symbols, x, strict=True))
        expected = of_numbers(name, *x)
        assert float(expression.subs(values).evalf(30)) == pytest.approx(expected, rel=1e-15)
        named = {symbol.name: value for symbol, value in values.items()}
        assert evaluate(expression, Floats(), named) == pytest.approx(expected, rel=1e-15)


def test_emitted_c_and_python_agree(tmp_path: Path) -> None:
    files = {name: codegen.render(module(), name) for name in codegen.LANGUAGES}
    compiled = Compiled(files["c"], "functions", tmp_path)
    emitted = load(files["python"], "functions", tmp_path)
    for x in (0.3, 0.7):
        for y, z in points("atan2"):
            q = [x, y, z]
            (expected,) = run(module().programs[0], {"q": q})
            found = compiled.call("every", q, out=[(len(ARITY),)])
            np.testing.assert_allclose(found, expected, rtol=4e-16, atol=0)
            np.testing.assert_allclose(emitted.every(q), expected, rtol=4e-16, atol=0)
            np.testing.assert_allclose(emitted.every([q, q])[1], expected, rtol=4e-16, atol=0)


@pytest.mark.parametrize("name", SMOOTH)
def test_jets_are_derivatives(name: str) -> None:
    for (x,) in points(name):
        found = Jets(Floats()).function(name, Jet(x, 2.0, 3.0))

        def moved(t: float, x: float = x) -> mpmath.mpf:
            return getattr(mpmath, name)(x + 2 * t + 1.5 * t * t)

        assert found.dx == pytest.approx(float(mpmath.diff(moved, 0)), rel=1e-13)
        assert found.ddx == pytest.approx(float(mpmath.diff(moved, 0, 2)), rel=1e-12)


@pytest.mark.parametrize("y_moves", [True, False])
@pytest.mark.parametrize("x_moves", [True, False])
def test_jets_turn_with_the_point_of_atan2(y_moves: bool, x_moves: bool) -> None:
    """Its angle jumps by a full turn on one side, its derivatives are smooth all around."""
    for y, x in [*points("atan2"), (0.3, 0.5), (0.0, -2.0), (1.2, 0.0)]:
        rise, run = ((2.0, 3.0) if y_moves else (0, 0)), ((-0.5, 0.7) if x_moves else (0, 0))
        given = (Jet(y, *rise) if y_moves else y, Jet(x, *run) if x_moves else x)
        found = Jets(Floats()).function("atan2", *given)

        def moved(t: float, at: float, by: tuple[float, float]) -> mpmath.mpf:
            return at + by[0] * t + by[1] * t * t / 2

        def turned(t: float, y: float = y, x: float = x, by: Any = (rise, run)) -> mpmath.mpf:
            # from the point itself, where mpmath's branch cut is far away
            up, along = moved(t, y, by[0]), moved(t, x, by[1])
            return mpmath.atan2(x * up - y * along, x * along + y * up)

        assert found.x == math.atan2(y, x)
        assert found.dx == pytest.approx(float(mpmath.diff(turned, 0)), rel=1e-13, abs=1e-15)
        assert found.ddx == pytest.approx(float(mpmath.diff(turned, 0, 2)), rel=1e-12, abs=1e-14)


def test_jets_follow_the_rules_of_arithmetic() -> None:
    t = Jet(0.7, 1, 0)
    found = (2 - t) / (1 + t * t) - 3 * t / 2 + (-t) * t

    def curve(s: mpmath.mpf) -> mpmath.mpf:
        return (2 - s) / (1 + s * s) - 3 * s / 2 - s * s

    assert found.x == pytest.approx(float(curve(mpmath.mpf(0.7))), rel=1e-15)
    assert found.dx == pytest.approx(float(mpmath.diff(curve, 0.7)), rel=1e-13)
    assert found.ddx == pytest.approx(float(mpmath.diff(curve, 0.7, 2)), rel=1e-12)


@pytest.mark.parametrize("name", ["abs", "sign", "min", "max"])
def test_what_is_not_smooth_prescribes_no_motion(name: str) -> None:
    with pytest.raises(ModelError, match="not smooth"):
        Jets(Floats()).function(name, Jet(0.1, 1, 0), 0.2)


@pytest.mark.parametrize("text", ["log(0)", "sqrt(-1)", "acos(2)", "exp(10000)"])
def test_numbers_outside_the_domain_are_refused(text: str) -> None:
    with pytest.raises(ModelError, match="is not a finite number"):
        parse(text).evaluate(Floats(), {})
