"""Programs of a few operations, and what they return by a walk of their own."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any

from support.plain_values import value

from linegraph.ir.program import Argument, Guards, Program, Result, assemble

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from linegraph.ir.program import Check


OPERATIONS: dict[str, Callable[[Any, Any], Any]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}


def program(*entries: Any, name: str = "f", checks: tuple[Check, ...] = (), **more: Any) -> Program:
    """A program of q and p with one result."""
    given = Argument("q", 4, "coordinates"), Argument("p", None, "parameters")
    result = Result("y", (len(entries),), entries, "results")
    return assemble(name, "", given, (result,), Guards(checks, **more))


def returned(program: Program, at: Mapping[Any, Any]) -> list[Any]:
    """The entries of all results where symbols have these values."""
    return [value(entry, at) for result in program.results for entry in result.entries]


def at(q: tuple[Any, ...] = (), **p: Any) -> dict[Any, Any]:
    """Values of q by place and of p by name."""
    return {("q", n): x for n, x in enumerate(q)} | {("p", name): x for name, x in p.items()}
