"""Interpreter of a `Program`: evaluates its operations in order, in floats."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any

from linegraph.ir.dag import ADD, DIV, MUL, NEG, SUB, SYMBOL, Node
from linegraph.ir.functions import of_numbers

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from linegraph.ir.program import Program

_OPERATIONS: dict[str, Callable[..., float]] = {
    ADD: operator.add,
    SUB: operator.sub,
    MUL: operator.mul,
    DIV: operator.truediv,
    NEG: operator.neg,
}


def run(program: Program, arguments: Mapping[str, Any]) -> list[list[float]]:
    """The entries of each result.

    Args:
        program: one without calls.
        arguments: for each argument a sequence, a mapping of parameters, or the time.

    Example:
        >>> from linegraph.ir.dag import Dag
        >>> from linegraph.ir.program import Argument, Result, assemble
        >>> x = Dag().symbol("q", 0)
        >>> square = assemble("square", "", (Argument("q", 1, ""),), (Result("y", (1,), (x * x,), ""),))
        >>> run(square, {"q": [3.0]})
        [[9.0]]
    """
    values: dict[int, float] = {}

    def value(x: Any) -> float:
        return values[x.index] if isinstance(x, Node) else float(x)

    for node in program.live:
        if node.op == SYMBOL:
            given = arguments[node.a]
            values[node.index] = float(given if node.b is None else given[node.b])
            continue
        operands = [value(x) for x in (node.a, node.b) if x is not None]
        action = _OPERATIONS.get(node.op)
        result = action(*operands) if action else of_numbers(node.op, *operands)
        values[node.index] = float(result)
    return [[value(entry) for entry in result.entries] for result in program.results]
