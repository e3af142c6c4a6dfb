"""Newton's method for the algebraic loops of a network: the algorithm of emitted code, run in floats."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, cast

from linegraph.algebra.differentiation import Replay
from linegraph.algebra.protocol import Floats
from linegraph.errors import ModelError
from linegraph.ir.algorithms.language import reals
from linegraph.ir.algorithms.newton import is_only, search
from linegraph.networks.static import EASE, LOOP

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from linegraph.algebra.differentiation import Symbol
    from linegraph.ir.algorithms.language import ModuleAtState, Reals
    from linegraph.networks.network import Network


def solved(network: Network, known: Callable[[Symbol], float]) -> list[float]:
    """Solve a network's algebraic loop for its unknowns.

    Args:
        network: with the loop.
        known: the value of every other symbol, given as (argument, place).

    Returns:
        One number for each of `network.loop_names`.

    Raises:
        ModelError: no solution was found, or it is not the only one.
    """
    loop = cast("ModuleAtState", _Loop(network, known))
    at = reals(loop.size)
    if not search(loop, at):
        raise ModelError("model", "the algebraic loop of its network has no solution here")
    if not is_only(loop, at):
        raise ModelError("model", "the algebraic loop of its network has several solutions here")
    return [at[i] for i in range(loop.size)]


class _Loop:
    """What the algorithm asks of a module: the equations of the loop."""

    def __init__(self, network: Network, known: Callable[[Symbol], float]) -> None:
        self.network, self.known = network, known
        self.size = len(network.loop)
        self.given = {symbol: known(symbol) for symbol in network.loop_needs}

    def loop_equations(self, r: Reals, K: Reals, s: Reals, *, loop: Reals, ease: Reals) -> None:
        """Residuals, their Jacobian and sizes of terms; infinite residuals where a law is not defined."""
        values = {(LOOP, k): loop[k] for k in range(self.size)}
        values |= {(EASE, k): ease[k] for k in range(2)}

        def value(symbol: Symbol) -> float:
            if symbol in values:
                return values[symbol]
            return self.given[symbol] if symbol in self.given else self.known(symbol)

        replay = Replay(Floats(), value)
        network = self.network
        try:
            _fill(r, (replay(x) for x in network.eased))
            _fill(K, (replay(x) for row in network.eased_jacobian for x in row))
            _fill(s, (replay(x) for x in network.loop_sizes))
        except (ModelError, ArithmeticError):
            _fill(r, [math.inf] * self.size)


def _fill(array: Reals, entries: Iterable[float]) -> None:
    for place, entry in enumerate(entries):
        array[place] = float(entry)
