"""Newton's method for the algebraic loops of a network, in floats: the reference of what is emitted."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from linegraph.algebra import Floats
from linegraph.differentiation import Replay
from linegraph.errors import ModelError
from linegraph.network.static import LOOP

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.differentiation import Symbol
    from linegraph.network.network import Network

MOST_STEPS = 200
MOST_HALVINGS = 40
ENOUGH = 1e-14
"""A step below this fraction of an unknown's size is rounding."""


def solved(network: Network, known: Callable[[Symbol], float]) -> list[float]:
    """The unknowns of a network's algebraic loop, from zero on.

    Raises:
        ModelError: no solution was found.
    """
    import numpy as np

    size = len(network.loop)
    x = [0.0] * size

    def evaluate(at: list[float]) -> tuple[list[float], list[list[float]]]:
        replay = Replay(Floats(), lambda s: at[s[1]] if s[0] == LOOP else known(s))
        return (
            [float(replay(r)) for r in network.loop],
            [[float(replay(e)) for e in row] for row in network.loop_jacobian],
        )

    residual, jacobian = evaluate(x)
    for _ in range(MOST_STEPS):
        try:
            step = np.linalg.solve(np.array(jacobian), -np.array(residual))
        except np.linalg.LinAlgError:
            break
        length, before = 1.0, _norm(residual)
        for _ in range(MOST_HALVINGS):
            trial = [a + length * float(b) for a, b in zip(x, step, strict=True)]
            try:
                found = evaluate(trial)
            except (ModelError, ArithmeticError):
                found = ([math.inf], [])
            if _norm(found[0]) <= before:
                break
            length /= 2
        done = all(abs(b) <= ENOUGH * (abs(a) + 1e-300) for a, b in zip(trial, step, strict=True))
        if not _norm(found[0]) <= before or done or _norm(found[0]) == 0.0:
            if _norm(found[0]) <= before:
                x = trial
            return x
        x, (residual, jacobian) = trial, found
    raise ModelError("model", "the algebraic loop of its network has no solution here")


def _norm(residual: list[float]) -> float:
    largest = max(map(abs, residual), default=0.0)
    return largest if math.isfinite(largest) else math.inf
