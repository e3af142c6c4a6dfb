"""How a component's type becomes a method of the builder."""

from __future__ import annotations

from functools import cached_property
from importlib import import_module
from types import MethodType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.components.scalar.base import Component

PAIRS = ("between", "second", "output", "points", "shaft")


class connects:  # noqa: N801  (a line of the register reads as a verb)
    """A builder method that adds a component of one type: a line in the register."""

    def __init__(self, module: str, name: str) -> None:
        """Remember a type by its name; its file is not imported yet.

        Args:
            module: the file, from `linegraph.components` on.
            name: the type in it.
        """
        self._place = module, name

    @cached_property
    def kind(self) -> type[Component]:
        """The type; its file is imported when it is first needed."""
        module, name = self._place
        found: type[Component] = getattr(import_module(f"linegraph.components.{module}"), name)
        return found

    def __get__(self, model: Any, owner: type | None = None) -> Any:
        return self._method if model is None else MethodType(self._method, model)

    @cached_property
    def _method(self) -> Any:
        kind = self.kind

        def connect(model: Any, name: str, *args: Any, **options: Any) -> Component:
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
            found: Component = model.add_component(make(name, *args, **given))
            return found

        connect.__doc__ = kind.__doc__
        connect.__name__ = kind.kind
        connect.kind = kind  # type: ignore[attr-defined]
        return connect


def _written(end: Any) -> Any:
    """A vertex as its name; pairs of them, as of windings, stay what they are."""
    return end if isinstance(end, (tuple, list)) else str(end)
