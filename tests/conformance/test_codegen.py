"""What holds for every language in the register, and for code generation as a whole."""

from __future__ import annotations

import hashlib
import math
import os
import random
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import jinja2
import numpy as np
import pytest
from support import codegen_samples as samples
from support.compiled import Compiled
from support.emitted import load

import codegen
from codegen import templates
from linegraph.errors import LinegraphError
from linegraph.ir.dag import Dag
from linegraph.ir.program import Argument, Module, Quantity, Result, assemble

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT = Path(__file__).resolve().parents[2]
MOST_CALLS = 20  # of Python functions for each operation, both languages; 17.8 when last counted


def run_c(module: Module, folder: Path) -> Callable[[str, samples.Values], samples.Values]:
    library = Compiled(codegen.render(module, "c"), module.name, folder)

    def run(name: str, values: samples.Values) -> samples.Values:
        program = next(x for x in module.programs if x.name == name)
        inputs = [_as_array(values[x.name]) for x in program.arguments]
        made = library.call(name, *inputs, out=[x.shape for x in program.results])
        made = made if isinstance(made, tuple) else (made,)
        return {x.name: y.ravel() for x, y in zip(program.results, made, strict=True)}

    return run


def run_python(module: Module, folder: Path) -> Callable[[str, samples.Values], samples.Values]:
    emitted = load(codegen.render(module, "python"), module.name, folder)

    def run(name: str, values: samples.Values) -> samples.Values:
        program = next(x for x in module.programs if x.name == name)
        inputs = [
            emitted.Parameters(**values["p"]) if x.name == "p" else values[x.name]
            for x in program.arguments
        ]
        made = getattr(emitted, name)(*inputs)
        made = made if isinstance(made, tuple) else (made,)
        return {x.name: y.ravel() for x, y in zip(program.results, made, strict=True)}

    return run


def _as_array(values: Any) -> Any:
    return list(values.values()) if isinstance(values, dict) else values


RUN = {"c": run_c, "python": run_python}
"""How a test runs what is emitted; a new language has to say how."""


def test_every_language_has_its_file_its_templates_and_its_way_to_run() -> None:
    assert set(RUN) == set(codegen.LANGUAGES), "RUN says how to run each language"
    assert codegen.LANGUAGES[:2] == ("c", "python")
    for language in codegen.LANGUAGES:
        assert (ROOT / "codegen" / language / "__init__.py").is_file()
        assert list((templates.folder() / language).glob("*.jinja"))


@pytest.mark.parametrize("language", codegen.LANGUAGES)
@pytest.mark.parametrize("make", [samples.arm, samples.constant])
def test_text_is_ascii_without_tabs_and_stray_spaces(language: str, make: Any) -> None:
    module = make()
    files = codegen.render(module, language)
    assert files == codegen.render(make(), language)
    for name, text in files.items():
        assert name.startswith(f"{module.name}.")
        assert text.isascii()
        assert text.endswith("\n")
        assert not text.endswith("\n\n")
        assert all(line == line.rstrip() for line in text.split("\n"))
        assert all(" " <= letter <= "~" for letter in text.replace("\n", ""))
    whole = "".join(files.values())
    for program in module.programs:
        assert program.name in whole
        assert program.about in whole
    for x in (*module.positions, *module.velocities, *module.inputs):
        assert x.name in whole
        assert x.unit in whole
        assert x.about in whole


STATE = {
    "p": {"m": 1.3, "I": 0.7},
    "t": 0.4,
    "q": [0.3, -1.2],
    "v": [0.8, 0.5],
    "u": [1.0, -2.0],
}


@pytest.mark.parametrize("language", codegen.LANGUAGES)
def test_values_are_those_of_the_dag(language: str, tmp_path: Path) -> None:
    module = samples.arm()
    run = RUN[language](module, tmp_path)
    for program in module.programs:
        direct = samples.evaluate(module, program.name, STATE)
        made = run(program.name, STATE)
        assert list(made) == list(direct)
        for key, expected in direct.items():
            np.testing.assert_allclose(made[key], expected, rtol=1e-14, atol=0)


@pytest.mark.parametrize("language", codegen.LANGUAGES)
def test_constants_and_missing_inputs(language: str, tmp_path: Path) -> None:
    run = RUN[language](samples.constant(), tmp_path)
    expected = [2, 0, 0, 1 / 3]
    assert run("mass_matrix", {"q": [1.0, 2.0]})["M"].tolist() == expected
    assert run("driven", {"q": [1.0, 2.0], "u": []})["M"].tolist() == expected


@pytest.mark.parametrize("language", codegen.LANGUAGES)
def test_random_arithmetic_is_the_same_to_the_last_bit(language: str, tmp_path: Path) -> None:
    rng = random.Random(20)
    module, point = samples.random_module(rng, 300, functions=False)
    run = RUN[language](module, tmp_path)
    for program in module.programs:
        for _ in range(3):
            state = {"q": [x * rng.uniform(0.999, 1.001) for x in point]}
            direct = samples.evaluate(module, program.name, state)
            assert run(program.name, state)["y_out"].tolist() == direct["y_out"]


