"""Mechanics and networks in one: ``𝓜(x) ẋ = f`` with the mass matrix as a block of 𝓜.

What a network stores adds to the mass matrix where it is tied to joints, as a rotor behind its gear does, and
stands beside it where it is not.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.algebra.protocol import set_label
from linegraph.dynamics import orthogonality
from linegraph.dynamics.applied_forces import Acting
from linegraph.dynamics.mass_matrix import mass_matrix

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.applied_forces import Applied
    from linegraph.dynamics.chords import Chords
    from linegraph.dynamics.law_names import State
    from linegraph.dynamics.network_state import Exchange
    from linegraph.kinematics.arms import Arm
    from linegraph.kinematics.links import KinematicTree
    from linegraph.model.system import System

Entries = list[tuple[int, int, "Scalar"]]


def exchange_at(
    model: System,
    tree: KinematicTree,
    algebra: Algebra,
    parameters: Mapping[str, Scalar],
    chords: Chords,
    state: State,
) -> Exchange | None:
    """A model's networks at a state; None if it has none."""
    if tree.network is None:
        return None
    return Acting(model, tree, algebra, parameters, chords, state).exchange


def network_entries(exchange: Exchange | None, algebra: Algebra) -> Entries:
    """What networks add to the mass matrix: row, column and entry; places may repeat."""
    if exchange is None:
        return []
    set_label(algebra, "network, what it stores")
    return list(exchange.inertia())


def united_mass_matrix(
    tree: KinematicTree,
    algebra: Algebra,
    crossed: Sequence[Arm],
    entries: Iterable[tuple[int, int, Scalar]],
) -> list[list[Scalar]]:
    """𝓜: the mass matrix, and what networks add."""
    rows = mass_matrix(tree, algebra, list(crossed))
    for i, j, entry in entries:
        rows[i][j] = rows[i][j] + entry
    return rows


def united_inverse_dynamics(
    tree: KinematicTree,
    algebra: Algebra,
    crossed: Sequence[Arm],
    entries: Iterable[tuple[int, int, Scalar]],
    a: Sequence[Scalar] | None,
    acting: Applied | None,
) -> list[Scalar]:
    """``𝓜 a + h``, of mechanics without forming its mass matrix; h where no a is given."""
    found = orthogonality.inverse_dynamics(tree, algebra, list(crossed), a, acting)
    if a is not None:
        set_label(algebra, "network, what it stores")
        for i, j, entry in entries:
            found[i] = found[i] + entry * a[j]
    return found
