"""What force elements and stores hold: integrated, given and compared, named as not known, or refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from linegraph import Model, ModelError, derive
from linegraph.algebra.antiderivative import antiderivative
from linegraph.algebra.differentiation import Calculus, Replay
from linegraph.algebra.protocol import Floats
from linegraph.components.parameters import resolver
from linegraph.emission.emit import render
from linegraph.ir.dag import Dag
from linegraph.readers.modelfile import parse

INTEGRATED = (
    "100*x + 7*x**3",
    "k*(x - a)**3",
    "k/x**2",
    "1/(x + a)",
    "k*(x - a)*abs(x - a)",
    "sin(k*x + a)",
    "k*cos(x)*3 - 2",
    "tan(x/4)",
    "tanh(x/a)",
    "exp(-x)*k",
    "sinh(x) + cosh(x)",
    "log(x)",
    "atan(k*x)",
    "asin(x/5) + acos(x/5)",
    "k*max(0, x - a)",
    "max(0, x - a)**2",
    "k*max(0, a - x)**3",
    "max(0, x)**1.5",
    "min(x, a)",
    "min(a, max(-a, k*x))",
    "max(-1, min(x, a))",
    "max(0, max(x, a))",
    "x**1.5",
    "sqrt(max(0, x))",
    "abs(x)**1.5*sign(x)",
    "sign(x)*sqrt(abs(x))",
    "(x**2 + 1)*(x - a)",
    "(1 + x)/x**3",
    "x/(1 + x**2)",
    "x*sqrt(x**2 + a**2)",
    "k*(1 - a/sqrt(x**2 + a**2))*x",
    "x*exp(-x**2)",
    "1/sqrt(x + a)",
)
LEFT = ("x*exp(x)", "exp(x**2)", "sin(x)**3*cos(k*x)", "x*max(0, x - a)")


def traced(text: str) -> tuple[Calculus, Any, Any]:
    dag = Dag()
    calculus = Calculus(dag)
    f = resolver(dag, {name: dag.symbol(name) for name in "xka"})(text)
    return calculus, f, antiderivative(calculus, f, ("x", None))


@pytest.mark.parametrize("text", INTEGRATED)
def test_antiderivatives_are_integrals(text: str) -> None:
    _calculus, f, found = traced(text)
    assert found is not None
    replay = [
        lambda x, y=y: Replay(
            Floats(), {("x", None): x, ("k", None): 1.3, ("a", None): 0.7}.__getitem__
        )(y)
        for y in (f, found)
    ]
    nodes, weights = np.polynomial.legendre.leggauss(60)
    for low, high in ((0.1, 0.6), (0.8, 2.5)):
        middle, half = (low + high) / 2, (high - low) / 2
        integral = half * sum(
            w * replay[0](float(middle + half * n)) for n, w in zip(nodes, weights, strict=True)
        )
        # limits have kinks within the interval: there the rule of Gauss is less exact
        close = 1e-3 if "max" in text or "min" in text else 1e-9
        assert replay[1](high) - replay[1](low) == pytest.approx(integral, rel=close, abs=close)


@pytest.mark.parametrize("text", LEFT)
def test_what_no_rule_integrates_is_left(text: str) -> None:
    assert traced(text)[2] is None


def slider(**keys: Any) -> Model:
    model = Model("slider")
    model.gravity = (0, 0, 0)
    for name, value in (("k", 3.0), ("k3", 2.0), ("a", 0.4)):
        model.parameter(name, value)
    model.input("u")
    body = model.body("block", mass=2)
    model.prismatic("x1", ("ground", body), (1, 0, 0), effort=False)
    other = model.body("other", mass=1)
    model.prismatic("y1", ("ground", other), (1, 0, 0), effort=False)
    kind = keys.pop("kind", "law")
    getattr(model, kind)("l", joint="x1", **keys)
    return model


def potential(model: Model, x: float) -> float:
    return float(derive(model).function("energy")([x, 0.3], [0.0, 0.0])[1])


@pytest.mark.parametrize(
    ("keys", "x", "expected"),
    [
        ({"force": "k*x + k3*x**3"}, 1.0, 1.5 + 0.5),
        ({"kind": "spring", "force": "k*x + k3*x**3", "length": 0.5}, 1.5, 1.5 + 0.5),
        ({"force": "k*x + 5*v - u + sin(t)"}, 2.0, 6.0),
        ({"force": "k*x*(1 + v)"}, 2.0, 6.0),
        ({"force": "u*x"}, 2.0, 0.0),
        ({"force": "(k + u)*x"}, 2.0, 6.0),
        ({"force": "min(1, max(-1, x))"}, 3.0, 2.5),
        ({"force": "x*exp(x)", "energy": "(x - 1)*exp(x) + 1"}, 1.0, 1.0),
        ({"kind": "spring", "stiffness": "k", "energy": "k*x**2/2"}, 2.0, 6.0),
    ],
)
def test_energy_of_a_law(keys: dict[str, Any], x: float, expected: float) -> None:
    model = slider(**keys)
    arguments = [x, 0.3], [0.0, 0.0]
    energy = derive(model).function("energy")
    found = energy(0.0, *arguments) if model.depends_on_time else energy(*arguments)
    assert found[1] == pytest.approx(expected, abs=1e-12)
    assert "Not known" not in "".join(render(model, languages=["python"]).values())


@pytest.mark.parametrize(
    ("keys", "reason"),
    [
        ({"force": "x*exp(x)"}, "law l (no rule integrates its force)"),
        ({"force": "k*(x - y1)"}, "law l (its force depends on y1 too)"),
        ({"force": "x/u"}, "law l (its force is not finite at rest)"),
        ({"force": "k*x*sin(t)"}, "law l (the time changes its stiffness)"),
        ({"kind": "spring", "stiffness": "k*(1 + u)"}, "spring l (its stiffness depends on u)"),
        ({"kind": "spring", "stiffness": 2, "length": "y1"}, "spring l (its length depends on y1)"),
    ],
)
def test_what_is_not_known_is_named_where_energy_is_described(
    keys: dict[str, Any], reason: str
) -> None:
    files = render(slider(**keys))
    for name in ("slider.h", "slider.py"):
        said = " ".join(files[name].replace("*", " ").split())
        assert f"Not known, and left out: the energy of {reason}".replace("*", " ") in said


@pytest.mark.parametrize(
    ("keys", "problem"),
    [
        ({"force": "x*exp(x)", "energy": "x*exp(x)"}, "is not the force at v = 0"),
        ({"force": "-k*x", "energy": "k*x**2/2"}, "is not the force at v = 0"),
        ({"force": "k*x + u", "energy": "k*x**2/2 + u*x"}, "names u"),
        ({"force": "k*x", "energy": "k*x**2/2 + v"}, "names v"),
    ],
)
def test_an_energy_that_is_not_that_of_the_force_is_refused(
    keys: dict[str, Any], problem: str
) -> None:
    with pytest.raises(ModelError, match="energy: ") as error:
        derive(slider(**keys))
    assert problem in str(error.value)
    assert error.value.thing == 'law "l"'


def test_a_stop_holds_what_it_takes_in() -> None:
    model = slider(kind="stop", lower=-0.2, upper=0.5, stiffness=1e3, width=1e-2)
    derivation = derive(model)
    energy, bias = derivation.function("energy"), derivation.function("bias")
    for x in (-0.5, -0.2, 0.1, 0.5, 0.9):
        h = 1e-5
        ahead, behind = (energy([x + s, 0.3], [0, 0])[1] for s in (h, -h))
        force = bias([x, 0.3], [0.0, 0.0])[0]
        assert (ahead - behind) / (2 * h) == pytest.approx(force, rel=1e-7, abs=1e-6)
    # far beyond the limit it is the spring's, but for the rounding
    assert potential(model, 1.5) == pytest.approx(1e3 / 2, rel=1e-3)


# ---- stores


def plate(kind: str = "capacitor", **keys: Any) -> Model:
    model = slider(kind="spring", stiffness=1)
    ends = ("a", "ground")
    model.current_source("s", ends, current=1) if kind != "inductor" else model.resistor(
        "s", ends, resistance=1
    )
    model.resistor("beside", ends, resistance=2)
    getattr(model, kind)("C", ends, **keys)
    return model


@pytest.mark.parametrize(
    ("kind", "keys", "named", "instead"),
    [
        ("capacitor", {"capacitance": "1e-9*a/x1"}, "x1", "variable_capacitor"),
        ("capacitor", {"charge": "x*(1 + x1)"}, "x1", "variable_capacitor"),
        ("capacitor", {"coenergy": "x**2*(1 + x1)"}, "x1", "variable_capacitor"),
        ("capacitor", {"capacitance": "1 + der(x1)"}, "der(x1)", "variable_capacitor"),
        ("inductor", {"inductance": "1 + x1"}, "x1", "solenoid or reluctance_machine"),
        (
            "store",
            {"domain": "electrical", "constant": "1 + x1**2"},
            "x1",
            "its own variable alone",
        ),
        ("capacitor", {"capacitance": "1 + across(s)**2"}, "across(s)", "its own variable alone"),
        (
            "capacitor",
            {"capacitance": "1 + through(beside)"},
            "through(beside)",
            "its own variable alone",
        ),
        (
            "capacitor",
            {"capacitance": "1 + across(C)**2"},
            "across(C)",
            "give charge or coenergy instead",
        ),
    ],
)
def test_a_store_that_something_else_changes_is_refused(
    kind: str, keys: dict[str, Any], named: str, instead: str
) -> None:
    with pytest.raises(ModelError) as error:
        derive(plate(kind, **keys))
    assert error.value.thing == f'{kind} "C"'
    assert named in error.value.problem
    assert instead in error.value.problem


def test_the_line_of_a_store_that_moves_is_named() -> None:
    text = """\
