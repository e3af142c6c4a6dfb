"""Which functions are emitted, which have a prepared twin, and which do not depend on constraints."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.dag_values import run

import linegraph as lg
from linegraph import ModelError
from linegraph.ir.program import Program
from linegraph.ir.prologue import PREPARED, PREPARED_PREFIX, is_prepared
from linegraph.kinematics.frame_trees import NamedFrame
from linegraph.programs.register import OF_FRAMES, ON_REQUEST, PROGRAMS, module_of
from linegraph.programs.request import Request
from linegraph.verification.golden.beside import ANYWHERE, beside
from linegraph.verification.golden.beside import OF_FRAMES as ENDINGS
from linegraph.verification.golden.references import REFERENCES

if TYPE_CHECKING:
    from linegraph.ir.program import Module

G, M, L = 9.81, 1.3, 0.6


def linkage(closed: bool = True) -> lg.Model:
    """Three bars on hinges about z; closed, a fourth hinge joins the last two."""
    model = lg.Model("linkage", gravity=(0, "-g", 0))
    model.parameter("g", G)
    model.parameter("m", M)
    made = [
        model.body(name, mass="m", mass_center=(length / 2, 0, 0), inertia=(0.01, 0.02, 0.03))
        for name, length in (("crank", 0.3), ("coupler", 0.8), ("rocker", 0.6))
    ]
    crank, coupler, rocker = made
    model.revolute("a", between=("ground", crank))
    model.revolute("b", between=(crank.frame("tip", at=(0.3, 0, 0)), coupler), effort=False)
    model.revolute("d", between=(model.ground.frame("there", at=(1, 0, 0)), rocker), effort=False)
    if closed:
        ends = (coupler.frame("tip", at=(0.8, 0, 0)), rocker.frame("tip", at=(0.6, 0, 0)))
        model.revolute("c", between=ends, effort=False)
        model.formulation(tree=("a", "b", "d"))
    return model


def arm() -> lg.Model:
    """A bar that turns and slides in space, with an output."""
    model = lg.Model("arm", gravity=(0, 0, "-g"))
    model.parameter("g", G)
    model.parameter("m", M)
    bars = [model.body(n, mass="m", mass_center=(0.2, 0, 0), inertia=(1, 2, 2)) for n in "xyz"]
    near: Any = "ground"
    for body, axis in zip(bars, ((1, 0, 0), (0, 1, 0), (0, 0, 1)), strict=True):
        model.prismatic(f"along_{body.name}", between=(near, body), axis=axis)
        near = body
    model.output("reach", "position(z.mass_center).x")
    return model


def led() -> lg.Model:
    """A pendulum whose pivot is led along x."""
    model = lg.Model("led", gravity=(0, "-g", 0))
    model.parameter("g", G)
    cart, bob = model.body("cart", mass=2.0), model.body("bob", mass=M, mass_center=(0, -L, 0))
    model.prismatic("rail", between=("ground", cart), axis=(1, 0, 0), motion="0.1*sin(t)")
    model.revolute("swing", between=(cart, bob))
    return model


def rectifier() -> lg.Model:
    """A diode and a resistor in series, which decide the current into a capacitor between them."""
    model = lg.Model("rectifier")
    model.parameter("R", 100.0)
    model.input("U")
    model.voltage_source("supply", between=("plus", "ground"), voltage="U")
    model.resistor("R1", between=("plus", "mid"), resistance="R")
    model.diode("D1", between=("mid", "out"))
    model.capacitor("C1", between=("out", "ground"), capacitance="1e-3")
    return model


MODELS = {"linkage": linkage, "arm": arm, "led": led, "rectifier": rectifier}
LOOPS = {"constraints", "project", "reduction"}
OF_BODIES = {
    key
    for key in PROGRAMS
    if key.startswith(("center_of_mass", "centroidal", "momentum", "kinematics"))
}
OF_FORWARD = {"forward_dynamics_derivatives", "forward_dynamics_parameter_derivatives"}
REFUSED: dict[str, set[str]] = {
    "linkage": {
        "algebraic_loop",
        "drives",
        "outputs",
        *OF_FORWARD,
        # one velocity is left, fewer than the rows of a frame
        "operational_space",
        "operational_position",
    },
    # it slides along three axes and turns about none
    "arm": {"algebraic_loop", "drives", *LOOPS, "operational_space"},
    "led": {"algebraic_loop", "outputs", *LOOPS, "operational_space", "operational_position"},
    "rectifier": {
        "drives",
        "outputs",
        *LOOPS,
        *OF_FRAMES,
        *OF_BODIES,
        "regressor",
        "inertial_parameters",
    },
}
"""The functions that each model does not have."""

FRAMES = {"linkage": "rocker", "arm": "z", "led": "bob"}


@cache
def derivation(name: str, *options: bool) -> lg.Derivation:
    return lg.derive(MODELS[name](*options))  # type: ignore[operator]


def asked(name: str, key: str) -> Module:
    """The module of one function of a model, of a frame where it is of frames."""
    frames = [NamedFrame("tip", FRAMES[name])] if key in OF_FRAMES and name in FRAMES else []
    return module_of(derivation(name), "one", Request(only=(key,), frames=frames))


@cache
def whole(name: str, *options: bool) -> Module:
    """All functions of a model."""
    further = [key for key in ON_REQUEST if key not in REFUSED[name]]
    frames = [NamedFrame("tip", FRAMES[name])] if name in FRAMES else []
    made = derivation(name, *options)
    return module_of(made, "all", Request(wanted=further, frames=frames))


def names(module: Module) -> set[str]:
    """Its functions without twins."""
    found = {program.name for program in module.programs}
    return {name for name in found if not name.endswith("_prepared")} - {"prepare"}


@pytest.mark.parametrize("key", PROGRAMS)
@pytest.mark.parametrize("name", MODELS)
def test_every_function_is_emitted_alone_or_refused(name: str, key: str) -> None:
    if key in REFUSED[name]:
        with pytest.raises(ModelError) as told:
            asked(name, key)
        assert told.value.thing in (
            f'function "{key}"',
            f'model "{name}"',
            'frame "z"',
            'frame "bob"',
        )
        return
    found = names(asked(name, key))
    if key == "frames":
        assert found == {
            f"frame_tip_{x}" for x in ("pose", "velocity", "jacobian", "jacobian_dot_v")
        }
    elif key in OF_FRAMES:
        assert f"frame_tip_{key}" in found
    elif key == "reduction":
        assert {"reduced_equations", "complete"} <= found
    else:
        assert key in found


@pytest.mark.parametrize("name", MODELS)
def test_unasked_all_but_what_is_on_request_is_emitted(name: str) -> None:
    found = names(module_of(derivation(name), "plain"))
    assert not found & {*ON_REQUEST}
    assert not any(x.startswith(PREPARED_PREFIX) for x in found)
    expected = {*PROGRAMS} - {*ON_REQUEST} - REFUSED[name] - {"reduction"}
    assert expected <= found


@pytest.mark.parametrize("key", OF_FRAMES)
def test_functions_of_frames_need_a_frame(key: str) -> None:
    with pytest.raises(ModelError, match="name a frame"):
        module_of(derivation("arm"), "one", Request(only=(key,)))


def test_sets_name_existing_functions_and_each_once() -> None:
    assert {*ON_REQUEST} <= PROGRAMS.keys()
    assert {*OF_FRAMES} <= {*ON_REQUEST}
    for names_of_set in (ON_REQUEST, PREPARED, ANYWHERE, OF_FRAMES):
        assert len({*names_of_set}) == len(names_of_set)
    every = set[str]().union(*(names(whole(name)) for name in MODELS))
    assert {*PREPARED} <= every
    assert {*ANYWHERE} <= every
    assert all(f"frame_tip{ending}" in every for ending in ENDINGS)


@pytest.mark.parametrize("name", MODELS)
def test_what_is_prepared_has_a_twin_that_takes_the_constants(name: str) -> None:
    programs = {program.name: program for program in whole(name).programs}
    assert "prepare" in programs
    for function in names(whole(name)):
        prepared = function in PREPARED or function.startswith(PREPARED_PREFIX)
        assert (f"{function}_prepared" in programs) is prepared, function
        assert is_prepared(function) is prepared
        if prepared:
            twin = programs[f"{function}_prepared"]
            given = [argument.name for argument in programs[function].arguments]
            assert [a.name for a in twin.arguments] == ["c" if a == "p" else a for a in given]
            assert [r.shape for r in twin.results] == [r.shape for r in programs[function].results]


def test_all_but_what_is_read_now_and_then_is_prepared() -> None:
    every = set[str]().union(*(names(whole(name)) for name in MODELS))
    assert {function for function in every if not is_prepared(function)} == {
        "energy",
        "across",
        "reactions_at",
        "reactions",
        "drives",
        "power",
        "outputs",
        "inverse_dynamics_parameter_derivatives",
        "forward_dynamics_parameter_derivatives",
        "inertial_parameters",
    }


def test_a_hole_in_the_register_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every function that is called must be made by some key; the search used to run forever."""
    monkeypatch.setitem(PROGRAMS, "forward_dynamics", lambda _: ())
    with pytest.raises(LookupError, match="makes forward_dynamics"):
        asked("arm", "power")


