"""Terminal equations: each component's laws as zeros, charges, states, energy and heat."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest
from network_parts import parts
from support.plain_values import value

from linegraph.components.scalar.any_store import AnyStore
from linegraph.components.scalar.couplings import Transformer
from linegraph.components.scalar.electrical import Capacitor, Inductor, Resistor
from linegraph.components.scalar.element import AnyElement
from linegraph.components.scalar.thermal import Conduction, HeatCapacity, Losses, Radiation
from linegraph.components.scalar.translational import Mass
from linegraph.components.transducers.dc_motor import DcMotor
from linegraph.errors import ModelError
from linegraph.ir.dag import Dag, Node
from linegraph.networks.variables import constant, key_of

if TYPE_CHECKING:
    from linegraph.components.scalar.base import Component

AT_A = ("a", "ground")


def test_ohms_law_is_zero_where_the_voltage_is_that_of_the_current() -> None:
    laws = parts(Resistor("R", AT_A, "2*r"), parameters=["r"]).laws
    (static,) = laws.statics
    at = {("p", "r"): 5, ("X", "R"): 30, ("Y", "R"): 3}
    assert value(static.zero, at) == 0
    assert value(static.zero, at | {("Y", "R"): 4}) == -10
    assert (static.edge, static.component.name) == ("R", "R")


def test_a_dissipator_heats_by_voltage_times_current() -> None:
    laws = parts(Resistor("R", AT_A, 2)).laws
    assert value(laws.heat["R"], {("X", "R"): 6, ("Y", "R"): 3}) == 18
    assert laws.energy["R"] == 0


@pytest.mark.parametrize(
    ("store", "key", "dual"),
    [
        (Capacitor("S", AT_A, 4), ("X", "S"), ("Y", "S")),
        (Inductor("S", AT_A, 4), ("Y", "S"), ("X", "S")),
        (Mass("S", AT_A, 4), ("X", "S"), ("Y", "S")),
        (AnyStore("S", AT_A, keeps="through", constant=4), ("Y", "S"), ("X", "S")),
    ],
)
def test_a_store_of_a_constant_has_a_charge_in_proportion(
    store: Component, key: Any, dual: Any
) -> None:
    laws = parts(store).laws
    (found,) = laws.stores
    assert (found.key, found.dual, found.rest) == (key, dual, 0)
    assert value(found.charge, {key: 3}) == 12
    assert value(laws.energy["S"], {key: 3}) == 18


def test_energy_and_coenergy_differ_where_the_charge_is_no_proportion() -> None:
    """Of W' = k^4 the charge is 4 k^3, and the energy k Q - W' is 3 k^4."""
    laws = parts(Capacitor("C", AT_A, coenergy="x**4")).laws
    key = ("X", "C")
    assert value(laws.stores[0].charge, {key: 2}) == 32
    assert value(laws.energy["C"], {key: 2}) == 48


def test_an_element_with_a_state_has_its_rate() -> None:
    memory = AnyElement("M", AT_A, law="x = s*y", rate="y - s/4")
    (own,) = parts(memory).laws.own
    assert own.key == ("s", "M.s")
    assert value(own.rate, {("Y", "M"): 3, ("s", "M.s"): 8}) == 1
    assert own.quantity.name == "s_M"


def test_a_transformer_has_two_laws_that_keep_no_power() -> None:
    laws = parts(Transformer("T", AT_A, ("b", "ground"), 3)).laws
    first, second = laws.statics
    at = {("X", "T.first"): 6, ("X", "T.second"): 2, ("Y", "T.first"): 5, ("Y", "T.second"): -15}
    assert [value(static.zero, at) for static in (first, second)] == [0, 0]
    assert (first.edge, second.edge) == ("T.first", "T.second")


def test_laws_may_name_variables_of_other_edges_inputs_and_the_time() -> None:
    law = AnyElement("N", AT_A, law="y = across(R)*u + through(R)*t")
    laws = parts(Resistor("R", AT_A, 1), law, inputs=["u"]).laws
    (static,) = (s for s in laws.statics if s.edge == "N")
    at = {("X", "R"): 2, ("Y", "R"): 3, ("u", "u"): 5, ("t", None): 7, ("Y", "N"): 31}
    assert value(static.zero, at) == 0


def test_the_edge_of_a_motor_in_mechanics_has_the_rate_of_its_joint() -> None:
    motor = DcMotor("M", AT_A, shaft=("s", "ground"), constant=2, resistance=3, ratio=5)
    laws = parts(motor, Mass("m", ("n", "ground"), 1)).laws
    electrical, mechanical = (s.zero for s in laws.statics)
    at = {("X", "M.electrical"): 52, ("Y", "M.electrical"): 4, ("X", "M.mechanical"): 4}
    assert value(electrical, at) == 0
    assert value(mechanical, at | {("Y", "M.mechanical"): -40}) == 0


def test_losses_are_the_heat_of_what_they_are_of_wherever_these_are_declared() -> None:
    laws = parts(
        Losses("Q", ("ground", "w"), of=("R", "S")),
        HeatCapacity("H", ("w", "ground"), 1),
        Resistor("R", AT_A, 2),
        Resistor("S", AT_A, 4),
    ).laws
    (static,) = (s for s in laws.statics if s.edge == "Q")
    at = {("X", "R"): 6, ("Y", "R"): 3, ("X", "S"): 8, ("Y", "S"): 2, ("Y", "Q"): 34}
    assert value(static.zero, at) == 0


def test_a_potential_is_the_sum_along_the_way_to_ground() -> None:
    """Radiation has fourth powers of absolute temperatures: from c it is measured over b, against S."""
    laws = parts(
        Conduction("R", ("c", "b"), 1),
        Conduction("S", ("ground", "b"), 1),
        Radiation("P", ("c", "b"), 1),
    ).laws
    (static,) = (s for s in laws.statics if s.edge == "P")
    drops = {("X", "R"): 5, ("X", "S"): -2, ("X", "P"): 5}
    assert value(static.zero, drops | {("Y", "P"): 7**4 - 2**4}) == 0


@pytest.mark.parametrize(
    ("given", "text"), [(0.1, "1/10"), (1e-12, "1/1000000000000"), (Fraction(2, 3), "2/3")]
)
def test_numbers_that_are_not_whole_are_symbols_that_carry_their_digits(
    given: Any, text: str
) -> None:
    found = constant(given, Dag())
    assert isinstance(found, Node)
    assert key_of(found) == ("c", text)


@pytest.mark.parametrize(("given", "whole"), [(3.0, 3), (7, 7), (Fraction(4), 4)])
def test_whole_numbers_are_integers(given: Any, whole: int) -> None:
    found = constant(given, Dag())
    assert isinstance(found, int)
    assert found == whole


@pytest.mark.parametrize(
    ("component", "words"),
    [
        (Resistor("R", AT_A, "across(RR)"), r"there is no across\(RR\)"),
        (Resistor("R", AT_A, "1/0"), "division by zero"),
        (Resistor("R", AT_A, "q7"), "q7"),
        (AnyElement("R", AT_A, law="y = s*x"), "give rate, the derivative of s"),
        (Capacitor("R", AT_A, 0), "stores nothing"),
        (Losses("R", ("ground", "w"), of=("S",)), 'no component, damper or friction "S"'),
    ],
)
def test_laws_that_cannot_be_are_refused_with_their_component(
    component: Component, words: str
) -> None:
    with pytest.raises(ModelError, match=words) as caught:
        parts(component)
    assert caught.value.thing == f'{component.kind} "R"'


def test_a_name_of_the_component_itself_may_have_no_other_owner() -> None:
    with pytest.raises(ModelError, match='"x" is of the component itself'):
        parts(AnyElement("N", AT_A, law="y = x"), parameters=["x"])
