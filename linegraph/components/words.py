"""How a component's type becomes a word of the builder."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.components.base import Component

PAIRS = ("between", "second", "output", "points", "shaft")


def connects(kind: type[Component]) -> Any:
    """A builder method that adds a component of one type: a line in the register."""

    def connect(self: Any, name: str, *args: Any, **options: Any) -> Component:
        given = {
            key: tuple(map(str, value)) if key in PAIRS and value is not None else value
            for key, value in options.items()
        }
        if args:
            args = (tuple(map(_written, args[0])), *args[1:])
        joint = given.get("joint")
        if joint is not None:
            given["joint"] = getattr(joint, "name", joint)
        make: Callable[..., Component] = kind
        found: Component = self.add_component(make(name, *args, **given))
        return found

    connect.__doc__ = kind.__doc__
    connect.__name__ = kind.kind
    connect.kind = kind  # type: ignore[attr-defined]
    return connect


def _written(end: Any) -> Any:
    """A vertex as its name; pairs of them, as of windings, stay what they are."""
    return end if isinstance(end, (tuple, list)) else str(end)
