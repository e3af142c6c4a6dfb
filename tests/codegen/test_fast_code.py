"""C that is fast to compile and to run: parts of long functions, order of lines, own sines, many states."""

from __future__ import annotations

import ctypes
import re
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from click.testing import CliRunner
from support import codegen_samples as samples
from support.compiled import COMPILERS, Array, Compiled, Failed, available, has_no_warnings
from support.emitted import load

import codegen
from codegen import Options
from codegen.c import parts
from linegraph.cli.main import main
from linegraph.emission.emit import module_for
from linegraph.ir.dag import Dag
from linegraph.ir.program import Module, Program, Result, assemble
from linegraph.readers import modelfile, urdf

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linegraph import Model

EXAMPLES = Path(__file__).parents[2] / "examples"
WAYS = {
    "libm": Options(),
    "inline": Options(trig="inline"),
    "batch": Options(batch=True),
    "both": Options(trig="inline", batch=True),
}
EXACT = ("-O1", "-ffp-contract=off")
PLAIN = ("-O0", "-ffp-contract=off")


def exact(name: str) -> tuple[str, ...]:
    """How to compile for results to the last bit; robots without optimizing, which takes a while."""
    return PLAIN if name in ("panda", "anymal") else EXACT


COUNTS = (0, 1, 2, 3, 4, 5, 7, 8, 9, 1000)
SWINGING = """
name = "swing"
[parameters]
m = 2.0
l = { value = 0.7, unit = "m" }
w = 3.0
[gravity]
acceleration = [0, 0, -9.81]
[body.bob]
mass = "m"
mass_center = [0, 0, "-l"]
inertia = { yy = 0.1 }
[body.slider]
mass = 0.5
[prismatic.rail]
between = ["ground", "slider"]
axis = [1, 0, 0]
motion = "0.1*sin(w*t)"
[revolute.hinge]
between = ["slider", "bob"]
axis = [0, -1, 0]
"""


def robot(name: str) -> Model:
    if name == "panda":
        return urdf.read(EXAMPLES / "panda" / "panda.urdf")
    return urdf.read(EXAMPLES / "anymal_c" / "anymal.urdf", base="floating")


def rough() -> Module:
    """Every function of the register, of one state and of time, mixed with numbers and parameters."""
    dag = Dag()
    q, v, m, t = dag.symbol("q", 0), dag.symbol("v", 1), dag.symbol("p", "m"), dag.symbol("t")
    swing = dag.sin(q * v + dag.cos(m * t)) * dag.cos(q * v + dag.cos(m * t))
    rest = (dag.function(name, 0.3 + 0.1 * q) for name in ("tan", "asin", "exp", "log", "sqrt"))
    twos = (dag.function("atan2", q, m), dag.function("min", m, q), dag.function("max", q, v))
    signs = (dag.function("sign", v), dag.function("abs", q), dag.function("tanh", v))
    late = dag.sin(swing * swing) + dag.cos(swing * swing)
    entries = (swing, late, *rest, *twos, *signs, dag.sin(t), m, 0, -2.5, dag.sin(q) + dag.sin(v))
    arguments = (samples.P, samples.T, samples.Q, samples.V)
    program = assemble("bias", "All.", arguments, (Result("h", (len(entries),), entries, ""),))
    base = samples.arm()
    return Module(
        "rough",
        (),
        base.positions,
        base.velocities,
        base.inputs,
        base.parameters,
        True,
        (program,),
    )


def module(name: str, tmp_path: Path) -> Module:
    if name == "arm":
        return samples.arm()
    if name == "rough":
        return rough()
    if name == "swing":
        path = tmp_path / "swing.toml"
        path.write_text(SWINGING)
        return module_for(modelfile.read(str(path)), "swing")
    if name == "rlc_ladder":
        return module_for(modelfile.read(str(EXAMPLES / name / f"{name}.toml")), name)
    return module_for(robot(name), name, folded=True)


def state(made: Module, program: Program, seed: int = 0, lead: tuple[int, ...] = ()) -> list[Any]:
    """Arguments as C takes them, quaternions of length 1."""
    rng = np.random.default_rng(seed)
    given: list[Any] = []
    for argument in program.arguments:
        if argument.name == "p":
            given.append(None)
        elif argument.size is None:
            given.append(0.4)
        elif argument.name == "c":
            # constants of a mass matrix are not any numbers
            given.append(rng.uniform(0.5, 1.5, argument.size))
        else:
            x = rng.uniform(-1.5, 1.5, (*lead, argument.size))
            if argument.name == "q" and argument.size > len(made.velocities):
                x[..., 3:7] /= np.linalg.norm(x[..., 3:7], axis=-1, keepdims=True)
            given.append(x)
    return given


