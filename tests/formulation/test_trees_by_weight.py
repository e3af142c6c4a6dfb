"""Which joints and inertia edges become branches, by weight and by wish, judged by hand."""

from __future__ import annotations

import math
from typing import Any

import pytest
from support.chains import formulated

import linegraph as lg
from linegraph.formulation.absolute import floating, stems_of, turning
from linegraph.formulation.formulate import INERTIA_WEIGHT, edge_weights
from linegraph.model.terminal_graphs import system_graph


def four_bar(kinds: str = "rrrr", **options: Any) -> lg.Model:
    """Crank, coupler and rocker; pins a, b, c, d from ground to ground.

    Args:
        kinds: of each pin: r a hinge, s a ball, w a weld, p a slide.
        options: keywords of single pins.
    """
    model = lg.Model("four_bar")
    names = ("crank", "coupler", "rocker")
    crank, coupler, rocker = (model.body(n, mass=1.0, inertia=(1, 1, 1)) for n in names)
    words = {"r": "revolute", "s": "spherical", "w": "fixed", "p": "prismatic"}
    ends = (
        (model.ground, crank),
        (crank.frame("tip", at=(1, 0, 0)), coupler),
        (coupler.frame("tip", at=(2, 0, 0)), rocker),
        (rocker.frame("tip", at=(1, 0, 0)), model.ground.frame("there", at=(2, 0, 0))),
    )
    for name, kind, between in zip("abcd", kinds, ends, strict=True):
        getattr(model, words[kind])(name, between=between, **options.get(name, {}))
    return model


@pytest.mark.parametrize(
    ("kinds", "chord"),
    [("rrrr", "c"), ("srrr", "a"), ("rsrr", "b"), ("rrrs", "d"), ("ssrr", "b"), ("rrpr", "c")],
)
def test_of_a_loop_that_joint_is_cut_which_has_most_freedoms_far_from_ground(
    kinds: str, chord: str
) -> None:
    found = formulated(four_bar(kinds))
    assert found.chords == (chord,)
    assert found.joints == frozenset("abcd") - {chord}


@pytest.mark.parametrize(
    ("options", "chord"),
    [
        ({"b": {"effort": False}}, "b"),
        ({"a": {"effort": False}}, "a"),
        ({"c": {"effort": False}, "b": {"effort": False}}, "c"),
        ({"b": {"effort": False, "start": 0.3}}, "c"),
        ({"c": {"motion": "0.1*sin(t)"}}, "b"),
        ({"b": {"motion": "t"}, "c": {"motion": "t"}, "a": {"effort": False}}, "a"),
    ],
)
def test_joints_in_which_something_acts_or_that_have_a_start_are_rather_branches(
    options: dict[str, Any], chord: str
) -> None:
    assert formulated(four_bar("rrrr", **options)).chords == (chord,)


def test_a_spring_in_a_hinge_without_effort_keeps_it_a_branch() -> None:
    model = four_bar("rrrr", b={"effort": False})
    model.spring("coil", joint="b", stiffness=2.0)
    assert formulated(model).chords == ("c",)


def test_a_weld_is_never_the_chord_of_a_loop_with_hinges() -> None:
    for kinds in ("rwrr", "rrwr", "rrrw"):
        found = formulated(four_bar(kinds))
        assert "abcd"[kinds.index("w")] in found.joints


def test_a_wish_decides_before_weights() -> None:
    for chord in "abcd":
        model = four_bar()
        model.formulation(tree=tuple(x for x in "abcd" if x != chord))
        assert formulated(model).chords == (chord,)


def test_a_wish_for_a_whole_loop_is_refused() -> None:
    model = four_bar()
    model.formulation(tree=tuple("abcd"))
    with pytest.raises(lg.ModelError, match="circuit"):
        formulated(model)


def test_a_wish_for_something_unknown_is_refused_with_what_is_like_it() -> None:
    model = four_bar()
    model.formulation(tree=("crank/inertial",))
    with pytest.raises(lg.ModelError, match="crank/inertia"):
        formulated(model)
    model = four_bar()
    model.formulation(of_body={"cranck": "absolute"})
    with pytest.raises(lg.ModelError, match=r"there is no such body.*crank"):
        formulated(model)


def test_a_wish_for_an_inertia_edge_makes_its_body_absolute_and_cuts_its_cheapest_chord() -> None:
    model = four_bar()
    model.formulation(tree=("coupler/inertia",))
    found = formulated(model)
    assert found.absolute == ("coupler",)
    # four joints and one inertia edge for three bodies: two chords, the two pins of the coupler
    assert set(found.chords) == {"b", "c"}
    assert "coupler/inertia" in {edge.name for edge in found.rotation.branches}


def test_with_absolute_coordinates_all_joints_are_chords() -> None:
    model = four_bar()
    model.formulation(coordinates="absolute")
    found = formulated(model)
    assert found.absolute == ("crank", "coupler", "rocker")
    assert found.chords == tuple("abcd")
    assert found.joints == frozenset()


