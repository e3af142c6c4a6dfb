"""Algebraic loops with one solution are solved: saturations, dead zones, diodes, limits, kinks of sources.

The networks are drawn around a solution (`monotone_networks`), so that nothing here repeats the derivation.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from compiled import Compiled, Failed
from emitted import load
from monotone_networks import Drawn, draw

from linegraph import Model, derive
from linegraph.emission import render
from linegraph.modelfile import parse

if TYPE_CHECKING:
    from collections.abc import Callable

SEEDS = 3000
CHUNK = 20
CLOSE = 1e-6


def sizes(drawn: Drawn) -> np.ndarray:
    """What each output is compared with: the largest across and through variable."""
    x = max(abs(edge.x) for edge in drawn.edges)
    y = max(abs(edge.y) for edge in drawn.edges)
    return np.array([x, y] * len(drawn.edges))


@pytest.mark.seeds(range(0, SEEDS, SEEDS // 3), range(0, SEEDS, CHUNK))
def test_the_chosen_solution_is_found_in_c_and_in_python(seed: int, tmp_path: Path) -> None:
    for number in range(seed, seed + CHUNK):
        drawn = draw(number)
        model = drawn.model()
        # what is no part of the network keeps it company, so that there is a state
        model.capacitor("clock", ("alone", "ground"), capacitance=1.0)
        model.resistor("spring", ("alone", "ground"), resistance=1.0)
        files = render(model, name=f"m{number}", only=["outputs"])
        c = Compiled(files, f"m{number}", tmp_path / str(number), flags=("-O0",))
        python = load(files, f"m{number}", tmp_path / str(number))
        v = [drawn.state.get(state, 0.0) for state in python.V_NAMES]
        given = [[], v, drawn.inputs] if "u" in python.outputs.__code__.co_varnames else [[], v]
        expected = np.array(drawn.expected())
        for found in (python.outputs(*given), c.call("outputs", *given, out=[expected.shape])):
            error = np.abs(np.asarray(found) - expected) / sizes(drawn)
            assert np.max(error) <= CLOSE, number
