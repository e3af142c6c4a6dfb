"""Networks that cannot be: one message with file and line that names the component.

Also the other side: what looks suspicious and can be, what is worth a remark, and what fails at run time.
"""

from __future__ import annotations

import inspect
import math
import re
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pytest
from click.testing import CliRunner
from support.compiled import Compiled, Failed
from support.emitted import load

from linegraph import Model, ModelError, derive
from linegraph.cli.main import main
from linegraph.emission.emit import render
from linegraph.errors import LinegraphError, SourceError, SourceErrors
from linegraph.readers.modelfile import parse

if TYPE_CHECKING:
    from pathlib import Path

    from linegraph.derivation import Derivation


def part(kind: str, name: str, between: str, *keys: str) -> str:
    """The table of a component."""
    ends = ", ".join(f'"{vertex}"' for vertex in between.split())
    return "\n".join((f"[{kind}.{name}]", f"between = [{ends}]", *keys, ""))


def given(value: Any) -> str:
    return f'"{value}"' if isinstance(value, str) else str(value)


def resistor(name: str, between: str, value: Any = 2) -> str:
    return part("resistor", name, between, f"resistance = {given(value)}")


def capacitor(name: str, between: str, value: Any = 3) -> str:
    return part("capacitor", name, between, f"capacitance = {given(value)}")


def inductor(name: str, between: str, value: Any = 4) -> str:
    return part("inductor", name, between, f"inductance = {given(value)}")


def voltage(name: str, between: str, value: Any = 1) -> str:
    return part("voltage_source", name, between, f"voltage = {given(value)}")


def current(name: str, between: str, value: Any = 1) -> str:
    return part("current_source", name, between, f"current = {given(value)}")


def two(kind: str, name: str, between: str, second: str, *keys: str) -> str:
    ends = ", ".join(f'"{vertex}"' for vertex in second.split())
    return part(kind, name, between, f"second = [{ends}]", *keys)


RC = resistor("R1", "a ground") + capacitor("C1", "a ground")
INPUT = "[inputs]\nu = {}\n"
HINGES = """\
[body.arm]
mass = 1
inertia = [1, 1, 1]
[body.hand]
mass = 1
inertia = [1, 1, 1]
[revolute.hinge]
between = ["ground", "arm"]
axis = [0, 1, 0]
[revolute.wrist]
between = ["arm", "hand"]
axis = [0, 1, 0]
"""
HINGE = """\
[revolute.{}]
between = ["ground", "arm"]
axis = [0, 1, 0]
"""
SLIDE = """\
[body.cart]
mass = 1
[prismatic.slide]
between = ["ground", "cart"]
axis = [1, 0, 0]
"""
FREE = """\
[body.ship]
mass = 1
inertia = [1, 1, 1]
[free.floats]
between = ["ground", "ship"]
"""
MOUNT = part("translational_interface", "mount", "rail ground", 'joint = "slide"')
TURNED = part("rotational_interface", "near", "n ground", 'joint = "hinge"') + part(
    "rotational_interface", "far", "f ground", 'joint = "wrist"'
)
MOTOR = ("constant = 1", "resistance = 1")
ACOUSTIC = """\
[domain.acoustic]
across = { name = "pressure", unit = "Pa", letter = "p" }
through = { name = "flow", unit = "m^3/s", letter = "U" }
"""
HEAT = part("heat_capacity", "warm", "warm ground", "capacity = 1")
TRANSFORMER = two("transformer", "T", "a ground", "c ground", "ratio = 2") + resistor(
    "R2", "c ground"
)


def windings(kind: str, name: str, *keys: str) -> str:
    pairs = 'windings = [["a", "ground"], ["b", "ground"]]'
    return "\n".join((f"[{kind}.{name}]", pairs, *keys, ""))


class Bad(NamedTuple):
    """A file, the header of the table to blame, and what the message must say."""

    text: str
    tables: tuple[str, ...]
    says: tuple[str, ...]


def bad(text: str, tables: str | tuple[str, ...], *says: str) -> Bad:
    return Bad(text, (tables,) if isinstance(tables, str) else tables, says)


def changed(text: str, old: str, new: str) -> str:
    assert text.count(old) == 1, old
    return text.replace(old, new)


SOURCES = {
    "two_voltages": bad(
        RC + voltage("V1", "a ground") + voltage("V2", "a ground", 2),
        ("[voltage_source.V1]", "[voltage_source.V2]"),
        *("V1", "V2", "closes a loop", "resistance in series"),
    ),
    "two_that_agree": bad(
        RC + voltage("V1", "a ground") + voltage("V2", "ground a", -1),
        ("[voltage_source.V1]", "[voltage_source.V2]"),
        *("V1", "V2", "repeat"),
    ),
    "three_voltages": bad(
        RC
        + voltage("V1", "a ground")
        + voltage("V2", "a b", 2)
        + voltage("V3", "b ground", 3)
        + resistor("R2", "b ground"),
        ("[voltage_source.V1]", "[voltage_source.V2]", "[voltage_source.V3]"),
        *("V1", "V2", "V3", "closes a loop"),
    ),
    "an_input_and_the_time": bad(
        INPUT + RC + voltage("V1", "a ground", "u") + voltage("V2", "a ground", "sin(t)"),
        ("[voltage_source.V1]", "[voltage_source.V2]"),
        *("V1", "V2", "closes a loop"),
    ),
    "a_short_behind_a_transformer": bad(
        RC
        + voltage("V1", "b ground")
        + two("transformer", "T", "b ground", "c ground", "ratio = 2")
        + voltage("short", "c ground", 0),
        ("[voltage_source.V1]", "[transformer.T]", "[voltage_source.short]"),
        *("V1", "T", "short"),
    ),
    "controlled_by_itself": bad(
        RC + voltage("V1", "b ground", "across(V1)") + resistor("R2", "b ground"),
        "[voltage_source.V1]",
        "V1",
    ),
    "controlled_in_a_circle": bad(
        RC
        + voltage("V1", "b ground", "across(V2)")
        + voltage("V2", "c ground", "across(V1)")
        + resistor("R2", "b ground")
        + resistor("R3", "c ground"),
        ("[voltage_source.V1]", "[voltage_source.V2]"),
        *("V1", "V2"),
    ),
    "two_currents": bad(
        RC + current("I1", "ground b") + current("I2", "b ground", 2),
        ("[current_source.I1]", "[current_source.I2]"),
        *("I1", "I2", "closes a cutset", "resistance in parallel"),
    ),
    "a_current_without_a_way": bad(
        RC + current("I1", "ground b"),
        "[current_source.I1]",
        *("I1", "cutset"),
    ),
    "three_currents_at_a_vertex": bad(
        RC + current("I1", "ground b") + current("I2", "a b") + current("I3", "b ground"),
        ("[current_source.I1]", "[current_source.I2]", "[current_source.I3]"),
        *("I1", "I2", "I3", "closes a cutset"),
    ),
    "two_velocities": bad(
        part("mass", "m", "m ground", "mass = 1")
        + part("translational_damper", "d", "m ground", "damping = 1")
        + part("velocity_source", "V1", "m ground", "velocity = 1")
        + part("velocity_source", "V2", "m ground", "velocity = 2"),
        ("[velocity_source.V1]", "[velocity_source.V2]"),
        *("V1", "V2", "closes a loop"),
    ),
    "two_temperatures": bad(
        HEAT
        + part("temperature_source", "V1", "warm ground", "temperature = 1")
        + part("temperature_source", "V2", "warm ground", "temperature = 2"),
        ("[temperature_source.V1]", "[temperature_source.V2]"),
        *("V1", "V2", "closes a loop"),
    ),
}

