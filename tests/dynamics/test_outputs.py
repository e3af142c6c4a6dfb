"""Named outputs of a pendulum on a spring, a driven joint and a motor, compared with formulas."""

from __future__ import annotations

import math
from typing import Any

import pytest
from support.chains import walked
from support.inverse_schemes import scheme
from support.near import near

import linegraph as lg
from linegraph.dynamics.outputs import DYNAMIC, OF_POINTS, observed
from linegraph.errors import ModelError

G, M, L, K = 9.81, 2.0, 0.8, 30.0
ANGLE, RATE, SPIN = 0.6, 1.4, -2.5


def pendulum() -> lg.Model:
    """A bar along -y that turns about z, with a spring from ground to its tip at twice the mass centre."""
    model = lg.Model("pendulum", gravity=(0, -G, 0))
    bar = model.body("bar", mass=M, mass_center=(0, -L, 0), inertia={"zz": 0.1})
    tip = bar.frame("tip", at=(0, -2 * L, 0))
    model.revolute("hinge", between=("ground", bar))
    model.spring("coil", between=(model.ground.frame("eye", at=(1.0, 0, 0)), tip), stiffness=K)
    model.damper("brake", joint="hinge", damping=0.3)
    return model


def seen(
    model: lg.Model,
    q: Any = (ANGLE,),
    v: Any = (RATE,),
    a: Any = (SPIN,),
    *known: Any,
    **given: Any,
) -> Any:
    """The outputs' values, and whether they take accelerations; `known` are multipliers."""
    return observed(scheme(model, q, v, a, *known, **{"u": [0.0], **given}))


def value(text: str, **known: Any) -> Any:
    model = pendulum()
    model.output("y", text)
    (found,), dynamic = seen(model, **known)
    return found, dynamic


S, C = math.sin(ANGLE), math.cos(ANGLE)
TIP = (2 * L * S, -2 * L * C)
LINE = math.hypot(TIP[0] - 1, TIP[1])
FORMULAS: dict[str, tuple[str, float]] = {
    "position": ("position(bar.tip).x", 2 * L * S),
    "mass centre": ("position(bar.mass_center).y", -L * C),
    "velocity": ("velocity(bar.tip).y", 2 * L * S * RATE),
    "acceleration": ("acceleration(bar.tip).x", 2 * L * (C * SPIN - S * RATE**2)),
    "angular velocity": ("angular_velocity(bar).z", RATE),
    "angular acceleration": ("angular_acceleration(bar).z", SPIN),
    "length": ("across(coil)", LINE),
    "tension": ("through(coil)", K * LINE),
    "angle of a damper": ("across(brake)", ANGLE),
    "torque of a damper": ("through(brake)", 0.3 * RATE),
    "sum": ("2*position(bar.tip).x - der(hinge)**2 + hinge", 4 * L * S - RATE**2 + ANGLE),
}


@pytest.mark.parametrize("name", FORMULAS)
def test_an_output_is_what_its_formula_says(name: str) -> None:
    text, expected = FORMULAS[name]
    found, dynamic = value(text)
    assert found == pytest.approx(expected, abs=1e-13)
    assert dynamic is ("acceleration" in text)


def test_forces_are_those_of_reactions_and_need_accelerations() -> None:
    """On the bar, in its own axes: along it M (l w^2 + g cos) less the spring's pull along it."""
    pull = [K * (1 - TIP[0]), K * -TIP[1]]
    along = (S, -C)
    force, dynamic = value("force(hinge).y")
    towards = M * (L * RATE**2 + G * C) + pull[0] * along[0] + pull[1] * along[1]
    assert force == pytest.approx(towards, abs=1e-12)
    assert dynamic is True
    # about the hinge: what spins the bar, less weight and spring; the damper has its own edge
    lever = TIP[0] * pull[1] - TIP[1] * pull[0]
    torque, dynamic = value("torque(hinge).z")
    expected = (0.1 + M * L**2) * SPIN + M * G * L * S - lever + 0.3 * RATE
    assert torque == pytest.approx(expected, abs=1e-12)
    assert dynamic is True


def test_one_output_that_needs_accelerations_makes_all_dynamic() -> None:
    assert {"acceleration", "angular_acceleration"} == {*OF_POINTS} & {*DYNAMIC}
    model = pendulum()
    model.output("still", "position(bar.tip).x")
    assert seen(model)[1] is False
    model.output("moving", "force(hinge).x")
    found, dynamic = seen(model)
    assert dynamic is True
    assert len(found) == 2
    model.output("again", "position(bar.tip).y")
    assert seen(model)[1] is True


