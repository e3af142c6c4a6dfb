"""Emitted C of whole models: clean under every compiler, and under sanitizers for 2e4 calls."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.compiled import COMPILERS, WARNINGS, Compiled, available, has_no_warnings
from support.spec_models import model_of
from systems import random_trees as trees

from linegraph.emission.emit import render
from linegraph.readers import urdf

if TYPE_CHECKING:
    from linegraph import Model

EXAMPLES = Path(__file__).parents[2] / "examples"
CALLS = 20_000

HARNESS = """
#include <stdio.h>
#include "{name}.h"

static unsigned long long state = 88172645463325252ULL;

static double draw(void)
{{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) / 4503599627370496.0 - 1.0;
}}

int main(void)
{{
    double q[{upper}_NQ], v[{upper}_NV], a[{upper}_NV], u[{upper}_NU + 1];
    double M[{upper}_NV * {upper}_NV], h[{upper}_NV], E[2], rates[{upper}_NQ], sum = 0.0;
    for (int call = 0; call < {calls}; ++call) {{
        for (int i = 0; i < {upper}_NQ; ++i) q[i] = draw();
        for (int i = 0; i < {upper}_NV; ++i) v[i] = draw();
        for (int i = 0; i < {upper}_NU; ++i) u[i] = draw();
        {name}_mass_matrix({p}q, M);
        {name}_bias({p}q, v, h);
        {name}_equations({p}q, v, M, h);
        {name}_coordinate_rates({p}q, v, rates);
        {name}_energy({p}q, v, E);
        if ({name}_forward_dynamics({p}q, v, u, a) == 0)
            {name}_inverse_dynamics({p}q, v, a, h);
        sum += h[0] + E[0];
    }}
    printf("%g\\n", sum);
    return 0;
}}
"""


def models() -> dict[str, Model]:
    """Small and large, fixed and floating, numbers and symbols."""
    rng = np.random.default_rng(11)
    return {
        "panda": urdf.read(EXAMPLES / "panda" / "panda.urdf"),
        "panda_symbolic": urdf.read(EXAMPLES / "panda" / "panda.urdf", symbolic=True),
        "anymal": urdf.read(EXAMPLES / "anymal_c" / "anymal.urdf", base="floating"),
        "random_tree": model_of(trees.random_tree(rng, bodies=7)),
    }


@pytest.fixture(scope="module")
def emitted() -> dict[str, dict[str, str]]:
    return {name: render(m, name=name, languages=["c"]) for name, m in models().items()}


@pytest.mark.one_in(2)
@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("name", ["panda", "panda_symbolic", "anymal", "random_tree"])
def test_compiles_without_a_warning(
    name: str, compiler: str, emitted: dict[str, dict[str, str]], tmp_path: Path
) -> None:
    if not available(compiler):
        pytest.skip(f"{compiler} is not installed")
    has_no_warnings(emitted[name], name, tmp_path, compiler, ("-O2",))


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", ["random_tree", "panda_symbolic"])
def test_sanitizers_find_nothing(
    name: str, emitted: dict[str, dict[str, str]], tmp_path: Path
) -> None:
    parameters = f"&{name}_default_parameters, " if name == "panda_symbolic" else ""
    for file, text in emitted[name].items():
        (tmp_path / file).write_text(text)
    harness = HARNESS.format(name=name, upper=name.upper(), p=parameters, calls=CALLS)
    (tmp_path / "harness.c").write_text(harness)
    program = tmp_path / "harness"
    command = ["gcc", "-std=c99", "-O1", "-g", "-fsanitize=address,undefined,float-cast-overflow"]
    command += [
        "-fno-sanitize-recover=all",
        "-Wall",
        "-Wextra",
        "-Werror",
        "harness.c",
        f"{name}.c",
    ]
    subprocess.run([*command, "-lm", "-o", str(program)], cwd=tmp_path, check=True)
    done = subprocess.run([str(program)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert np.isfinite(float(done.stdout))


def test_needs_nothing_but_the_mathematics_library(
    emitted: dict[str, dict[str, str]], tmp_path: Path
) -> None:
    """No heap, no I/O, no globals that change: the object file's own symbols say so."""
    for file, text in emitted["anymal"].items():
        (tmp_path / file).write_text(text)
    warnings = [w for w in WARNINGS if w != "-Werror"]
    command = ["gcc", "-std=c99", "-O2", "-Wvla", *warnings, "-c", "anymal.c"]
    subprocess.run(command, cwd=tmp_path, check=True)
    table = subprocess.run(
        ["nm", "anymal.o"], cwd=tmp_path, check=True, capture_output=True, text=True
    ).stdout
    rows = [line.split() for line in table.splitlines()]
    needed = {row[-1] for row in rows if row[-2] == "U"}
    kinds = {row[-2] for row in rows}
    assert needed <= {"sin", "cos", "sincos", "sqrt"}, needed
    assert kinds <= {"U", "T", "t", "R", "r", "D", "d"}
    writable = {row[-1] for row in rows if row[-2] in "Dd"}
    assert (
        writable <= {f"anymal_{x}_names" for x in (*"qvu", "across", "reaction", "state")}
        or not writable
    )


def test_a_singular_mass_matrix_is_a_status(tmp_path: Path) -> None:
    from linegraph import Model

    model = Model("gimbal")
    inner = model.body("inner")
    rod = model.body("rod", mass=1.0, mass_center=(0, 0, 1))
    model.revolute("azimuth", between=("ground", inner), axis=(0, 0, 1))
    model.revolute("tilt", between=(inner, rod), axis=(1, 0, 0))
    compiled = Compiled(render(model, languages=["c"]), "gimbal", tmp_path)
    function = compiled.library["gimbal_forward_dynamics"]
    upright, moved = (np.array(x) for x in ([0.3, 0.0], [0.3, 0.4]))
    zero, result = np.zeros(2), np.full(2, 7.0)
    pointers = [x.ctypes.data for x in (upright, zero, zero, result)]
    import ctypes

    function.argtypes = [ctypes.c_void_p] * 4
    assert function(*pointers) == 1
    assert np.array_equal(result, [7.0, 7.0])
    pointers[0] = moved.ctypes.data
    assert function(*pointers) == 0
    assert np.all(np.isfinite(result))
