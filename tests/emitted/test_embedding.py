"""Emitted C for controllers: what docs/embedding.md says of floats, names, brackets, labels, MISRA, lint."""

from __future__ import annotations

import re
import struct
import subprocess
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from click.testing import CliRunner
from support import codegen_samples as samples
from support import targets
from support.compiled import Compiled

import codegen
from codegen import Options
from codegen.c import real
from linegraph import Model
from linegraph.cli.main import main
from linegraph.emission.emit import emit, module_for, render
from linegraph.errors import ModelError, NameRefused
from linegraph.readers import modelfile

if TYPE_CHECKING:
    from collections.abc import Iterator

DOCUMENT = (Path(__file__).parents[2] / "docs" / "embedding.md").read_text()
CHECKED = ("furuta+", "four_bar+", "rolling_disc", "condenser_microphone", "mixed4", "tree3")
"""Models whose code has every routine and helper in it, and every function on request."""

BRIEFLY = ("rolling_disc", "mixed4")
"""Of these, what cppcheck takes seconds for and what shows every deviation; without --all-forms no others."""

PENDULUM = targets.EXAMPLES / "double_pendulum" / "double_pendulum.toml"
MATH = "a?(sin|cos|tan)h?|sqrt|fabs|fmax|fmin|exp|log|pow|atan2"


def bare(text: str) -> str:
    """C without comments and strings."""
    return re.sub(r'/\*.*?\*/|"(?:\\.|[^"\\])*"', "", text, flags=re.DOTALL)


@cache
def emitted(name: str, numbers: str = "double") -> dict[str, str]:
    """The files of a model; of the one with an algebraic loop, what forward dynamics needs."""
    if name != "mixed4":
        return targets.emitted(name, numbers)
    module = module_for(targets.everything()[name](), "model", only=("forward_dynamics",))
    return codegen.render(module, "c", Options(real=numbers))


def deviations() -> dict[str, str]:
    """The rules in the table of the document, with their reasons."""
    rows = re.findall(r"^\| (\d+\.\d+) \| ([^|]+) \|", DOCUMENT, re.MULTILINE)
    return dict(rows)


# ---- compilers that cannot


