"""Emitted C: clean under every compiler, documented, whole outputs, failures, nothing but <math.h>."""

from __future__ import annotations

import re
import shutil
import subprocess
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support import codegen_samples as samples
from support.compiled import COMPILERS, WARNINGS, Compiled, Failed, available

import codegen
from codegen.c import source as c
from linegraph.ir.dag import Dag
from linegraph.ir.program import Argument, Call, Check, Guards, Module, Quantity, Result, assemble
from linegraph.ir.statuses import NOT_FINITE_INPUT

if TYPE_CHECKING:
    from pathlib import Path

MODULES: dict[str, Any] = {
    "arm": samples.arm,
    "constant": samples.constant,
    "hostile": lambda: samples.hostile('*/ ??/ \\ " é\n'),
}


@pytest.fixture(params=list(COMPILERS))
def compiler(request: pytest.FixtureRequest) -> str:
    name: str = request.param
    if not available(name):
        pytest.skip(f"{name} is not on this machine")
    return name


@pytest.mark.parametrize("make", MODULES.values(), ids=MODULES)
@pytest.mark.parametrize("level", ["-O0", "-O2"])
def test_compiles_without_a_warning(make: Any, level: str, compiler: str, tmp_path: Path) -> None:
    module = make()
    Compiled(codegen.render(module, "c"), module.name, tmp_path, compiler, (level,))


@pytest.mark.parametrize("standard", ["c11", "c17", "gnu99", "gnu17"])
def test_compiles_in_other_dialects(standard: str, tmp_path: Path) -> None:
    module = samples.arm()
    Compiled(codegen.render(module, "c"), "arm", tmp_path, "gcc", (f"-std={standard}",))


def test_header_stands_alone_and_may_be_included_twice(tmp_path: Path) -> None:
    for file, text in codegen.render(samples.arm(), "c").items():
        (tmp_path / file).write_text(text, encoding="ascii")
    user = tmp_path / "user.c"
    user.write_text('#include "arm.h"\n#include "arm.h"\nint user = ARM_NQ;\n', encoding="ascii")
    command = ["gcc", "-std=c99", *WARNINGS, "-c", str(user), "-o", str(tmp_path / "user.o")]
    subprocess.run(command, check=True)


def test_layout_of_the_emitted_files() -> None:
    files = codegen.render(samples.arm(), "c")
    assert list(files) == ["arm.h", "arm.c"]
    header, source = files.values()
    assert re.findall(r"^#define (\w+) (\d+)", header, re.M) == [
        ("ARM_NQ", "2"),
        ("ARM_NV", "2"),
        ("ARM_NU", "2"),
    ]
    assert "void arm_mass_matrix(const arm_parameters *p,\n" in header
    assert "const double q[ARM_NQ],\n" in header
    assert "double M[ARM_RESTRICT ARM_NV * ARM_NV]);" in header
    assert re.findall(r"#include (\S+)", header + source) == ['"arm.h"', "<math.h>"]
    assert "    double I; /* kg m^2: inertia */" in header
    said = re.sub(r"\s+\*?\s*", " ", header)
    text = "@return ARM_OK (0), or with all outputs untouched ARM_STATUS_1 (1): the mass matrix is singular"
    assert text in said
    for text in (header, source):
        assert max(map(len, text.splitlines())) <= 104
    for word in ("malloc", "goto", "while", "extern int"):
        assert word not in source
    equations = source.partition("void arm_mass_matrix(")[2].partition("arm_forward_dynamics")[0]
    assert not re.search(r"\bstatic\b|\bfor \(", equations)


def test_names_and_default_parameters_can_be_read(compiler: str, tmp_path: Path) -> None:
    library = Compiled(codegen.render(samples.arm(), "c"), "arm", tmp_path, compiler)
    assert library.names("q", 2) == [b"joint_0", b"joint_1"]
    assert library.default_parameters(2).tolist() == [1.5, 0.1]
    q = [0.3, 0.4]
    shape = [(2, 2)]
    default = library.call("mass_matrix", None, q, out=shape)
    assert (default == library.call("mass_matrix", [1.5, 0.1], q, out=shape)).all()
    assert (default != library.call("mass_matrix", [1.6, 0.1], q, out=shape)).any()


