"""Networks at a state: a charging capacitor, a motor on a hinge and a diode, by hand."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest
from support.chains import formulated, walked
from support.near import near

import linegraph as lg
from linegraph.dynamics.network_state import (
    ALL,
    DRIVEN,
    NONE,
    RESTING,
    EdgeMotion,
    Exchange,
)
from linegraph.errors import ModelError
from linegraph.ir.dag import Dag
from linegraph.kinematics.tree import kinematic_tree
from linegraph.kinematics.tree_state import TreeState
from linegraph.networks.network import RATE

if TYPE_CHECKING:
    from collections.abc import Callable


def exchange(
    model: lg.Model,
    v: Any,
    motion: Callable[[str], EdgeMotion] | None = None,
    acceleration: Any = None,
    parameters: Any = None,
    names: Any = None,
    **arguments: Any,
) -> Exchange:
    """A model's network over floats, joints at zero; v holds their rates, then states."""
    tree = walked(model, parameters, **arguments)
    assert tree.network is not None
    state = TreeState(tree, [0.0] * len(tree.positions), v)
    return Exchange(tree.network, state, names or {}, motion or unmoved, acceleration)


def unmoved(port: str) -> EdgeMotion:
    raise AssertionError(f"nothing asks how {port} moves")


# a capacitor that is charged through a resistor

VOLTAGE, RESISTANCE, CAPACITANCE, CHARGED = 5.0, 2.0, 0.5, 3.0


def charging(**more: Any) -> Exchange:
    model = lg.Model("rc")
    model.input("U")
    model.parameter("R", 1.0)
    model.voltage_source("supply", between=("plus", "ground"), voltage="U")
    model.resistor("R1", between=("plus", "mid"), resistance="R")
    model.capacitor("C1", between=("mid", "ground"), capacitance=CAPACITANCE)
    return exchange(model, [CHARGED], parameters={"R": RESISTANCE}, u=[VOLTAGE], **more)


def test_what_charges_a_capacitor_is_told_apart_by_inputs() -> None:
    """C v' = (U - v) / R."""
    found = charging()
    resting, driven = -CHARGED / RESISTANCE, VOLTAGE / RESISTANCE
    assert found.force(0, RESTING) == pytest.approx(resting)
    assert found.force(0, DRIVEN) == pytest.approx(driven)
    assert found.force(0, ALL) == pytest.approx(resting + driven)
    assert found.force(0, NONE) == 0
    assert list(found.inertia()) == [(0, 0, CAPACITANCE)]


def test_every_edge_has_both_its_variables() -> None:
    found = charging()
    current = (VOLTAGE - CHARGED) / RESISTANCE
    for edge, across, through in (
        ("supply", VOLTAGE, -current),
        ("R1", VOLTAGE - CHARGED, current),
        ("C1", CHARGED, current),
    ):
        assert found.across(edge) == pytest.approx(across)
        assert found.through(edge) == pytest.approx(through)


def test_variables_are_looked_up_by_what_laws_call_them() -> None:
    named = charging().variables()
    assert named["across(R1)"] == pytest.approx(VOLTAGE - CHARGED)
    assert named["through(supply)"] == pytest.approx(-(VOLTAGE - CHARGED) / RESISTANCE)
    assert "across(R1)" in named
    for name in ("across(R2)", "force(R1).x", "across(R1).x", "R1"):
        assert name not in named
        with pytest.raises(KeyError):
            named[name]


def test_a_size_is_that_of_the_terms_and_not_of_their_difference() -> None:
    found = charging()
    assert found.size("R1", 0) == pytest.approx(VOLTAGE + CHARGED)
    assert found.size("R1", 1) == pytest.approx((VOLTAGE + CHARGED) / RESISTANCE)


def test_what_is_stored_and_what_becomes_heat_is_what_is_taken_in() -> None:
    current = (VOLTAGE - CHARGED) / RESISTANCE
    found = charging(acceleration=[current / CAPACITANCE])
    assert found.energy() == pytest.approx(CAPACITANCE * CHARGED**2 / 2)
    assert found.heat("R1") == pytest.approx(RESISTANCE * current**2)
    assert found.heat("C1") == 0
    gains = found.gains()
    assert set(gains) == {"R1", "C1"}
    near(list(gains.values()), [0, 0])
    # at another rate the capacitor gains what nobody delivers
    wrong = charging(acceleration=[current / CAPACITANCE + 1]).gains()
    assert wrong["C1"] == pytest.approx(CAPACITANCE * CHARGED)


def test_heat_capacities_hold_no_energy_of_the_audit() -> None:
    model = lg.Model("warm")
    model.heat_capacity("block", between=("case", "ground"), capacity=10.0)
    model.capacitor("C1", between=("plus", "ground"), capacitance=2.0)
    found = exchange(model, [300.0, 3.0], u=[])
    assert [s.quantity.name for s in found.network.states] == ["T_block", "v_C1"]
    assert found.energy() == pytest.approx(9.0)


# a motor behind a gear on a hinge

