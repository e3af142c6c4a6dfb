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
