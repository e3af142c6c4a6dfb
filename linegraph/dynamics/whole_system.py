"""Mechanics and networks together: ``𝓜(x) ẋ = f``, with the mass matrix as a block of 𝓜.

Stores of a network that are tied to joints, such as a rotor behind its gear, add to the mass matrix;
others get rows and columns of their own.
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
    """Entries that networks add to the mass matrix: row, column, value; places may repeat."""
    if exchange is None:
        return []
    set_label(exchange.state.algebra, "network, what it stores")
    return list(exchange.inertia())


def united_mass_matrix(
    state: TreeState, entries: Iterable[tuple[int, int, Scalar]]
) -> list[list[Scalar]]:
    """𝓜: the mass matrix with the entries of networks added.

    Args:
        state: the tree at (q, v).
        entries: row, column and value of each addition.
    """
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
    """Generalised forces ``𝓜 a + h``, without forming the mass matrix of mechanics.

    Args:
        state: the tree at (q, v).
        entries: row, column and value of each addition by networks.
        a: the accelerations v̇, rates of network states included.
        acting: applied forces, subtracted, in the working frames of the state.
    """
    found = orthogonality.inverse_dynamics(state, a, acting)
    set_label(state.algebra, "network, what it stores")
    for i, j, entry in entries:
        found[i] = found[i] + entry * a[j]
    return found
