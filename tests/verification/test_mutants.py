"""Mutants of emitted C: golden vectors notice them, but for those that make no difference.

What they do not notice runs beside the original at further legal states and at corners, and must differ there
by less than rounding: no kind of mutant is excused by what it looks like.
"""

from __future__ import annotations

import random
import zlib
from typing import TYPE_CHECKING

from support import mutant_judge, mutants, targets

from linegraph.verification.golden.states import NO_ROUTE

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

MODELS = targets.everything()
EVERY = tuple(name for name in MODELS if not name.endswith(targets.MORE))
SAMPLE = ("cart_pole_motor", "slider_crank", "crane_hoist", "tree21", "network3", "mixed0")
COUNT = 10
"""Mutants of each model: sixty, and a thousand of all models."""

FEW = 3
"""Times twenty further states that survivors are asked at by default."""


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Six models, or all with ``--all-forms``."""
    if "name" in metafunc.fixturenames:
        every = metafunc.config.getoption("--all-forms")
        metafunc.parametrize("name", EVERY if every else SAMPLE)


def test_there_are_a_thousand() -> None:
    assert len(EVERY) >= 76
    assert len(EVERY) * COUNT >= 1000


def test_mutants_are_seen(name: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    """None is missed: what survives makes no difference, or less than rounding, at further states either."""
    every = request.config.getoption("--all-forms")
    subject = mutant_judge.subject(MODELS[name]())
    assert [x for x, why in subject.vectors.untested if why == NO_ROUTE] == []
    seeds = mutant_judge.SEEDS if every else FEW
    outcome = mutant_judge.judged(subject, COUNT, zlib.crc32(name.encode()), tmp_path, seeds)
    assert outcome.tried == COUNT
    assert [x for x in outcome.survivors if x[0] == "MISSED"] == []
    # the judge is not what kills them
    assert outcome.killed >= outcome.tried // 2


def test_the_judge_sees_what_golden_vectors_see(tmp_path: Path) -> None:
    """Every mutant that they notice differs beside the original: it would be missed if they did not."""
    subject = mutant_judge.subject(MODELS["network3"]())
    code = f"{mutant_judge.NAME}.c"
    chosen = mutants.mutants(subject.files[code], random.Random(1), 40)
    program = mutants.build(subject.files, mutant_judge.NAME, chosen, tmp_path)
    seen = [k for k in range(1, 41) if not mutants.run(program, k)[0]]
    beside = mutant_judge.Beside(subject, chosen, tmp_path / "beside")
    points = list(mutant_judge.states(subject, range(2)))
    found = mutant_judge.largest(beside, subject, points, seen)
    assert len(seen) > 20
    assert {mutant_judge.verdict(x) for x, _ in found.values()} == {"MISSED"}


def test_all_kinds_are_among_them() -> None:
    text = (
        "void f(void)\n{\n    const double t0 = 2.0 * q[1];\n    const double t1 = t0 + q[0];\n"
        "    const double t2 = t1 - q[1];\n}\n"
    )
    found = mutants.mutants(text, random.Random(0), 8)
    assert {x.kind for x in found} == set(mutants.KINDS)
    assert all(x.right != x.wrong for x in found)


def test_functions_take_turns() -> None:
    text = "".join(
        f"void {name}(void)\n{{\n" + f"    const double t0 = 2.0 * q[{k}];\n" * 9 + "}\n"
        for k, name in enumerate("fgh", 1)
    )
    found = mutants.mutants(text, random.Random(0), 6)
    assert sorted(x.function for x in found) == ["f", "f", "g", "g", "h", "h"]
    assert mutants.callers("void f(void)\n{\n}\nint g(void)\n{\n    f();\n}\n", "f") == {"f", "g"}


def test_one_at_a_time() -> None:
    text = "void f(void)\n{\n    const double t0 = 2.0 * q[1];\n}\n"
    found = mutants.mutants(text, random.Random(0), 1)
    assert f"= (lg_mutant == 1) ? ({found[0].wrong}) : (2.0 * q[1]);" in mutants.schemata(
        text, found
    )
