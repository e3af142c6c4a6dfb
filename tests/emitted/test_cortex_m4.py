"""Emitted floats on a Cortex-M4, run by QEMU: the results are those of this machine."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support import targets
from support.targets import COMPILERS, WARNINGS

if TYPE_CHECKING:
    from pathlib import Path

MODELS = ("double_pendulum", "crane", "four_bar", "condenser_microphone", "tree3", "loop1", "panda")
ACCURACY = 1e-5
ROUNDINGS = 30
"""How many times what rounding its arguments does a function may be off; see docs/embedding.md."""

pytestmark = pytest.mark.skipif(
    bool(targets.missing("arm-none-eabi-gcc", "qemu-system-arm")),
    reason=targets.missing("arm-none-eabi-gcc", "qemu-system-arm"),
)


@pytest.mark.one_in(4)
@pytest.mark.parametrize(
    ("name", "optimised"),
    [
        *((name, "-O2") for name in MODELS),
        ("four_bar+", "-Os"),
        ("furuta+", "-O2"),
        ("crane", "-O0"),
    ],
)
def test_results_are_those_of_this_machine(name: str, optimised: str, tmp_path: Path) -> None:
    module = targets.module(name)
    rng = np.random.default_rng(3)
    states = [targets.drawn(module, rng) for _ in range(4)]
    text = targets.harness(module, states, "float")
    files = targets.emitted(name, "float")
    flags = (*WARNINGS, optimised)
    board = targets.compiled(files, tmp_path / "board", COMPILERS["arm"], flags)
    here = targets.compiled(files, tmp_path / "here", COMPILERS["gcc"], ("-O1",))
    found = targets.shown(targets.on_cortex_m4(text, board))
    wanted = targets.shown(targets.on_this_machine(text, here))
    beside = []
    for _ in range(3):
        shaken = targets.harness(module, [targets.shaken(s, rng) for s in states], "float")
        beside.append(targets.shown(targets.on_this_machine(shaken, here)))
    assert [row[:2] for row in found] == [row[:2] for row in wanted]
    assert len(found) >= len(states) * (len(module.programs) - 1)
    for k, ((function, status, own), (_, _, other)) in enumerate(zip(found, wanted, strict=True)):
        if status == 0:
            # both round as they go, the board with fused multiplications; where a function is badly
            # conditioned, that may be some times what rounding its arguments does
            near = [row[2] - other for row in (rows[k] for rows in beside) if row[1] == 0]
            moved = max((np.abs(x).max(initial=0.0) for x in near), default=0.0)
            size = np.abs(other).max(initial=0.0)
            most = max(ACCURACY * size, ROUNDINGS * moved)
            assert np.abs(own - other).max(initial=0.0) <= most, function


@pytest.mark.parametrize("name", ["panda", "four_bar+", "ring_modulator"])
def test_nothing_is_computed_in_doubles(name: str, tmp_path: Path) -> None:
    made = targets.compiled(targets.emitted(name, "float"), tmp_path, COMPILERS["arm"], ("-O2",))
    code = targets.run(["arm-none-eabi-objdump", "-d", "-r", made.name], tmp_path)
    assert "vmul.f32" in code
    assert not re.search(
        r"\.f64|__aeabi_\w*d\w*2?|__aeabi_f2d", re.sub(r"__aeabi_mem\w+", "", code)
    )


def test_doubles_would_be_seen(tmp_path: Path) -> None:
    """What the test above looks for is there where doubles are."""
    files = targets.emitted("double_pendulum")
    made = targets.compiled(files, tmp_path, COMPILERS["arm"], ("-O2",))
    assert "__aeabi_dmul" in targets.run(["arm-none-eabi-objdump", "-d", "-r", made.name], tmp_path)
