"""A small evaluator of the expression DAG and of programs, written apart from the library's own walks."""

from __future__ import annotations

import math
import operator
from typing import TYPE_CHECKING, Any

from linegraph.ir.dag import Node

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from linegraph.ir.program import Module, Program

BINARY: dict[str, Callable[[Any, Any], Any]] = {
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
}
UNARY: dict[str, Callable[[Any], Any]] = {
    "neg": operator.neg,
    "sin": math.sin,
    "cos": math.cos,
    "sqrt": math.sqrt,
    "tanh": math.tanh,
}


def reached(roots: Iterable[Any]) -> list[Node]:
    """Every node that `roots` depend on, themselves included, operands first."""
    found: set[Node] = set()
    pending = [root for root in roots if isinstance(root, Node)]
    while pending:
        node = pending.pop()
        if node not in found:
            found.add(node)
            pending += [operand for operand in (node.a, node.b) if isinstance(operand, Node)]
    return sorted(found, key=lambda node: node.index)


def values(roots: Sequence[Any], arguments: Mapping[str, Any]) -> list[Any]:
    """The numbers that `roots` are for these arguments: sequences, mappings or single numbers."""
    known: dict[Node, Any] = {}

    def number(operand: Any) -> Any:
        return known[operand] if isinstance(operand, Node) else operand

    for node in reached(roots):
        if node.op == "symbol":
            given = arguments[node.a]
            known[node] = given if node.b is None else given[node.b]
        elif node.op in BINARY:
            known[node] = BINARY[node.op](number(node.a), number(node.b))
        else:
            known[node] = UNARY[node.op](number(node.a))
    return [number(root) for root in roots]


def value(root: Any, **arguments: Any) -> Any:
    """The number that one node is."""
    return values([root], arguments)[0]


def run(module: Module, name: str, **arguments: Any) -> dict[str, list[Any]]:
    """Every result of one function of a module, flat, the functions it calls included."""
    program = _program(module, name)
    given = dict(arguments)
    for call in program.calls:
        inner = run(module, call.program, **{key: given[key] for key in call.arguments})
        for local, entries in zip(call.results, inner.values(), strict=True):
            given[local.name] = entries
    return {result.name: values(result.entries, given) for result in program.results}


def _program(module: Module, name: str) -> Program:
    return next(program for program in module.programs if program.name == name)
