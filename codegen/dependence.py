"""Determines which values of a program differ from state to state."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.ir.dag import SYMBOL, Node

if TYPE_CHECKING:
    from collections.abc import Iterable

SHARED = ("p", "c", "t")
"""Arguments that all states of a batch have in common."""


def varying(live: Iterable[Node]) -> frozenset[int]:
    """The indices of the nodes that differ from state to state.

    Args:
        live: the nodes of a program, each after its operands.
    """
    found: set[int] = set()
    for node in live:
        if node.op == SYMBOL:
            wide = node.a not in SHARED
        else:
            wide = any(isinstance(x, Node) and x.index in found for x in (node.a, node.b))
        if wide:
            found.add(node.index)
    return frozenset(found)
