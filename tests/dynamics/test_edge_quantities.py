"""Wrenches, powers of edges and what their variables are called."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.chains import walked
from support.near import near

import linegraph as lg
from linegraph.dynamics.edge_quantities import (
    NOTHING,
    EdgeVariables,
    Wrench,
    across_groups,
    across_quantities,
    network_powers,
    network_quantities,
    powers,
    reaction_axes,
    reaction_groups,
    reaction_quantities,
)

PUSH = Wrench((1.0, -2.0, 3.0), (0.5, 0.7, -0.4))


def test_wrenches_add_and_turn_round() -> None:
    assert Wrench((1, 2, 3), (4, 5, 6)) + Wrench((10, 0, 0), (0, 0, 7)) == ((11, 2, 3), (4, 5, 13))
    assert Wrench((1, 2, 3), (4, 5, 6)).turned() == ((-1, -2, -3), (-4, -5, -6))
    assert PUSH + NOTHING == PUSH


def test_a_wrench_about_another_point_does_the_same_power() -> None:
    """A rigid body's points move with u + w x r, so that f . u + n . w is one number for all of them."""
    old, new = np.array([0.3, 0.2, -0.5]), np.array([-1.0, 0.4, 0.6])
    moved = PUSH.about(tuple(old), tuple(new))
    w, origin = np.array([0.9, -0.2, 0.4]), np.array([1.0, 2.0, 3.0])
    for found, place in ((PUSH, old), (moved, new)):
        power = np.dot(found.force, origin + np.cross(w, place)) + np.dot(found.torque, w)
        near(power, np.dot(PUSH.force, origin + np.cross(w, old)) + np.dot(PUSH.torque, w))
    assert moved.about(tuple(new), tuple(old)).force == PUSH.force
    near(moved.about(tuple(new), tuple(old)).torque, PUSH.torque)


def test_powers_are_through_times_across_and_levers_count_as_rotation() -> None:
    edges = {
        "a": EdgeVariables(PUSH, (2, 1, 0), (0, 0, 5)),
        "b": EdgeVariables(PUSH.turned(), (1, 0, 0), (1, 0, 0), lever=(0, 3, 0), turning=(7, 2, 1)),
    }
    each, sums = powers(edges)
    assert each == {
        "a.translation": 0.0,
        "a.rotation": -2.0,
        "a.lever": 0,
        "b.translation": -1.0,
        "b.rotation": -0.5,
        "b.lever": 6,
    }
    assert sums == (-1.0, pytest.approx(3.5))
    assert powers({}) == ({}, (0, 0))


def servo() -> lg.Model:
    """A motor on a hinge, fed through a resistor, that heats a block."""
    model = lg.Model("servo")
    arm = model.body("arm", mass=1.0, inertia=(1, 1, 1))
    model.revolute("hinge", between=("ground", arm), effort=False)
    model.voltage_source("supply", between=("plus", "ground"), voltage=6.0)
    model.dc_motor("motor", between=("plus", "ground"), joint="hinge", constant=0.3, resistance=2.0)
    model.heat_capacity("block", between=("case", "ground"), capacity=10.0)
    model.conduction("skin", between=("case", "ground"), conductance=0.2)
    return model


def parts() -> tuple[Any, Any]:
    model = servo()
    return model.system(), walked(model).network


def test_edges_of_networks_deliver_what_they_do_not_take_in() -> None:
    """Heat flow times temperature is no power, and edges in mechanics are counted there."""
    _, network = parts()
    known = {"supply": (6.0, -0.5), "motor.electric": (6.0, 0.5), "block": (3.0, 2.0)}
    names = [b.name for b in network.branches if not b.port.spatial]
    given = {name: known.get(name, (1.0, 4.0)) for name in names}
    each, sums = network_powers(network, given)
    electric = [b.name for b in network.branches if b.port.domain == "electrical"]
    assert list(each) == electric
    assert each["supply"] == 3.0
    assert len(electric) == 2
    assert sums == {"electrical": sum(-x * y for x, y in (given[name] for name in electric))}
    assert network_powers(None, {}) == ({}, {})


def test_variables_of_networks_have_the_units_of_their_domain() -> None:
    system, network = parts()
    across, through = (network_quantities(system, network, k) for k in (0, 1))
    units = {q.name: q.unit for q in across}
    flows = {q.name: q.unit for q in through}
    assert units["supply"] == "V"
    assert flows["supply"] == "A"
    assert units["block"] == "K"
    assert flows["block"] == "W"
    assert not any(b.port.spatial and b.name in units for b in network.branches)
    (supply,) = (q for q in across if q.name == "supply")
    assert supply.about == "voltage across supply"
    (supply,) = (q for q in through if q.name == "supply")
    assert supply.about == "current through supply"
    assert network_quantities(system, None, 0) == []


def test_a_domain_of_the_models_own_gives_its_own_units() -> None:
    model = lg.Model("horn")
    pressure = {"name": "pressure", "unit": "Pa", "letter": "p"}
    flow = {"name": "flow", "unit": "m^3/s", "letter": "U"}
    model.domain("acoustic", across=pressure, through=flow)
    for name, law in (("wall", "x = 2*y"), ("voice", "y = 3")):
        model.element(name, ("in", "ground"), "acoustic", law=law)
    network = walked(model).network
    (across, _), (through, _) = (network_quantities(model.system(), network, k) for k in (0, 1))
    assert (across.unit, across.about) == ("Pa", "pressure across wall")
    assert (through.unit, through.about) == ("m^3/s", "flow through wall")


def test_names_come_part_by_part_and_axis_by_axis() -> None:
    across = across_quantities(["hinge", "coil"])
    assert [q.name for q in across[:6]] == [
        f"hinge_{x}" for x in ("vx", "vy", "vz", "wx", "wy", "wz")
    ]
    assert [q.unit for q in across[6:]] == ["m/s"] * 3 + ["rad/s"] * 3
    assert across[-1].about == "angular velocity z across coil, in ground axes"
    model = servo()
    reactions = reaction_quantities(model.system(), ["hinge"])
    assert [q.name for q in reactions] == [
        f"hinge_{x}" for x in ("fx", "fy", "fz", "tx", "ty", "tz")
    ]
    assert [q.unit for q in reactions] == ["N"] * 3 + ["N*m"] * 3
    assert reactions[1].about == "force y that hinge exerts on its head, in the head's axes"


def test_a_file_lists_six_variables_of_each_edge_as_one() -> None:
    ((across, six),) = across_groups(["hinge"])
    assert (across.name, across.unit, six) == ("hinge", "m/s, rad/s", 6)
    assert [(q.name, q.unit, n) for q, n in reaction_groups(["a", "b"])] == [
        ("a", "N, N*m", 6),
        ("b", "N, N*m", 6),
    ]


@pytest.mark.parametrize(
    ("chosen", "words"), [("head", "the head's"), ("tail", "the tail's"), ("ground", "ground")]
)
def test_reactions_say_in_whose_axes_they_are(chosen: str, words: str) -> None:
    model = servo()
    model.formulation(reactions=chosen)
    assert reaction_axes(model.system()) == words
