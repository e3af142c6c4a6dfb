"""The search for a position that closes a loop, beside the law of cosines; what the constraints are worth."""

from __future__ import annotations

import math
import random
from typing import Any

import numpy as np
import pytest
from support.chains import formulated
from support.linkages import BASE, COUPLER, CRANK, ROCKER, closed, four_bar, gap, tips
from support.rigid_motion import TINY

import linegraph as lg
from linegraph.model.terminal_graphs import system_graph
from linegraph.numeric import loop_closure
from linegraph.numeric.assembly import assemble, consistent, saddle
from linegraph.numeric.derived import Derived
from linegraph.numeric.loop_closure import Search, at_some_time, least, quoted
from linegraph.pipeline import derived


def of(model: lg.Model) -> Derived:
    return derived(model, Derived)


def of_open(model: lg.Model) -> Derived:
    """The same without assembling it, of loops that may not close."""
    system = model.system()
    return Derived(system, system_graph(system), formulated(model))


def searched(model: lg.Model, hold: dict[str, float] | None = None) -> Search:
    return Search(of(model), hold or {}, 0)


@pytest.mark.parametrize("a", [-2.0, -0.5, 0.3, 1.0, 2.5])
def test_with_the_crank_held_the_loop_closes_where_the_law_of_cosines_says(a: float) -> None:
    search = searched(four_bar(), {"a": a})
    q = search.position(None)
    assert q[0] == a
    expected = [closed(a, sign) for sign in (1, -1)]
    turns = [np.abs(np.exp(1j * np.array(q)) - np.exp(1j * x)).max() for x in expected]
    assert min(turns) < 1e-12


def slider_crank(crank: float = 3.0, rod: float = 8.0) -> lg.Model:
    """A crank and a rod on a slide along x; the pin between rod and slide is the chord."""
    model = lg.Model("slider_crank")
    parts = [model.body(n, mass=1.0, mass_center=(1, 0, 0)) for n in ("crank", "rod", "piston")]
    model.revolute("a", between=("ground", parts[0]))
    model.revolute("b", between=(parts[0].frame("tip", at=(crank, 0, 0)), parts[1]))
    model.prismatic("x", between=("ground", parts[2]), axis=(1, 0, 0))
    model.revolute("c", between=(parts[1].frame("tip", at=(rod, 0, 0)), parts[2]))
    model.formulation(tree=("a", "b", "x"))
    return model


def test_a_slide_is_measured_by_the_length_of_its_loop() -> None:
    search = searched(slider_crank(), {"a": 0.7})
    # metres count by the loop's 3 + 8 m, so that one step suits angles and shifts alike
    assert search.of_positions == [1, 1, 11]
    q = search.position([0.7, -0.5, 8.0])
    expected = 3 * math.cos(0.7) + math.sqrt(64 - (3 * math.sin(0.7)) ** 2)
    assert q[2] == pytest.approx(expected, abs=1e-11)
    # far from closed, the steps still arrive: those of a loop of kilometres, too
    far = searched(slider_crank(3e3, 8e3), {"a": 0.7})
    q = [0.7, -0.5, 5.0]
    assert far.close(q) < 1e-12
    assert q[2] == pytest.approx(1e3 * expected, rel=1e-11)


def test_start_values_of_hinges_are_added_where_angles_are_measured_from_ground() -> None:
    model = lg.Model("levels")
    before: Any = model.ground
    for k, start in enumerate((0.3, -0.5, 0.9)):
        body = model.body(f"b{k}", mass=1.0, mass_center=(1, 0, 0))
        model.revolute(f"j{k}", between=(before, body), start=start)
        before = body
    assert searched(model)._start() == pytest.approx([0.3, -0.5, 0.9])
    model.formulation(coordinates="absolute-angle")
    assert searched(model)._start() == pytest.approx([0.3, -0.2, 0.7])


def test_a_start_chooses_between_two_ways_to_close_a_loop() -> None:
    search = searched(four_bar(), {"a": 0.7})
    for sign in (1, -1):
        near = closed(0.7, sign)
        found = search.position(near + np.array([0, 0.1, -0.1]))
        np.testing.assert_allclose(found, near, atol=1e-12)


def test_closing_moves_no_farther_than_it_must() -> None:
    """Newton's step of least norm: the crank's angle moves, too, but the gap is gone."""
    search = searched(four_bar())
    q = list(closed(0.7) + 0.01)
    assert search.close(q) < 1e-14
    assert np.abs(gap(q)).max() < 1e-14
    assert np.abs(np.array(q) - closed(0.7)).max() < 0.03


