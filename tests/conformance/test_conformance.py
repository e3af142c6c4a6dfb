"""Every model in all coordinates through every command: no exception but `LinegraphError`, no nan, no inf.

A seeded sample of small models by default; every model of examples, documents and tests with ``--all-forms``,
and every robot of the example-robot-data wheel, fixed and floating, with ``--all-robots``.
"""

from __future__ import annotations

import functools
import random
from typing import TYPE_CHECKING

import pytest
from support.every_model import COORDINATES, QUESTIONS, derived, documented, every_model, robots

from linegraph import LinegraphError

if TYPE_CHECKING:
    from linegraph.derivation import Derivation

SMALL = (
    "double_pendulum",
    "cart_pole",
    "furuta",
    "four_bar",
    "slider_crank",
    "rolling_disc",
    "cart_pole_motor",
    "loudspeaker",
    "rlc_ladder",
    "new",
    "small",
    "tree1",
    "tree3",
    "loop1",
    "network2",
    "mixed1",
    "mixed3",
    *documented(),
)
"""Models that take little time."""

CELLS = 36
"""How many of their combinations with coordinates and commands are tried by default."""

UNREFUSED = COORDINATES[0]
"""In joint coordinates, or those that a model chooses itself, no command refuses it."""


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "robot" in metafunc.fixturenames:
        wanted = robots() if metafunc.config.getoption("--all-robots") else ()
        cells = [
            (name, kind, question)
            for name in wanted
            for kind in COORDINATES
            for question in QUESTIONS
        ]
        metafunc.parametrize(("robot", "coordinates", "question"), cells)
    elif "name" in metafunc.fixturenames:
        whole = metafunc.config.getoption("--all-forms")
        names = every_model() if whole else SMALL
        cells = [
            (name, kind, question)
            for name in names
            for kind in COORDINATES
            for question in QUESTIONS
        ]
        if not whole:
            cells = sorted(random.Random(1).sample(cells, CELLS))
        metafunc.parametrize(("name", "coordinates", "question"), cells)


@functools.lru_cache(maxsize=2)
def derivation(name: str, coordinates: str) -> Derivation | LinegraphError:
    """A model derived, or why it is refused."""
    make = every_model().get(name) or robots()[name]
    try:
        return derived(make, coordinates)
    except LinegraphError as error:
        return error


def ask(name: str, coordinates: str, question: str) -> None:
    """One question: an answer, or one sentence that says why there is none."""
    found = derivation(name, coordinates)
    refused = found if isinstance(found, LinegraphError) else None
    try:
        if not isinstance(found, LinegraphError):
            QUESTIONS[question](found)
    except LinegraphError as error:
        refused = error
    if refused is None:
        return
    if coordinates == UNREFUSED:
        raise refused
    assert str(refused).strip()
    assert "\n" not in str(refused)


def test_every_model_is_answered(name: str, coordinates: str, question: str) -> None:
    ask(name, coordinates, question)


@pytest.mark.robots
def test_every_robot_is_answered(robot: str, coordinates: str, question: str) -> None:
    try:
        ask(robot, coordinates, question)
    except LinegraphError as error:
        pytest.skip(f"refused: {error}")


def test_there_are_models_of_every_kind() -> None:
    """Examples, robots, random trees, closed systems, networks, mixtures, documents: more than a hundred."""
    names = every_model()
    assert set(SMALL) <= set(names)
    assert len(names) > 110
    assert len(documented()) >= 10
