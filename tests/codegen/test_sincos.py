"""The emitted files' own sine and cosine, against 40 digits: everywhere within 2 units in the last place."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from mpmath import libmp
from support import codegen_samples as samples
from support.compiled import Array, Compiled, available

import codegen
from codegen import Options
from linegraph.ir.dag import Dag
from linegraph.ir.program import Argument, Module, Result, assemble

if TYPE_CHECKING:
    from pathlib import Path

WAYS = {
    # compiler and flags: with and without fused multiplication, one number at a time and several
    "plain": ("gcc", ("-O1", "-ffp-contract=off")),
    "fast": ("gcc", ("-O3", "-march=native", "-ffp-contract=fast")),
    "not fused": ("gcc", ("-O3", "-march=native", "-ffp-contract=off")),
    "one": ("gcc", ("-O3", "-march=native", "-DONE_LANES=1")),
    "one, not fused": ("gcc", ("-O0", "-ffp-contract=off", "-DONE_LANES=1")),
    "four": ("clang", ("-O3", "-march=native", "-DONE_LANES=4")),
    "clang": ("clang", ("-O3", "-march=native", "-ffp-contract=fast")),
    "C++": ("g++", ("-O2",)),
}


def waves() -> Module:
    """bias(q): sine and cosine of both coordinates."""
    dag = Dag()
    q = [dag.symbol("q", i) for i in (0, 1)]
    entries = tuple(f(x) for x in q for f in (dag.sin, dag.cos))
    program = assemble("bias", "", (Argument("q", 2, ""),), (Result("h", (4,), entries, ""),))
    return samples.single(program)


def points() -> Array:
    """Everywhere up to 1e4 and beyond, around zeros and extremes, tiny, and what is not a number."""
    rng = np.random.default_rng(5)
    quarter = np.arange(-6400, 6400) * (math.pi / 2)
    near = [quarter, np.nextafter(quarter, 1e9), np.nextafter(quarter, -1e9), quarter * (1 + 1e-9)]
    middle = [quarter + math.pi / 4, np.nextafter(quarter + math.pi / 4, 1e9)]
    tiny = 10.0 ** rng.uniform(-320, 0, 3000)
    border = np.array([1e4, math.nextafter(1e4, 0), math.nextafter(1e4, 1e9), 1e4 + 1e-8])
    far = np.array([1e5, 1e10, 1e22, 1e300, 1.7976931348623157e308])
    special = np.array([0.0, -0.0, math.inf, -math.inf, math.nan, 5e-324, 2.2250738585072014e-308])
    drawn = [rng.uniform(-1e4, 1e4, 30000), rng.uniform(-4, 4, 30000), rng.uniform(-1e6, 1e6, 2000)]
    pieces = [*near, *middle, tiny, -tiny, border, -border, far, -far, special, *drawn]
    found = np.concatenate(pieces)
    return np.append(found, [1.0] * (len(found) % 2))


@pytest.fixture(scope="module")
def given() -> tuple[Array, list[tuple[int, ...]]]:
    """The points, and sine and cosine of each in 130 bits."""
    x = points()
    return x, [libmp.mpf_cos_sin(libmp.from_float(v), 130)[::-1] for v in x.tolist()]


def many(library: Compiled, x: Array) -> Array:
    """Sine and cosine of each point."""
    found = np.full((len(x), 2), 7.0)
    function = library.library["one_bias_batch"]
    function(len(x) // 2, x.ctypes.data_as(_pointers()), found.ctypes.data_as(_pointers()))
    return found


def _pointers() -> type:
    import ctypes

    return ctypes.POINTER(ctypes.c_double)


def units(found: float, exact: tuple[int, ...]) -> float:
    """The distance of a value from an exact one, in units in the last place of the exact one."""
    gap = libmp.mpf_sub(libmp.from_float(found), exact, 130)
    last = math.ulp(libmp.to_float(exact))
    return abs(libmp.to_float(libmp.mpf_div(gap, libmp.from_float(last), 53)))


@pytest.mark.one_in(4)
@pytest.mark.parametrize("way", WAYS)
def test_within_two_units_everywhere(
    way: str, given: tuple[Array, list[tuple[int, ...]]], tmp_path: Path
) -> None:
    compiler, flags = WAYS[way]
    if not available(compiler):
        pytest.skip(f"{compiler} is not installed")
    files = codegen.render(waves(), "c", Options(trig="inline", batch=True))
    x, exact = given
    assert len(x) > 100_000
    found = many(Compiled(files, "one", tmp_path, compiler, flags), x)
    finite = np.isfinite(x)
    assert np.isnan(found[~finite]).all()
    inside = np.flatnonzero(finite).tolist()
    assert max(units(found[i, k], exact[i][k]) for i in inside for k in (0, 1)) < 2.0
    zeros = x == 0
    assert np.array_equal(np.signbit(found[zeros, 0]), np.signbit(x[zeros]))
    assert (found[zeros, 1] == 1.0).all()


@pytest.mark.parametrize("lanes", ["-DONE_LANES=1", "-DONE_LANES=2", "-O2"])
def test_one_state_has_the_same(lanes: str, tmp_path: Path) -> None:
    """Angles beside each other within one state, some of them beyond the range."""
    files = codegen.render(waves(), "c", Options(trig="inline"))
    library = Compiled(files, "one", tmp_path, flags=(lanes, "-ffp-contract=off"))
    for a, b in [(0.3, -2.0), (1e5, 0.25), (-0.5, math.inf), (math.nan, 3.0), (9999.0, 1e22)]:
        h = library.call("bias", [a, b], out=[(4,)])
        for k, x in enumerate((a, b)):
            if math.isfinite(x):
                assert h[2 * k : 2 * k + 2] == pytest.approx([math.sin(x), math.cos(x)], abs=3e-16)
            else:
                assert np.isnan(h[2 * k : 2 * k + 2]).all()