def test_no_inputs_leave_one_empty_name(tmp_path: Path) -> None:
    files = codegen.render(samples.constant(), "c")
    assert "#define PLAIN_NU 0" in files["plain.h"]
    assert "none: one empty string, as C has no empty arrays" in files["plain.h"]
    assert Compiled(files, "plain", tmp_path).names("u", 1) == [b""]


def test_failure_is_reported_and_leaves_outputs_alone(tmp_path: Path) -> None:
    library = Compiled(codegen.render(samples.arm(), "c"), "arm", tmp_path)
    state: list[Any] = [0.4, [0.3, -1.2], [0.8, 0.5], [1.0, -2.0]]
    shape = [(2,)]
    assert np.isfinite(library.call("forward_dynamics", None, *state, out=shape)).all()
    not_finite = NOT_FINITE_INPUT.number
    for parameters, status in (
        ([0.0, 0.0], 1),
        ([-50.0, 0.0], 1),
        ([np.nan, 0.1], not_finite),
        ([1.0, np.inf], not_finite),
    ):
        with pytest.raises(Failed) as failure:
            library.call("forward_dynamics", parameters, *state, out=shape)
        assert failure.value.status == status


def test_only_unused_arguments_are_marked() -> None:
    source = codegen.render(samples.constant(), "c")["plain.c"]
    assert re.findall(r"\(void\)(\w+);", source) == ["q", "v", "q", "u"]
    assert "(void)" not in codegen.render(samples.arm(), "c")["arm.c"].split("arm_bias")[0]


def failing() -> Module:
    """Three functions that call each other; each can fail in a way of its own."""
    dag = Dag()
    x, y = (dag.symbol("q", i) for i in (0, 1))
    result = (Result("y_out", (1,), (x / y,), "a quotient"),)
    inner = assemble(
        "inner", "", (samples.Q,), result, Guards((Check(y, 0, 3, "y is not positive"),))
    )
    outer = assemble(
        "outer", "", (samples.Q,), result, Guards((Check(x, 1, 7, "x is not above 1"),))
    )
    local = Argument("y_in", 1, "")
    outer = replace(outer, calls=(Call("inner", ("q",), (local,)),))
    free = assemble("free", "", (samples.Q,), (Result("z", (1,), (Dag().symbol("y_in", 0),), ""),))
    free = replace(free, calls=(Call("outer", ("q",), (local,)),))
    return replace(samples.single(inner), programs=(free, outer, inner))


def test_failures_pass_through_calls(tmp_path: Path) -> None:
    files = codegen.render(failing(), "c")
    assert "ONE_STATUS_3 (3): y is not positive; ONE_STATUS_7 (7): x is not above 1" in re.sub(
        r"\s+\*?\s*", " ", files["one.h"]
    )
    library = Compiled(files, "one", tmp_path)
    assert library.call("free", [2.0, 4.0], out=[(1,)]).tolist() == [0.5]
    for name in ("free", "outer"):
        for q, status in (([2.0, -1.0], 3), ([0.5, 1.0], 7)):
            with pytest.raises(Failed) as failure:
                library.call(name, q, out=[(1,)])
            assert failure.value.status == status


def test_objects_need_nothing_but_the_functions_of_math(tmp_path: Path) -> None:
    if shutil.which("nm") is None:
        pytest.skip("nm is not on this machine")
    for file, text in codegen.render(samples.arm(), "c").items():
        (tmp_path / file).write_text(text, encoding="ascii")
    target = tmp_path / "arm.o"
    source = str(tmp_path / "arm.c")
    subprocess.run(["gcc", "-std=c99", "-fno-pic", "-c", source, "-o", str(target)], check=True)
    lines = subprocess.run(["nm", str(target)], capture_output=True, text=True, check=True)
    kinds: dict[str, set[str]] = {}
    for line in lines.stdout.splitlines():
        kind, name = line.split()[-2:]
        kinds.setdefault(kind, set()).add(name)
    assert kinds["U"] <= {"sin", "cos", "sqrt", "sincos", "_GLOBAL_OFFSET_TABLE_"}
    assert set(kinds) <= {"U", "T", "t", "R"}, "no writable data"


