"""What stores hold, what changes it, and what may not."""

from __future__ import annotations

import math
from typing import Any

import pytest
from network_parts import parts
from support.plain_values import slope, value

from linegraph.components.scalar.electrical import Capacitor, Inductor, Resistor
from linegraph.components.scalar.translational import TranslationalSpring
from linegraph.errors import ModelError

AT_A = ("a", "ground")
X = ("X", "C")


@pytest.mark.parametrize(
    "charge", ["2*x", "x + x**3", "sin(x)", "tanh(2*x)", "x*abs(x)", "max(x - 1, 0)"]
)
def test_the_energy_of_a_charge_grows_by_voltage_times_charge(charge: str) -> None:
    """DW/dx = x dQ/dx for all of them, and an empty capacitor holds nothing."""
    laws = parts(Capacitor("C", AT_A, charge=charge)).laws
    energy, (store,) = laws.energy["C"], laws.stores
    for x in (-1.3, 0.4, 1.7):
        expected = x * slope(store.charge, {X: x}, X)
        assert math.isclose(slope(energy, {X: x}, X), expected, rel_tol=1e-10, abs_tol=1e-12)
    assert math.isclose(float(value(energy, {X: 0})), 0, abs_tol=1e-15)
    assert laws.unknown == set()


def test_an_inductor_is_integrated_over_its_current() -> None:
    laws = parts(Inductor("L", AT_A, flux="3*y + y**3")).laws
    key = ("Y", "L")
    assert math.isclose(slope(laws.energy["L"], {key: 0.7}, key), 0.7 * (3 + 3 * 0.49))


def test_a_charge_that_no_rule_integrates_has_an_unknown_energy() -> None:
    laws = parts(Capacitor("C", AT_A, charge="x*exp(x*x + x)")).laws
    assert laws.unknown == {"C"}
    assert laws.energy["C"] == 0


@pytest.mark.parametrize(
    ("force", "at_two"), [("3*x + x**3", 10.0), ("5*sin(x)", 5 - 5 * math.cos(2))]
)
def test_a_spring_by_its_force_holds_the_work_of_that_force(force: str, at_two: float) -> None:
    laws = parts(TranslationalSpring("s", AT_A, force=force)).laws
    (own,) = laws.own
    assert math.isclose(float(value(laws.energy["s"], {own.key: 2})), at_two)


def test_a_spring_by_its_energy_holds_that_energy() -> None:
    laws = parts(TranslationalSpring("s", AT_A, energy="x**4")).laws
    (own,), (static,) = laws.own, laws.statics
    assert value(laws.energy["s"], {own.key: 2}) == 16
    assert value(static.zero, {own.key: 2, ("Y", "s"): 32}) == 0


@pytest.mark.parametrize(
    ("capacitance", "by"), [("1 + u", ("u",)), ("2 + sin(t)", ("t",)), ("c*(2 + t*u)", ("t", "u"))]
)
def test_inputs_and_the_time_change_what_is_stored(capacitance: str, by: tuple[str, ...]) -> None:
    laws = parts(Capacitor("C", AT_A, capacitance), parameters=["c"], inputs=["u"]).laws
    assert laws.driven == {"C": by}


def test_parameters_change_nothing() -> None:
    assert parts(Capacitor("C", AT_A, "c"), parameters=["c"]).laws.driven == {}


@pytest.mark.parametrize(
    ("store", "words"),
    [
        (Capacitor("C", AT_A, "1 + across(R)**2"), r"its value names across\(R\)"),
        (Inductor("C", AT_A, "1 + through(R)"), r"its value names through\(R\)"),
        (
            Capacitor("C", AT_A, "1 + across(C)"),
            r"names its own across\(C\); give charge or coenergy",
        ),
    ],
)
def test_a_store_that_other_variables_change_is_refused(store: Any, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        parts(store, Resistor("R", AT_A, 1))


def test_a_resistor_may_depend_on_its_own_voltage() -> None:
    laws = parts(Resistor("R", AT_A, "2 + across(R)")).laws
    assert value(laws.statics[0].zero, {("X", "R"): 6, ("Y", "R"): 1}) == -2
