"""Golden vectors: what is emitted passes them, in C and in Python, and what is corrupted does not."""

from __future__ import annotations

import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from click.testing import CliRunner
from oracles import newton_euler
from support.closed_examples import reformulated
from support.compiled import WARNINGS
from support.emitted import load
from support.spec_models import model_of
from systems import random_mixed, random_systems
from systems.random_trees import random_state, random_tree

import linegraph as lg
from linegraph.cli.main import main
from linegraph.emission.emit import module_for, render
from linegraph.errors import ModelError
from linegraph.readers import modelfile, urdf
from linegraph.verification import golden
from linegraph.verification.golden.bodies import Bodies
from linegraph.verification.golden.walk import Walk

if TYPE_CHECKING:
    from linegraph.ir.golden_vectors import Vectors

EXAMPLES = Path(__file__).parents[2] / "examples"
FILES = {path.parent.name: path for path in sorted(EXAMPLES.glob("*/*.toml"))}
FILES |= {path.parent.name: path for path in sorted(EXAMPLES.glob("*/*.urdf"))}
IN_C = ("panda", "rolling_disc", "ring_modulator", "arm_with_drives", "quarter_car_3d")
"""Compiled by default: a robot, constraints, a network, both in one, and a law that is not smooth."""

SLOW = ("stewart_platform", "anymal_c", "bicycle", "andrews_squeezer")
"""Left out by default."""


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Examples: some, or all with ``--all-forms``."""
    every = metafunc.config.getoption("--all-forms")
    if "compiled_example" in metafunc.fixturenames:
        metafunc.parametrize("compiled_example", FILES if every else IN_C)
    if "example" in metafunc.fixturenames:
        names = [name for name in FILES if every or name not in SLOW]
        metafunc.parametrize("example", names)


def read(name: str) -> lg.Model:
    path = FILES[name]
    if path.suffix == ".toml":
        return modelfile.read(path)
    return urdf.read(path, base="floating" if name == "anymal_c" else "fixed")


@cache
def emitted(name: str) -> dict[str, str]:
    """All files of an example, golden vectors among them."""
    return render(read(name), name=name, tests=True)


@cache
def found(name: str) -> Vectors:
    """The golden vectors of an example."""
    model = read(name)
    return golden.vectors(lg.derive(model), module_for(model, name))


def build(files: dict[str, str], name: str, folder: Path, *flags: str) -> Path:
    """Compile the check with the code."""
    for file, text in files.items():
        (folder / file).write_text(text, encoding="ascii", newline="\n")
    program = folder / "check"
    command = ["gcc", "-std=c99", "-O0", *flags, f"{name}_test.c", f"{name}.c", "-lm"]
    command += ["-o", str(program)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return program


def run(program: Path) -> tuple[int, list[str]]:
    done = subprocess.run([str(program)], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout.splitlines()


# ---- what is emitted holds


@pytest.mark.one_in(2)
def test_c_holds(compiled_example: str, tmp_path: Path) -> None:
    name = compiled_example
    status, lines = run(build(emitted(name), name, tmp_path, *WARNINGS))
    *functions, summary = lines
    count = len(found(name).expected)
    assert status == 0, "\n".join(lines)
    assert [line.split()[-1] for line in functions] == ["ok"] * count
    assert summary == f"{name}: {count} of {count} functions hold"
    # far below what is allowed: the tolerance is not what makes it pass
    assert max(float(line.split()[3]) for line in functions) < 2e-12


@pytest.mark.one_in(4)
def test_python_holds(example: str, tmp_path: Path) -> None:
    files = emitted(example)
    load(files, example, tmp_path)
    check = load(files, f"test_{example}", tmp_path)
    assert list(check.FUNCTIONS) == [x.label for x in found(example).expected]
    for function in check.FUNCTIONS:
        check.compare(function, slice(None))
        check.compare(function, 0)


def holds(model: lg.Model, folder: Path) -> None:
    files = render(model, name="drawn_model", languages=["python"], tests=True)
    load(files, "drawn_model", folder)
    check = load(files, "test_drawn_model", folder)
    for function in check.FUNCTIONS:
        check.compare(function, slice(None))


@pytest.mark.seeds(range(0, 60, 40), range(0, 200))
def test_random_mixed_models_hold(seed: int, tmp_path: Path) -> None:
    """Mechanics with networks, prescribed motions and elements."""
    holds(random_mixed.model_of(random_mixed.random_system(seed)), tmp_path / "mixed")
    holds(random_systems.random_system(seed).model, tmp_path / "system")


@pytest.mark.one_in(2)
@pytest.mark.parametrize("kind", ["absolute", "absolute-angle", "tree"])
@pytest.mark.parametrize("name", ["slider_crank", "car_axis"])
def test_other_coordinates_hold(name: str, kind: str, tmp_path: Path) -> None:
    holds(reformulated(name, kind), tmp_path)


def test_pytest_runs_it(tmp_path: Path) -> None:
    for file, text in emitted("rolling_disc").items():
        (tmp_path / file).write_text(text, encoding="ascii", newline="\n")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    vectors = found("rolling_disc")
    assert f"{len(vectors.expected) * (vectors.states + 1)} passed" in done.stdout


def test_floats_hold(tmp_path: Path) -> None:
    """The same check where the code computes in floats, and has a prefix of its own."""
    files = render(read("panda"), name="panda", tests=True, real="float", prefix="arm")
    status, lines = run(build(files, "panda", tmp_path, *WARNINGS))
    assert status == 0, "\n".join(lines)
    assert "tolerance 1.0e-04" in lines[0]


def test_without_a_console(tmp_path: Path) -> None:
    """No <stdio.h>, and main returns how many functions fail."""
    files = dict(emitted("panda"))
    program = build(files, "panda", tmp_path, "-DPANDA_TEST_NO_STDIO", *WARNINGS)
    assert run(program) == (0, [])
    names = subprocess.run(["nm", "-u", program], capture_output=True, text=True, check=True)
    assert not re.search(r"printf|puts|stdout", names.stdout)
    files["panda.c"] = corrupted(files["panda.c"], "panda_energy", r"0\.5 \*", "0.6 *")
    assert run(build(files, "panda", tmp_path, "-DPANDA_TEST_NO_STDIO")) == (1, [])


# ---- what is corrupted does not


def corrupted(text: str, function: str, old: str, new: str) -> str:
    """The text with one place of a function's definition replaced."""
    # of a function that reports a status, what computes
    head = rf"^(?:\w+_PART )?(?:void|int) {function}(?:_core)?\("
    start = re.search(rf"{head}[^{{}}]*?\)\n\{{", text, re.M)
    assert start is not None
    end = text.index("\n}", start.end())
    body, count = re.subn(old, new, text[start.end() : end], count=1)
    assert count == 1, f"nothing like {old} in {function}"
    return text[: start.end()] + body + text[end:]