def straight(made: Module) -> Iterator[Program]:
    return (x for x in made.programs if isinstance(x, Program))


def compare(made: Module, program: Program, library: Compiled, python: Any, exact: bool) -> None:
    given = state(made, program)
    names = [x.name for x in program.arguments]
    other = [
        python.DEFAULT_PARAMETERS if x == "p" else y for x, y in zip(names, given, strict=True)
    ]
    expected = getattr(python, program.name)(*other)
    found = library.call(program.name, *given, out=[x.shape for x in program.results])
    single = len(program.results) == 1
    pairs = [(found, expected)] if single else zip(found, expected, strict=True)
    for a, b in pairs:
        if exact:
            assert np.array_equal(a, b), program.name
        else:
            np.testing.assert_allclose(a, b, rtol=1e-13, atol=1e-12, err_msg=program.name)


def in_parts(request: pytest.FixtureRequest, name: str, size: int) -> None:
    """Hundreds of parts of the large robot are left to ``--all-forms``: small models have parts, too."""
    if name == "anymal" and size == 5 and not request.config.getoption("--all-forms"):
        pytest.skip("large: other sizes do")


@pytest.mark.one_in(4)
@pytest.mark.parametrize("size", [5, 60, 1000])
@pytest.mark.parametrize("name", ["arm", "swing", "rough", "panda", "anymal"])
def test_order_and_parts_do_not_change_a_bit(
    name: str,
    size: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    request: pytest.FixtureRequest,
) -> None:
    in_parts(request, name, size)
    monkeypatch.setattr(parts, "SIZE", size)
    made = module(name, tmp_path)
    files = codegen.render(made, "c")
    divided = "_part1(" in files[f"{name}.c"]
    assert divided or size > 5
    assert not divided or size < 1000 or name in ("panda", "anymal")
    library = Compiled(files, name, tmp_path, flags=exact(name))
    python = load(codegen.render(made, "python"), name, tmp_path)
    for program in straight(made):
        # NumPy's functions other than these may differ from the library's in the last place
        compare(made, program, library, python, exact=name != "rough")


@pytest.mark.parametrize("size", [5, 1000])
@pytest.mark.parametrize("name", ["arm", "swing", "rough", "anymal"])
def test_own_sines_are_those_of_the_library(
    name: str,
    size: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    request: pytest.FixtureRequest,
) -> None:
    in_parts(request, name, size)
    monkeypatch.setattr(parts, "SIZE", size)
    made = module(name, tmp_path)
    files = codegen.render(made, "c", WAYS["inline"])
    assert not re.search(r"t\d+ = (sin|cos)\(", files[f"{name}.c"])
    library = Compiled(files, name, tmp_path, flags=exact(name))
    python = load(codegen.render(made, "python"), name, tmp_path)
    for program in straight(made):
        compare(made, program, library, python, exact=False)


def test_large_functions_in_parts_are_right(tmp_path: Path) -> None:
    made = samples.large_module(8000)
    library = Compiled(codegen.render(made, "c"), "humanoid", tmp_path, flags=EXACT)
    python = load(codegen.render(made, "python"), "humanoid", tmp_path)
    for program in straight(made):
        compare(made, program, library, python, exact=True)


