"""Published networks, symbol for symbol: StateMint's tests, Rowell and Wormley's problems, and more."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sympy
from published.published_networks import PUBLISHED, Published

import linegraph as lg
from linegraph.algebra.formula import parse
from linegraph.algebra.sympy_scalars import Sympy
from linegraph.readers import modelfile

LINEAR = [system for system in PUBLISHED if not system.rates]


def derived(system: Published) -> Any:
    model = modelfile.parse(system.model.encode(), f"{system.name}.toml")
    return lg.derive(model)


def expression(text: str) -> Any:
    """A text of the file as sympy, by our own parser."""
    formula = parse(text)
    return formula.evaluate(Sympy(), {name: sympy.Symbol(name) for name in formula.names()})


def matrix(rows: Any) -> Any:
    return sympy.Matrix([[expression(str(x)) for x in row] for row in rows])


@pytest.mark.parametrize("system", PUBLISHED, ids=lambda system: system.name)
def test_states_are_the_published_ones(system: Published) -> None:
    names = [q.name for q in derived(system).structure.velocities]
    assert sorted(names) == sorted(system.states)


@pytest.mark.parametrize("system", PUBLISHED, ids=lambda system: system.name)
def test_rates_are_the_published_ones(system: Published) -> None:
    derivation = derived(system)
    rates = dict(zip(map(str, derivation.symbolic.v), derivation.symbolic.rates, strict=True))
    ours = [sign * rates[name] for name, sign in zip(system.states, system.signs, strict=True)]
    turned = {
        sympy.Symbol(name): sign * sympy.Symbol(name)
        for name, sign in zip(system.states, system.signs, strict=True)
    }
    ours = [rate.subs(turned, simultaneous=True) for rate in ours]
    if system.rates:
        published = [expression(text) for text in system.rates]
    else:
        x = sympy.Matrix([sympy.Symbol(name) for name in system.states])
        u = sympy.Matrix([sympy.Symbol(name) for name in system.inputs])
        published = matrix(system.A) * x
        if system.inputs and system.B:
            published += matrix(system.B) * u
        if system.E:
            slopes = sympy.Matrix([sympy.Symbol(f"{name}_rate") for name in system.inputs])
            published += matrix(system.E) * slopes
    for rate, wanted in zip(ours, published, strict=True):
        assert sympy.simplify(rate - wanted) == 0


@pytest.mark.parametrize("system", LINEAR, ids=lambda system: system.name)
def test_state_space_is_the_published_one(system: Published) -> None:
    space = derived(system).state_space
    order = [space.states.index(name) for name in system.states]
    signs = sympy.diag(*system.signs)

    def same(ours: Any, published: Any) -> bool:
        return not any(sympy.simplify(x) != 0 for x in ours - matrix(published))

    assert same(signs * space.A.extract(order, order) * signs, system.A)
    for ours, published in ((space.B, system.B), (space.E, system.E)):
        if published and published[0]:
            assert same(signs * ours.extract(order, range(ours.cols)), published)
    if not system.outputs:
        return
    rows = [space.outputs.index(name) for name in system.outputs]
    assert same(space.C.extract(rows, order) * signs, system.C)
    for ours, published in ((space.D, system.D), (space.F, system.F)):
        if published and published[0]:
            assert same(ours.extract(rows, range(ours.cols)), published)


@pytest.mark.parametrize("system", LINEAR, ids=lambda system: system.name)
def test_transfer_functions_are_those_of_scipy(system: Published) -> None:
    """H(s) of the symbolic fraction, and of scipy's object, at a point off the axis."""
    space = derived(system).state_space
    if not space.inputs or any(entry != 0 for entry in space.F):
        return
    values = {sympy.Symbol(name): x for name, x in space.defaults.items()}
    s = 0.3 + 1.7j
    found = space.to_scipy()
    inner = np.linalg.solve(s * np.eye(len(found.A)) - found.A, found.B)
    expected = found.C @ inner + found.D
    if any(entry != 0 for entry in space.E):
        return  # scipy's states are shifted, and so are outputs that are states
    ours = space.transfer_function().subs(values).subs(sympy.Symbol("s"), s)
    ours = np.array(ours.applyfunc(sympy.N).tolist(), dtype=complex)
    assert np.max(np.abs(ours - expected)) <= 1e-10 * (1 + np.max(np.abs(expected)))