@pytest.mark.parametrize(
    ("function", "old", "new"),
    [
        ("mass_matrix", r"(= \S+ \* \S+) \+", r"\1 -"),
        ("bias", r"\b(\d+\.\d{3,})", r"1.00001 * \1"),
        ("inverse_dynamics", r"a\[3\]", "a[2]"),
        ("energy", r"E\[1\] = ", "E[1] = 1e-8 + "),
        ("coordinate_rates", r"= v\[0\]", "= 0.0 / 0.0 * v[0]"),
        ("forward_dynamics", r"return PANDA_OK;", "return 1;"),
    ],
)
def test_corrupted_c_fails(function: str, old: str, new: str, tmp_path: Path) -> None:
    """A sign, a constant, an index, a small offset, what is no number, a status."""
    files = dict(emitted("panda"))
    files["panda.c"] = corrupted(files["panda.c"], f"panda_{function}", old, new)
    status, lines = run(build(files, "panda", tmp_path))
    assert status == 1
    verdicts = {line.split()[0]: line.split()[-1] for line in lines[:-1]}
    assert verdicts.pop(function) == "FAIL"
    for caller in ("rhs", "reactions"):
        verdicts.pop(caller)
    assert set(verdicts.values()) == {"ok"}


def test_corrupted_python_fails(tmp_path: Path) -> None:
    """Most of what can be wrong by one sign is seen: at least 95 % of the sums of one function."""
    files = dict(emitted("rolling_disc"))
    name, test = "rolling_disc", "test_rolling_disc"
    lines = files[f"{name}.py"].split("\n")
    start = lines.index("def _constrained_equations_prepared(c, q, v):")
    stop = next(k for k in range(start + 1, len(lines)) if lines[k].startswith("def "))
    sums = [k for k in range(start, stop) if re.match(r"    t\d+ = .* [-+] ", lines[k])]
    caught = 0
    for k in sums:
        flipped = re.sub(r" ([-+]) ", lambda x: " - " if x[1] == "+" else " + ", lines[k], count=1)
        files[f"{name}.py"] = "\n".join([*lines[:k], flipped, *lines[k + 1 :]])
        load(files, name, tmp_path / str(k))
        check = load(files, test, tmp_path / str(k))
        try:
            check.compare("constrained_equations", slice(None))
        except (AssertionError, ArithmeticError):
            caught += 1
    assert len(sums) > 20
    assert caught >= 0.95 * len(sums)


