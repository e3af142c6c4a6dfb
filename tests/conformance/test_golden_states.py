"""Where golden vectors ask: what a state hides that is legal, locked or loud is seen at others."""

from __future__ import annotations

import contextlib
import random
import re
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from conformance.test_golden import build, found, read, run
from support.emitted import load

import linegraph as lg
from linegraph.emission.emit import module_for, render
from linegraph.readers import modelfile
from linegraph.verification import checking, golden
from linegraph.verification.golden.draws import Drawing
from linegraph.verification.golden.point import Kept

if TYPE_CHECKING:
    from pathlib import Path


def drawing(model: lg.Model) -> Drawing:
    return Drawing(
        lg.derive(model), random.Random(0), Kept(), [{"M": lambda p: p.bodies.mass_matrix}]
    )


def test_bodies_are_asked_beside_the_constraints() -> None:
    """Two cranks of a parallelogram stand alike on its constraints, and not where M is asked."""
    vectors = found("parallelograms")
    given = {x.function: x.given for x in vectors.expected}
    assert given["mass_matrix"] == ("q_off",)
    assert given["constraint_jacobian"] == ("q",)
    legal, beside = (np.array(vectors.given[key]) for key in ("q", "q_off"))
    alike = [
        (i, j)
        for i in range(legal.shape[1])
        for j in range(i)
        if np.abs(np.sin(legal[:, i] - legal[:, j])).max() < 1e-12
    ]
    assert alike
    assert all(np.abs(np.sin(beside[:, i] - beside[:, j])).min() > 1e-9 for i, j in alike)


def test_masses_vary_though_constraints_are_redundant() -> None:
    """Lengths that must fit keep their values; masses and lengths that need not are others."""
    some = drawing(read("four_bar"))
    assert some.derivation.assembled.redundant == 3
    assert some._fixed == frozenset()
    cranks = drawing(read("parallelograms"))
    assert cranks.derivation.assembled.redundant > 0
    values = {name for point in cranks.points() for name in point.p}
    assert values


ZERO = """
[parameters]
m = { value = 2, unit = "kg" }
x = { value = 0, unit = "m" }
l = { value = 0.5, unit = "m" }
[body.bob]
mass = "m"
mass_center = ["x", 0, "-l"]
[revolute.hinge]
between = ["ground", "bob"]
axis = [0, 1, 0]
"""


def test_parameters_that_are_zero_vary() -> None:
    """Else no wrong factor of theirs would be seen: little beside others of their unit."""
    model = modelfile.parse(ZERO.encode(), "m.toml")
    values = [point.p.get("x", 0.0) for point in drawing(model).points()]
    assert {0.04 <= x <= 0.0625 for x in values if x} == {True}
    assert sum(x != 0 for x in values) == 5


def test_locked_velocities_are_zero() -> None:
    """What rounding leaves of them would be its own scale."""
    for point in drawing(read("bricard")).points():
        v = np.abs(point.v)
        assert not ((v > 0) & (v < 1e-13 * v.max())).any()


def test_exponential_laws_hide_nothing() -> None:
    """Diodes at two volts of a source carry 1e11 A; beside that no capacitor's milliamperes are seen."""
    model = read("ring_modulator")
    vectors = golden.vectors(lg.derive(model), module_for(model, "m", only=("bias",)))
    # two volts of ten kilohertz have a phase of 1e5 at most, and rounding of that is what is left
    assert max(vectors.values["h"].scale) < 1e5
    assert min(vectors.values["h"].scale) > 1e-3


@pytest.mark.parametrize("sign", ["-", "+"])
def test_a_current_beside_diodes_is_seen(sign: str, tmp_path: Path) -> None:
    """The sign of a capacitor's current beside two diodes."""
    files = render(read("ring_modulator"), name="m", only=("bias",), tests=True, languages=["c"])
    files["m.c"], count = re.subn(r"(h\[6\] = .*)- v\[5\]", rf"\1{sign} v[5]", files["m.c"])
    assert count == 2  # from parameters, and from the constants of prepare
    status, _ = run(build(files, "m", tmp_path))
    assert status == (sign == "+")


