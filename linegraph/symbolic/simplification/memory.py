"""The state of objects that learn while they calculate, and how it is restored."""

from __future__ import annotations

from typing import Any


class Memory:
    """The present attributes of some objects; lists and dicts are copied.

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
        """Copy the attributes of all objects."""
        self._kept = [
            (x, name, value, value.copy() if isinstance(value, (list, dict)) else value)
            for x in objects
            for name, value in vars(x).items()
        ]

    def restore(self) -> None:
        """Restore every attribute; lists and dicts stay the same objects, since others may hold them."""
        for x, name, value, kept in self._kept:
            if isinstance(value, list):
                value[:] = kept
            elif isinstance(value, dict):
                value.clear()
                value.update(kept)
            setattr(x, name, value)
