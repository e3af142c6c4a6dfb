"""A hundred emitted models: no warning, no report of a sanitizer, no heap, floats as good as they can be.

A dozen by default, all with ``--all-forms``.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support import targets
from support.targets import COMPILERS, WARNINGS

if TYPE_CHECKING:
    from pathlib import Path

DOZEN = (
    "panda",
    "double_pendulum",
    "crane",
    "condenser_microphone",
    "four_bar",
    "rolling_disc",
    "ring_modulator",
    "tree3",
    "tree22",
    "loop1",
    "network3",
    "mixed1",
    "furuta+",
    "four_bar+",
)
CALLS, FEW_CALLS = 1_000_000, 100_000
"""Calls of functions under sanitizers, over all models together; of a dozen."""

HEAP = re.compile(r"\b(_?(m|c|re)alloc\w*|free|alloca|_Znw\w*|_Zdl\w*|aligned_alloc|brk|sbrk)\b")
DIVIDES = re.compile(r"panda(_floating)?$|anymal|tree")
"""Models without networks, loops and massless bodies of symbolic mass: no division by zero is called for."""

NAMES = tuple(targets.everything())

NUMBERS = {"gcc": ("double", "float"), "clang": ("float",), "g++": ("double",), "arm": ("float",)}
"""What each compiler is given: the words that differ between the two are few."""


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    wanted = NAMES if metafunc.config.getoption("--all-forms") else DOZEN
    if "name" in metafunc.fixturenames:
        metafunc.parametrize("name", wanted)
    if "sanitized" in metafunc.fixturenames:
        metafunc.parametrize("sanitized", wanted if wanted is NAMES else DOZEN[1::2])


def test_there_are_a_hundred() -> None:
    assert len(NAMES) >= 100
    assert set(DOZEN) <= set(NAMES)


@pytest.mark.one_in(4)
@pytest.mark.parametrize("compiler", COMPILERS)
def test_no_compiler_warns(name: str, compiler: str, tmp_path: Path) -> None:
    lacking = targets.missing(COMPILERS[compiler][0])
    if lacking:
        pytest.skip(lacking)
    for real in NUMBERS[compiler]:
        folder = tmp_path / real
        # what is only seen on the way to faster code, gcc sees
        flags = (*WARNINGS, "-O1" if compiler in ("gcc", "arm") else "-O0")
        made = targets.compiled(targets.emitted(name, real), folder, COMPILERS[compiler], flags)
        nm = "arm-none-eabi-nm" if compiler == "arm" else "nm"
        needed = targets.run([nm, "--undefined-only", made.name], folder)
        assert not HEAP.search(needed), needed
        if compiler == "arm":
            # helpers for doubles, and functions of doubles, would be undefined symbols
            assert not re.search(
                r"__aeabi_(d|f2d|i2d|ui2d|l2d|ul2d)|\b(sin|cos|sqrt|fabs|exp)$", needed, re.M
            )


@pytest.mark.one_in(4)
def test_sanitizers_find_nothing(
    sanitized: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    every = request.config.getoption("--all-forms")
    calls, count = (CALLS, len(NAMES)) if every else (FEW_CALLS, len(DOZEN[1::2]))
    module = targets.module(sanitized)
    turns = -(-calls // (count * len(module.programs) * 2))
    checks = "address,undefined,float-cast-overflow"
    if DIVIDES.match(sanitized):
        checks += ",float-divide-by-zero"
    flags = ("-O0", f"-fsanitize={checks}", "-fno-sanitize-recover=all")
    for real in ("double", "float"):
        files = targets.emitted(sanitized, real)
        made = targets.compiled(files, tmp_path / real, COMPILERS["gcc"], flags)
        said = targets.on_this_machine(targets.harness(module, [], real, turns), made, flags)
        assert said.startswith("sum 0 ")


@pytest.mark.one_in(4)
def test_floats_are_as_good_as_floats_can_be(name: str, tmp_path: Path) -> None:
    module = targets.module(name)
    rng = np.random.default_rng(1)
    states = [targets.drawn(module, rng) for _ in range(4)]
    around = [
        x for s in states for x in (s, *(targets.shaken(s, rng) for _ in range(targets.SHAKES)))
    ]
    said = {}
    for real, at in (("double", around), ("float", states)):
        made = targets.compiled(
            targets.emitted(name, real), tmp_path / real, COMPILERS["gcc"], ("-O1",)
        )
        said[real] = targets.on_this_machine(targets.harness(module, at, real), made)
    assert targets.misfits(module, len(states), said["double"], said["float"]) == []