def test_parameters_inputs_and_the_time_may_be_named() -> None:
    model = lg.Model("given")
    model.input("push")
    cart = model.body("cart", mass=1.0)
    model.prismatic("slide", between=("ground", cart), axis=(1, 0, 0), motion="0.5*t**2")
    model.prismatic("lift", between=(cart, model.body("load", mass=1.0)), axis=(0, 1, 0))
    model.load("wind", at=cart, force=("3*push", 0, 0))
    model.output("y", "push + 10*t + 100*slide + 1000*der(slide)")
    # the inputs are the lift's effort and the push
    (found,), _ = seen(model, [0.7], [0.2], [0.0], u=[0.0, 5.0], t=2.0)
    assert found == pytest.approx(5 + 20 + 200 + 2000)


def test_an_input_that_prescribes_a_motion_may_be_named() -> None:
    model = lg.Model("led")
    model.prismatic(
        "slide", ("ground", model.body("cart", mass=1.0)), axis=(1, 0, 0), motion="input"
    )
    names = [x.name for x in walked(model, u=[0, 0, 0]).inputs]
    assert names == ["slide", "slide_rate", "slide_acceleration"]
    model.output("y", "slide_acceleration + 10*slide")
    (found,), _ = seen(model, [], [], [], u=[0.7, 0.2, 3.0])
    assert found == pytest.approx(10.0)


def test_an_effort_has_the_name_of_a_coordinate_or_of_nothing() -> None:
    """An effort shares its name with an angle or a velocity; an output never means the effort."""
    found, _ = value("hinge", u=[17.0])
    assert found == ANGLE
    model = lg.Model("ball")
    model.spherical("ball", between=("ground", model.body("body", mass=1.0, inertia=(1, 1, 1))))
    torque, *_ = (x.name for x in walked(model).inputs)
    model.output("y", torque)
    with pytest.raises(ModelError, match=torque):
        seen(model, [0, 0, 0, 1], [0, 0, 0], [0, 0, 0], u=[1.0, 2.0, 3.0])


def test_variables_of_networks_come_before_those_of_elements() -> None:
    model = lg.Model("servo")
    arm = model.body("arm", mass=1.0, inertia=(1, 1, 2))
    model.revolute("hinge", between=("ground", arm), effort=False)
    model.voltage_source("supply", between=("plus", "ground"), voltage=6.0)
    model.dc_motor("motor", between=("plus", "ground"), joint="hinge", constant=0.3, resistance=2.0)
    model.output("v", "across(supply)")
    model.output("i", "through(supply)")
    (voltage, current), dynamic = seen(model)
    assert voltage == pytest.approx(6.0)
    assert current == pytest.approx(-(6.0 - 0.3 * RATE) / 2.0)
    assert dynamic is False


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("position(bar.tap).x", r"position\(bar.tap\): there is no such terminal"),
        ("across(cool)", r"across\(cool\): there is no such element; .*coil"),
        ("through(cool)", r"through\(cool\): there is no such element"),
        ("force(hing).x", r"force\(hing\): there is no such joint or constraint; .*hinge"),
        ("hing", "hing"),
    ],
)
def test_what_does_not_exist_is_refused_with_what_is_like_it(text: str, problem: str) -> None:
    with pytest.raises(ModelError, match=problem) as told:
        value(text)
    assert told.value.thing == 'output "y"'


def test_outputs_of_a_chord_are_its_reaction() -> None:
    """Two hinges hold a bar at rest on both ends: the chord's multiplier is half of the weight."""
    model = lg.Model("plank", gravity=(0, -G, 0))
    bar = model.body("bar", mass=M, mass_center=(L, 0, 0))
    model.revolute("left", between=("ground", bar))
    ends = (model.ground.frame("post", at=(2 * L, 0, 0)), bar.frame("end", at=(2 * L, 0, 0)))
    model.revolute("right", between=ends)
    model.formulation(tree=("left",))
    for name in ("left", "right"):
        model.output(name, f"force({name}).y")
    half = M * G / 2
    found, dynamic = seen(model, [0], [0], [0], [0, half, 0, 0, 0], u=[0, 0])
    near(found, [half, half])
    assert dynamic is True
