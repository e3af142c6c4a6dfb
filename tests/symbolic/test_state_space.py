"""Linear systems as other tools have them: the same frequency responses, poles and names."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import scipy.signal
import sympy
from published.published_networks import PUBLISHED, Published

import linegraph as lg
from linegraph import Model, ModelError
from linegraph.readers import modelfile

if TYPE_CHECKING:
    from linegraph.symbolic.state_space import StateSpace

ROOT = Path(__file__).parents[2]
POINTS = (0.3 + 1.7j, 2.0j, -0.4 + 0.9j)
LINEAR = [s for s in PUBLISHED if not s.rates and s.inputs]


def space_of(text: str) -> StateSpace:
    found: StateSpace = lg.derive(modelfile.parse(text.encode(), "m.toml")).state_space
    return found


def response(space: StateSpace, s: complex) -> Any:
    """C (sI - A)^-1 (B + sE) + D + sF in numbers."""
    values = {sympy.Symbol(name): x for name, x in space.defaults.items()}

    def at(matrix: Any) -> Any:
        return np.array(matrix.subs(values).tolist(), dtype=complex).reshape(matrix.shape)

    inner = np.linalg.solve(
        s * np.eye(len(space.states)) - at(space.A), at(space.B) + s * at(space.E)
    )
    return at(space.C) @ inner + at(space.D) + s * at(space.F)


@pytest.mark.parametrize("system", LINEAR, ids=lambda system: system.name)
def test_other_tools_have_the_same_response(system: Published) -> None:
    """Also where an input's derivative is needed: shifted states change no output."""
    space = space_of(system.model)
    if any(entry != 0 for entry in space.shifted.F):
        with pytest.raises(ModelError, match="not proper"):
            space.to_control()
        return
    there = space.to_control()
    assert (there.state_labels, there.input_labels) == (list(space.states), list(space.inputs))
    assert there.output_labels == list(space.outputs)
    other = space.to_scipy()
    assert isinstance(other, scipy.signal.StateSpace)
    for s in POINTS:
        ours = response(space, s)
        theirs = np.asarray(there(s)).reshape(ours.shape)
        assert np.max(np.abs(ours - theirs)) <= 1e-10 * (1 + np.max(np.abs(ours)))
        inner = np.linalg.solve(s * np.eye(len(other.A)) - other.A, other.B)
        assert np.max(np.abs(ours - other.C @ inner - other.D)) <= 1e-10 * (
            1 + np.max(np.abs(ours))
        )


def test_parameters_may_be_changed() -> None:
    model = Model("low_pass")
    model.input("u", "V")
    model.parameter("R", 1e3)
    model.parameter("C", 1e-6)
    model.voltage_source("s", ("a", "ground"), voltage="u")
    model.resistor("R1", ("a", "b"), resistance="R")
    model.capacitor("C1", ("b", "ground"), capacitance="C")
    space = lg.derive(model).state_space
    assert space.to_control().poles() == pytest.approx([-1e3])
    assert space.to_control({"R": 500.0}).poles() == pytest.approx([-2e3])


def test_a_cart_on_a_spring_is_linear_too() -> None:
    """Mechanics in 3-D that happens to be linear: q and v are its states."""
    model = Model("cart", gravity=(0, 0, 0))
    model.parameter("m", 2.0)
    model.parameter("k", 18.0)
    cart = model.body("cart", mass="m")
    model.prismatic("slide", ("ground", cart), axis=(1, 0, 0))
    model.spring("spring", joint="slide", stiffness="k")
    space = lg.derive(model).state_space
    k, m = sympy.symbols("k m")
    assert sympy.Matrix([[0, 1], [-k / m, 0]]) == space.A
    assert list(space.B) == [0, 1 / m]
    assert sorted(abs(space.to_control().poles().imag)) == pytest.approx([3, 3])


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("ring_modulator", '"v_C3": its rate is not linear'),
        ("motor_warming_up", '"i_motor": its rate is not linear'),
    ],
)
def test_what_is_not_linear_says_so(name: str, problem: str) -> None:
    path = ROOT / "examples" / name / f"{name}.toml"
    with pytest.raises(ModelError, match=problem):
        _ = lg.derive(modelfile.read(path)).state_space


def test_a_constant_source_is_no_input() -> None:
    text = """
[voltage_source.s]
between = ["a", "ground"]
voltage = 5
[resistor.R]
between = ["a", "b"]
resistance = 2
[capacitor.C]
between = ["b", "ground"]
capacitance = 3
"""
    with pytest.raises(ModelError, match="make its source an input"):
        space_of(text)