# functions that do not depend on constraints

STATE = {
    "q": [0.7, -0.4, 1.1],  # the loop stands open
    "v": [0.9, -1.3, 0.6],
    "a": [0.2, 0.5, -0.8],
    "u": [0.3],
}


def results(module: Module) -> dict[str, dict[str, Any]]:
    """The results, at the state, of all functions that need neither multipliers nor another function."""
    found = {}
    for program in module.programs:
        called = [call.program for call in getattr(program, "calls", ())]
        if not isinstance(program, Program) or program.name not in names(module):
            continue
        if {a.name for a in program.arguments} - {"p", *STATE} or called:
            continue
        found[program.name] = run(module, program.name, p={"g": G, "m": M}, **STATE)
    return found


def test_what_is_right_anywhere_is_the_same_without_the_constraint() -> None:
    """Compares a linkage with its bars without the closing hinge, at a state off the constraint."""
    closed, opened = (results(whole("linkage", way)) for way in (True, False))

    def same(function: str) -> bool:
        return closed[function].keys() == opened[function].keys() and all(
            np.shape(x) == np.shape(y) and np.allclose(x, y, rtol=1e-13, atol=1e-13)
            for x, y in zip(closed[function].values(), opened[function].values(), strict=True)
        )

    both = {function for function in closed.keys() & opened.keys() if same(function)}
    assert both == {*ANYWHERE, *(f"frame_tip{ending}" for ending in ENDINGS)}


def test_what_is_right_anywhere_is_compared_beside_the_constraints() -> None:
    for label, reference in REFERENCES.items():
        moved = beside(label, reference)
        if label in ANYWHERE:
            assert (moved.given["q"], moved.given["v"]) == ("q_off", "v_off")
            assert moved.results.keys() == reference.results.keys()
            assert moved.route.endswith("; beside the constraints")
        else:
            assert moved is reference
    (reference, *_) = REFERENCES.values()
    for ending in ENDINGS:
        assert beside(f"frame_hand{ending}", reference) is not reference
    for label in ("hand_pose", "frame_hand_operational_space"):
        assert beside(label, reference) is reference
