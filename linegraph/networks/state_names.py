"""The states of a network in their order, and the names of its variables."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.components.domains import DOMAINS
from linegraph.ir.program import Quantity
from linegraph.networks.network import State

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.components.domains import Domain
    from linegraph.components.scalar.branches import Branch
    from linegraph.model.system import System
    from linegraph.networks.law_records import Laws, StoreLaw
    from linegraph.networks.selection import Selection


def states_of(
    system: System, branches: Sequence[Branch], laws: Laws, selection: Selection
) -> list[State]:
    """The states in the order of the components; a component's stored variables before its own states.

    Args:
        system: has the components and the domains.
        branches: the edges of the network.
        laws: their terminal equations.
        selection: the stores that are states.
    """
    order = {c.name: k for k, c in enumerate(system.components)}
    branch = {b.name: b for b in branches}
    found: list[tuple[int, State]] = []
    for store in selection.states:
        b = branch[store.edge]
        domain = domain_of(system, b.port.domain)
        variable = domain.across if store.key[0] == "X" else domain.through
        where = "across" if store.key[0] == "X" else "through"
        name = f"{variable.letter}_{_short(branches, b, store)}"
        about = f"{variable.name} {where} {store.edge}"
        found.append(
            (order[b.component.name], State(Quantity(name, variable.symbol, about), store.key))
        )
    for own in laws.own:
        component = str(own.key[1]).partition(".")[0]
        found.append((order[component], State(own.quantity, own.key)))
    return [state for _, state in sorted(found, key=lambda pair: pair[0])]


def variable_name(system: System, branches: Sequence[Branch], symbol: Symbol) -> str:
    """The name of an across or through variable, with the letter of its domain.

    Args:
        system: has the domains.
        branches: the edges of the network.
        symbol: ``("X", edge)`` or ``("Y", edge)``.
    """
    kind, edge = symbol
    branch = next(b for b in branches if b.name == edge)
    letter = {"X": "across", "Y": "through"}[kind]
    if branch.port.domain:
        domain = domain_of(system, branch.port.domain)
        letter = domain.across.letter if kind == "X" else domain.through.letter
    return f"{letter}_{edge.replace('.', '_')}"


def domain_of(system: System, name: str) -> Domain:
    """The domain of a name: one that the system declares, or a built-in one.

    Args:
        system: may declare domains.
        name: ``electrical``, ``hydraulic``, ...
    """
    return system.domains.get(name) or DOMAINS[name]


def _short(branches: Sequence[Branch], branch: Branch, store: StoreLaw) -> str:
    """The component's name, or the edge's if the component stores several variables in one domain."""
    alike = [
        b
        for b in branches
        if b.component is branch.component and b.kept and b.port.domain == branch.port.domain
    ]
    return branch.component.name if len(alike) == 1 else store.edge.replace(".", "_")