REFERENCES = {
    name: bad(
        resistor("R1", f"a {name}") + capacitor("C1", f"a {name}"),
        ("[resistor.R1]", "[capacitor.C1]"),
        *("R1, C1", "no reference", f'is "{name}" meant to be "ground"?'),
    )
    for name in ("gnd", "GND", "0", "earth", "vss")
} | {
    "without_a_hint": bad(
        resistor("R1", "a b") + capacitor("C1", "a b"),
        ("[resistor.R1]", "[capacitor.C1]"),
        *("R1, C1", "no reference", '(a, b) to "ground"'),
    ),
    "a_part_of_it": bad(
        RC + resistor("R2", "p q") + capacitor("C2", "p q"),
        ("[resistor.R2]", "[capacitor.C2]"),
        *("R2, C2", "no reference"),
    ),
    "behind_a_transformer": bad(
        RC + two("transformer", "T", "a ground", "c d", "ratio = 2") + resistor("R2", "c d"),
        ("[transformer.T]", "[resistor.R2]"),
        *("T.second, R2", "no reference", "c, d"),
    ),
    "in_another_domain": bad(
        RC + part("translational_damper", "d", "a b", "damping = 1"),
        "[translational_damper.d]",
        *("translation_1d", "d", "no reference"),
    ),
}

EDGES = {
    "loop": bad(RC + resistor("R2", "b b"), "[resistor.R2]", "R2", 'begins and ends at "b"'),
    "on_ground": bad(
        RC + resistor("R2", "ground ground"), "[resistor.R2]", "R2", 'begins and ends at "ground"'
    ),
    "second": bad(
        RC + two("transformer", "T", "a ground", "c c", "ratio = 2"),
        "[transformer.T]",
        *("T", 'begins and ends at "c"'),
    ),
    "shaft": bad(
        RC + part("dc_motor", "M", "a ground", 'shaft = ["s", "s"]', *MOTOR),
        "[dc_motor.M]",
        *("M", 'begins and ends at "s"'),
    ),
    "winding": bad(
        RC
        + '[coupled_inductors.K]\nwindings = [["a", "ground"], ["b", "b"]]\n'
        + "inductance = [[1, 0], [0, 1]]\n",
        "[coupled_inductors.K]",
        *("K", 'begins and ends at "b"'),
    ),
    "one_vertex": bad(
        RC + part("resistor", "R2", "a", "resistance = 1"),
        "[resistor.R2]",
        *("R2", "[tail, head]", "a list of 1"),
    ),
    "three_vertices": bad(
        RC + resistor("R2", "a b ground"), "[resistor.R2]", "R2", "[tail, head]", "a list of 3"
    ),
    "a_number": bad(
        RC + '[resistor.R2]\nbetween = ["a", 0]\nresistance = 1\n',
        "[resistor.R2]",
        *("R2", "name of a vertex", "not 0"),
    ),
    "no_vertices": bad(
        RC + "[resistor.R2]\nresistance = 1\n", "[resistor.R2]", "R2", "between is missing"
    ),
    "nameless_vertex": bad(
        RC + '[resistor.R2]\nbetween = ["a", ""]\nresistance = 1\n', "[resistor.R2]", "empty"
    ),
    "no_feedback": bad(
        RC
        + part("opamp", "amp", "a ground", 'output = ["o", "ground"]')
        + resistor("R2", "o ground"),
        "[opamp.amp]",
        *("amp", "feedback"),
    ),
    "no_feedback_but_an_input": bad(
        RC
        + part("opamp", "amp", "ground m", 'output = ["o", "ground"]')
        + resistor("R2", "o ground")
        + resistor("R3", "a m"),
        "[opamp.amp]",
        *("amp", "feedback"),
    ),
    "no_output": bad(
        RC + part("opamp", "amp", "ground m"), "[opamp.amp]", "amp", "output is missing"
    ),
}

