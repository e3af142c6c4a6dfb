"""Options of the test suite."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pytest


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