MAIN = """
#include "arm.h"
int main(void)
{
    const double q[2] = {0.3, -1.2}, v[2] = {0.8, 0.5}, u[2] = {1.0, -2.0}, bad[2] = {1e308, 0.0 / 0.0};
    double M[4], h[2], E[2], a[2];
    arm_mass_matrix(&arm_default_parameters, q, M);
    arm_bias(&arm_default_parameters, 0.5, q, v, h);
    arm_equations(&arm_default_parameters, 0.5, q, bad, M, h);
    arm_energy(&arm_default_parameters, bad, v, E);
    return arm_forward_dynamics(&arm_default_parameters, 0.5, q, v, u, a)
        + 2 * (arm_forward_dynamics(&arm_default_parameters, 0.5, bad, v, u, a) != ARM_NOT_FINITE_INPUT);
}
"""


def test_runs_clean_under_sanitizers(tmp_path: Path) -> None:
    for file, text in {**codegen.render(samples.arm(), "c"), "main.c": MAIN}.items():
        (tmp_path / file).write_text(text, encoding="ascii")
    program = str(tmp_path / "main")
    flags = ["-std=c99", "-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
    sources = [str(tmp_path / "main.c"), str(tmp_path / "arm.c")]
    built = subprocess.run(
        ["gcc", *flags, *sources, "-lm", "-o", program], capture_output=True, text=True, check=False
    )
    if built.returncode and "cannot find" in built.stderr:
        pytest.skip("the sanitizers' libraries are not on this machine")
    assert built.returncode == 0, built.stderr
    done = subprocess.run([program], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize(
    "text", [*samples.HOSTILE, "".join(map(chr, range(1, 256))), "\U0010ffff", "0\x007"]
)
def test_strings_are_exact(text: str) -> None:
    literal = c.string(text)
    assert literal.isascii()
    assert literal.isprintable()
    assert "?" not in literal
    inside = re.fullmatch(r'"((?:[^"\\]|\\[0-7]{3})*)"', literal)
    assert inside is not None
    octal = re.sub(r"\\([0-7]{3})", lambda x: chr(int(x[1], 8)), inside[1])
    assert octal.encode("latin-1") == text.encode("utf-8", "backslashreplace")


def tokens(text: str) -> list[str]:
    """What a C compiler sees: trigraphs and spliced lines first, comments and strings as one token."""
    for mark, letter in zip("=/'()!<>-", "#\\^[]|{}~", strict=True):
        text = text.replace(f"??{mark}", letter)
    text = text.replace("\\\n", "")
    pattern = r'/\*.*?\*/|//[^\n]*|"(?:[^"\\\n]|\\.)*"|\w+|\n|\S'
    found = re.findall(pattern, text, re.S)
    assert not any(x.startswith("//") for x in found)
    words = ["STRING" if x.startswith('"') else x for x in found if not x.startswith("/*")]
    return [x for x in words if x != "\n"]


@pytest.mark.parametrize("text", samples.HOSTILE, ids=range(len(samples.HOSTILE)))
def test_hostile_text_never_becomes_code(text: str) -> None:
    benign = codegen.render(samples.hostile("text"), "c")
    files = codegen.render(samples.hostile(text), "c")
    for name, expected in benign.items():
        assert files[name].isascii()
        assert files[name].replace("\n", "").isprintable()
        assert tokens(files[name]) == tokens(expected)
        assert "\\" not in "".join(re.findall(r"/\*.*?\*/", files[name], re.S))


def test_hostile_texts_compile_and_names_survive(compiler: str, tmp_path: Path) -> None:
    listed = tuple(Quantity(text, text, text) for text in samples.HOSTILE)
    assert len(listed) >= 40
    base = samples.hostile(" ".join(samples.HOSTILE))
    dag = Dag()
    steps: Any = dag.symbol("q", 0)
    for text in samples.HOSTILE:
        dag.label = text
        steps = dag.sin(steps * steps + 1)
    result = (Result("x", (1,), (steps,), ""),)
    labelled = assemble("labelled", "", (Argument("q", len(listed), ""),), result)
    parameters = tuple(replace(x, name=f"p{i}", value=1.0) for i, x in enumerate(listed))
    module = replace(
        base,
        positions=listed,
        velocities=listed,
        inputs=(),
        parameters=(*base.parameters, *parameters),
        programs=(*base.programs, labelled),
    )
    library = Compiled(codegen.render(module, "c"), "arm", tmp_path, compiler)
    for text, name in zip(samples.HOSTILE, library.names("q", len(listed)), strict=True):
        assert name == text.encode("utf-8", "backslashreplace").split(b"\0")[0]
