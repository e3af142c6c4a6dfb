"""What calculating objects have come to know, and how they forget it again."""

from __future__ import annotations

from typing import Any


class Memory:
    """The attributes of some objects as they are now; lists and dicts by their entries.

    Example:
        >>> from linegraph.symbolic.simplification.polynomial import Ring
        >>> ring = Ring()
        >>> memory = Memory(ring)
        >>> _ = ring.symbol("q", 0)
        >>> memory.restore()
        >>> ring.generators
        []
    """

    def __init__(self, *objects: Any) -> None:
        """Keep them."""
        self._kept = [
            (x, name, value, value.copy() if isinstance(value, (list, dict)) else value)
            for x in objects
            for name, value in vars(x).items()
        ]

    def restore(self) -> None:
        """Give every attribute its value back; lists and dicts stay the objects that others hold."""
        for x, name, value, kept in self._kept:
            if isinstance(value, list):
                value[:] = kept
            elif isinstance(value, dict):
                value.clear()
                value.update(kept)
            setattr(x, name, value)