# ---- what they are made of


def close(found: Any, expected: Any) -> bool:
    error = np.max(np.abs(np.asarray(found) - expected), initial=0.0)
    return bool(error <= 1e-12 * (1 + np.max(np.abs(expected), initial=0.0)))


@pytest.mark.parametrize("seed", range(12))
def test_the_reference_agrees_with_newton_and_euler(seed: int) -> None:
    """Against equations of motion that know nothing of this package, on random trees."""
    rng = np.random.default_rng(seed)
    tree = random_tree(rng, bodies=1 + seed % 6)
    q, v = random_state(rng, tree)
    walk = Walk(lg.derive(model_of(tree)).numeric(), q.tolist(), v.tolist())
    bodies = Bodies(walk)
    assert close(bodies.mass_matrix[0], newton_euler.mass_matrix(tree, q, v))
    assert close(bodies.bias[0], newton_euler.bias(tree, q, v))
    assert close(walk.rates[0], newton_euler.coordinate_rates(tree, q, v))
    assert close(bodies.energy[0][0], newton_euler.kinetic_energy(tree, q, v))
    # bodies welded to ground count there, too
    there, _ = random_state(rng, tree)
    other = Bodies(Walk(walk.numeric, there.tolist(), v.tolist()))
    expected = newton_euler.potential_energy(tree, q) - newton_euler.potential_energy(tree, there)
    assert close(bodies.energy[0][1] - other.energy[0][1], expected)


@pytest.mark.parametrize("name", ["rolling_disc", "bricard", "heavy_top"])
def test_states_are_legal(name: str) -> None:
    """Quaternions have length 1, loops are closed, velocities are allowed; the first is at rest."""
    vectors = found(name)
    derivation = lg.derive(read(name))
    assert ("p" in vectors.given) == bool(derivation.system.parameters)
    rows = vectors.given.get("p", ((),) * vectors.states)
    for q, v, p in zip(vectors.given["q"], vectors.given["v"], rows, strict=True):
        numeric = derivation.numeric(dict(zip(vectors.parameters, p, strict=True)))
        for places in numeric.tree.quaternions:
            assert abs(np.linalg.norm([q[k] for k in places]) - 1) < 1e-14
        if numeric.tree.closed:
            assert np.abs(numeric.constraints(q)).max(initial=0.0) < 1e-11
            assert np.abs(numeric.constraint_rates(q, v)).max() < 1e-11
    assert not any(vectors.given["v"][0])
    assert len(set(vectors.given["v"])) == vectors.states == 10


def test_what_is_not_compared_is_listed() -> None:
    vectors = found("rolling_disc")
    emitted_names = [p.name for p in module_for(read("rolling_disc"), "rolling_disc").programs]
    compared = {x.function for x in vectors.expected}
    listed = [*compared, *(name for name, _ in vectors.untested)]
    assert sorted(listed) == sorted(emitted_names)
    # the measures of constraints and velocities are no results, and take part in all that solves with them
    names = {name for name, _ in vectors.untested if not name.endswith("_prepared")}
    assert names == {"prepare", "constraint_sizes"}
    assert all("called" in why for _, why in vectors.untested)
    for file in ("rolling_disc_test.c", "test_rolling_disc.py"):
        about = emitted("rolling_disc")[file].split("Not compared are:")[1]
        assert re.search(r"prepare: the functions that take its constants", about)


def test_same_bytes() -> None:
    again = render(read("rolling_disc"), name="rolling_disc", tests=True)
    assert again == emitted("rolling_disc")


# ---- how they are asked for


def test_command_line(tmp_path: Path) -> None:
    model = str(FILES["cart_pole"])
    done = CliRunner().invoke(
        main, ["emit", model, "--tests", "--lang", "c", "--out", str(tmp_path)]
    )
    assert done.exit_code == 0
    assert {path.name for path in tmp_path.iterdir()} == {
        "cart_pole.h",
        "cart_pole.c",
        "cart_pole_test.c",
    }


def test_only_what_is_emitted_is_compared() -> None:
    files = render(read("panda"), name="panda", only=("bias",), tests=True)
    assert "test_bias" in files["panda_test.c"]
    assert "mass_matrix" not in files["panda_test.c"]


def test_nothing_to_compare_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="nothing that is emitted is known"):
        render(read("rlc_ladder"), name="rlc", only=("coordinate_rates",), tests=True)
    out = tmp_path / "out"
    arguments = ["emit", str(FILES["rlc_ladder"]), "--tests", "--out", str(out)]
    arguments += ["--only", "coordinate_rates"]
    done = CliRunner().invoke(main, arguments)
    assert done.exit_code == 2
    assert not out.exists()
