"""Static laws solved: against nodal analysis of the same resistors, and one nonlinear law at a time."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st
from network_parts import parts
from support.plain_values import value

from linegraph.algebra.differentiation import Calculus
from linegraph.algebra.residues import Residues
from linegraph.components.scalar.electrical import (
    Capacitor,
    CurrentSource,
    Inductor,
    Resistor,
    VoltageSource,
)
from linegraph.components.scalar.element import AnyElement
from linegraph.ir.dag import Dag
from linegraph.networks.static import DUAL, EASE, LOOP, Statics, pruned

if TYPE_CHECKING:
    from linegraph.components.scalar.base import Component
    from linegraph.networks.law_records import Laws

AT_A = ("a", "ground")


def variable(laws: Laws, statics: Statics, kind: str, edge: str) -> Any:
    """A variable by states, inputs and parameters."""
    return statics.kirchhoff.combined((kind, edge), laws.dag, statics.values)


def solved(*components: Component, **names: Any) -> Any:
    network = parts(*components, **names)
    statics = network.statics()
    return statics, lambda kind, edge: variable(network.laws, statics, kind, edge)


@settings(derandomize=True, deadline=None, max_examples=30)
@given(st.lists(st.integers(1, 60), min_size=5, max_size=5), st.integers(-9, 9))
def test_a_bridge_has_the_potentials_of_nodal_analysis(ohms: list[int], amperes: int) -> None:
    """A Wheatstone bridge a, b, c over ground, fed by a current; G v = i in fractions."""
    ends = [("a", "b"), ("a", "c"), ("b", "c"), ("b", "ground"), ("c", "ground")]
    bridge = [Resistor(f"R{k}", pair, f"R{k}") for k, pair in enumerate(ends)]
    names = [f"R{k}" for k in range(5)]
    _, of = solved(
        *bridge, CurrentSource("I", ("ground", "a"), "i"), parameters=names, inputs=["i"]
    )
    order = {"a": 0, "b": 1, "c": 2}
    G = sympy.zeros(3, 3)
    for (tail, head), r in zip(ends, ohms, strict=True):
        rows = [(order[v], sign) for v, sign in ((tail, 1), (head, -1)) if v in order]
        for i, s in rows:
            for j, t in rows:
                G[i, j] += sympy.Rational(s * t, r)
    v = G.LUsolve(sympy.Matrix([amperes, 0, 0]))
    at = {("p", f"R{k}"): r for k, r in enumerate(ohms)} | {("u", "i"): amperes}
    assert value(of("X", "R4"), at) == Fraction(int(v[2].p), int(v[2].q))
    assert (
        value(of("Y", "R2"), at) == Fraction(int((v[1] - v[2]).p), int((v[1] - v[2]).q)) / ohms[2]
    )


def test_a_divider_divides_by_the_sum_of_its_resistances() -> None:
    source = VoltageSource("V", AT_A, "u")
    pair = Resistor("R1", ("a", "b"), "R1"), Resistor("R2", ("b", "ground"), "R2")
    statics, of = solved(source, *pair, parameters=["R1", "R2"], inputs=["u"])
    at = {("p", "R1"): 3, ("p", "R2"): 7, ("u", "u"): 20}
    assert value(of("X", "R2"), at) == 14
    assert value(of("Y", "V"), at) == -2
    assert any(value(pivot, at) in (10, -10) for pivot in statics.pivots)


def test_a_kept_voltage_and_a_kept_current_stand_for_themselves() -> None:
    """The resistor closes the loop: its current is that of the capacitor's voltage."""
    _, of = solved(Capacitor("C", AT_A, 1), Inductor("L", AT_A, 1), Resistor("R", AT_A, 4))
    at = {("X", "C"): 6, ("Y", "L"): 1}
    assert value(of("X", "R"), at) == 6
    assert value(of("Y", "C"), at) == Fraction(-6, 4) - 1


def test_a_state_that_is_no_primary_variable_ties_those_that_are() -> None:
    """The source and the wanted resistor are the tree; the capacitor's voltage is their difference."""
    circuit = VoltageSource("V", AT_A, "u"), Resistor("R", ("b", "ground"), 2)
    network = parts(*circuit, Capacitor("C", ("a", "b"), 1), inputs=["u"])
    tree = network.selection("R")
    assert [store.edge for store in tree.states] == ["C"]
    statics = network.statics("R")
    drop = variable(network.laws, statics, "X", "R")
    assert value(drop, {("X", "C"): 3, ("u", "u"): 10}) == 7


