"""Options of the test suite."""

from __future__ import annotations

import gc
import sys
import zlib
from collections import Counter
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--all-robots",
        action="store_true",
        help="compare with Pinocchio on every URDF of the example-robot-data wheel, not on a few",
    )
    parser.addoption(
        "--all-forms",
        action="store_true",
        help="ask every random system, tree and form, not a few of each",
    )


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Seeds of tests that are marked with them: a few, or all with ``--all-forms``.

    What one seed is asked by different tests of a file is asked one after the other: it is derived once.
    """
    found = metafunc.definition.get_closest_marker("seeds")
    if found is not None:
        few, every = found.args
        wanted = every if metafunc.config.getoption("--all-forms") else few
        metafunc.parametrize("seed", wanted, scope="module")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Of a test marked with ``one_in(k)`` keep one case in k, or all with ``--all-forms`` or by name.

    Tests with the same cases begin at different ones, so that together they see most of them.
    """
    if config.getoption("--all-forms"):
        return
    seen: Counter[str] = Counter()
    kept, left_out = [], []
    for item in items:
        mark = item.get_closest_marker("one_in")
        name = item.nodeid.partition("[")[0]
        place = seen[name] + zlib.crc32(name.encode())
        seen[name] += 1
        chosen = mark is None or place % mark.args[0] == 0
        (kept if chosen or item.nodeid in config.args else left_out).append(item)
    if left_out:
        items[:] = kept
        config.hook.pytest_deselected(items=left_out)


def pytest_collection_finish() -> None:
    """Modules and tests live as long as the run: the garbage collector need not look at them again."""
    gc.collect()
    gc.freeze()


@pytest.fixture(autouse=True, scope="module")
def _forgotten(request: pytest.FixtureRequest) -> Iterator[None]:
    """What a file's tests have cached is let go after them: a run of all tests stays below 2 GiB.

    So are emitted modules: what is in `sys.modules` is never freed, and hypothesis reads its source.
    """
    yield
    for name, module in list(sys.modules.items()):
        if "pytest-of-" in str(getattr(module, "__file__", "")):
            del sys.modules[name]
    for value in vars(request.module).values():
        if hasattr(value, "cache_clear"):
            value.cache_clear()
    if "sympy" in sys.modules:
        from sympy.core.cache import clear_cache

        clear_cache()
    gc.collect()