MECHANICS = {
    "two_joints_by_a_gear": bad(
        HINGES + TURNED + two("gear", "box", "n ground", "f ground", "ratio = 3"),
        ("[gear.box]", "[rotational_interface.near]", "[rotational_interface.far]"),
        *("near", "far", "box"),
    ),
    "two_interfaces_of_a_joint": bad(
        SLIDE + MOUNT + part("translational_interface", "hook", "rail ground", 'joint = "slide"'),
        ("[translational_interface.mount]", "[translational_interface.hook]"),
        *("mount", "hook"),
    ),
    "a_velocity_on_a_joint": bad(
        SLIDE + MOUNT + part("velocity_source", "pull", "rail ground", "velocity = 1"),
        ("[velocity_source.pull]", "[translational_interface.mount]"),
        *("mount", "pull"),
    ),
    "an_input_on_a_joint": bad(
        INPUT + SLIDE + MOUNT + part("velocity_source", "pull", "rail ground", 'velocity = "u"'),
        ("[velocity_source.pull]", "[translational_interface.mount]"),
        *("mount", "pull"),
    ),
    "no_place": bad(
        HINGES + RC + part("dc_motor", "M", "a ground", *MOTOR),
        "[dc_motor.M]",
        *("M", "joint or points or shaft is missing"),
    ),
    "two_places": bad(
        HINGES
        + RC
        + part("dc_motor", "M", "a ground", 'joint = "hinge"', 'shaft = ["s", "ground"]', *MOTOR),
        "[dc_motor.M]",
        *("M", "joint or shaft, not both"),
    ),
    "no_place_of_a_machine": bad(
        RC + windings("synchronous_machine", "S", "inductance = [[1, 0], [0, 1]]"),
        "[synchronous_machine.S]",
        *("S", "joint or shaft is missing"),
    ),
    "a_joint_of_six_freedoms": bad(
        FREE + RC + part("dc_motor", "M", "a ground", 'joint = "floats"', *MOTOR),
        "[dc_motor.M]",
        *("M", "6 degrees of freedom", "one"),
    ),
    "an_unknown_joint": bad(
        HINGES + RC + part("dc_motor", "M", "a ground", 'joint = "hing"', *MOTOR),
        "[dc_motor.M]",
        *("M", 'no joint "hing"', 'did you mean "hinge"'),
    ),
    "unknown_points": bad(
        HINGES + RC + part("moving_coil", "M", "a ground", 'points = ["ground", "amr"]', MOTOR[0]),
        "[moving_coil.M]",
        *("M", "points (item 2)", 'did you mean "arm"'),
    ),
    "points_of_a_body": bad(
        HINGES + RC + part("moving_coil", "M", "a ground", 'points = ["arm", "arm"]', MOTOR[0]),
        "[moving_coil.M]",
        *("M", 'connects body "arm" to itself'),
    ),
    "a_shaft_of_one": bad(
        RC + part("dc_motor", "M", "a ground", 'shaft = ["s"]', *MOTOR),
        "[dc_motor.M]",
        *("M", "shaft", "a list of 1"),
    ),
    "a_shaft_without_reference": bad(
        RC
        + part("dc_motor", "M", "a ground", 'shaft = ["s", "gnd"]', *MOTOR)
        + part("rotational_damper", "d", "s gnd", "damping = 1"),
        ("[dc_motor.M]", "[rotational_damper.d]"),
        *("M.mechanical, d", "rotation_1d", 'is "gnd" meant'),
    ),
    "a_massless_loop_beside_it": bad(
        RC + "[body.arm]\n" + HINGE.format("near") + HINGE.format("far"),
        ("[revolute.near]", "[revolute.far]"),
        *("near", "no inertia"),
    ),
    "a_motor_between_points": bad(
        HINGES + RC + part("dc_motor", "M", "a ground", 'points = ["ground", "arm"]', *MOTOR),
        "[dc_motor.M]",
        *("M", "turns", "joint or shaft"),
    ),
    "a_shaft_on_a_slide": bad(
        SLIDE
        + part("rotational_interface", "mount", "n ground", 'joint = "slide"')
        + part("rotational_damper", "d", "n ground", "damping = 1"),
        "[rotational_interface.mount]",
        *("mount", '"slide"', "turns"),
    ),
    "a_rod_on_a_hinge": bad(
        HINGES
        + part("translational_interface", "mount", "n ground", 'joint = "hinge"')
        + part("translational_damper", "d", "n ground", "damping = 1"),
        "[translational_interface.mount]",
        *("mount", '"hinge"', "slides"),
    ),
} | {
    f"{kind}_in_the_air": bad(
        RC + part(kind, "it", "p q", f"{key} = 1"),
        f"[{kind}.it]",
        *("it", "must be ground", "it has p and q"),
    )
    for kind, key in (
        *(("mass", "mass"), ("inertia", "inertia")),
        *(("tank", "area"), ("heat_capacity", "capacity")),
    )
}

