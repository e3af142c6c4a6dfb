"""Stack that headers state: never less than what compilers take, and not much more.

Compilers say what a frame takes and who calls whom (-fcallgraph-info=su); the sum along the deepest chain of
calls is measured, for this machine and for a Cortex-M4, without optimisation and with all of it.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest
import targets
from targets import CORTEX_M4

import codegen
from codegen import stack

if TYPE_CHECKING:
    from pathlib import Path

FEW = ("furuta+", "four_bar+", "network3")
LEVELS = ("-O0", "-O2", "-O3")
MACHINES = {"gcc": ("gcc",), "arm": ("arm-none-eabi-gcc", *CORTEX_M4)}
NAMES = tuple(targets.everything())

MOST, SMALL = 3, 448
"""How many times what is measured may be stated, or how many bytes more."""


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "name" in metafunc.fixturenames:
        every = metafunc.config.getoption("--all-forms")
        metafunc.parametrize("name", NAMES if every else FEW)


def stated(header: str) -> dict[str, int]:
    """What a header says of each of its functions."""
    pattern = r"Takes at most (\d+) bytes of stack\.\n \*/\n(?:void|int) (\w+)\("
    return {name: int(size) for size, name in re.findall(pattern, header)}


def measured(folder: Path, machine: str, flags: tuple[str, ...]) -> dict[str, int]:
    """What each function takes with all that it calls, math functions left out."""
    command = [*MACHINES[machine], "-std=c99", *flags, "-fcallgraph-info=su", "-c", "model.c"]
    targets.run([*command, "-o", "model.o"], folder)
    graph = (folder / "model.ci").read_text()
    nodes = re.findall(r'node: \{ title: "([^"]+)" label: "[^"]*?(\d+) bytes \(([\w,]+)\)', graph)
    assert {kind for _, _, kind in nodes} <= {"static", "dynamic,bounded"}
    own = {name: int(size) for name, size, _ in nodes}
    calls: dict[str, set[str]] = {}
    for source, target in re.findall(
        r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"', graph
    ):
        calls.setdefault(source, set()).add(target)

    def depth(name: str, above: tuple[str, ...] = ()) -> int:
        assert name not in above, "recursion"
        below = [depth(x, (*above, name)) for x in calls.get(name, ()) if x in own]
        return own[name] + max(below, default=0)

    return {name.rpartition(":")[2]: depth(name) for name in own}


@pytest.mark.parametrize("real", ["double", "float"])
def test_stack_is_stated_and_kept(name: str, real: str, tmp_path: Path) -> None:
    lacking = targets.missing("gcc", "arm-none-eabi-gcc")
    if lacking:
        pytest.skip(lacking)
    files = targets.emitted(name, real)
    for file, text in files.items():
        (tmp_path / file).write_text(text)
    said = stated(files["model.h"])
    assert set(said) == {f"model_{program.name}" for program in targets.module(name).programs}
    taken = {(m, o): measured(tmp_path, m, (o,)) for m in MACHINES for o in LEVELS}
    for function, size in said.items():
        found = {way: sizes[function] for way, sizes in taken.items()}
        worst = max(found.values())
        assert worst <= size, (function, found)
        assert size <= max(MOST * worst, worst + SMALL), (function, found)


@pytest.mark.parametrize("flags", [("-mavx512f",), ("-DMODEL_LANES=1",)])
@pytest.mark.parametrize("model", ["double_pendulum", "panda"])
def test_stack_of_vector_registers(model: str, flags: tuple[str, ...], tmp_path: Path) -> None:
    options = codegen.Options(trig="inline", batch=True)
    files = codegen.render(targets.module(model), "c", options)
    for file, text in files.items():
        (tmp_path / file).write_text(text)
    said = stated(files["model.h"])
    for level in ("-O0", "-O2"):
        taken = measured(tmp_path, "gcc", (level, *flags))
        for function, size in said.items():
            assert taken[function] <= size, (function, level)


def test_sizes_are_read_as_they_are_written() -> None:
    source = """
static int helper(const int n, double *const A)
{
    enum { N = ARM_NV, C = 2 };
    static const int place[3] = {0, 1, 2};
    double B[(N + C) * (N + 1)] = {0};
    const float *const row = &B[n];
    for (int i = 0; i < n; ++i) {
        A[i] = 0.0;
    }
}

void arm_all(const double q[ARM_NQ])
{
    const double t0 = 1.0, /* double not[99]; */ unused;
    helper(1, q);
}
"""
    found = stack.bounds(source, {"ARM_NV": 3, "ARM_NQ": 3})
    variables = 8 * 5 * 4 + 8 + 4
    own = (
        stack.CALL
        + 2 * 8
        + variables * 5 // 4
        + 8 * source.split("void", maxsplit=1)[0].count(";")
        - 8
    )
    assert found["helper"] == -(-own // 8) * 8
    assert found["arm_all"] > found["helper"]
