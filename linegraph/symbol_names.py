"""What the symbols of a derivation are called."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.closure import equations
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.derive import Derivation
    from linegraph.kinematics import KinematicTree

MULTIPLIERS = "lam"


def symbol_names(derivation: Derivation) -> dict[str, tuple[str, ...]]:
    """The names of all entries of each argument, no two alike.

    Raises:
        ModelError: a name stands for two things.
    """
    tree = derivation.structure
    positions, rates, inputs = _of_state(tree, derivation.model.parameters)
    network = derivation.formulation.network
    return {
        "q": tuple(positions),
        "v": tuple(rates),
        "u": tuple(inputs),
        "a": tuple(f"a_{quantity.name}" for quantity in tree.velocities),
        MULTIPLIERS: tuple(equation.multiplier.name for equation in equations(tree)),
        "loop": () if network is None else tuple(network.loop_names),
    }


def _of_state(
    tree: KinematicTree, parameters: Iterable[str]
) -> tuple[list[str], list[str], list[str]]:
    """What positions, velocities and inputs are called."""
    positions = [quantity.name for quantity in tree.positions]
    rates = [quantity.name for quantity in tree.velocities]
    rates = [f"{name}_dot" if name in positions else name for name in rates]
    inputs = [
        f"u_{quantity.name}" if quantity.name in (*positions, *rates) else quantity.name
        for quantity in tree.inputs
    ]
    for name in parameters:
        if name in positions or name in rates:
            raise ModelError(f'parameter "{name}"', "has the name of a coordinate; rename one")
    for name in rates:
        if name in positions:
            problem = "is the name of a coordinate and of a rate; rename a joint"
            raise ModelError(f'coordinate "{name}"', problem)
    return positions, rates, inputs
