"""Mutants of emitted C: golden vectors notice them, but for those that make no difference."""

from __future__ import annotations

import random
import re
import zlib
from typing import TYPE_CHECKING

import mutants
from test_golden import FILES, read

from linegraph.emission import render
from linegraph.errors import ModelError
from linegraph.programs import ON_REQUEST

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

    from linegraph.model import Model

SAMPLE = ("cart_pole_motor", "slider_crank", "crane_hoist")
EVERY = tuple(
    x for x in ON_REQUEST if x not in ("frames", "operational_space", "operational_position")
)
COUNT = 14

EQUIVALENT = re.compile(r"^(?:0\.5|1\.0) ?(?:/ largest)?$|^fmax\(|^fabs\(|kept\[|exp\(")
"""Steps of iterations, bounds of pivots, what parts hand on for a status, 1 beside an exponential."""


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Examples: three, or all with ``--all-forms``."""
    if "name" in metafunc.fixturenames:
        every = metafunc.config.getoption("--all-forms")
        metafunc.parametrize("name", FILES if every else SAMPLE)


def everything(model: Model, name: str) -> dict[str, str]:
    """The C of as many functions as the model has, with golden vectors."""
    wanted = list(EVERY)
    while True:
        try:
            return render(model, name=name, languages=["c"], functions=wanted, tests=True)
        except ModelError as error:
            refused = [x for x in wanted if f'"{x}"' in str(error)] or [
                x for x in wanted if "derivatives" in x or x == "linearize"
            ]
            if not refused:
                raise
            wanted.remove(refused[0])


def test_mutants_are_seen(name: str, tmp_path: Path) -> None:
    """Of fourteen at most three make no difference at legal states; none of these is of M, h or forces."""
    files = everything(read(name), name)
    draw = random.Random(zlib.crc32(name.encode()))
    chosen = mutants.mutants(files[f"{name}.c"], draw, COUNT)
    program = mutants.build(files, name, chosen, tmp_path)
    assert mutants.run(program, 0)[0]
    survivors = [x for k, x in enumerate(chosen, 1) if mutants.run(program, k)[0]]
    told = [f"{x.function}: {x.right} => {x.wrong}" for x in survivors]
    essential = ("mass_matrix", "bias", "equations", "inverse_dynamics", "energy", "reactions_at")
    serious = [
        text
        for x, text in zip(survivors, told, strict=True)
        if x.function.removeprefix(f"{name}_").removesuffix("_prepared") in essential
        and not EQUIVALENT.search(x.right)
    ]
    assert serious == []
    assert len(survivors) <= 3, "\n".join(told)
    assert len(chosen) == COUNT


def test_all_kinds_are_among_them() -> None:
    text = (
        "void f(void)\n{\n    const double t0 = 2.0 * q[1];\n    const double t1 = t0 + q[0];\n"
        "    const double t2 = t1 - q[1];\n}\n"
    )
    found = mutants.mutants(text, random.Random(0), 8)
    assert {x.kind for x in found} == set(mutants.KINDS)
    assert all(x.right != x.wrong for x in found)


def test_one_at_a_time() -> None:
    text = "void f(void)\n{\n    const double t0 = 2.0 * q[1];\n}\n"
    found = mutants.mutants(text, random.Random(0), 1)
    assert f"= (lg_mutant == 1) ? ({found[0].wrong}) : (2.0 * q[1]);" in mutants.schemata(
        text, found
    )