def test_kinetic_energy_is_judged_by_its_own_parts() -> None:
    """Not by what springs and weights hold beside it."""
    vectors = found("condenser_microphone")
    kinetic, *others = vectors.values["E"].scale
    assert kinetic == pytest.approx(max(row[0] for row in vectors.values["E"].rows), rel=1e-2)
    assert kinetic < 1e-3 * max(others)


CLIPPER = """
[inputs]
u = { unit = "V" }
[voltage_source.source]
between = ["in", "ground"]
voltage = "u"
[resistor.R1]
between = ["in", "a"]
resistance = 1e3
[diode.D1]
between = ["a", "out"]
[capacitor.C1]
between = ["out", "ground"]
capacitance = 1e-6
"""
"""A diode that conducts milliamperes at a volt, and no more than its 1e-14 A at most states near zero."""


@pytest.mark.parametrize("current", ["1e-14", "1.00001e-14"])
def test_a_diode_conducts_at_some_state(current: str, tmp_path: Path) -> None:
    """Its saturation current, off by a part of 1e-5, is nothing beside the terms of states near zero."""
    files = render(
        modelfile.parse(CLIPPER.encode(), "m.toml"),
        name="m",
        only=("forward_dynamics",),
        tests=True,
    )
    right = current == "1e-14"
    for code, law in (
        ("m.c", r"1e-14( \* \(t\d+ - 1.0\)\);)"),
        ("m.py", r"1e-14( \* \(t\d+ - 1.0\),)"),
    ):
        files[code], count = re.subn(law, current + r"\1", files[code])
        assert count == 1
    status, _ = run(build(files, "m", tmp_path))
    assert status == (not right)
    load({"m.py": files["m.py"]}, "m", tmp_path)
    checks = load({"test_m.py": files["test_m.py"]}, "test_m", tmp_path)
    for at in (slice(None), checks.SCALES.index(1)):
        with (
            contextlib.nullcontext() if right else pytest.raises(AssertionError, match="is off by")
        ):
            checks.compare("forward_dynamics", at)
    checks.compare("forward_dynamics", 0)


def test_derivatives_of_a_diode_that_hardly_conducts_hold(tmp_path: Path) -> None:
    """1e-12 A/V are left where the conductance of the resistor and its loss in the loop cancel."""
    model = modelfile.parse(CLIPPER.encode(), "m.toml")
    wanted = ("linearize", "forward_dynamics_derivatives", "inverse_dynamics_derivatives")
    status, lines = run(build(render(model, name="m", only=wanted, tests=True), "m", tmp_path))
    assert status == 0, lines
    assert len(lines) == 4


def test_loud_states_have_a_scale_of_their_own() -> None:
    """Never less than that of the others, which is what it is without them."""
    model = modelfile.parse(CLIPPER.encode(), "m.toml")
    vectors = golden.vectors(lg.derive(model), module_for(model, "m", only=("bias",)))
    values = vectors.values["h"]
    assert vectors.states == len(values.rows) == 10 + vectors.loud
    assert len(values.loud) == vectors.loud > 0
    calm, loud = np.abs(values.rows[:10]).max(), np.abs(values.rows[10:]).max()
    assert loud > 1e-5 > 1e6 * calm
    assert all(x >= y for row in values.loud for x, y in zip(row, values.scale, strict=True))
    assert found("double_pendulum").loud == 0