CONSTANT, OHM, HENRY, ROTOR, DRAG, RATIO = 0.3, 2.0, 0.1, 0.01, 0.02, 5
SPEED, CURRENT, BIAS = 1.4, 2.0, 0.5


def servo(**motor: Any) -> lg.Model:
    model = lg.Model("servo")
    arm = model.body("arm", mass=1.0, inertia=(1, 1, 1))
    model.revolute("hinge", between=("ground", arm), effort=False)
    model.voltage_source("supply", between=("plus", "ground"), voltage=6.0)
    model.dc_motor(
        "motor",
        between=("plus", "ground"),
        joint="hinge",
        constant=CONSTANT,
        resistance=OHM,
        inductance=HENRY,
        damping=DRAG,
        ratio=RATIO,
        **({"inertia": ROTOR} | motor),
    )
    return model


def turning(*row: tuple[int, float], bias: Any = BIAS) -> Callable[[str], EdgeMotion]:
    """A shaft at 0.7 rad and `SPEED`, whose rate is the sum of a row."""
    return lambda port: EdgeMotion(0.7, SPEED, row, bias)


DRIVES = CONSTANT * RATIO * CURRENT - RATIO**2 * DRAG * SPEED
REFLECTED = RATIO**2 * ROTOR


def test_a_motor_drives_with_its_current_and_its_voltage_falls_with_the_speed() -> None:
    found = exchange(servo(), [SPEED, CURRENT], turning((0, 1)), u=[])
    assert found.first == 1
    back = CONSTANT * RATIO * SPEED
    assert found.force(0, ALL) == pytest.approx(6.0 - OHM * CURRENT - back)
    # at v' = 0 the rotor accelerates with the shaft's own bias
    assert found.force(1, RESTING) == pytest.approx(DRIVES - REFLECTED * BIAS)
    assert found.force(1, DRIVEN) == 0


def test_a_rotor_is_reflected_to_all_velocities_that_turn_its_shaft() -> None:
    """With w = 2 v0 - 3 v1 its n^2 J is spread as (2, -3) (2, -3)^T."""
    found = exchange(servo(), [SPEED, CURRENT], turning((0, 2.0), (4, -3.0)), u=[])
    entries = {(i, j): x for i, j, x in found.inertia()}
    assert entries == {
        (1, 1): pytest.approx(HENRY),
        (0, 0): pytest.approx(4 * REFLECTED),
        (0, 4): pytest.approx(-6 * REFLECTED),
        (4, 0): pytest.approx(-6 * REFLECTED),
        (4, 4): pytest.approx(9 * REFLECTED),
    }
    assert found.projected(0) == ((1, 1),)
    assert found.projected(1) == found.coordinate_of(0) == ((0, 2.0), (4, -3.0))


def test_a_shafts_torque_needs_the_rates_that_its_rotor_has() -> None:
    still = exchange(servo(), [SPEED, CURRENT], turning((0, 2.0)), u=[])
    with pytest.raises(ModelError, match="known only once the equations are solved"):
        still.through("motor.mechanical")
    moving = exchange(servo(), [SPEED, CURRENT], turning((0, 2.0)), [-1.2, 7.0], u=[])
    spin = BIAS + 2.0 * -1.2
    assert moving.across("motor.mechanical") == pytest.approx(SPEED)
    assert moving.through("motor.mechanical") == pytest.approx(REFLECTED * spin - DRIVES)
    # forces are those at v' = 0, whatever is known
    with pytest.raises(ModelError, match="known only once the equations are solved"):
        moving.still(moving.network.dag.symbol(RATE, 0))
    # the electric port takes in what its coil asks for at this rate of its current
    coil = OHM * CURRENT + HENRY * 7.0 + CONSTANT * RATIO * SPEED
    gained = moving.gains()["motor"]
    taken = 6.0 * CURRENT + (REFLECTED * spin - DRIVES) * SPEED
    stored = HENRY * CURRENT * 7.0 + REFLECTED * SPEED * spin
    heat = OHM * CURRENT**2 + RATIO**2 * DRAG * SPEED**2
    assert gained == pytest.approx(stored + heat - taken)
    assert gained == pytest.approx((coil - 6.0) * CURRENT)


def test_how_a_shaft_moves_is_found_once() -> None:
    asked = []

    def motion(port: str) -> EdgeMotion:
        asked.append(port)
        return EdgeMotion(0.7, SPEED, ((0, 1),), BIAS)

    found = exchange(servo(), [SPEED, CURRENT], motion, u=[])
    found.force(0, ALL)
    found.force(1, ALL)
    list(found.inertia())
    assert asked == ["motor.mechanical"]


def test_a_rotor_on_a_joint_without_a_formula_for_its_acceleration_is_refused() -> None:
    unknown = turning((0, 1), bias=None)
    found = exchange(servo(), [SPEED, CURRENT], unknown, u=[])
    with pytest.raises(ModelError, match="reflects inertia to a joint") as told:
        found.force(1, ALL)
    assert told.value.thing == 'dc_motor "motor"'
    # without a rotor nothing asks
    light = exchange(servo(inertia=None), [SPEED, CURRENT], unknown, u=[])
    assert light.force(1, ALL) == pytest.approx(DRIVES)