@pytest.mark.parametrize("language", codegen.LANGUAGES)
def test_random_functions_agree(language: str, tmp_path: Path) -> None:
    rng = random.Random(21)
    module, point = samples.random_module(rng, 200, functions=True)
    run = RUN[language](module, tmp_path)
    for program in module.programs:
        direct = samples.evaluate(module, program.name, {"q": point})["y_out"]
        made = run(program.name, {"q": point})["y_out"]
        np.testing.assert_allclose(made, direct, rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize("language", codegen.LANGUAGES)
@pytest.mark.parametrize("bad", [math.inf, -math.inf, math.nan, 10**400])
def test_numbers_that_are_none_are_refused(language: str, bad: float) -> None:
    dag = Dag()
    result = Result("M", (1, 1), (dag.symbol("q", 0) + bad,), "")
    program = assemble("f", "", (Argument("q", 1, ""),), (result,))
    with pytest.raises(LinegraphError, match="too large, or not a number"):
        codegen.render(samples.single(program, size=1), language)


@pytest.mark.parametrize("language", codegen.LANGUAGES)
def test_extreme_numbers_survive(language: str, tmp_path: Path) -> None:
    numbers = (
        5e-324,
        2.2250738585072014e-308,
        1.7976931348623157e308,
        0.1,
        -1 / 3,
        1e22,
        123456789,
    )
    result = Result("M", (len(numbers),), numbers, "numbers")
    program = assemble("f", "", (Argument("q", 2, ""),), (result,))
    run = RUN[language](samples.single(program), tmp_path)
    assert tuple(run("f", {"q": [0, 0]})["M"]) == numbers


def test_deep_programs_print_without_recursion() -> None:
    dag = Dag()
    x: Any = dag.symbol("q", 0)
    for i in range(50_000):
        x = x * dag.symbol("q", 1) + i + 1
    program = assemble("f", "", (samples.Q,), (Result("M", (1,), (x,), ""),))
    for language in codegen.LANGUAGES:
        codegen.render(samples.single(program), language)


def test_emission_of_a_humanoid_takes_few_steps_for_each_operation() -> None:
    """Counted in calls of Python functions, which the load of a machine does not change."""
    module = samples.large_module()
    operations = sum(program.operations for program in module.programs)
    assert operations > 25_000
    codegen.render(samples.constant(), "c")
    calls = 0

    def count(frame: object, event: str, argument: object) -> None:
        nonlocal calls
        calls += event == "call"

    sys.setprofile(count)
    try:
        for language in ("c", "python"):
            codegen.render(module, language)
    finally:
        sys.setprofile(None)
    assert calls < MOST_CALLS * operations, calls / operations


def test_same_bytes_whatever_the_hash_seed_the_locale_and_the_folder(tmp_path: Path) -> None:
    script = (
        "import hashlib, codegen; from support import codegen_samples as s\n"
        "files = [codegen.render(m, x) for m in (s.arm(), s.hostile('\\u03b1*/'), s.constant())"
        " for x in codegen.LANGUAGES]\n"
        "print(hashlib.sha256(repr(files).encode()).hexdigest())"
    )
    found = set()
    for seed, locale, folder in (("0", "C", ROOT), ("1", "de_DE.UTF-8", tmp_path), ("77", "", "/")):
        environment = os.environ | {"PYTHONHASHSEED": seed, "LC_ALL": locale, "TZ": "Asia/Tokyo"}
        environment["PYTHONPATH"] = os.pathsep.join((str(ROOT), str(ROOT / "tests")))
        done = subprocess.run(
            [sys.executable, "-W", "error", "-c", script],
            cwd=folder,
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        )
        found.add(done.stdout)
    modules = (samples.arm(), samples.hostile("\u03b1*/"), samples.constant())
    files = [codegen.render(module, x) for module in modules for x in codegen.LANGUAGES]
    assert found == {hashlib.sha256(repr(files).encode()).hexdigest() + "\n"}


def test_jinja_is_loaded_only_to_render() -> None:
    script = "import codegen, sys; assert codegen.LANGUAGES; print('jinja2' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert done.stdout == "False\n"


def test_templates_refuse_a_place_that_nothing_fills() -> None:
    with pytest.raises(jinja2.UndefinedError):
        templates.fill("c/source.c.jinja", name="arm")


def test_unknown_language_is_an_error() -> None:
    with pytest.raises(KeyError):
        codegen.render(samples.constant(), "fortran")


def test_a_parameter_needs_a_value() -> None:
    module = samples.single(samples.constant().programs[0])
    without = Module(**{**module.__dict__, "parameters": (Quantity("m", "kg"),)})
    for language in codegen.LANGUAGES:
        with pytest.raises(ValueError, match="'m' has no value"):
            codegen.render(without, language)