def test_check_sees_the_current_of_a_diode(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same error in the emitted program, at the states that `check` draws."""
    derivation = lg.derive(modelfile.parse(CLIPPER.encode(), "m.toml"))
    assert checking.check(derivation).good
    right = checking._State.emitted

    def off(state: Any, module: Any) -> Any:
        M, h = right(state, module)
        return M, [x * (1 + 1e-9) for x in h]

    monkeypatch.setattr(checking._State, "emitted", off)
    assert [c.what for c in checking.check(derivation).bad] == ["h"]


def test_the_relief_valve_of_the_excavator_opens_at_some_state() -> None:
    """Bounds in the model file lead its supply line above the pressure of the valve, and below."""
    vectors = found("excavator_arm")
    model = read("excavator_arm")
    names = [x.name for x in lg.derive(model).structure.velocities]
    line = [row[names.index("p_line")] for row in vectors.given["v"]]
    assert 1 <= sum(p > 34e6 for p in line) < len(line)


MISALIGNED = """
[frame.low]
at = [0.3, 0, 0]
[frame.high]
at = [0.3, 0, 1]
[frame.mid]
at = [0.3, 0, 0.7]
[body.door]
mass = 10
mass_center = [0.5, 0, 0.5]
inertia = [1, 2, 1]
frame.low = { at = [0.30000000003, 0, 0] }
frame.high = { at = [0.3, 0, 1] }
frame.mid = { at = [0.30000000000000004, 1e-13, 0.7] }
[revolute.low]
between = ["ground.low", "door.low"]
axis = [0, 0, 1]
[cylindrical.high]
between = ["ground.high", "door.high"]
axis = [0, 0, 1]
effort = false
[spherical.mid]
between = ["ground.mid", "door.mid"]
effort = false
"""
"""A door on a hinge, a bolt and a ball, which miss each other by less than what closes a loop."""

FLAT = """
[body.a]
mass = 1
mass_center = [0.5, 0, 0]
inertia = [0.1, 0.1, 0.1]
frame.end = { at = [1, 0, 0] }
[body.b]
mass = 1
mass_center = [0.5, 0, 0]
inertia = [0.1, 0.1, 0.1]
frame.end = { at = [1, 0, 0] }
[body.coupler]
mass = 1
mass_center = [1, 0, 0]
inertia = [0.1, 0.1, 0.1]
frame.end = { at = [2, 0, 0] }
[frame.far]
at = [2, 0, 0]
[revolute.j1]
between = ["ground", "a"]
axis = [0, -1, 0]
[revolute.j2]
between = ["a.end", "coupler"]
axis = [0, -1, 0]
effort = false
[revolute.j3]
between = ["ground.far", "b"]
axis = [0, -1, 0]
effort = false
[revolute.j4]
between = ["b.end", "coupler.end"]
axis = [0, -1, 0]
effort = false
"""
"""A parallelogram whose joints are all at zero where it lies flat: more motions are free there."""


TILTED = MISALIGNED.replace("axis = [0, 0, 1]\neffort", "axis = [9e-10, 0, 1]\neffort")
LOCKED = MISALIGNED.replace("axis = [0, 0, 1]\neffort", "axis = [1e-5, 0, 1]\neffort")
LOOPS = {"misaligned": MISALIGNED, "tilted": TILTED, "locked": LOCKED, "flat": FLAT}


@pytest.mark.parametrize("text", LOOPS.values(), ids=LOOPS)
def test_loops_that_miss_a_little_or_lie_flat_hold(text: str, tmp_path: Path) -> None:
    """What is left of lengths that cancel is judged beside these; flat positions are not asked."""
    model = modelfile.parse(text.encode(), "m.toml")
    files = render(model, name="m", tests=True, languages=["c"])
    status, lines = run(build(files, "m", tmp_path))
    assert status == 0, "\n".join(lines)
    assert checking.check(lg.derive(model)).good


STEEP = """
[body.b]
mass = 1
inertia = [1, 1, 1]
[prismatic.p]
between = ["ground", "b"]
axis = [1, 0, 0]
[law.steep]
joint = "p"
force = "{law}"
"""


@pytest.mark.parametrize(
    "law", ["-sqrt(abs(x))", "-sign(v)*sqrt(abs(v))", "-asin(min(1, 1 + x))", "-abs(x)**1.5"]
)
def test_derivatives_hold_though_they_are_infinite_at_rest(law: str, tmp_path: Path) -> None:
    """There the emitted code reports it; golden vectors ask elsewhere, and at rest where it is finite."""
    model = modelfile.parse(STEEP.format(law=law).encode(), "m.toml")
    files = render(model, name="m", only=("linearize",), tests=True, languages=["c"])
    status, lines = run(build(files, "m", tmp_path))
    assert status == 0, "\n".join(lines)
    derivation = lg.derive(model)
    vectors = golden.vectors(derivation, module_for(model, "m", only=("linearize",)))
    at_rest = (0.0,) in vectors.given["q"] and (0.0,) in vectors.given["v"]
    assert at_rest == ("1.5" in law)