NAMES = {
    "across": bad(
        RC
        + voltage("V1", "b ground", "across(load_resistr)")
        + resistor("load_resistor", "b ground"),
        "[voltage_source.V1]",
        *("V1", "load_resistr", 'did you mean "load_resistor"'),
    ),
    "through": bad(
        RC
        + current("I1", "b ground", "2*through(load_resistr)")
        + resistor("load_resistor", "b ground"),
        "[current_source.I1]",
        *("I1", "load_resistr", 'did you mean "load_resistor"'),
    ),
    "across_a_two_port": bad(
        RC + TRANSFORMER + voltage("V1", "b ground", "across(T)") + resistor("R3", "b ground"),
        "[voltage_source.V1]",
        *("V1", "across(T)", "T.first", "T.second"),
    ),
    "across_a_port": bad(
        RC
        + TRANSFORMER
        + voltage("V1", "b ground", "across(T.frist)")
        + resistor("R3", "b ground"),
        "[voltage_source.V1]",
        *("V1", "T.frist", 'did you mean "T.first"'),
    ),
    "output_of_a_two_port": bad(
        RC + TRANSFORMER + '[outputs]\ny = "across(T)"\n', "[outputs]", "T.first", "T.second"
    ),
    "output_of_a_port": bad(
        RC + TRANSFORMER + '[outputs]\ny = "across(T.frist)"\n',
        "[outputs]",
        *("T.frist", 'did you mean "T.first"'),
    ),
    "output": bad(
        RC + '[outputs]\ny = "across(load_resistr)"\n' + resistor("load_resistor", "a ground"),
        "[outputs]",
        *("load_resistr", 'did you mean "load_resistor"'),
    ),
    "coordinate": bad(
        HINGES + RC + current("I1", "a ground", "der(hing)"),
        "[current_source.I1]",
        *("I1", "der(hing)", 'did you mean "hinge"'),
    ),
    "parameter": bad(
        "[parameters]\nresistance_1 = 2\n" + resistor("R1", "a ground", "resistanc_1"),
        "[resistor.R1]",
        *("R1", "resistanc_1", 'did you mean "resistance_1"'),
    ),
    "taken_by_a_component": bad(
        RC + resistor("C1", "a ground"), "[resistor.C1]", "taken by [capacitor.C1] in line 4"
    ),
    "taken_by_a_joint": bad(
        HINGES + RC + resistor("hinge", "a ground"), "[resistor.hinge]", "taken by [revolute.hinge]"
    ),
    "taken_by_an_element": bad(
        HINGES + '[spring.R1]\njoint = "hinge"\nstiffness = 1\n' + RC,
        "[resistor.R1]",
        "taken by [spring.R1]",
    ),
    "of_a_state_and_a_coordinate": bad(
        RC + SLIDE.replace("slide", "v_C1"),
        ("[capacitor.C1]", "[prismatic.v_C1]"),
        *("v_C1", "rename"),
    ),
    "of_two_states": bad(
        RC
        + windings("coupled_inductors", "K", "inductance = [[1, 0], [0, 1]]")
        + inductor("K_winding1", "a ground")
        + resistor("R2", "b ground"),
        ("[coupled_inductors.K]", "[inductor.K_winding1]"),
        *("i_K_winding1", "rename"),
    ),
    "of_an_input_and_a_rate": bad(
        "[inputs]\nu = {}\nu_rate = {}\n"
        + RC
        + voltage("V1", "a ground", "u")
        + resistor("R2", "a b")
        + capacitor("C2", "b ground"),
        ("[inputs]", "[capacitor.C1]"),
        *("u_rate", "rename"),
    ),
    "own_variable": bad(
        "[parameters]\nx = 1\n"
        + resistor("R1", "a ground")
        + part("capacitor", "C1", "a ground", 'charge = "2*x"'),
        "[capacitor.C1]",
        *("C1", '"x"', "rename"),
    ),
    "type": bad(
        part("resistr", "R2", "a ground", "resistance = 1") + RC,
        "[resistr.R2]",
        *("[resistr]", 'did you mean "resistor"'),
    ),
    "key": bad(
        RC + part("resistor", "R2", "a ground", "resistence = 1"),
        "[resistor.R2]",
        *("resistence", 'did you mean "resistance"'),
    ),
    "wanted_branch": bad(
        RC + '[formulation]\ntree = ["C2"]\n', "[formulation]", '"C2"', "component", "R1, C1"
    ),
    "lost_power": bad(
        RC
        + HEAT
        + part("losses", "heat", "ground warm", 'of = ["load_resistr"]')
        + resistor("load_resistor", "a ground"),
        "[losses.heat]",
        *("heat", "load_resistr", 'did you mean "load_resistor"'),
    ),
    "lost_power_of_itself": bad(
        RC + HEAT + part("losses", "heat", "ground warm", 'of = ["heat"]'), "[losses.heat]", "heat"
    ),
    "lost_power_of_nothing": bad(
        RC + HEAT + part("losses", "heat", "ground warm", "of = []"), "[losses.heat]", "heat", "of"
    ),
}

SHAPES = {
    "one_row": bad(
        RC + windings("coupled_inductors", "K", "inductance = [[1, 0]]"),
        "[coupled_inductors.K]",
        *("K", "2 x 2", "2 windings"),
    ),
    "a_short_row": bad(
        RC + windings("coupled_inductors", "K", "inductance = [[1, 0], [1]]"),
        "[coupled_inductors.K]",
        *("K", "2 x 2"),
    ),
    "not_symmetric": bad(
        RC + windings("coupled_inductors", "K", "inductance = [[1, 0.5], [0.4, 1]]"),
        "[coupled_inductors.K]",
        *("K", "not symmetric"),
    ),
    "a_number": bad(
        RC + windings("coupled_inductors", "K", "inductance = 3"),
        "[coupled_inductors.K]",
        *("K", "a list of rows", "not 3"),
    ),
    "numbers": bad(
        RC + windings("coupled_inductors", "K", "inductance = [3]"),
        "[coupled_inductors.K]",
        *("K", "inductance (item 1)", "a row of the matrix", "not 3"),
    ),
    "nothing": bad(
        RC + windings("coupled_inductors", "K"), "[coupled_inductors.K]", "K", "inductance"
    ),
    "one_winding": bad(
        RC + '[coupled_inductors.K]\nwindings = [["a", "ground"]]\ninductance = [[1]]\n',
        "[coupled_inductors.K]",
        *("K", "at least two"),
    ),
    "windings_of_words": bad(
        RC + '[coupled_inductors.K]\nwindings = ["a ground"]\ninductance = [[1]]\n',
        "[coupled_inductors.K]",
        *("K", "windings (item 1)", "[tail, head]"),
    ),
    "windings_of_three": bad(
        RC + '[coupled_inductors.K]\nwindings = [["a", "b", "c"]]\ninductance = [[1]]\n',
        "[coupled_inductors.K]",
        *("K", "windings (item 1)", "a list of 3"),
    ),
    "machine_of_one_row": bad(
        RC
        + windings(
            "synchronous_machine", "S", 'shaft = ["s", "ground"]', 'inductance = [["1 + x", 0]]'
        ),
        "[synchronous_machine.S]",
        *("S", "2 x 2"),
    ),
    "machine_not_symmetric": bad(
        RC
        + windings(
            "synchronous_machine",
            "S",
            'shaft = ["s", "ground"]',
            'inductance = [[1, "sin(x)"], ["cos(x)", 1]]',
        ),
        "[synchronous_machine.S]",
        *("S", "not symmetric"),
    ),
    "machine_of_three_magnets": bad(
        RC
        + windings(
            "synchronous_machine",
            "S",
            'shaft = ["s", "ground"]',
            "inductance = [[1, 0], [0, 1]]",
            "flux = [1, 2, 3]",
        ),
        "[synchronous_machine.S]",
        *("S", "2 linkages"),
    ),
    "flux_is_a_number": bad(
        RC
        + windings(
            "synchronous_machine",
            "S",
            'shaft = ["s", "ground"]',
            "inductance = [[1, 0], [0, 1]]",
            "flux = 1",
        ),
        "[synchronous_machine.S]",
        *("S", "flux", "a list"),
    ),
    "two_charges": bad(
        part("capacitor", "C1", "a ground", "capacitance = 1", 'charge = "x"'),
        "[capacitor.C1]",
        *("C1", "capacitance or charge, not both"),
    ),
    "no_charge": bad(
        part("capacitor", "C1", "a ground"),
        "[capacitor.C1]",
        *("C1", "capacitance or charge or coenergy is missing"),
    ),
    "keeps": bad(
        RC + part("store", "S", "a ground", "constant = 1", 'keeps = "voltage"'),
        "[store.S]",
        *("S", '"across" or "through"', '"voltage"'),
    ),
}


