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
BEGINS = (0.0, 1.0, -1.0)
ROUNDING = 1e-13
"""A residual below this fraction of its terms is zero."""


def solved(network: Network, known: Callable[[Symbol], float]) -> list[float]:
    """The unknowns of a network's algebraic loop, from zero on, or from one or minus one where that fails.

    Raises:
        ModelError: no solution was found.
    """
    import numpy as np

    size = len(network.loop)
    given = {symbol: known(symbol) for symbol in network.loop_needs}

    def known_of(symbol: Symbol) -> float:
        return given[symbol] if symbol in given else known(symbol)

    def evaluate(at: list[float]) -> tuple[list[float], list[list[float]], bool]:
        replay = Replay(Floats(), lambda s: at[s[1]] if s[0] == LOOP else known_of(s))
        try:
            residual = [float(replay(r)) for r in network.loop]
            slopes = [[float(replay(e)) for e in row] for row in network.loop_jacobian]
            terms = [float(replay(e)) for e in network.loop_sizes]
        except (ModelError, ArithmeticError):
            return [math.inf] * size, [], False
        pairs = zip(residual, terms, strict=True)
        return residual, slopes, all(abs(r) <= ROUNDING * term for r, term in pairs)

    for begin in BEGINS:
        x = [begin] * size
        residual, jacobian, solved_ = evaluate(x)
        gap = _norm(residual)
        for _ in range(MOST_STEPS):
            if not 0 < gap < math.inf:
                break
            try:
                step = np.linalg.solve(np.array(jacobian), -np.array(residual))
            except np.linalg.LinAlgError:
                break
            found, trial = ([math.inf], jacobian, False), x
            for halving in range(MOST_HALVINGS):
                trial = [a + float(b) / 2**halving for a, b in zip(x, step, strict=True)]
                found = evaluate(trial)
                if _norm(found[0]) <= gap:
                    break
            if not _norm(found[0]) <= gap:
                break
            x, before = trial, gap
            residual, jacobian, gap = found[0], found[1], _norm(found[0])
            # once it is rounding, go on while that still becomes less
            if solved_ and gap > before / 2:
                break
            solved_ = found[2]
        if gap == 0 or (solved_ and gap < math.inf):
            return x
    raise ModelError("model", "the algebraic loop of its network has no solution here")


def _norm(residual: list[float]) -> float:
    largest = max(map(abs, residual), default=0.0)
    return largest if math.isfinite(largest) else math.inf
