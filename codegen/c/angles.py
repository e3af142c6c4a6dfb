"""The angles of a function whose sines and cosines the emitted file computes itself.

Those known from the start, which are nearly all of a robot's, are taken side by side in vector
registers; the others one by one where they become known.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from codegen.c.order import NamedStep
from linegraph.ir.dag import SYMBOL, Node
from linegraph.ir.functions import ARITY
from linegraph.ir.program import INLINE_LIMIT

if TYPE_CHECKING:
    from collections.abc import Sequence

    from codegen.c.order import Item

FILL = 8
"""Arrays of angles are filled up to a multiple of this, the most lanes there are."""

_WAVES = ("sin", "cos")


class Angles:
    """The places of the sine and cosine of each angle.

    Attributes:
        early: the angles known from the start, in the order of their places.
        filled: how many places these take.
        size: how many places there are.
        reads: the arguments that the early angles are made of.
    """

    def __init__(self, items: Sequence[Item], wide: frozenset[int] | None) -> None:
        """The angles of some lines; of registers (`wide`) only, unless all are numbers (None)."""
        found = {
            x.node.a.index: x.node.a
            for x in items
            if isinstance(x, NamedStep)
            and x.node.op in _WAVES
            and (wide is None or x.node.index in wide)
        }
        known = {key: _symbols(angle) for key, angle in found.items()}
        early = [key for key, symbols in known.items() if symbols is not None]
        if wide is None and len(early) == 1:
            early = []  # one angle alone has no others beside it
        late = [key for key in found if key not in early]
        self.early = [found[key] for key in early]
        self.filled = len(early) if wide is not None else -(-len(early) // FILL) * FILL
        self.size = self.filled + len(late)
        self.reads = frozenset(name for key in early for name in known[key] or ())
        self._place = {key: k for k, key in enumerate(early)}
        self._place |= {key: self.filled + k for k, key in enumerate(late)}
        self._late = {key: _first_use(items, key) for key in late}

    def has(self, node: Node) -> bool:
        """Whether a node is sine or cosine of one of the angles."""
        return node.op in _WAVES and node.a.index in self._place

    def place(self, node: Node) -> int:
        """The place of a sine or cosine."""
        return self._place[node.a.index]

    def comes_first(self, node: Node) -> bool:
        """Whether a sine or cosine is where both of its angle are to be computed."""
        return self._late.get(node.a.index) == node.index

    def without(self, items: Sequence[Item]) -> list[Item]:
        """The lines, less what only angles known elsewhere need."""
        changed = [
            x._replace(needs=())
            if isinstance(x, NamedStep) and self.has(x.node) and not self.comes_first(x.node)
            else x
            for x in items
        ]
        needed: set[int] = set()
        kept: list[Item] = []
        for item in reversed(changed):
            if not isinstance(item, NamedStep) or item.node.index in needed:
                needed.update(item.needs)
                kept.append(item)
        return kept[::-1]


def _first_use(items: Sequence[Item], key: int) -> int:
    """The first sine or cosine of an angle."""
    return next(
        x.node.index
        for x in items
        if isinstance(x, NamedStep) and x.node.op in _WAVES and x.node.a.index == key
    )


def _symbols(angle: Node) -> frozenset[str] | None:
    """The arguments that a short sum or product of symbols reads; None for all other angles."""
    names: set[str] = set()
    pending, operations = [angle], 0
    while pending:
        node = pending.pop()
        if node.op == SYMBOL:
            names.add(str(node.a))
            continue
        operations += 1
        if node.op in ARITY or operations > INLINE_LIMIT:
            return None
        pending += [x for x in (node.a, node.b) if isinstance(x, Node)]
    return frozenset(names)