def test_coupled_joints_stay_branches_and_a_loop_of_them_is_refused_by_that_word() -> None:
    model = four_bar()
    model.couple("c", to="a")
    assert formulated(model).chords == ("b",)
    model = four_bar("rrrr")
    model.couple("b", to="a")
    model.couple("c", to="d")
    with pytest.raises(lg.ModelError, match="coupled joints have to be branches, too"):
        formulated(model)


def test_a_coupled_body_keeps_its_joint_where_all_others_are_absolute() -> None:
    model = lg.Model("pair")
    a, b, c = (model.body(x, mass=1.0, inertia=(1, 1, 1)) for x in "abc")
    model.revolute("ja", between=("ground", a))
    model.revolute("jb", between=(a, b))
    model.revolute("jc", between=(b, c))
    model.couple("jb", to="ja")
    model.formulation(coordinates="absolute")
    found = formulated(model)
    assert found.absolute == ("c",)
    assert found.joints == {"ja", "jb"}
    # asked for by name it is not spared, and cannot be both
    model.formulation(coordinates="joint", of_body={"b": "absolute"})
    with pytest.raises(lg.ModelError, match="coupled joints have to be branches"):
        formulated(model)


def test_a_body_that_nothing_holds_is_refused_and_a_rod_does_not_hold_it() -> None:
    model = four_bar()
    loose = model.body("loose", mass=1.0)
    with pytest.raises(lg.ModelError, match="nothing connects it to ground"):
        formulated(model)
    model.rod("tether", between=("crank", loose), length=1.0)
    with pytest.raises(lg.ModelError, match="nothing connects it to ground") as told:
        formulated(model)
    assert told.value.thing == 'body "loose"'


def test_a_model_of_nothing_is_refused() -> None:
    with pytest.raises(lg.ModelError, match="has no bodies and no components"):
        formulated(lg.Model("empty"))


def test_weights_are_freedoms_with_a_little_for_idleness_and_depth() -> None:
    system = four_bar("rsrr", c={"effort": False}).system()
    weights = edge_weights(system, system_graph(system)["translation"])
    # from ground: crank 1, its centre 2, its tip 3, coupler 4; there 1, the rocker's tip 2, its centre 3,
    # rocker 4, the coupler's tip and centre 5; a whole depth of 6 is worth 0.2
    assert weights == {
        **dict.fromkeys(("crank/inertia", "coupler/inertia", "rocker/inertia"), INERTIA_WEIGHT),
        "a": pytest.approx(1 + 0.2 * 1 / 6),
        "b": pytest.approx(3 + 0.2 * 4 / 6),
        "c": pytest.approx(1 + 0.3 + 0.2 * 5 / 6),
        "d": pytest.approx(1 + 0.2 * 2 / 6),
    }


def test_a_force_element_weighs_more_than_anything() -> None:
    model = four_bar()
    model.spring("far", between=("ground", "coupler"), stiffness=1.0)
    system = model.system()
    weights = edge_weights(system, system_graph(system)["translation"])
    assert weights["far"] == math.inf


def test_branches_number_what_a_tree_must_have_in_both_subspaces() -> None:
    model = four_bar()
    model.formulation(coordinates="absolute-angle")
    found = formulated(model)
    for tree in (found.translation, found.rotation):
        assert len(tree.branches) == len(tree.projection.vertices) - 1
    assert set(found.level) == {"a", "b", "d"}
    turning = {edge.name for edge in found.rotation.branches}
    assert {"crank/inertia", "coupler/inertia", "rocker/inertia"} <= turning
    assert not turning & {"a", "b", "d"}
    assert {"a", "b", "d"} <= {edge.name for edge in found.translation.branches}


def test_a_chord_closes_the_circuit_of_all_pins() -> None:
    found = formulated(four_bar())
    circuit = found.translation.circuit
    row = circuit.entries[circuit.rows.index("c")]
    pins = {circuit.columns[j]: sign for j, sign in row.items()}
    # from the coupler over the rocker to ground and back over the crank: along c, d, a, b
    assert {name: pins[name] for name in "abd"} == {"a": 1, "b": 1, "d": 1}


def test_a_body_called_like_a_coordinate_gets_another_stem() -> None:
    model = four_bar()
    model.formulation(coordinates="absolute")
    system = model.system()
    assert stems_of(system, formulated(model)) == {n: n for n in ("crank", "coupler", "rocker")}
    model.parameter("crank_x", 1.0)
    assert stems_of(model.system(), formulated(model))["crank"] == "crank_body"
    model.parameter("crank_body", 1.0)
    stem = stems_of(model.system(), formulated(model))["crank"]
    assert stem not in ("crank", "crank_body")
    assert stem.startswith("crank_body")
    assert stems_of(four_bar().system(), formulated(four_bar())) == {}


def test_an_inertia_edge_leads_from_ground_to_the_mass_centre_and_turns_the_body() -> None:
    joint = floating("crank", "c")
    assert joint.between == ("ground", "crank.mass_center")
    assert [q.name for q in joint.positions()] == [
        *("c_x", "c_y", "c_z"),
        *("c_qx", "c_qy", "c_qz", "c_qw"),
    ]
    ball = turning("a", "crank", "c")
    assert ball.between == ("a", "crank")
    assert len(ball.velocities()) == 3
    assert ball.effort is False