def test_a_displacement_is_where_its_edge_stands() -> None:
    """A coil whose inductance is 0.1 (1 + x) H, its plunger at x = 0.7 m."""
    model = lg.Model("solenoid")
    arm = model.body("arm", mass=1.0)
    model.prismatic("slide", between=("ground", arm), axis=(1, 0, 0), effort=False)
    model.voltage_source("supply", between=("plus", "ground"), voltage=6.0)
    model.solenoid(
        "coil", between=("plus", "ground"), joint="slide", inductance="0.1*(1 + x)", resistance=OHM
    )
    found = exchange(model, [SPEED, CURRENT], turning((0, 1)), u=[])
    # L i' = U - R i - (dL/dx) w i, and a pull of (dL/dx) i^2 / 2
    assert list(found.inertia()) == [(1, 1, pytest.approx(0.17))]
    assert found.force(0, ALL) == pytest.approx(6.0 - OHM * CURRENT - 0.1 * SPEED * CURRENT)
    assert found.force(1, ALL) == pytest.approx(0.1 * CURRENT**2 / 2)
    assert found.energy() == pytest.approx(0.17 * CURRENT**2 / 2)


# what laws name


def sourced(voltage: str, **given: Any) -> float:
    model = lg.Model("named")
    model.input("U")
    model.parameter("k", 1.0)
    model.revolute("hinge", ("ground", model.body("arm", mass=1, inertia=(1, 1, 1))), effort=False)
    model.voltage_source("supply", between=("plus", "ground"), voltage=voltage)
    model.resistor("R1", between=("plus", "ground"), resistance=1.0)
    found = exchange(model, [0.0], parameters={"k": 3.0}, **({"u": [0.7], "t": 2.0} | given))
    return float(found.across("R1"))


def test_laws_name_parameters_inputs_the_time_numbers_and_coordinates() -> None:
    assert sourced("10*k + U + t/4") == pytest.approx(30 + 0.7 + 0.5)
    names = {"hinge": 0.2, "der(hinge)": -4.0}
    assert sourced("hinge + der(hinge)", names=names) == pytest.approx(-3.8)
    with pytest.raises(ModelError, match="hinge is not known here"):
        sourced("2*hinge")


def test_an_input_whose_derivative_counts_is_an_input_with_it() -> None:
    """A capacitor on a source: its current is C dU/dt."""
    model = lg.Model("led")
    model.input("U")
    model.voltage_source("supply", between=("plus", "ground"), voltage="U")
    model.capacitor("C1", between=("plus", "ground"), capacitance=CAPACITANCE)
    found = exchange(model, [], u=[5.0, 0.8])
    assert [q.name for q in found.state.tree.inputs] == ["U", "U_rate"]
    assert found.through("C1") == pytest.approx(CAPACITANCE * 0.8)


# an algebraic loop


def rectifier() -> lg.Model:
    model = lg.Model("rectifier")
    model.voltage_source("supply", between=("plus", "ground"), voltage=1.0)
    model.resistor("R1", between=("plus", "mid"), resistance=100.0)
    model.diode("D1", between=("mid", "ground"), saturation=1e-14, voltage=0.02585)
    return model


def test_a_loop_is_solved_in_floats() -> None:
    """The current through resistor and diode is one: (1 - v) / 100 = Is (exp(v / Vt) - 1)."""
    found = exchange(rectifier(), [], u=[])
    (v,) = found.solved
    assert found.across("D1") == v
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        if (1 - middle) / 100 > 1e-14 * math.expm1(middle / 0.02585):
            low = middle
        else:
            high = middle
    assert v == pytest.approx(low, abs=1e-14)
    assert found.through("R1") == pytest.approx((1 - low) / 100, rel=1e-12)
    (left,) = found.algebraic_loop()
    assert abs(left) < 1e-15


def test_over_nodes_the_unknowns_of_a_loop_are_symbols() -> None:
    dag = Dag()
    model = rectifier()
    tree = kinematic_tree(model.system(), formulated(model), dag, {})
    assert tree.network is not None
    found = Exchange(tree.network, TreeState(tree, [], []), {}, unmoved)
    assert found.across("D1") is dag.symbol("loop", 0)


def test_energy_without_a_value_names_its_component() -> None:
    """Of the charge log(1 + x) the energy is x - log(1 + x)."""
    model = lg.Model("store")
    model.capacitor("C1", between=("plus", "ground"), charge="log(1 + x)")
    model.resistor("R1", between=("plus", "ground"), resistance=1.0)
    assert exchange(model, [0.5], u=[]).energy() == pytest.approx(0.5 - math.log(1.5))
    with pytest.raises(ModelError, match="its energy: log") as told:
        exchange(model, [-2.0], u=[]).energy()
    assert told.value.thing == 'capacitor "C1"'
