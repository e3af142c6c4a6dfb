"""Cutset and circuit equations against Kirchhoff's two laws, edge by edge and vertex by vertex."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.plain_values import value

from linegraph.components.scalar.branches import edges_of, projections
from linegraph.components.scalar.electrical import Resistor
from linegraph.components.transducers.dc_motor import DcMotor
from linegraph.graph.forest import choose_forest
from linegraph.ir.dag import Dag
from linegraph.networks.kirchhoff import Kirchhoff

VERTICES = ("ground", "a", "b", "c")


def kirchhoff_of(ends: list[tuple[str, str]], weights: dict[str, float] | None = None) -> Kirchhoff:
    """The equations of resistors between these vertices."""
    branches = edges_of([Resistor(f"R{k}", pair, 1) for k, pair in enumerate(ends)])
    trees = [choose_forest(graph, weights, ("ground",)) for graph in projections(branches)]
    return Kirchhoff(branches, trees)


@st.composite
def graphs(draw: st.DrawFn) -> list[tuple[str, str]]:
    """A connected graph of two to four vertices; its first edges are a tree, turned either way."""
    count = draw(st.integers(2, 4))
    tree = [(VERTICES[draw(st.integers(0, k - 1))], VERTICES[k]) for k in range(1, count)]
    pairs = st.tuples(st.integers(0, count - 1), st.integers(0, count - 1))
    more = draw(st.lists(pairs.filter(lambda pair: pair[0] != pair[1]), max_size=4))
    ends = [*tree, *((VERTICES[i], VERTICES[j]) for i, j in more)]
    return [pair if draw(st.booleans()) else pair[::-1] for pair in draw(st.permutations(ends))]


@settings(derandomize=True, deadline=None, max_examples=40)
@given(graphs(), st.lists(st.integers(-9, 9), min_size=3, max_size=3))
def test_across_variables_are_differences_of_potentials(
    ends: list[tuple[str, str]], heights: list[int]
) -> None:
    potential = dict(zip(VERTICES, (0, *heights), strict=True))
    found = kirchhoff_of(ends)
    across = {("X", f"R{k}"): potential[a] - potential[b] for k, (a, b) in enumerate(ends)}
    for symbol, expected in across.items():
        assert sum(k * across[primary] for primary, k in found.form(symbol).items()) == expected


@settings(derandomize=True, deadline=None, max_examples=40)
@given(graphs(), st.lists(st.integers(-9, 9), min_size=7, max_size=7))
def test_through_variables_balance_at_every_vertex(
    ends: list[tuple[str, str]], flows: list[int]
) -> None:
    found = kirchhoff_of(ends)
    chords = [symbol for symbol in found.primaries if symbol[0] == "Y"]
    given_flows = dict(zip(chords, flows, strict=False))
    leaving = dict.fromkeys(VERTICES, 0)
    for k, (tail, head) in enumerate(ends):
        form = found.form(("Y", f"R{k}"))
        flow = sum(factor * given_flows[primary] for primary, factor in form.items())
        leaving[tail] += flow
        leaving[head] -= flow
    assert set(leaving.values()) == {0}


@settings(derandomize=True, deadline=None, max_examples=40)
@given(graphs())
def test_each_edge_has_one_primary_variable(ends: list[tuple[str, str]]) -> None:
    primaries = kirchhoff_of(ends).primaries
    assert [edge for _, edge in primaries] == [f"R{k}" for k in range(len(ends))]
    vertices = len({vertex for pair in ends for vertex in pair})
    assert sum(kind == "X" for kind, _ in primaries) == vertices - 1


def test_of_two_parallel_edges_the_lighter_one_is_the_branch() -> None:
    found = kirchhoff_of([("a", "ground"), ("ground", "a")], {"R0": 1.0, "R1": 0.0})
    assert found.primaries == [("Y", "R0"), ("X", "R1")]
    assert found.form(("X", "R0")) == {("X", "R1"): -1}
    assert found.form(("Y", "R1")) == {("Y", "R0"): 1}


def test_a_value_is_put_in_place_of_a_primary_variable_and_others_stay_symbols() -> None:
    found = kirchhoff_of([("a", "ground"), ("a", "b"), ("b", "ground")])
    dag = Dag()
    total = found.combined(("X", "R2"), dag, {("X", "R0"): dag.symbol("u", "V")})
    assert value(total, {("u", "V"): 10, ("X", "R1"): 3}) == Fraction(7)


@pytest.mark.parametrize(("inertia", "known"), [(None, True), (2e-5, False)])
def test_an_edge_in_mechanics_is_primary_unless_rates_determine_it(
    inertia: Any, known: bool
) -> None:
    motor = DcMotor(
        "motor", ("a", "ground"), joint="hinge", constant=1, resistance=1, inertia=inertia
    )
    branches = edges_of([motor])
    found = Kirchhoff(branches, [choose_forest(graph) for graph in projections(branches)])
    assert found.knows(("Y", "motor.mechanical")) is known
    assert (("Y", "motor.mechanical") in found.primaries) is known
    assert not found.knows(("X", "motor.mechanical"))