def test_links_too_short_leave_the_gap_that_geometry_leaves(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(loop_closure, "TRIES", 3)
    # 1.5 m of base with 0.3 + 0.8 + 0.2 m of links: 0.2 m remain
    with pytest.raises(lg.ModelError, match=r"a gap of 0\.2 m remains at least") as told:
        assemble(of_open(four_bar(rocker=0.2, base=1.5)))
    assert told.value.thing == 'joint "c"'
    assert "a - b - d - c" in told.value.problem


def test_a_held_angle_beyond_reach_is_told_of_by_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(loop_closure, "TRIES", 3)
    model = four_bar(coupler=0.45)
    with pytest.raises(lg.ModelError, match='cannot be assembled with "a" held') as told:
        assemble(of_open(model), {"a": math.pi})
    # 1.3 to the rocker's hinge, 0.45 + 0.6 of links
    assert "a gap of 0.25 m" in told.value.problem


def test_a_coordinate_that_is_none_cannot_be_held() -> None:
    with pytest.raises(lg.ModelError, match="is none of this tree; known: a, b, d"):
        searched(four_bar(), {"c": 0.1})


def test_a_hinge_turned_over_does_not_count_as_closed() -> None:
    model = lg.Model("flip")
    a, b = (model.body(x, mass=1.0, mass_center=(0.1, 0, 0), inertia=(1, 1, 1)) for x in "ab")
    model.revolute("first", between=("ground", a), axis=(1, 0, 0))
    model.revolute("second", between=(a, b), axis=(0, 1, 0), start=3.0)
    model.revolute("last", between=("ground", b), axis=(1, 0, 0))
    model.formulation(tree=("first", "second"))
    search = searched(model)
    # half a turn about y has the axes in line, but against each other
    assert search._flipped([0.4, math.pi])
    assert not search._flipped([0.4, 0.0])
    # the start is nearly there, and yet the search ends at no turn but full ones
    assert math.cos(search.position(None)[1]) == pytest.approx(1, abs=1e-12)


def test_jacobian_and_rates_are_in_pure_numbers_without_what_is_held() -> None:
    search = searched(four_bar(), {"a": 0.7})
    q = [0.7, -0.4, 1.1]
    J = search.jacobian(q)
    length = CRANK + COUPLER + ROCKER + BASE
    slopes = [gap(np.array(q) + 1j * TINY * e).imag / TINY / length for e in np.eye(3)]
    np.testing.assert_allclose(J[:2, 1:], np.array(slopes).T[:, 1:], atol=1e-15)
    assert not J[:, 0].any()
    v = [0.3, -0.2, 0.5]
    expected = gap(np.array(q) + 1j * TINY * np.array(v)).imag / TINY / length
    np.testing.assert_allclose(search.rates(q, v)[:2], expected, atol=1e-15)


def test_the_least_solution_is_that_of_the_pseudoinverse() -> None:
    rng = np.random.default_rng(4)
    J = rng.normal(size=(4, 2)) @ rng.normal(size=(2, 6))
    right = rng.normal(size=4)
    np.testing.assert_allclose(least(J, right), np.linalg.pinv(J, 1e-10) @ right, atol=1e-12)
    # a direction of 1e-9 is rounding and not divided by
    assert np.abs(least(np.diag([1.0, 1e-9]), np.ones(2))).max() == 1.0


def test_a_place_beside_closes_the_loop_and_is_another() -> None:
    search = searched(four_bar())
    q = list(closed(0.7))
    near = search.beside(q)
    assert near is not None
    assert np.abs(gap(near)).max() < 1e-9
    assert 1e-4 < np.abs(np.array(near) - q).max() < 0.3
    assert q == list(closed(0.7))


def test_a_motion_without_derivatives_at_0_is_judged_later() -> None:
    model = four_bar()
    free = model.body("flag", mass=1.0, inertia=(1, 1, 1))
    model.revolute("driven", between=("crank", free), motion="sqrt(t)")
    assert at_some_time(of_open(model)).t > 0
    assert at_some_time(of_open(four_bar())).t == 0


def test_names_are_quoted_one_by_one() -> None:
    assert quoted(["a", "b"]) == '"a", "b"'
    assert quoted({"a": 1}) == '"a"'


def test_a_plane_four_bar_has_one_freedom_and_three_redundant_constraints() -> None:
    found = of(four_bar()).assembled
    assert (found.rank, found.position_rank, found.redundant, found.freedoms) == (2, 2, 3, 1)
    # of the forces only the two in the plane are determined
    assert found.unique == [True, True, False, False, False]
    assert found.independent == [0]
    assert found.massless == ()
    assert np.abs(gap(found.q)).max() < 1e-12


def test_a_flat_start_does_not_decide_what_constraints_are_worth() -> None:
    """0.3 + 0.7 = 0.4 + 0.6: with all links in line J has rank 1 there, and 2 at places beside."""
    model = four_bar(crank=0.3, coupler=0.7, rocker=0.4, base=0.6)
    found = assemble(of_open(model), start=[0.0, 0.0, 0.0])
    assert (found.rank, found.freedoms) == (2, 1)
    np.testing.assert_allclose(found.q, 0, atol=1e-9)


def test_a_second_strut_across_a_triangle_is_redundant_where_it_fits_and_refused_where_not() -> (
    None
):
    def braced(length: float) -> Any:
        model = lg.Model("braced")
        door = model.body("door", mass=1.0, inertia=(1, 1, 1))
        model.revolute("hinge", between=("ground", door))
        edge = door.frame("edge", at=(3, 0, 0))
        model.rod("first", between=(model.ground.frame("eye", at=(0, 4, 0)), edge), length=5.0)
        model.rod("second", between=(model.ground.frame("low", at=(0, -4, 0)), edge), length=length)
        return of_open(model)

    found = assemble(braced(5.0))
    assert (found.rank, found.redundant, found.freedoms) == (1, 1, 0)
    assert found.unique == [False, False]
    assert math.sin(found.q[0]) == pytest.approx(0.0, abs=1e-8)  # 3 - 4 - 5, on either side
    with pytest.raises(lg.ModelError, match="cannot be assembled"):
        assemble(braced(5.5))


def test_two_motors_on_one_freedom_contradict_each_other_and_are_named() -> None:
    model = four_bar()
    flag = model.body("flag", mass=1.0, inertia=(1, 1, 1))
    model.revolute("m1", between=("ground", flag), motion="t")
    model.revolute("m2", between=("ground", flag), motion="2*t")
    with pytest.raises(lg.ModelError, match="is over-driven") as told:
        assemble(of_open(model))
    assert '"m1"' in told.value.problem
    assert '"m2"' in told.value.problem


def test_a_motion_that_nothing_with_mass_takes_part_in_is_massless() -> None:
    model = four_bar()
    idle = model.body("idle")
    model.revolute("spin", between=("crank", idle))
    found = assemble(of_open(model))
    assert [x.name for x in found.massless] == ["spin"]


def test_a_random_state_satisfies_positions_and_rates() -> None:
    found = of(four_bar())
    q, v = consistent(found, found.assembled.q, found.numeric(), random.Random(3))
    assert np.abs(gap(q)).max() < 1e-9
    rate = gap(np.array(q) + 1j * TINY * np.array(v)).imag / TINY
    assert np.abs(rate).max() < 1e-9
    assert np.abs(v).max() > 0.05
    other, _ = consistent(found, found.assembled.q, found.numeric(), random.Random(4))
    assert q != other


def test_accelerations_and_multipliers_solve_the_saddle() -> None:
    rng = np.random.default_rng(9)
    A = rng.normal(size=(4, 4))
    M, J = A @ A.T + np.eye(4), rng.normal(size=(2, 4))
    right, bias = rng.normal(size=4), rng.normal(size=2)
    a, force = saddle(M.tolist(), right.tolist(), J.tolist(), bias.tolist())
    S = np.linalg.inv(J @ np.linalg.inv(M) @ J.T)
    expected = S @ (bias - J @ np.linalg.solve(M, right))
    np.testing.assert_allclose(force, expected, atol=1e-12)
    np.testing.assert_allclose(a, np.linalg.solve(M, right + J.T @ expected), atol=1e-12)
    # the same constraint twice: each carries half
    twice = saddle(M, right, [J[0], J[0]], [bias[0]] * 2)[1]
    once = saddle(M, right, [J[0]], bias[:1])[1]
    np.testing.assert_allclose(twice, [once[0] / 2] * 2, atol=1e-12)
    assert saddle([[2.0]], [3.0], [], []) == ([pytest.approx(1.5)], [])


def test_the_assembled_tips_meet() -> None:
    coupler, rocker = tips(of(four_bar()).assembled.q)
    np.testing.assert_allclose(coupler, rocker, atol=1e-12)
