"""Mechanics and networks in one: ``𝓜(x) ẋ = f`` with the mass matrix as a block of 𝓜.

What a network stores adds to the mass matrix where it is tied to joints, as a rotor behind its gear does, and
stands beside it where it is not.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.algebra.protocol import set_label
from linegraph.dynamics import orthogonality
from linegraph.dynamics.mass_matrix import mass_matrix

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.applied_forces import Applied
    from linegraph.dynamics.network_state import Exchange
    from linegraph.kinematics.tree_state import TreeState

Entries = list[tuple[int, int, "Scalar"]]


def network_entries(exchange: Exchange | None) -> Entries:
    """What networks add to the mass matrix: row, column and entry; places may repeat."""
    if exchange is None:
        return []
    set_label(exchange.state.algebra, "network, what it stores")
    return list(exchange.inertia())


def united_mass_matrix(
    state: TreeState, entries: Iterable[tuple[int, int, Scalar]]
) -> list[list[Scalar]]:
    """𝓜: the mass matrix, and what networks add."""
    rows = mass_matrix(state)
    for i, j, entry in entries:
        rows[i][j] = rows[i][j] + entry
    return rows


def united_inverse_dynamics(
    state: TreeState,
    entries: Iterable[tuple[int, int, Scalar]],
    a: Sequence[Scalar],
    acting: Applied,
) -> list[Scalar]:
    """``𝓜 a + h``, of mechanics without forming its mass matrix."""
    found = orthogonality.inverse_dynamics(state, a, acting)
    set_label(state.algebra, "network, what it stores")
    for i, j, entry in entries:
        found[i] = found[i] + entry * a[j]
    return found