def element(*keys: str) -> str:
    return RC + part("element", "E", "a ground", 'domain = "electrical"', *keys)


LAWS = {
    "an_expression": bad(element('law = "2*x"'), "[element.E]", "E", "an equation", '"2*x"'),
    "two_equations": bad(element('law = "y = x = 2"'), "[element.E]", "E", "an equation"),
    "a_comparison": bad(element('law = "y == x"'), "[element.E]", "E", "an equation"),
    "half_an_equation": bad(element('law = "y ="'), "[element.E]", "E", "law", "empty"),
    "a_number": bad(element("law = 2"), "[element.E]", "E", "an equation", "not 2"),
    "none": bad(element(), "[element.E]", "E", "law is missing"),
    "of_an_unknown": bad(element('law = "y = g*x"'), "[element.E]", "E", 'no "g"'),
    "of_a_state_it_has_not": bad(element('law = "y = s"'), "[element.E]", "E", "s", "rate"),
    "of_nothing": bad(element('law = "y = y"'), "[element.E]", "E"),
    "of_numbers": bad(element('law = "1 = 2"'), "[element.E]", "E"),
    "not_readable": bad(element('law = "y = x +"'), "[element.E]", "E", "cannot read"),
    "a_division_by_zero": bad(element('law = "y = x/0"'), "[element.E]", "E", "division by zero"),
    "no_domain": bad(
        RC + part("element", "E", "a ground", 'law = "y = x"'), "[element.E]", "domain is missing"
    ),
    "a_misspelt_domain": bad(
        RC + part("element", "E", "a ground", 'domain = "electric"', 'law = "y = x"'),
        "[element.E]",
        *("E", '"electric"', 'did you mean "electrical"'),
    ),
    "a_spatial_domain": bad(
        RC + part("element", "E", "a ground", 'domain = "rotation"', 'law = "y = x"'),
        "[element.E]",
        *("E", '"rotation"'),
    ),
    "domains_of_a_transformer": bad(
        RC
        + two("transformer", "T", "a ground", "c ground", "ratio = 2", 'domains = ["electrical"]'),
        "[transformer.T]",
        *("T", "a list of two domains"),
    ),
    "units_without_power": bad(
        RC + changed(ACOUSTIC, "m^3/s", "m/s"), "[domain.acoustic]", "acoustic", "power"
    ),
    "units_with_power": bad(
        RC + changed(ACOUSTIC, "across =", "power = false\nacross ="),
        "[domain.acoustic]",
        *("acoustic", "leave power = false out"),
    ),
    "an_unknown_unit": bad(
        RC + changed(ACOUSTIC, "Pa", "bar"), "[domain.acoustic]", "acoustic", '"bar"', "Pa"
    ),
    "an_exponent_of_letters": bad(
        RC + changed(ACOUSTIC, "m^3/s", "m^x/s"), "[domain.acoustic]", "acoustic", '"m^x'
    ),
    "a_domain_twice": bad(
        RC + changed(ACOUSTIC, "acoustic", "electrical"), "[domain.electrical]", "taken"
    ),
    "no_letter": bad(
        RC + changed(ACOUSTIC, ', letter = "p"', ""),
        "[domain.acoustic]",
        *("across", "letter is missing"),
    ),
}

VALUES = {
    "resistance_is_a_list": bad(
        RC + resistor("R2", "a ground", [1]), "[resistor.R2]", "R2", "a number or an expression"
    ),
    "resistance_is_not_finite": bad(
        RC + part("resistor", "R2", "a ground", "resistance = nan"), "[resistor.R2]", "finite"
    ),
    "division_by_zero": bad(
        RC + resistor("R2", "a ground", "1/(2 - 2)"), "[resistor.R2]", "R2", "division by zero"
    ),
    "no_logarithm": bad(
        RC + resistor("R2", "a ground", "log(0)"), "[resistor.R2]", "R2", "not a finite number"
    ),
    "no_reluctance": bad(
        RC
        + two("winding", "W", "a ground", "m ground", "turns = 5")
        + part("reluctance", "path", "m ground", "reluctance = 0"),
        "[reluctance.path]",
        *("path", "division by zero"),
    ),
    "no_density": bad(
        part("tank", "basin", "a ground", "area = 1", "density = 0")
        + part("pipe", "drain", "a ground", "resistance = 1"),
        "[tank.basin]",
        *("basin", "division by zero"),
    ),
    "no_thermal_voltage": bad(
        RC + part("diode", "D", "a ground", "voltage = 0"),
        "[diode.D]",
        *("D", "division by zero"),
    ),
    "no_width": bad(
        part("mass", "m", "m ground", "mass = 1")
        + part("translational_friction", "rail", "m ground", "coulomb = 1", "width = 0"),
        "[translational_friction.rail]",
        *("rail", "division by zero"),
    ),
    "no_width_in_a_joint": bad(
        RC + SLIDE + '[friction.rail]\njoint = "slide"\ncoulomb = 1\nwidth = 0\n',
        "[friction.rail]",
        *("rail", "division by zero"),
    ),
    "no_lead": bad(
        part("mass", "m", "m ground", "mass = 1")
        + two("screw", "spindle", "s ground", "m ground", "lead = 0"),
        "[screw.spindle]",
        "spindle",
    ),
    "no_radii": bad(
        part("inertia", "J", "m ground", "inertia = 1")
        + two("belt", "belt", "m ground", "s ground", "radius1 = 0", "radius2 = 0"),
        "[belt.belt]",
        "belt",
    ),
    "no_state": bad(
        voltage("V1", "a ground") + resistor("R1", "a ground"), "", "no state", "stores energy"
    ),
    "no_capacitance": bad(
        resistor("R1", "a ground") + capacitor("C1", "a ground", 0), "[capacitor.C1]", "C1"
    ),
    "rates_of_rates": bad(
        INPUT
        + voltage("V1", "a ground", "u")
        + capacitor("C1", "a ground")
        + current("I1", "ground b", "through(C1)")
        + inductor("L1", "b ground")
        + voltage("V2", "c ground", "across(L1)")
        + capacitor("C2", "c ground")
        + HEAT
        + part("heat_source", "H", "ground warm", 'heat = "through(C2)"'),
        ("[capacitor.C1]", "[inductor.L1]", "[capacitor.C2]"),
        *("C1", "third derivative of input u"),
    ),
}

