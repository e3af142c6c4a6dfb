"""Emitted files beside each other: in one translation unit, and under names that meet those of the checks."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from conformance.test_golden import build, corrupted, read, run
from support import targets
from support.codegen_samples import with_parameters
from support.compiled import COMPILERS, WARNINGS

from codegen import naming
from linegraph import Model
from linegraph.emission.emit import render
from linegraph.errors import NameRefused
from linegraph.readers import modelfile

if TYPE_CHECKING:
    from pathlib import Path


def rubbing() -> Model:
    """A joint whose friction jumps."""
    model = Model("rubbing")
    bob = model.body("bob", mass=2.0, mass_center=(0, 0, -0.5))
    model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
    model.spring("brake", joint="hinge", force="0.1*sign(v)")
    return model


LOOP = b"""name = "clipper"
[resistor.R]
between = ["a", "ground"]
resistance = 1000.0
[diode.D]
between = ["a", "b"]
saturation = 1e-12
[capacitor.C]
between = ["b", "ground"]
capacitance = 1e-6
"""
"""A network with an algebraic loop: Newton's method is emitted."""


# ---- one translation unit


@pytest.mark.parametrize("compiler", ["gcc", "g++"])
def test_many_files_are_one_translation_unit(compiler: str, tmp_path: Path) -> None:
    """Two mechanisms with loops, and each kind of helper of the file's own twice."""
    lacking = targets.missing(compiler)
    if lacking:
        pytest.skip(lacking)
    files = dict(render(read("slider_crank"), name="slider_crank", languages=["c"]))
    for name in ("first", "second"):
        files |= render(read("four_bar"), name=f"{name}_bar", languages=["c"])
        files |= render(modelfile.parse(LOOP, "clipper.toml"), name=f"{name}_loop", languages=["c"])
        files |= render(rubbing(), name=f"{name}_rub", languages=["c"], trig="inline", batch=True)
    for file, text in files.items():
        (tmp_path / file).write_text(text)
    text = "".join(files.values())
    for helper in ("least_norm", "determined", "size_of", "is_rounding", "sign_of", "RANK_TOO_LOW"):
        assert helper in text
    sources = sorted(file for file in files if file.endswith(".c"))
    (tmp_path / "all.c").write_text("".join(f'#include "{file}"\n' for file in sources))
    warnings = [x for x in WARNINGS if x in ("-Wall", "-Wextra", "-Werror")]
    targets.run([*COMPILERS[compiler], *warnings, "-c", "all.c", "-o", "all.o"], tmp_path)


# ---- what checks the files


@pytest.mark.parametrize("prefix", ["test", "given", "expected", "scale", "load", "out"])
def test_a_prefix_meets_no_name_of_the_check(prefix: str, tmp_path: Path) -> None:
    files = render(
        rubbing(),
        name="rubbing",
        prefix=prefix,
        languages=["c"],
        functions=("momentum",),
        frames=("bob",),
        tests=True,
    )
    status, lines = run(build(files, "rubbing", tmp_path, *WARNINGS))
    assert status == 0, "\n".join(lines)


def test_floats_hold_where_double_has_four_bytes(tmp_path: Path) -> None:
    """As on AVR: the tolerance is that of floats, and what is wrong by more is still seen."""
    files = render(read("cart_pole"), name="cart", languages=["c"], tests=True, real="float")
    right = files["cart.c"]
    wrong = corrupted(right, "cart_energy", r"0\.5", "0.501")
    short = "#include <math.h>\n#include <stdio.h>\n#define double float\n"
    short += '#include "code.c"\n#include "check.c"\n'
    for source, expected in ((right, 0), (wrong, 1)):
        written = {
            "cart.h": files["cart.h"],
            "code.c": source,
            "check.c": files["cart_test.c"],
            "cart_test.c": short,
            "cart.c": "typedef int nothing;\n",
        }
        status, lines = run(build(written, "cart", tmp_path))
        assert status == expected, "\n".join(lines)
        assert "tolerance 1.0e-04" in lines[0]


@pytest.mark.parametrize("name", ["pytest", "_pytest", "conftest"])
def test_a_file_that_would_hide_pytest_is_refused(name: str) -> None:
    with pytest.raises(NameRefused):
        render(rubbing(), name=name, tests=True)
    assert naming.identifier("pytest") == "x_pytest"


@pytest.mark.parametrize("switch", ["TEST_REAL", "TEST_NO_STDIO"])
def test_a_parameter_is_no_switch_of_the_check(switch: str) -> None:
    naming.validate(replace(with_parameters(switch), name="arm"))
    with pytest.raises(NameRefused, match="macro of the emitted files"):
        naming.validate(replace(with_parameters(f"ARM_{switch}"), name="arm"))