@pytest.mark.parametrize("size", [3, 1000])
def test_a_part_that_fails_leaves_the_results_alone(
    size: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(parts, "SIZE", size)
    made = samples.arm()
    library = Compiled(codegen.render(made, "c"), "arm", tmp_path)
    arguments: list[Any] = [0.4, [0.3, -1.2], [0.8, 0.5], [1.0, -2.0]]
    with pytest.raises(Failed):
        library.call("forward_dynamics", [-50.0, 0.0], *arguments, out=[(2,)])
    assert np.isfinite(library.call("forward_dynamics", None, *arguments, out=[(2,)])).all()


def test_sine_and_cosine_of_an_angle_are_neighbours() -> None:
    dag = Dag()
    q = [dag.symbol("q", i) for i in (0, 1)]
    dag.label = "one"
    first = dag.sin(q[0]) * q[1] + 1
    dag.label = "other"
    second = dag.cos(q[0]) * first + dag.cos(q[1])
    program = assemble("f", "", (samples.Q,), (Result("h", (2,), (first, second), ""),))
    source = codegen.render(samples.single(program), "c")["one.c"]
    assert "const double t0 = cos(q[0]);\n    /* one */\n    const double t1 = sin(q[0]);" in source


def test_a_cut_is_made_where_few_values_are_alive() -> None:
    made = samples.large_module(8000)
    program = next(x for x in made.programs if x.name == "equations")
    assert isinstance(program, Program)
    from codegen.c.order import arranged

    items = arranged(program, ())
    found = parts.cut(items)
    assert [x for part in found for x in part.items] == items
    assert max(sum(x.cost for x in part.items) for part in found) <= 2 * parts.SIZE
    places = parts.places(found, lambda index: "double")
    for number, part in enumerate(found):
        read = {places.of[x] for x in part.given}
        written = {places.of[x] for x in part.kept}
        assert len(read) == len(part.given)
        assert not read & written, number


# ---- many states


def batched(library: Compiled, name: str, given: list[Any], n: int, out: list[int]) -> list[Array]:
    """The results of a function of n states, guarded on both sides."""
    function = library.library[f"{library.name}_{name}_batch"]
    kept = [
        np.ascontiguousarray(x) if isinstance(x, np.ndarray) else library._pass(x) for x in given
    ]
    pointers = [x.ctypes.data_as(ctypes.c_void_p) if isinstance(x, np.ndarray) else x for x in kept]
    buffers = [np.full(n * size + 32, 7e300) for size in out]
    ends = [x[16:].ctypes.data_as(ctypes.c_void_p) for x in buffers]
    function.restype = None
    function(ctypes.c_int(n), *pointers, *ends)
    for buffer in buffers:
        assert (buffer[:16] == 7e300).all()
        assert (buffer[-16:] == 7e300).all()
        assert (buffer[16:-16] != 7e300).all()
    return [x[16:-16] for x in buffers]


@pytest.mark.one_in(6)
@pytest.mark.parametrize("lanes", [(), (2,), (4,), (8,), (1,)])
@pytest.mark.parametrize("name", ["arm", "swing", "rough", "panda", "anymal"])
def test_many_states_are_as_one_by_one(
    name: str, lanes: tuple[int, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if name == "anymal" and lanes not in ((), (4,)):
        pytest.skip("large: two widths do")
    if name == "rough":
        monkeypatch.setattr(parts, "SIZE", 5)
    made = module(name, tmp_path)
    keep = tuple(x for x in made.programs if x.name in codegen.c.batch.NAMES)
    made = Module(**{**vars(made), "programs": keep})
    flags = [f"-D{name.upper()}_LANES={x}" for x in lanes] or ["-march=native"]
    files = codegen.render(made, "c", WAYS["both"])
    optimize = "-O1" if name == "anymal" else "-O2"
    library = Compiled(files, name, tmp_path, flags=(optimize, "-ffp-contract=off", *flags))
    done = 0
    for program in straight(made):
        if f"{name}_{program.name}_batch(" not in files[f"{name}.h"]:
            continue
        done += 1
        sizes = [int(np.prod(x.shape)) for x in program.results]
        for n in COUNTS:
            given = state(made, program, n, (n,))
            found = batched(library, program.name, given, n, sizes)
            for i in sorted({0, 1, n // 2, n - 2, n - 1} & set(range(n))):
                one = [x[i] if isinstance(x, np.ndarray) else x for x in given]
                expected = library.call(program.name, *one, out=[(size,) for size in sizes])
                expected = expected if isinstance(expected, tuple) else (expected,)
                for a, b, size in zip(found, expected, sizes, strict=True):
                    np.testing.assert_allclose(
                        a[i * size : (i + 1) * size], b, rtol=1e-15, atol=1e-15 * abs(b).max()
                    )
    assert done == {"arm": 3, "swing": 4, "rough": 1, "panda": 4, "anymal": 4}[name]


def test_a_batch_that_reads_no_rows_compiles_without_a_warning(tmp_path: Path) -> None:
    """The clipper of the documents: what has a batch is a constant mass matrix, and nothing is gathered."""
    page = (EXAMPLES.parent / "docs" / "networks.md").read_text("utf-8")
    blocks = re.findall(r"^```toml\n(.*?)^```", page, re.M | re.S)
    text = next(block for block in blocks if 'name = "clipper"' in block)
    module = module_for(modelfile.parse(text.encode(), "clipper.toml"), "clipper")
    files = codegen.render(module, "c", WAYS["batch"])
    assert "clipper_mass_matrix_batch(" in files["clipper.h"]
    assert "_gather(" not in files["clipper.c"]
    Compiled(files, "clipper", tmp_path)  # warnings are errors


def test_the_header_says_what_cannot_be_had_for_many_states(tmp_path: Path) -> None:
    header = codegen.render(samples.arm(), "c", WAYS["batch"])["arm.h"]
    assert "void arm_equations_batch(int n,\n" in header
    assert "p and t are the same for all." in header.replace("\n * ", " ")
    assert "forward_dynamics.\n" in header
    assert "arm_forward_dynamics_batch" not in header
    assert "(n x NV x NV) the mass matrix" in header
    assert "_batch" not in codegen.render(samples.arm(), "c")["arm.h"]


@pytest.mark.one_in(6)
@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("name", ["arm", "swing", "rough", "panda", "rlc_ladder"])
def test_compiles_without_a_warning(name: str, compiler: str, tmp_path: Path) -> None:
    if not available(compiler):
        pytest.skip(f"{compiler} is not installed")
    made = module(name, tmp_path)
    for way in ("both",) if name == "panda" else ("inline", "batch", "both"):
        files = codegen.render(made, "c", WAYS[way])
        for flags in (("-O1",), ("-O2", "-march=native"), (f"-D{name.upper()}_LANES=1",)):
            if name == "arm":  # vector registers are chosen behind the syntax
                Compiled(files, name, tmp_path / way, compiler, flags)
            else:
                has_no_warnings(files, name, tmp_path / way, compiler, flags)


HARNESS = """
#include <stdio.h>
#include <stdlib.h>
#include "{name}.h"

int main(void)
{{
    int n, i;
    for (n = 0; n < 20; ++n) {{
        double *q = (double *)malloc(sizeof(double) * (size_t)(n * {upper}_NQ));
        double *v = (double *)malloc(sizeof(double) * (size_t)(n * {upper}_NV));
        double *M = (double *)malloc(sizeof(double) * (size_t)(n * {upper}_NV * {upper}_NV));
        double *h = (double *)malloc(sizeof(double) * (size_t)(n * {upper}_NV));
        for (i = 0; i < n * {upper}_NQ; ++i) q[i] = i % 7 == 3 ? 3e5 * i : 0.37 * i;
        for (i = 0; i < n * {upper}_NV; ++i) v[i] = 0.1 * i;
        {name}_equations_batch(n, {p}q, v, M, h);
        {name}_mass_matrix_batch(n, {mass}q, M);
        for (i = 0; i < n; ++i) {name}_equations({p}q + i * {upper}_NQ, v + i * {upper}_NV, M, h);
        free(q);
        free(v);
        free(M);
        free(h);
    }}
    return 0;
}}
"""


@pytest.mark.one_in(2)
@pytest.mark.parametrize(
    ("name", "flags"),
    [
        ("arm", "-O1"),
        ("arm", "-march=native"),
        ("arm", "-DARM_LANES=4"),
        ("panda", "-march=native"),
    ],
)
def test_sanitizers_find_nothing(name: str, flags: str, tmp_path: Path) -> None:
    upper = name.upper()
    for file, text in codegen.render(module(name, tmp_path), "c", WAYS["both"]).items():
        (tmp_path / file).write_text(text)
    p = "&arm_default_parameters, 0.5, " if name == "arm" else ""
    mass = "&arm_default_parameters, " if name == "arm" else ""
    (tmp_path / "main.c").write_text(HARNESS.format(name=name, upper=upper, p=p, mass=mass))
    command = ["gcc", "-std=c99", "-O1", "-g", "-fsanitize=address,undefined"]
    command += ["-fno-sanitize-recover=all", flags]
    command += ["main.c", f"{name}.c", "-lm", "-o", "main"]
    subprocess.run(command, cwd=tmp_path, check=True)
    done = subprocess.run([str(tmp_path / "main")], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


# ---- options


def test_python_does_not_depend_on_options_and_c_is_deterministic() -> None:
    made = samples.arm()
    assert len({codegen.render(made, "python", way)["arm.py"] for way in WAYS.values()}) == 1
    for way in WAYS.values():
        assert codegen.render(samples.arm(), "c", way) == codegen.render(made, "c", way)
        for text in codegen.render(made, "c", way).values():
            assert text.isascii()
            assert all(line == line.rstrip() for line in text.split("\n"))
            assert max(map(len, text.split("\n"))) <= 110


def test_the_command_line_takes_both(tmp_path: Path) -> None:
    path = tmp_path / "swing.toml"
    path.write_text(SWINGING)
    command = ["emit", str(path), "--out", str(tmp_path), "--trig", "inline", "--batch"]
    done = CliRunner().invoke(main, command)
    assert done.exit_code == 0, done.output
    assert "swing_equations_batch(int n" in (tmp_path / "swing.h").read_text()
    assert "swing_sincos(" in (tmp_path / "swing.c").read_text()
    assert "many states at once in C" not in (tmp_path / "swing.py").read_text()
    text = CliRunner().invoke(main, ["emit", "--help"], env={"COLUMNS": "100"}).output
    assert "--trig [libm|inline]" in text
    assert "--batch" in text
    wrong = CliRunner().invoke(main, ["emit", str(path), "--trig", "fast"])
    assert wrong.exit_code == 2