CASES = {
    f"{group}-{name}": case
    for group, cases in {
        "sources": SOURCES,
        "references": REFERENCES,
        "edges": EDGES,
        "mechanics": MECHANICS,
        "names": NAMES,
        "shapes": SHAPES,
        "laws": LAWS,
        "values": VALUES,
    }.items()
    for name, case in cases.items()
}


def whole(text: str) -> Derivation:
    """All that a command does with a file, forward dynamics among it."""
    model = parse(text.encode(), "m.toml")
    derivation = derive(model)
    derivation.require_inverse("forward_dynamics")
    render(model)
    return derivation


def lines_of(text: str, tables: tuple[str, ...]) -> set[int]:
    """The lines of some tables, their keys included."""
    found, inside = set(), False
    for number, line in enumerate(text.split("\n"), start=1):
        if line.startswith("["):
            inside = line in tables
        if inside:
            found.add(number)
    assert found, tables
    return found


@pytest.mark.parametrize("name", CASES)
def test_says_where_and_what(name: str) -> None:
    case = CASES[name]
    with pytest.raises(LinegraphError) as caught:
        whole(case.text)
    assert isinstance(caught.value, (SourceError, SourceErrors))
    message = str(caught.value)
    assert len(message) < 700
    for line in message.split("\n"):
        place = re.match(r"m\.toml(?::(\d+))?: (.*)", line)
        assert place, message
        assert line.isprintable(), message
        for word in ("Traceback", "Fraction(", "invalid literal", "Node", "None"):
            assert word not in line, message
        if case.tables == ("",):
            continue
        assert place[1], message
        if any(part in place[2] for part in case.says):
            assert int(place[1]) in lines_of(case.text, case.tables), message
    for part_ in case.says:
        assert part_ in message, message


def test_what_the_cases_change_is_sound() -> None:
    for text in (RC, HINGES, SLIDE, FREE, RC + TRANSFORMER, RC + ACOUSTIC, SLIDE + MOUNT + RC):
        whole(text)


# ---- what can be, and what is worth a remark

REMARKS = {
    "loose_end": (
        RC + resistor("R2", "a free"),
        (),
        ("R2", '"free"', "nothing flows"),
    ),
    "loose_shaft": (
        RC + part("dc_motor", "M", "a ground", 'shaft = ["s", "ground"]', *MOTOR),
        (),
        ("M.mechanical", '"s"'),
    ),
    "capacitor_on_a_source": (
        INPUT
        + voltage("V1", "a ground", "u")
        + capacitor("C1", "a ground")
        + resistor("R1", "a b")
        + capacitor("C2", "b ground"),
        ("C1",),
        ("C1", "no state", "V1"),
    ),
    "loop_of_capacitors": (
        RC + capacitor("C2", "a b") + capacitor("C3", "b ground") + resistor("R2", "b ground"),
        ("C2",),
        ("C2", "no state", "C1, C3"),
    ),
    "cutset_of_inductors": (
        RC + inductor("L1", "a b") + inductor("L2", "b ground"),
        ("L1",),
        ("L1", "no state", "L2"),
    ),
    "two_inertias_on_a_gear": (
        part("inertia", "J1", "m ground", "inertia = 1")
        + part("inertia", "J2", "l ground", "inertia = 2")
        + two("gear", "box", "m ground", "l ground", "ratio = 3"),
        ("J2",),
        ("J2", "no state", "J1", "box"),
    ),
    "algebraic_loop": (
        capacitor("C1", "a ground") + resistor("R1", "a b") + part("diode", "D", "b ground"),
        (),
        ("algebraic loop", "D"),
    ),
}


@pytest.mark.parametrize("name", REMARKS)
def test_remarks(name: str, tmp_path: Path) -> None:
    """In the derivation, in what is shown, and of dependent stores on what they depend."""
    text, dependent, says = REMARKS[name]
    network = whole(text).formulation.network
    assert network is not None
    assert tuple(network.dependent) == dependent
    (remark,) = (r for r in network.remarks if all(word in r for word in says))
    path = tmp_path / "m.toml"
    path.write_text(text)
    shown = CliRunner().invoke(main, ["show", str(path)])
    assert shown.exit_code == 0
    assert remark in shown.output


def test_nothing_to_remark() -> None:
    network = whole(RC).formulation.network
    assert network is not None
    assert network.remarks == ()


def test_the_derivative_of_an_input_becomes_an_input() -> None:
    text, _, _ = REMARKS["capacitor_on_a_source"]
    derivation = whole(text)
    network = derivation.formulation.network
    assert network is not None
    assert network.rates == {"u": 1}
    inputs = derivation.structure.inputs
    assert [q.name for q in inputs] == ["u", "u_rate"]
    assert any("u_rate" in remark for remark in network.remarks)
    files = render(derivation.system)
    assert '"u_rate",' in files["m.py"]


def test_domains_have_vertices_of_their_own() -> None:
    text = (
        RC
        + part("inertia", "J", "a ground", "inertia = 1")
        + part("rotational_damper", "d", "a ground", "damping = 1")
        + part("dc_motor", "M", "a ground", 'shaft = ["a", "ground"]', *MOTOR)
    )
    network = whole(text).formulation.network
    assert network is not None
    assert [state.quantity.name for state in network.states] == ["v_C1", "w_J"]