name = "cap"
[body.plate]
mass = 0.01
[prismatic.gap]
between = ["ground", "plate"]
axis = [1, 0, 0]
[current_source.s]
between = ["ground", "a"]
current = 1
[capacitor.C]
between = ["a", "ground"]
capacitance = "1e-9/(1 + gap)"
"""
    with pytest.raises(ModelError, match=r'm\.toml:10: capacitor "C": .*Use variable_capacitor'):
        derive(parse(text.encode(), "m.toml"))


def test_what_the_time_and_inputs_change_is_remarked() -> None:
    model = plate(capacitance="2 + sin(t) + u")
    assert any(
        "t and u change what C stores" in r for r in derive(model).formulation.network.remarks
    )


def test_a_resistor_may_name_anything() -> None:
    model = plate(capacitance=1)
    model.resistor("R", ("a", "ground"), resistance="1 + x1**2 + across(s)**2")
    derive(model)


def test_a_variable_capacitor_pulls_its_plate_with_the_derivative_of_its_energy() -> None:
    """C = C0/(1 + x/d) at voltage v: the force is v² C'(x) / 2, towards smaller x."""
    model = Model("cap")
    model.gravity = (0, 0, 0)
    model.prismatic("gap", ("ground", model.body("plate", mass=0.01)), (1, 0, 0), effort=False)
    model.resistor("R", ("a", "ground"), resistance=1e9)
    model.variable_capacitor("C", ("a", "ground"), joint="gap", capacitance="1e-9/(1 + x/1e-3)")
    x, v = 2e-4, 100.0
    rates = derive(model).function("forward_dynamics")([x], [0.0, v], [])
    slope = -1e-9 / 1e-3 / (1 + x / 1e-3) ** 2
    assert rates[0] == pytest.approx(v * v * slope / 2 / 0.01, rel=1e-12)
    assert math.isfinite(rates[1])
