"""Algebraic loops with one solution are solved: saturations, dead zones, diodes, limits, kinks of sources.

The networks are drawn around a solution (`monotone_networks`), so that nothing here repeats the derivation.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.compiled import Compiled, Failed
from support.emitted import load
from systems.monotone_networks import Drawn, draw

from linegraph import Model, ModelError, derive
from linegraph.emission.emit import render
from linegraph.ir.statuses import NO_LOOP_SOLUTION
from linegraph.readers.modelfile import parse

if TYPE_CHECKING:
    from pathlib import Path

SEEDS = 3000
CHUNK = 20
CLOSE = 1e-6


def sizes(drawn: Drawn) -> np.typing.NDArray[np.float64]:
    """What each output is compared with: the largest across and through variable."""
    x = max(abs(edge.x) for edge in drawn.edges)
    y = max(abs(edge.y) for edge in drawn.edges)
    return np.array([x, y] * len(drawn.edges))


@pytest.mark.seeds(range(0, SEEDS, SEEDS // 2), range(0, SEEDS, CHUNK))
def test_the_chosen_solution_is_found_in_c_and_in_python(seed: int, tmp_path: Path) -> None:
    for number in range(seed, seed + CHUNK):
        drawn = draw(number)
        model = drawn.model()
        # what is no part of the network keeps it company, so that there is a state
        model.capacitor("clock", ("alone", "ground"), capacitance=1.0)
        model.resistor("spring", ("alone", "ground"), resistance=1.0)
        files = render(model, name=f"m{number}", only=["outputs"])
        c = Compiled(files, f"m{number}", tmp_path / str(number), flags=("-O0",))
        python = load(files, f"m{number}", tmp_path / str(number))
        v = [drawn.state.get(state, 0.0) for state in python.V_NAMES]
        given = [[], v, drawn.inputs] if "u" in python.outputs.__code__.co_varnames else [[], v]
        expected = np.array(drawn.expected())
        for found in (python.outputs(*given), c.call("outputs", *given, out=[expected.shape])):
            error = np.abs(np.asarray(found) - expected) / sizes(drawn)
            assert np.max(error) <= CLOSE, number


INTEGRATOR = """\
name = "integrator"
[inputs]
u = { unit = "V" }
[voltage_source.source]
between = ["in", "ground"]
voltage = "u"
[resistor.r]
between = ["in", "n"]
resistance = 1000
[capacitor.c]
between = ["out", "n"]
capacitance = 1e-4
[conductance.sense]
between = ["ground", "n"]
conductance = 0
[voltage_source.amplifier]
between = ["out", "ground"]
voltage = "min(15, max(-15, 15000*across(sense)))"
[resistor.load]
between = ["out", "in"]
resistance = 2500
[outputs]
out = "across(amplifier)"
"""


def test_a_limited_amplifier_is_solved_in_every_state(tmp_path: Path) -> None:
    """With v_c given, ``out = clip(-15000 n)`` and ``out = n + v_c`` have one solution."""
    files = render(parse(INTEGRATOR.encode(), "m.toml"), name="m")
    c, python = Compiled(files, "m", tmp_path), load(files, "m", tmp_path)
    for k, u in enumerate(np.linspace(-15, 15, 61)):
        for v in np.linspace(-20, 20, 161):
            expected = np.clip(15000 * v / 15001, -15, 15)
            assert abs(c.call("outputs", [], [v], [u], out=[(1,)])[0] - expected) < 1e-9
            if k % 20 == 0:
                assert abs(python.outputs([], [v], [u])[0] - expected) < 1e-9


AMPLIFIER = """\
name = "amp"
[voltage_source.source]
between = ["in", "ground"]
voltage = "{}"
[resistor.r1]
between = ["in", "n"]
resistance = 1000
[resistor.r2]
between = ["out", "n"]
resistance = 2000
[voltage_source.amplifier]
between = ["out", "ground"]
voltage = "min(15, max(-15, -1000*across(sense)))"
[conductance.sense]
between = ["n", "ground"]
conductance = 0
[resistor.load]
between = ["out", "c"]
resistance = 1
[capacitor.C]
between = ["c", "ground"]
capacitance = 1e-3
[outputs]
out = "across(amplifier)"
"""


@pytest.mark.parametrize(
    ("source", "time"), [("10/pi*asin(cos(2*pi*t))", 0.0), ("5*sqrt(cos(t))**2", 0.0), ("5", None)]
)
def test_a_source_with_an_infinite_rate_is_no_yardstick(
    source: str, time: float | None, tmp_path: Path
) -> None:
    """5 V, amplified by -2: ``-1000*10/3 / (1 + 1000/3)``; the triangle's rate is infinite at its peak."""
    files = render(parse(AMPLIFIER.format(source).encode(), "m.toml"), name="m")
    c, python = Compiled(files, "m", tmp_path), load(files, "m", tmp_path)
    given = ([], [0.0]) if time is None else (time, [], [0.0])
    for found in (c.call("outputs", *given, out=[(1,)]), python.outputs(*given)):
        assert found[0] == pytest.approx(-1000 * 10 / 3 / (1 + 1000 / 3), rel=1e-12)