@pytest.mark.parametrize(
    "text",
    [
        INPUT + resistor("R1", "a ground", "u") + capacitor("C1", "a ground"),
        INPUT + resistor("R1", "a ground") + capacitor("C1", "a ground", "u"),
        INPUT + resistor("R1", "a ground") + capacitor("C1", "a ground", "1/u"),
        INPUT + RC + part("conductance", "G", "a ground", 'conductance = "1/u"'),
        INPUT + RC + current("I1", "ground a", "1/u"),
        INPUT + RC + current("I1", "ground a", "log(u)"),
        INPUT + RC + current("I1", "ground a", "u**-2"),
        INPUT
        + part("mass", "m", "m ground", "mass = 1")
        + part("translational_spring", "k", "m ground", 'stiffness = "u"'),
        INPUT
        + part("inertia", "J", "m ground", "inertia = 1")
        + two("gear", "box", "m ground", "l ground", 'ratio = "u"')
        + part("rotational_damper", "d", "l ground", "damping = 1"),
        INPUT + RC + part("element", "E", "a ground", 'domain = "electrical"', 'law = "x = u*y"'),
    ],
    ids=[
        *("resistance", "capacitance", "elastance", "conductance", "current", "logarithm", "power"),
        *("stiffness", "ratio", "law"),
    ],
)
def test_inputs_may_be_what_is_divided_by(text: str, tmp_path: Path) -> None:
    """Nothing of a network is ever evaluated at u = 0 but where u is 0."""
    derivation = whole(f'name = "m"\n{text}')
    module = load(render(derivation.system), "m", tmp_path)
    u = [2.0] + [0.0] * (module.NU - 1)
    v = [0.7] * module.NV
    assert np.isfinite(module.forward_dynamics([], v, u)).all()
    expected = derivation.numeric(u=u)
    assert np.isfinite(expected.bias([], v)).all()


@pytest.mark.parametrize("damping", [2, 0.6, "R"])
@pytest.mark.parametrize("ratio", [3, -1.7, "n", "1 + n*t"])
def test_two_inertias_on_a_gear(ratio: Any, damping: Any, tmp_path: Path) -> None:
    """``(J1 + J2/n^2) w' = -(b + b/n^2) w`` of the first; the ratio may be any expression."""
    text = "[parameters]\nR = 2.0\nn = 3.0\n"
    for inertia, vertex in ((1.3, "m"), (0.9, "l")):
        text += part("inertia", f"J{vertex}", f"{vertex} ground", f"inertia = {inertia}")
        damper = f"damping = {given(damping)}"
        text += part("rotational_damper", f"d{vertex}", f"{vertex} ground", damper)
    text += two("gear", "box", "m ground", "l ground", f"ratio = {given(ratio)}")
    emitted = Emitted(text, tmp_path)
    assert emitted.module.V_NAMES == ("w_Jm",)
    n = {"n": 3, "1 + n*t": 1}.get(ratio, ratio)
    changing = 3 * (ratio == "1 + n*t")
    b = 2 if damping == "R" else damping
    w = 0.7
    # J2 d/dt (w/n) reaches the first shaft as a torque over n
    expected = -(b + b / n**2 - 0.9 * changing / n**3) * w / (1.3 + 0.9 / n**2)
    found = emitted.in_python("forward_dynamics", [w], R=2.0, n=3.0)
    assert found[0] == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("value", [-1, "-2*R"])
def test_negative_values_are_the_users_own_affair(value: Any) -> None:
    """There are negative resistances and stiffnesses; whether they make sense is not judged."""
    whole("[parameters]\nR = 3.0\n" + RC + resistor("R2", "a ground", value))


def test_names_of_states_are_free_for_parameters() -> None:
    """Parameters are arguments, states are not: no confusion is possible."""
    text = "[parameters]\nv_C1 = 4.0\n" + resistor("R1", "a ground", "v_C1")
    whole(text + capacitor("C1", "a ground"))


@pytest.mark.parametrize("name", ["my load", "手", "t", "u", "hinge_1", "2"])
def test_what_loses_power_may_have_any_name(name: str) -> None:
    """A name is no expression: none is read from it, and no function gets the time for it."""
    text = INPUT + resistor(f'"{name}"', "a ground") + capacitor("C1", "a ground") + HEAT
    derivation = whole(text + part("losses", "heat", "ground warm", f'of = ["{name}"]'))
    assert not derivation.system.depends_on_time


@pytest.mark.parametrize("later", ["joint", "element", "constraint", "component"])
def test_the_builder_gives_no_name_twice(later: str) -> None:
    model = Model("m")
    body = model.body("b", mass=1)
    model.resistor("R1", ("a", "ground"), resistance=1)
    words: dict[str, tuple[Any, dict[str, Any]]] = {
        "joint": (model.revolute, {"between": ("ground", body), "axis": (0, 1, 0)}),
        "element": (model.spring, {"between": ("ground", body), "stiffness": 1}),
        "constraint": (model.rod, {"between": ("ground", body), "length": 1}),
        "component": (model.capacitor, {"between": ("a", "ground"), "capacitance": 1}),
    }
    add, keys = words[later]
    with pytest.raises(ModelError, match="taken"):
        add("R1", **keys)


@pytest.mark.parametrize(
    ("word", "keys"),
    [
        ("resistor", {"resistance": math.nan}),
        ("resistor", {"resistance": math.inf}),
        ("capacitor", {"capacitance": 1, "charge": "x"}),
        ("capacitor", {}),
        ("element", {"law": "2*x"}),
        ("coupled_inductors", {"windings": (("a", "ground"),), "inductance": ((1,),)}),
        ("store", {"keeps": "voltage", "constant": 1}),
        ("losses", {"of": ()}),
    ],
)
def test_the_builder_names_the_component(word: str, keys: dict[str, Any]) -> None:
    ends = {} if "windings" in keys else {"between": ("a", "ground")}
    with pytest.raises(ModelError, match=f'^{word} "it": '):
        getattr(Model("m"), word)("it", **ends, **keys)


# ---- at run time


class Emitted:
    """A model in C and in Python."""

    def __init__(self, text: str, folder: Path) -> None:
        """Write both, compile and import them."""
        self.model = parse(f'name = "m"\n{text}'.encode(), "m.toml")
        files = render(self.model)
        self.module, self.c = load(files, "m", folder), Compiled(files, "m", folder)

    def arguments(self, function: str, v: list[float], p: dict[str, float]) -> list[Any]:
        u = np.zeros(max(1, self.module.NU))
        values = {"q": [0.0], "v": v, "x": v, "u": u, "t": 0.0, "a": [0.0] * len(v)}
        values["p"] = list(p.values())
        return [
            values[name] for name in inspect.signature(getattr(self.module, function)).parameters
        ]

    def in_c(self, function: str, size: int, v: list[float], **p: float) -> Any:
        return self.c.call(function, *self.arguments(function, v, p), out=[(size,)])

    def in_python(self, function: str, v: list[float], **p: float) -> Any:
        given_ = self.arguments(function, v, p)
        if p:
            given_[0] = self.module.Parameters(**p)
        given_ = [x[: self.module.NU] if isinstance(x, np.ndarray) else x for x in given_]
        names = list(inspect.signature(getattr(self.module, function)).parameters)
        given_ = [[] if n == "q" else x for n, x in zip(names, given_, strict=True)]
        return getattr(self.module, function)(*given_)


