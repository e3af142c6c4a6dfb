"""Which stores are states: against counts of loops and cutsets, and networks known by sight."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from network_parts import parts

from linegraph.components.scalar.couplings import Transformer
from linegraph.components.scalar.electrical import (
    Capacitor,
    CurrentSource,
    Inductor,
    OpAmp,
    Resistor,
    VoltageSource,
)
from linegraph.components.scalar.element import AnyElement
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from linegraph.components.scalar.base import Component
    from linegraph.networks.selection import Selection

AT_A = ("a", "ground")
VERTICES = ("ground", "a", "b", "c")
KINDS: dict[str, Any] = {
    "R": lambda name, ends: Resistor(name, ends, 2),
    "C": lambda name, ends: Capacitor(name, ends, 3),
    "L": lambda name, ends: Inductor(name, ends, 5),
    "V": lambda name, ends: VoltageSource(name, ends, 7),
    "I": lambda name, ends: CurrentSource(name, ends, 11),
}


def states(selection: Selection) -> list[str]:
    return [store.edge for store in selection.states]


def branches(selection: Selection) -> list[str]:
    return [edge.name for edge in selection.topologies[0].branches]


def pieces(edges: list[tuple[str, str]], vertices: int) -> int:
    """How many connected parts edges leave of the first vertices."""
    group = {vertex: vertex for vertex in VERTICES[:vertices]}
    for a, b in edges:
        old, new = group[a], group[b]
        group = {vertex: new if part == old else part for vertex, part in group.items()}
    return len(set(group.values()))


@st.composite
def circuits(draw: st.DrawFn) -> list[tuple[str, tuple[str, str]]]:
    """Up to six edges of any kind between two to four vertices, all of them connected."""
    count = draw(st.integers(2, 4))
    ends = [(VERTICES[draw(st.integers(0, k - 1))], VERTICES[k]) for k in range(1, count)]
    for _ in range(draw(st.integers(0, 3))):
        i = draw(st.integers(1, count - 1))
        ends.append((VERTICES[i], VERTICES[draw(st.integers(0, i - 1))]))
    return [(draw(st.sampled_from("RCLVI")), pair) for pair in ends]


@settings(derandomize=True, deadline=None, max_examples=60)
@given(circuits())
def test_states_number_stores_less_loops_of_capacitors_and_cutsets_of_inductors(
    circuit: list[tuple[str, tuple[str, str]]],
) -> None:
    """Bryant's count; a loop of voltage sources alone or a cutset of current sources alone is refused."""
    count = len({vertex for _, pair in circuit for vertex in pair})

    def loops(kinds: str) -> int:
        inside = [pair for kind, pair in circuit if kind in kinds]
        return len(inside) - count + pieces(inside, count)

    def cutsets(kinds: str) -> int:
        return pieces([pair for kind, pair in circuit if kind not in kinds], count) - 1

    network = parts(*(KINDS[kind](f"{kind}{n}", pair) for n, (kind, pair) in enumerate(circuit)))
    if loops("V") or cutsets("I"):
        with pytest.raises(ModelError):
            network.selection()
        return
    found = network.selection()
    stores = [f"{kind}{n}" for n, (kind, _) in enumerate(circuit) if kind in "CL"]
    lost = loops("VC") + cutsets("IL")
    assert len(found.states) == len(stores) - lost
    assert len(found.dependent) == len(found.determined) == lost
    assert sorted([*states(found), *found.dependent]) == sorted(stores)


def test_of_parallel_capacitors_the_second_depends_on_the_first() -> None:
    found = parts(Capacitor("C1", AT_A, 1), Capacitor("C2", AT_A, 2)).selection()
    assert states(found) == ["C1"]
    assert found.dependent == {"C2": ("C1",)}
    assert [store.edge for store in found.determined] == ["C2"]


