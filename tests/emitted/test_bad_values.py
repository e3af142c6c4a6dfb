"""Finite in, finite out: every function that reports a status, at states with one bad entry, in C and Python.

A few models by default, thirty with ``--all-forms``.
"""

from __future__ import annotations

import ctypes
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pytest
from support import targets
from support.compiled import Compiled
from support.emitted import load

import codegen
from codegen import failures
from linegraph.ir.program import Routine
from linegraph.ir.statuses import COMMON, FIRST, LAST, NOT_FINITE_INPUT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from linegraph.ir.program import Module, Program

BAD = (np.nan, np.inf, -np.inf, 1e300, -1e300, 1e160, 1e-300, 5e-324)
FEW = ("double_pendulum", "four_bar", "network3")
THIRTY = (
    *FEW,
    *("andrews_squeezer", "bicycle", "bricard", "car_axis", "cart_pole", "cart_pole_motor"),
    *("condenser_microphone", "crane", "electro_hydraulic_servo", "furuta", "heavy_top"),
    *("magnetic_levitation", "moving_support_pendulum", "parallelograms", "ring_modulator"),
    *("rolling_disc", "slider_crank", "panda", "panda_symbolic", "anymal_floating"),
    *("tree3", "tree22", "loop1", "loop5", "mixed1", "mixed4", "furuta+", "four_bar+"),
)
MOST_ENTRIES = 12
"""Of each argument so many entries at most, spread over it, unless all are asked for."""

UNTOUCHED = -7.25


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "name" in metafunc.fixturenames:
        wanted = THIRTY if metafunc.config.getoption("--all-forms") else FEW
        metafunc.parametrize("name", wanted)


class Function(NamedTuple):
    """A function that reports a status, and what it is called with."""

    program: Program | Routine
    arguments: dict[str, Any]


class Both:
    """The C and the Python of one model."""

    def __init__(self, name: str, folder: Path) -> None:
        """Emit, compile and load it."""
        self.module = targets.module(name)
        self.library = Compiled(codegen.render(self.module, "c"), "model", folder, flags=("-O1",))
        self.python = load(codegen.render(self.module, "python"), "model", folder)
        own = np.random.default_rng(7)
        self.given = state(self.module, self.python, own)

    def functions(self) -> Iterator[Function]:
        statuses = failures.statuses(self.module)
        for program in self.module.programs:
            if statuses[program.name]:
                yield Function(program, {x.name: self.given[x.name] for x in program.arguments})

    def in_c(self, function: Function, changed: dict[str, Any]) -> tuple[int, list[Any]]:
        """The status and what has been written."""
        emitted = self.library.library[f"model_{function.program.name}"]
        emitted.restype = ctypes.c_int
        results = [
            np.full(max(1, int(np.prod(x.shape))), UNTOUCHED) for x in function.program.results
        ]
        kept = [self._passed(key, x) for key, x in {**function.arguments, **changed}.items()]
        status = emitted(*kept, *(pointer(x) for x in results))
        return status, [
            x for x, y in zip(results, function.program.results, strict=True) if np.prod(y.shape)
        ]

    def _passed(self, key: str, x: Any) -> Any:
        if key == "p":
            known = ctypes.c_double.in_dll(self.library.library, "model_default_parameters")
            return ctypes.byref(known)
        return ctypes.c_double(x) if key == "t" else pointer(np.array(x, float))

    def in_python(self, function: Function, changed: dict[str, Any]) -> tuple[int, list[Any]]:
        """The status and what is returned."""
        arguments = {**function.arguments, **changed}
        try:
            found = getattr(self.python, function.program.name)(*arguments.values())
        except self.python.StatusError as error:
            return error.status, []
        return 0, list(found) if isinstance(found, tuple) else [found]


def pointer(x: Any) -> Any:
    return x.ctypes.data_as(ctypes.POINTER(ctypes.c_double))