def squared(law: str, value: float = 2) -> str:
    """A capacitor, a resistance and an element in series: its current solves an equation."""
    text = capacitor("C1", "a ground") + resistor("R1", "a b", value)
    return text + part("element", "E", "b ground", 'domain = "electrical"', f'law = "{law}"')


FUNCTIONS = (("forward_dynamics", 1), ("rhs", 1), ("across", 3), ("reactions", 3), ("bias", 1))


@pytest.mark.parametrize(("function", "size"), FUNCTIONS)
def test_a_loop_without_solution_is_reported(function: str, size: int, tmp_path: Path) -> None:
    """``v = 2 y + y^2 + 2`` has solutions from v = 1 on."""
    emitted = Emitted(squared("x = y**2 + 2"), tmp_path)
    for v in (0.0, 0.9, -1e6, math.nan):
        status, message = (902, "not a number") if math.isnan(v) else (900, "algebraic loop")
        with pytest.raises(Failed) as caught:
            emitted.in_c(function, size, [v])
        assert caught.value.status == status
        with pytest.raises(np.linalg.LinAlgError, match=message):
            emitted.in_python(function, [v])
    for v in (1.1, 10.0, 1e6):
        assert np.isfinite(emitted.in_c(function, size, [v])).all()


LOOPS: dict[str, tuple[str, Any]] = {
    "square": ("x = y**2 + 2", lambda v, y: v - 2 * y - y**2 - 2),
    "steep": ("x = 3*abs(y) + 1", lambda v, y: v - 2 * y - 3 * abs(y) - 1),
    "growing": ("x = exp(y) + 3*y**2", lambda v, y: v - 2 * y - math.exp(y) - 3 * y**2),
    "cubic": ("x = y**3 - 6*y", lambda v, y: v - 2 * y - y**3 + 6 * y),
    "waves": ("x = 3 + y*sin(y)", lambda v, y: v - 2 * y - 3 - y * math.sin(y)),
    "diode": (
        "y = 1e-12*(exp(x/0.025) - 1)",
        lambda v, y: y - 1e-12 * (math.exp((v - 2 * y) / 0.025) - 1),
    ),
}


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", LOOPS)
def test_what_a_loop_gives_solves_it(name: str, tmp_path: Path) -> None:
    """Newton's method says so where it has stopped elsewhere: never a number that is no solution."""
    law, residual = LOOPS[name]
    emitted = Emitted(squared(law), tmp_path)
    numeric = derive(emitted.model).numeric()
    found = 0
    for k, v in enumerate(np.linspace(-20, 20, 161).tolist()):
        # Python is slow, and does the same as C
        for way in ("in_c", "in_python", "numeric") if k % 8 == 0 else ("in_c",):
            try:
                if way == "numeric":
                    y = numeric.bias([], [v])[0]
                elif way == "in_c":
                    y = -3 * emitted.in_c("forward_dynamics", 1, [v])[0]
                else:
                    y = -3 * emitted.in_python("forward_dynamics", [v])[0]
            except (Failed, np.linalg.LinAlgError, ModelError):
                continue
            assert abs(residual(v, y)) <= 1e-9 * (1 + abs(v)), (way, v, y)
            found += 1
    assert found >= 60


ROUGH: dict[str, Any] = {
    "x = max(y, -y/2) + 1": lambda y: max(y, -y / 2) + 1,
    "x = abs(y) + 1": lambda y: abs(y) + 1,
    "x = sqrt(y + 1)": lambda y: math.sqrt(y + 1),
}


@pytest.mark.parametrize("law", ROUGH)
def test_a_loop_that_has_a_solution_finds_it(law: str, tmp_path: Path) -> None:
    """Also where the law is not smooth at zero, from which the search begins."""
    emitted = Emitted(squared(law), tmp_path)
    for v in (2.0, 7.0, 100.0):
        y = -3 * emitted.in_c("forward_dynamics", 1, [v])[0]
        assert ROUGH[law](y) == pytest.approx(v - 2 * y, abs=1e-11)


ZEROS = {
    "capacitance": ("C", resistor("R1", "a ground") + capacitor("C1", "a ground", "C")),
    "one_of_two_capacitances": (
        "C",
        RC + resistor("R2", "a b") + capacitor("C2", "b ground", "C"),
    ),
    "resistance": ("R", resistor("R1", "a ground", "R") + capacitor("C1", "a ground")),
    "inductance": ("L", RC + inductor("L1", "a ground", "L")),
    "mass": (
        "m",
        part("mass", "m", "m ground", 'mass = "m"')
        + part("translational_damper", "d", "m ground", "damping = 1"),
    ),
    "ratio": (
        "n",
        part("inertia", "J", "m ground", "inertia = 1")
        + two("gear", "box", "m ground", "l ground", 'ratio = "n"')
        + part("rotational_damper", "d", "l ground", "damping = 1"),
    ),
}


@pytest.mark.parametrize("name", ZEROS)
def test_zero_at_run_time_is_reported(name: str, tmp_path: Path) -> None:
    """A status that is not zero, an exception: never NaN alone."""
    parameter, text = ZEROS[name]
    emitted = Emitted(f"[parameters]\n{parameter} = 1.0\n{text}", tmp_path)
    size = emitted.module.NV
    for v in ([0.0] * size, [1.0] * size):
        assert np.isfinite(emitted.in_c("forward_dynamics", size, v, **{parameter: 1.0})).all()
        for value in (0.0, math.nan):
            with pytest.raises(Failed) as caught:
                emitted.in_c("forward_dynamics", size, v, **{parameter: value})
            assert caught.value.status > 0
            with pytest.raises((np.linalg.LinAlgError, ZeroDivisionError)):
                emitted.in_python("forward_dynamics", v, **{parameter: value})