def test_a_wanted_store_is_the_state() -> None:
    found = parts(Capacitor("C1", AT_A, 1), Capacitor("C2", AT_A, 2)).selection("C2")
    assert states(found) == ["C2"]
    assert found.dependent == {"C1": ("C2",)}


def test_a_store_with_an_end_on_ground_is_rather_a_state() -> None:
    loop = [Capacitor("far", ("a", "b"), 1), Capacitor("A", AT_A, 1)]
    found = parts(*loop, Capacitor("B", ("b", "ground"), 1), Resistor("R", AT_A, 1)).selection()
    assert states(found) == ["A", "B"]
    assert set(found.dependent["far"]) == {"A", "B"}


def test_a_capacitor_across_a_source_follows_from_the_source() -> None:
    found = parts(VoltageSource("V", AT_A, 1), Capacitor("C", AT_A, 1)).selection()
    assert states(found) == []
    assert found.dependent == {"C": ("V",)}


def test_a_transformer_ties_the_capacitors_at_its_two_sides() -> None:
    turned = Transformer("T", AT_A, ("b", "ground"), 3)
    pair = Capacitor("C1", AT_A, 1), Capacitor("C2", ("b", "ground"), 1)
    found = parts(turned, *pair).selection()
    assert states(found) == ["C1"]
    assert found.dependent == {"C2": ("C1", "T")}


def test_the_tree_has_given_and_kept_voltages_as_branches_and_currents_as_chords() -> None:
    ends = ("a", "b"), ("b", "ground")
    found = parts(
        Inductor("L", ends[0], 1),
        Resistor("R", ends[0], 1),
        CurrentSource("I", ends[1], 1),
        Capacitor("C", ends[1], 1),
        VoltageSource("V", AT_A, 1),
    ).selection()
    assert branches(found) == ["C", "V"]
    parallel = parts(CurrentSource("I", AT_A, 1), Inductor("L", AT_A, 1), Resistor("R", AT_A, 1))
    assert branches(parallel.selection()) == ["R"]


@pytest.mark.parametrize(
    ("law", "branch"), [("y = x + x**3", "N"), ("x = y + y**3", "R"), ("y = 2*x", "R")]
)
def test_a_nonlinear_law_is_a_branch_where_it_is_solved_for_the_through_variable(
    law: str, branch: str
) -> None:
    found = parts(Resistor("R", AT_A, 1), AnyElement("N", AT_A, law=law)).selection()
    assert branches(found) == [branch]


def test_a_wanted_edge_is_rather_a_branch_than_its_like() -> None:
    network = parts(Resistor("R1", AT_A, 1), Resistor("R2", AT_A, 1))
    assert branches(network.selection()) == ["R1"]
    assert branches(network.selection("R2")) == ["R2"]


def test_which_store_is_the_state_is_judged_by_exact_rank() -> None:
    """0.1 + 0.2 is 0.3 here: the two-ports repeat what the capacitors are tied by already."""
    network = parts(
        Transformer("T", AT_A, ("b", "ground"), 0.3),
        Transformer("U", AT_A, ("b", "ground"), "0.1 + 0.2"),
        Capacitor("C", AT_A, 1),
        Capacitor("D", ("b", "ground"), 1),
    )
    with pytest.raises(ModelError, match="contradict or repeat"):
        network.selection()


@pytest.mark.parametrize(
    ("components", "words"),
    [
        ([VoltageSource("V", AT_A, 1), VoltageSource("W", AT_A, 1)], "loop of across variables"),
        (
            [CurrentSource("I", AT_A, 1), CurrentSource("J", AT_A, 1)],
            "cutset of through variables",
        ),
        ([OpAmp("stage", ("ground", "a"), ("b", "ground")), Resistor("R", AT_A, 1)], "op-amp"),
    ],
)
def test_what_is_given_twice_or_not_at_all_is_refused(
    components: list[Component], words: str
) -> None:
    with pytest.raises(ModelError, match=words):
        parts(*components).selection()