def complaint(folder: Path, name: str, *flags: str) -> list[str]:
    """The errors of gcc, without the places where they are."""
    command = ["gcc", *flags, "-c", f"{name}.c", "-o", f"{name}.o"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return re.findall(r"error: (?:#error )?(.*)", done.stderr)


def test_floats_before_c99_stop_the_compiler(tmp_path: Path) -> None:
    """There sinf would be taken for a function that returns int."""
    if lacking := targets.missing("gcc"):
        pytest.skip(lacking)
    emit(modelfile.read(PENDULUM), tmp_path, name="arm", languages=["c"], real="float")
    said = "floats need the mathematics of C99: compile with -std=c99 or later, or emit with --real double"
    assert complaint(tmp_path, "arm", "-std=c89")[0] == f'"{said}"'
    assert said in " ".join(DOCUMENT.split())
    assert complaint(tmp_path, "arm", "-std=c99") == []
    assert complaint(tmp_path, "arm", "-x", "c++", "-std=c++98") == []


@pytest.mark.parametrize("options", [{"batch": True}, {"trig": "inline"}])
def test_lanes_that_there_are_not_stop_the_compiler(options: Any, tmp_path: Path) -> None:
    if lacking := targets.missing("gcc"):
        pytest.skip(lacking)
    emit(modelfile.read(PENDULUM), tmp_path, name="arm", languages=["c"], **options)
    said = "ARM_LANES must be 1, 2, 4 or 8: define it as one of these, or leave it undefined"
    for wrong in (16, 3, 0, -1):
        assert complaint(tmp_path, "arm", f"-DARM_LANES={wrong}") == [f'"{said}"']
    for right in (1, 2, 4, 8):
        assert complaint(tmp_path, "arm", f"-DARM_LANES={right}", "-Wno-psabi") == []


# ---- floats


@pytest.mark.parametrize(
    "x", [0.1, 1 / 3, 9.81, 1e-7, 16777217.0, 3.4028234e38, 1.1754944e-38, 5e-324 * 0]
)
def test_a_literal_is_the_shortest_that_reads_back(x: float) -> None:
    text = real.shortest(x)
    assert text.endswith("F")
    nearest = np.float32(x)
    assert np.float32(text[:-1]) == nearest
    assert len(text) <= len(np.format_float_scientific(nearest)) + 4
    assert "." in text or "e" in text


def test_literals_of_drawn_numbers() -> None:
    rng = np.random.default_rng(5)
    for bits in rng.integers(0x00800000, 0x7F7FFFFF, 3000):
        (x,) = struct.unpack("<f", struct.pack("<I", int(bits)))
        text = real.shortest(x)[:-1]
        assert np.float32(text) == np.float32(x)
        digits = len(re.sub(r"e.*|[.]", "", text).strip("0"))
        shortest = np.format_float_scientific(np.float32(x), unique=True)
        assert digits <= len(re.sub(r"e.*|[.]", "", shortest).strip("0"))


@pytest.mark.parametrize(
    ("x", "problem"), [(1e39, "too large for a float"), (1e-40, "too small for a float")]
)
def test_what_is_no_float_is_refused(x: float, problem: str) -> None:
    with pytest.raises(ModelError, match=problem):
        real.shortest(x)


@pytest.mark.parametrize("name", CHECKED)
def test_nothing_but_floats_is_written(name: str) -> None:
    files = emitted(name, "float")
    text = bare("".join(files.values()))
    assert not re.search(r"\bdouble\b", text)
    numbers = re.findall(r"(?<![\w.])\d+(?:\.\d*)?(?:e[+-]?\d+)?\w*", text)
    assert numbers
    assert all(x.endswith("F") for x in numbers if "." in x or "e" in x)
    assert not re.search(rf"\b({MATH})\(", text)
    assert "All numbers are floats" in files["model.h"]


@pytest.mark.parametrize("name", CHECKED)
def test_doubles_and_floats_differ_in_nothing_else(name: str) -> None:
    """Every word but types, functions, numbers and tolerances is the same."""
    said = [bare(emitted(name, x)["model.c"]) for x in codegen.REAL]
    # floats want C99, doubles do not: the check of that is their own
    said = [re.sub(r"#if [^\n]*\n#error[^\n]*\n#endif\n", "", text) for text in said]
    said = [re.sub(r"\n+", "\n", text) for text in said]
    number = r"(?<![\w.])\d[\d.]*(e[+-]?\d+)?F?"
    first = re.sub(number, "0", said[0].replace("double", "float").replace("HUGE_VAL", "HUGE_VALF"))
    first = re.sub(rf"\b({MATH})\(", r"\1f(", first)
    assert first == re.sub(number, "0", said[1])


def test_refused_together() -> None:
    for choices in ({"batch": True}, {"trig": "inline"}):
        with pytest.raises(ModelError, match="leave one of the two out"):
            codegen.options_of({"real": "float", **choices})
    with pytest.raises(ModelError, match="known: double, float"):
        codegen.options_of({"real": "half"})
    with pytest.raises(ModelError, match='option "reals"'):
        codegen.options_of({"reals": "float"})


def test_a_singular_mass_matrix_is_one_of_floats(tmp_path: Path) -> None:
    """Rounding of floats leaves pivots far above what it leaves of doubles."""
    import ctypes

    model = Model("gimbal")
    inner = model.body("inner")
    rod = model.body("rod", mass=1.0, mass_center=(0, 0, 1))
    model.revolute("azimuth", between=("ground", inner), axis=(0, 0, 1))
    model.revolute("tilt", between=(inner, rod), axis=(1, 0, 0))
    compiled = Compiled(render(model, languages=["c"], real="float"), "gimbal", tmp_path)
    function = compiled.library["gimbal_forward_dynamics"]
    function.argtypes = [ctypes.c_void_p] * 4
    zero, result = np.zeros(2, np.float32), np.full(2, 7, np.float32)
    for tilt, status in ((0.0, 1), (1e-5, 0), (0.4, 0)):
        q = np.array([0.3, tilt], np.float32)
        found = function(*(x.ctypes.data for x in (q, zero, zero, result)))
        assert found == status, tilt


# ---- names


def test_prefix_and_name_are_independent(tmp_path: Path) -> None:
    module = samples.arm()
    files = codegen.render(module, "c", Options(prefix="left"))
    assert list(files) == ["arm.h", "arm.c"]
    text = bare("".join(files.values()))
    assert '#include "arm.h"' in files["arm.c"]
    assert not re.search(r"\b(arm|ARM)_\w+", text)
    assert {"left_mass_matrix", "LEFT_NQ", "left_parameters", "left_q_names", "LEFT_H"} <= set(
        re.findall(r"\w+", text)
    )
    renamed = codegen.render(samples.arm(), "c")
    assert (
        bare(files["arm.c"]).split()
        == re.sub(r"\bARM_", "LEFT_", re.sub(r"\barm_", "left_", bare(renamed["arm.c"]))).split()
    )
    assert codegen.render(module, "python", Options(prefix="left")) == codegen.render(
        module, "python"
    )
    model = Model("pendulum")
    bob = model.body("bob", mass=2.0, mass_center=(0, 0, -0.5))
    model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
    written = emit(model, tmp_path, name="files", prefix="robot", languages=["c"])
    assert [path.name for path in written] == ["files.h", "files.c"]


@pytest.mark.parametrize("prefix", ["", "2nd", "a b", "int", "arm_", "a__b", "x" * 200, "a;b"])
def test_an_impossible_prefix_is_refused(prefix: str) -> None:
    with pytest.raises(NameRefused, match="prefix"):
        codegen.render(samples.arm(), "c", Options(prefix=prefix))


@pytest.mark.parametrize("name", CHECKED)
def test_statuses_are_returned_by_name(name: str) -> None:
    files = emitted(name)
    code = bare(files["model.c"])
    helper = r"(?:static|MODEL_PART) (?:int|void|double) model_(?!\w+_(?:part\d|core\()).*?\n}\n"
    outside = re.sub(helper, "", code, flags=re.DOTALL)
    assert not re.search(r"return \d", outside)
    enumerated = dict(re.findall(r"^    (MODEL_\w+) = (\d+)", files["model.h"], re.MULTILINE))
    assert enumerated["MODEL_OK"] == "0"
    private = set(re.findall(r"^    (MODEL_\w+) = \d", code, re.MULTILINE))
    assert not private & set(enumerated)
    returned = set(re.findall(r"\b(?:return|status =) (MODEL_\w+);", code)) - private
    assert returned <= set(enumerated)
    assert set(enumerated) - returned == set()
    for constant, number in enumerated.items():
        if constant != "MODEL_OK":
            header = re.sub(r"\s+\*?\s*", " ", files["model.h"])
            assert f"{constant} ({number}): " in header


def test_statuses_say_what() -> None:
    files = codegen.render(targets.module("double_pendulum"), "c")
    enumeration = files["model.h"]
    assert "MODEL_SINGULAR_AT_ELBOW = 2, /* the mass matrix is singular at elbow */" in enumeration
    assert (
        "MODEL_NOT_FINITE_INPUT = 902, /* an argument is infinite or not a number */" in enumeration
    )


def test_joints_that_read_alike_have_constants_of_their_own() -> None:
    model = Model("twins")
    body = "ground"
    for k, joint in enumerate(("a b", "a-b", "a_b")):
        new = model.body(f"rod{k}", mass=1.0, mass_center=(0.2, 0, 0.5))
        model.revolute(joint, between=(body, new), axis=(0, 1, 0))
        body = new
    header = render(model, languages=["c"])["twins.h"]
    found = dict(re.findall(r"^    (TWINS_SING\w+) = (\d+)", header, re.MULTILINE))
    assert len(found) == 3
    assert sorted(found.values()) == ["1", "2", "3"]


# ---- brackets and labels


def mixed(text: str) -> Iterator[str]:
    """Lines in which operators of different precedence stand side by side."""
    for line in text.splitlines():
        depths: list[set[str]] = [set()]
        for token in re.findall(r" [-+*/] |[(\[{]|[)\]}]|[,;=?:<>!&|]", line.replace("->", ".")):
            if token in "([{":
                depths.append(set())
            elif token in ")]}":
                depths.pop() if len(depths) > 1 else None
            elif token.strip() in "+-*/":
                depths[-1].add("sum" if token.strip() in "+-" else "product")
                if len(depths[-1]) > 1:
                    yield line
            else:
                depths[-1] = set()


@pytest.mark.parametrize("name", CHECKED)
def test_operators_of_different_precedence_are_in_brackets(name: str) -> None:
    assert list(mixed(bare(emitted(name)["model.c"]))) == []


def test_missing_brackets_would_be_seen() -> None:
    assert list(mixed("x = a * b + c;"))
    assert list(mixed("x = (a - f(b * c, d + e * g));"))
    assert not list(mixed("x = (a * b) + c - d; y[(i * n) + j] = a * b / c;"))


@pytest.mark.parametrize("name", [*CHECKED, "panda", "anymal_floating", "ring_modulator"])
def test_every_line_stands_under_its_element(name: str) -> None:
    label = ""
    count = 0
    for line in emitted(name)["model.c"].splitlines():
        if line == "{":
            label = ""
        label = line if re.fullmatch(r"    /\* .+ \*/", line) else label
        if re.match(r"    const double t\d+ =", line):
            assert label, line
            assert "no element" not in label
            count += 1
    assert count


def test_a_report_counts_what_is_written() -> None:
    module = targets.module("double_pendulum")
    header = codegen.render(module, "c", Options(report=True))["model.h"]
    rows = {
        cells[0]: cells[1:]
        for cells in (line[2:].split() for line in header.splitlines() if line.startswith(" *   "))
        if len(cells) == 8 and cells[-1].isdigit()
    }
    assert set(rows) == {program.name for program in module.programs}
    source = codegen.render(module, "c")["model.c"]
    for program in module.programs:
        sums, products, quotients, functions, variables, size, lines = rows[program.name]
        # what computes comes first, before the function around it that reports statuses
        start = rf"^(?:MODEL_PART )?\w+ model_{program.name}(?:_core)?"
        bodies = list(re.finditer(rf"{start}\([^{{}}]*\)\n\{{\n.*?^}}", source, re.M | re.S))
        body = bodies[0]
        assert int(lines) == sum(found[0].count("\n") + 1 for found in bodies)
        assert int(variables) == len(re.findall(r"const double t\d+ =", body[0]))
        assert f"Takes at most {size} bytes of stack." in header
        if functions != "-":
            total = sum(map(int, (sums, products, quotients, functions)))
            assert total == program.operations
            code = bare(body[0]).split("{", 1)[1]
            assert int(functions) == len(re.findall(r"\b(sin|cos|sqrt|fabs)\(", code))
            assert int(quotients) == len(re.findall(r" / ", code))
    assert "Cost of each function" not in codegen.render(module, "c")["model.h"]


# ---- MISRA C and lint


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Floats by default: another test shows that doubles differ from them in types and numbers alone."""
    if "misra" in metafunc.fixturenames:
        every = metafunc.config.getoption("--all-forms")
        metafunc.parametrize("misra", ["double", "float"] if every else ["float"], indirect=True)


@pytest.fixture(scope="module")
def misra(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, set[str]]:
    """For each rule that cppcheck finds broken: the models and lines."""
    lacking = targets.missing("cppcheck")
    if lacking:
        pytest.skip(lacking)
    found: dict[str, set[str]] = {}
    every = request.config.getoption("--all-forms")
    for name in CHECKED if every else BRIEFLY:
        folder = tmp_path_factory.mktemp(name)
        for file, text in emitted(name, request.param).items():
            (folder / file).write_text(text)
        command = [
            "cppcheck",
            "--addon=misra",
            "--std=c99",
            "--quiet",
            "--template={id} {file}:{line} {code}",
        ]
        done = subprocess.run(
            [*command, "--enable=warning,style,performance,portability", "model.c"],
            cwd=folder,
            capture_output=True,
            text=True,
            check=True,
        )
        for line in done.stderr.splitlines():
            rule = re.match(r"misra-c2012-([\d.]+) (.*)", line)
            if rule:
                found.setdefault(rule[1], set()).add(f"{name} {rule[2]}")
            elif re.match(r"[a-zA-Z]\w+ model\.[ch]:", line):
                found.setdefault(line.split()[0], set()).add(f"{name} {line}")
    return found


def test_the_rules_broken_are_those_of_the_document(misra: dict[str, set[str]]) -> None:
    assert set(misra) == set(deviations()), {k: sorted(v)[:3] for k, v in misra.items()}


LEFT_OUT = re.findall(r"^\| `([a-z]+-[a-z-]+)` \|", DOCUMENT, re.MULTILINE)
"""Checks of clang-tidy that the document leaves out, with reasons."""


@pytest.mark.parametrize("name", CHECKED)
def test_clang_tidy_finds_nothing(name: str, tmp_path: Path) -> None:
    lacking = targets.missing("clang-tidy")
    if lacking:
        pytest.skip(lacking)
    for file, text in emitted(name, "float").items():
        (tmp_path / file).write_text(text)
    groups = ["bugprone", "cert", "clang-analyzer", "misc", "performance", "readability"]
    checks = ",".join(["-*", *(f"{group}-*" for group in groups), *(f"-{x}" for x in LEFT_OUT)])
    assert 0 < len(LEFT_OUT) < 10
    said = targets.run(
        ["clang-tidy", "--quiet", f"--checks={checks}", "model.c", "--", "-std=c99"], tmp_path
    )
    assert "warning" not in said, said[:3000]


def test_only_the_mathematics_is_included() -> None:
    for name in CHECKED:
        text = "".join(emitted(name, "float").values())
        assert re.findall(r"#include (\S+)", text) == ['"model.h"', "<math.h>"]


# ---- the command


def called(*arguments: str) -> tuple[int, str]:
    """Exit status and output of a call of the command."""
    done = CliRunner().invoke(main, ["emit", str(PENDULUM), *arguments])
    return done.exit_code, done.output


def test_the_command_takes_all_of_it(tmp_path: Path) -> None:
    status, said = called(
        *("--out", str(tmp_path), "--lang", "c", "--name", "arm", "--prefix", "left"),
        *("--real", "float", "--report", "--cmake"),
    )
    assert status == 0, said
    assert sorted(path.name for path in tmp_path.iterdir()) == ["CMakeLists.txt", "arm.c", "arm.h"]
    header = (tmp_path / "arm.h").read_text()
    assert "void left_mass_matrix(const left_parameters *p,\n" in header
    assert "Cost of each function" in header
    assert (
        called("--out", str(tmp_path / "libraries"), "--lang", "c", "--name", "arm", "--arduino")[0]
        == 0
    )
    assert (tmp_path / "libraries" / "arm" / "src" / "arm.c").is_file()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--prefix", "2nd"), "prefix '2nd' cannot be used"),
        (("--real", "float", "--batch"), "leave one of the two out"),
        (("--cmake", "--arduino"), "another folder"),
        (("--cmake", "--name", "test"), "target of CMake's own"),
    ],
)
def test_what_cannot_be_is_one_message(
    arguments: tuple[str, ...], said: str, tmp_path: Path
) -> None:
    status, output = called("--out", str(tmp_path / "new"), *arguments)
    assert status == 2
    assert said in output
    assert "Traceback" not in output
    assert not (tmp_path / "new").exists()