def test_what_only_rates_determine_is_a_symbol_of_its_own() -> None:
    _, of = solved(Capacitor("C1", AT_A, 1), Capacitor("C2", AT_A, 2), Resistor("R", AT_A, 5))
    current = of("Y", "C1")
    assert value(current, {("X", "C1"): 10, (DUAL, "C2"): 3}) == -5


def test_a_nonlinear_law_of_a_kept_voltage_needs_no_loop() -> None:
    law = AnyElement("N", AT_A, law="y = x + 2*x**3")
    statics, of = solved(Capacitor("C", AT_A, 1), law)
    assert statics.loop == []
    assert value(of("Y", "C"), {("X", "C"): 2}) == -18


def test_nonlinear_laws_are_solved_one_after_the_other_where_each_gives_one_more() -> None:
    """The current of the first follows from the state, the voltage of the second from that current."""
    chain = AnyElement("N", AT_A, law="y = x*x"), AnyElement("M", ("b", "ground"), law="x = y**3")
    follower = CurrentSource("I", ("ground", "b"), "through(N)")
    statics, of = solved(Capacitor("C", AT_A, 1), *chain, follower)
    assert statics.loop == []
    assert value(of("X", "M"), {("X", "C"): 2}) == 64


def test_a_source_behind_a_resistor_and_a_diode_is_a_loop_of_one_unknown() -> None:
    """Its residual is zero at the solution of (u - x)/R = x + x^3, and what follows from it fits."""
    law = AnyElement("N", ("b", "ground"), law="y = x + x**3")
    statics, of = solved(
        VoltageSource("V", AT_A, "u"), Resistor("R", ("a", "b"), 3), law, inputs=["u"]
    )
    assert len(statics.loop) == len(statics.residuals) == 1
    assert statics.laws == ["N"]
    (kind, edge) = statics.loop[0]
    solution = {"X": 2, "Y": 10}[kind] if edge == "N" else {"X": 30, "Y": 10}[kind]
    at = {("u", "u"): 32, (LOOP, 0): solution}
    assert value(statics.residuals[0], at) == 0
    assert value(statics.residuals[0], at | {(LOOP, 0): solution + 1}) != 0
    assert value(of("X", "N"), at) == 2
    assert value(of("Y", "R"), at) == 10


def test_eased_residuals_are_those_of_the_loop_where_nothing_eases() -> None:
    law = AnyElement("N", ("b", "ground"), law="y = x + x**3")
    statics, _ = solved(VoltageSource("V", AT_A, 32), Resistor("R", ("a", "b"), 3), law)
    hard = {(EASE, 0): 0, (EASE, 1): 0, (LOOP, 0): 5}
    assert value(statics.eased[0], hard) == value(statics.residuals[0], hard)


def test_easing_puts_a_resistance_behind_and_a_conductance_beside_a_law() -> None:
    """Y - s x = f(x - r y) in place of y = f(x); x = 2 and y = 10 are on the line of source and R."""
    law = AnyElement("N", ("b", "ground"), law="y = x + x**3")
    statics, of = solved(VoltageSource("V", AT_A, 32), Resistor("R", ("a", "b"), 3), law)
    r, s = Fraction(1, 7), Fraction(1, 5)
    at = {(LOOP, 0): 3, (EASE, 0): r, (EASE, 1): s}
    x, y = value(of("X", "N"), at), value(of("Y", "N"), at)
    inner = x - r * y
    expected = (y - s * x) - (inner + inner**3)
    assert value(statics.eased[0], at) == expected


def test_a_resistance_that_an_across_variable_changes_is_linear_in_its_current() -> None:
    """R depends on a state: that makes the law no less linear in what is unknown."""
    resistor = Resistor("R", ("a", "b"), "1 + across(C)**2")
    statics, of = solved(VoltageSource("V", AT_A, 8), resistor, Capacitor("C", ("b", "ground"), 1))
    assert statics.loop == []
    assert value(of("Y", "C"), {("X", "C"): 3}) == Fraction(1, 2)


@pytest.mark.parametrize(("doubtful", "kept"), [(True, False), (False, True)])
def test_symbols_that_cancel_are_pruned_where_they_are_in_doubt(doubtful: bool, kept: bool) -> None:
    dag = Dag()
    d, x = dag.symbol(DUAL, "C"), dag.symbol("X", "C")
    seeming = (x + d) * 3 - (d * 3 + x)
    calculus = Calculus(dag)
    found = pruned(seeming, calculus, Residues(), lambda symbol: doubtful and symbol[0] == DUAL)
    assert ((DUAL, "C") in calculus.support(found)) is kept
    assert value(found, {(DUAL, "C"): 100, ("X", "C"): 4}) == 8
