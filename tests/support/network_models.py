"""Networks as numbers: what the derivation says of a network, evaluated."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from linegraph.algebra.differentiation import Replay
from linegraph.algebra.protocol import Floats
from linegraph.networks.equations import network_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from linegraph import Model
    from linegraph.algebra.differentiation import Symbol
    from linegraph.networks import Network

Array = Any


def numbers(network: Network, values: Callable[[Symbol], float]) -> Replay:
    """Scalars of a network as floats."""
    return Replay(Floats(), values)


def linear(model: Model) -> tuple[list[Symbol], Array, dict[int, Array]]:
    """States, A, and B by the order of the inputs' derivative, of a linear network in numbers."""
    network = network_of(model)
    assert network is not None
    given = {p.name: p.value for p in model.parameters.values()}

    def at_rest(symbol: Symbol) -> float:
        kind, place = symbol
        return (
            float(given[place]) if kind == "p" else float(Fraction(place)) if kind == "c" else 0.0
        )

    value = numbers(network, at_rest)
    n = len(network.states)
    mass = np.zeros((n, n))
    for (i, j), entry in network.mass.items():
        mass[i, j] = value(entry)
    slopes = [network.laws.calculus.gradient(f) for f in network.force]
    inputs = [q.name for q in model.inputs]

    def columns(keys: Sequence[Symbol]) -> Array:
        return np.array(
            [[float(value(row.get(key, 0))) for key in keys] for row in slopes]
        ).reshape(n, len(keys))

    A = np.linalg.solve(mass, columns([s.key for s in network.states]))
    B = {
        order: np.linalg.solve(mass, columns([(kind, name) for name in inputs]))
        for order, kind in enumerate(("u", "du", "ddu"))
    }
    return [s.key for s in network.states], A, B