LOADED = """\
name = "m"
[inputs]
i = {{ unit = "A" }}
[current_source.s]
between = ["ground", "a"]
current = "i"
[element.E]
between = ["a", "ground"]
domain = "electrical"
law = "y = {}"
[capacitor.C]
between = ["b", "ground"]
capacitance = 1
[resistor.R]
between = ["b", "ground"]
resistance = 1
[outputs]
x = "across(E)"
"""


@pytest.mark.parametrize(
    ("law", "current", "expected"),
    [
        ("min(1, max(-1, x))", 0.5, 0.5),
        ("min(1, max(-1, x))", 2.0, None),  # none
        ("max(0, x - 3) + min(0, x + 3)", 1e-3, 3.001),
        ("max(0, x - 3) + min(0, x + 3)", 0.0, None),  # all x within 3
        ("x*abs(x)", 0.0, 0.0),
        ("x**3", 8.0, 2.0),
        ("tanh(x)", 0.999, math.atanh(0.999)),
        ("tanh(x)", 1.5, None),
        ("1e-12*(exp(x/0.025) - 1)", 10.0, 0.025 * math.log(1e13)),
        ("1e-12*(exp(x/0.025) - 1)", -1e-3, None),
    ],
)
def test_a_loop_with_one_solution_is_solved_and_others_are_reported(
    law: str, current: float, expected: float | None, tmp_path: Path
) -> None:
    files = render(parse(LOADED.format(law).encode(), "m.toml"), name="m")
    c, python = Compiled(files, "m", tmp_path), load(files, "m", tmp_path)
    given = ([], [0.0], [current])
    if expected is None:
        with pytest.raises(Failed) as failed:
            c.call("outputs", *given, out=[(1,)])
        assert failed.value.status == NO_LOOP_SOLUTION.number
        with pytest.raises(np.linalg.LinAlgError):
            python.outputs(*given)
        return
    for found in (c.call("outputs", *given, out=[(1,)]), python.outputs(*given)):
        assert found[0] == pytest.approx(expected, rel=1e-9, abs=1e-12)


def test_what_a_dependent_store_keeps_does_not_depend_on_rates() -> None:
    """C4 follows from C7: ``v2 = k v1`` with k = -a/R1. By hand ``(C4 (k - 1) - C7) v1' = v1 (1/R1 + 1/R5)``.

    All edges around C4 depend on its current, and so on a rate, C4's voltage does not.
    """
    a, b, R0, R1, R2, R5, C4, C7 = 1.64, 1.66, 1.19, 0.67, 0.56, 2.0, 3.98, 2.56
    model = Model("m")
    for name, ends, value in (
        ("R0", ("n0", "ground"), R0),
        ("R1", ("n1", "ground"), R1),
        ("R2", ("n2", "n0"), R2),
        ("R5", ("ground", "n1"), R5),
    ):
        model.resistor(name, ends, resistance=value)
    model.voltage_source("E3", ("ground", "n2"), voltage=f"{a}*through(R1)")
    model.voltage_source("E6", ("n2", "n0"), voltage=f"{b}*through(E3)")
    model.capacitor("C4", ("n2", "n1"), capacitance=C4)
    model.capacitor("C7", ("ground", "n1"), capacitance=C7)
    model.output("i", "through(E3)")
    derivation = derive(model)
    k, v1 = -a / R1, -1.5
    rate = v1 * (1 / R1 + 1 / R5) / (C4 * (k - 1) - C7)
    v2 = k * v1
    assert derivation.function("forward_dynamics")([], [-v1], [])[0] == pytest.approx(
        -rate, rel=1e-12
    )
    stored = C4 * (v2 - v1) ** 2 / 2 + C7 * v1**2 / 2
    assert derivation.function("energy")([], [-v1])[2] == pytest.approx(stored, rel=1e-12)
    # at n2: E3 brings what goes into C4, and through R2 and E6 to n0, which is b i below n2
    i = derivation.function("outputs")([], [-v1], [])[0]
    n0 = v2 - b * i
    assert i == pytest.approx(C4 * (k - 1) * rate + n0 / R0, rel=1e-9)


def test_a_law_that_is_not_linear_in_a_rate_names_its_place() -> None:
    text = """\
name = "m"
[resistor.q]
between = ["ground", "e"]
resistance = 3
[voltage_source.F]
between = ["e", "a"]
voltage = "through(C)**2"
[capacitor.C0]
between = ["a", "ground"]
capacitance = 2
[voltage_source.s]
between = ["d", "ground"]
voltage = "across(C0)"
[capacitor.C]
between = ["d", "ground"]
capacitance = 2
"""
    with pytest.raises(ModelError, match=r'm\.toml:8: capacitor "C0": .*what flows in C'):
        derive(parse(text.encode(), "m.toml"))