def state(module: Module, python: Any, rng: np.random.Generator) -> dict[str, Any]:
    """A state at which the model works, with loops closed, and everything else that functions are given."""
    for _ in range(50):
        drawn = targets.drawn(module, rng)
        given: dict[str, Any] = {"t": drawn.t, **drawn.values}
        if hasattr(python, "DEFAULT_PARAMETERS"):
            given["p"] = python.DEFAULT_PARAMETERS
        if hasattr(python, "project"):
            program = next(x for x in module.programs if x.name == "project")
            try:
                given["q"], given["v"] = python.project(*(given[x.name] for x in program.arguments))
            except python.StatusError:
                continue
        break
    places = [dict(x.details) for x in module.programs if isinstance(x, Routine)]
    for found in places:
        if "s" in given and "s_at" in found:
            given["s"] = given["q"][list(found["s_at"])]
    if "x" in given:
        given["x"] = np.concatenate((given["q"], given["v"]))
    if hasattr(python, "prepare"):
        given["c"] = python.prepare(given["p"])
    return given


def entries(function: Function, every: bool) -> Iterator[tuple[str, int | None]]:
    """The places of bad values: of the time, of every array."""
    for key, value in function.arguments.items():
        if key == "t":
            yield key, None
        elif key not in ("p", "c"):
            size = len(value)
            yield from (
                (key, k) for k in range(0, size, 1 if every else -(-size // MOST_ENTRIES) or 1)
            )


def problems(both: Both, function: Function, key: str, place: int | None, bad: float) -> list[str]:
    """What is wrong with one call in both languages."""
    value: Any = bad
    if place is not None:
        value = np.array(function.arguments[key], float)
        value[place] = bad
    of_c, written = both.in_c(function, {key: value})
    of_python, returned = both.in_python(function, {key: value})
    found = []
    if of_c != of_python:
        found.append(f"status {of_c} in C, {of_python} in Python")
    if not np.isfinite(bad) and of_c != NOT_FINITE_INPUT.number:
        found.append(f"status {of_c} of what is not finite")
    if of_c == 0 and not all(np.isfinite(x).all() for x in written):
        found.append("C returns what is not finite")
    if of_python == 0 and not all(np.isfinite(x).all() for x in returned):
        found.append("Python returns what is not finite")
    if of_c and not all((x == UNTOUCHED).all() for x in written):
        found.append("outputs are touched")
    return [f"{function.program.name}, {key}[{place}] = {bad}: {x}" for x in found]


def test_bad_values_are_statuses_in_both_languages(
    name: str, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    """No result that is not finite with OK, no difference between the languages, no output touched."""
    every = request.config.getoption("--all-forms")
    both = Both(name, tmp_path)
    found: list[str] = []
    calls = 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for function in both.functions():
            for key, place in entries(function, every):
                for bad in BAD:
                    found += problems(both, function, key, place, bad)
                    calls += 1
    print(f"{name}: {calls} calls, {len(found)} problems")
    assert calls > 50
    assert not found, f"{len(found)} of {calls}: " + "\n".join(found[:20])


FAR = (1e2, -3e2, 1e3, 1e4, -1e4, 1e6, 3.3e7, 1e8, -1e8, 1e10, 1e12)


@pytest.mark.parametrize("closed", ["four_bar", "bicycle"])
def test_far_positions_close_in_both_languages_or_in_none(closed: str, tmp_path: Path) -> None:
    """Where one digit of a position is more than a gap that closes, no luck of rounding decides."""
    both = Both(closed, tmp_path)
    (project,) = (f for f in both.functions() if f.program.name == "project")
    closes = set()
    for place in range(len(project.arguments["q"])):
        for far in FAR:
            assert not problems(both, project, "q", place, far)
            q = np.array(project.arguments["q"], float)
            q[place] = far
            closes.add(both.in_c(project, {"q": q})[0] == 0)
    assert closes == {True, False}


def test_the_list_of_statuses_has_no_number_and_no_name_twice() -> None:
    assert len({x.number for x in COMMON}) == len({x.name for x in COMMON}) == len(COMMON)
    assert all(FIRST <= x.number <= LAST for x in COMMON)


@pytest.mark.parametrize("name_", ["four_bar+", "furuta+", "cart_pole_motor+", "tree3+"])
def test_no_two_statuses_of_a_module_share_a_number(name_: str) -> None:
    """C's constants and Python's table name the same statuses, and each number stands once."""
    module = targets.module(name_)
    constants = failures.constants(module)
    numbers = [number for number, _ in constants]
    assert len(numbers) == len(set(numbers)) > 3
    text = codegen.render(module, "python")["model.py"]
    for (number, _), (constant, _) in constants.items():
        assert f'"{constant.removeprefix("MODEL_")}": ({number}, ' in text
