"""Which bodies turn about one direction of ground only, and what their hinges' own angles are."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest
from support.chains import formulated

import linegraph as lg
from linegraph.formulation.planarity import Angle, related

if TYPE_CHECKING:
    from linegraph.formulation.formulate import Formulation


def chain(*kinds: Any, **options: Any) -> Formulation:
    """Bodies one after the other, each on the one before: (kind, axis, keywords, forward)."""
    model = lg.Model("chain")
    before: Any = model.ground
    for k, (kind, axis, *rest) in enumerate(kinds):
        keywords, forward = {**(rest[0] if rest else {})}, not (len(rest) > 1)
        body = model.body(f"b{k}", mass=1.0, inertia=(1, 1, 1))
        between = (before, body) if forward else (body, before)
        getattr(model, kind)(f"j{k}", between=between, **axis, **keywords)
        before = body
    model.formulation(**(options or {"coordinates": "absolute-angle"}))
    return formulated(model)


X, Y, Z, BACK = ({"axis": a} for a in ((1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, -1)))


def test_the_angle_of_a_hinges_near_body_is_what_its_own_is_less_by() -> None:
    found = chain(("revolute", Z), ("revolute", Z)).level
    assert found == {"j0": Angle("b0", ()), "j1": Angle("b1", (("j0", 1),))}


def test_against_each_other_axes_count_with_a_minus() -> None:
    assert chain(("revolute", Z), ("revolute", BACK)).level["j1"].less == (("j0", -1),)
    # three in a row: the body before is measured from ground, whatever stands before that
    found = chain(("revolute", BACK), ("revolute", Z), ("revolute", BACK)).level
    assert found["j2"].less == (("j1", -1),)


def test_a_hinge_whose_edge_points_to_ground_turns_its_body_backwards() -> None:
    found = chain(("revolute", Z, {}, "against"), ("revolute", Z)).level
    assert found["j1"].less == (("j0", -1),)
    both = chain(("revolute", Z, {}, "against"), ("revolute", Z, {}, "against")).level
    assert both["j1"].less == (("j0", 1),)


def test_beyond_an_oblique_hinge_an_orientation_takes_a_quaternion() -> None:
    found = chain(("revolute", Z), ("revolute", X), ("revolute", X)).level
    assert [found[j].less for j in ("j0", "j1", "j2")] == [(), None, None]


def test_automatic_coordinates_take_angles_where_bodies_turn_in_a_plane_only() -> None:
    parts = (("revolute", Z), ("revolute", Z), ("revolute", X))
    assert set(chain(*parts, coordinates="automatic").level) == {"j0", "j1"}
    assert set(chain(*parts, coordinates="absolute-angle").level) == {"j0", "j1", "j2"}
    assert set(chain(*parts, coordinates="joint").level) == set()


def test_a_slide_keeps_the_plane_and_its_own_coordinate() -> None:
    found = chain(("revolute", Z), ("prismatic", X), ("revolute", Z)).level
    assert found == {"j0": Angle("b0", ()), "j2": Angle("b2", (("j0", 1),))}


def test_a_single_absolute_body_sums_all_hinges_that_keep_their_own_angle() -> None:
    found = chain(
        ("revolute", Z), ("revolute", BACK), ("revolute", Z), of_body={"b2": "absolute-angle"}
    ).level
    assert found == {"j2": Angle("b2", (("j0", 1), ("j1", -1)))}


def test_a_turn_to_an_oblique_frame_is_judged_by_directions_of_ground() -> None:
    for angle, planar in ((0.0, True), (math.pi, True), (0.3, False)):
        model = lg.Model("tilted")
        a = model.body("a", mass=1.0, inertia=(1, 1, 1))
        b = model.body("b", mass=1.0, inertia=(1, 1, 1))
        seat = a.frame("seat", axis=(1, 0, 0), angle=angle)
        model.revolute("first", between=("ground", a))
        model.revolute("second", between=(seat, b))
        model.formulation(coordinates="absolute-angle")
        less = formulated(model).level["second"].less
        expected = (("first", 1 if angle == 0 else -1),)
        assert less == (expected if planar else None)


@pytest.mark.parametrize("kind", ["spherical", "universal"])
def test_balls_turn_bodies_in_space(kind: str) -> None:
    found = chain((kind, {}), ("revolute", Z)).level
    assert found == {"j0": Angle("b0", None), "j1": Angle("b1", None)}


def test_what_is_driven_keeps_its_coordinate_and_what_it_carries_turns_in_space() -> None:
    found = chain(("revolute", Z, {"motion": "t"}), ("revolute", Z)).level
    assert found == {"j1": Angle("b1", None)}


def test_coupled_hinges_keep_their_own_angles() -> None:
    model = lg.Model("geared")
    a, b = (model.body(x, mass=1.0, inertia=(1, 1, 1)) for x in "ab")
    model.revolute("ja", between=("ground", a))
    model.revolute("jb", between=("ground", b))
    model.couple("jb", to="ja", ratio=2)
    model.formulation(coordinates="absolute-angle")
    assert formulated(model).level == {}


def test_a_relation_keeps_the_joints_whose_rates_it_names() -> None:
    model = lg.Model("related")
    a, b, c = (model.body(x, mass=1.0, inertia=(1, 1, 1)) for x in "abc")
    for name, body in (("ja", a), ("jb", b), ("jc", c)):
        model.revolute(name, between=("ground", body))
    model.relation("wheel", "der(ja) - 2*der(jb)")
    assert related(model.system()) == {"ja", "jb"}
    model.formulation(coordinates="absolute-angle")
    assert set(formulated(model).level) == {"jc"}
    model.formulation(coordinates="absolute")
    assert formulated(model).absolute == ("c",)


def test_on_a_body_in_free_flight_hinges_turn_in_space() -> None:
    model = lg.Model("flying")
    a, b = (model.body(x, mass=1.0, inertia=(1, 1, 1)) for x in "ab")
    model.free("float", between=("ground", a))
    model.revolute("arm", between=(a, b))
    model.formulation(of_body={"a": "absolute", "b": "absolute-angle"})
    assert formulated(model).level == {"arm": Angle("b", None)}
