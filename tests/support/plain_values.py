"""Scalars of a DAG as exact fractions or as numbers of forty digits, by a walk of their own."""

from __future__ import annotations

import operator
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from mpmath.ctx_mp import MPContext

from linegraph.ir.dag import Node

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    Symbol = tuple[str, Any]

PRECISE = MPContext()
PRECISE.dps = 40

ARITHMETIC: dict[str, Callable[..., Any]] = {
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "neg": operator.neg,
}
OTHERS: dict[str, Callable[..., Any]] = {
    "abs": abs,
    "sign": lambda x: (x > 0) - (x < 0),
    "min": min,
    "max": max,
}


def value(x: Any, at: Mapping[Symbol, Any]) -> Any:
    """What a scalar is worth where symbols have these values; exact while only arithmetic is needed."""
    known: dict[int, Any] = {}

    def of(x: Any) -> Any:
        if not isinstance(x, Node):
            return Fraction(x) if isinstance(x, int) else x
        if x.index not in known:
            known[x.index] = of_node(x)
        return known[x.index]

    def of_node(node: Node) -> Any:
        if node.op == "symbol":
            if (node.a, node.b) in at:
                return of(at[node.a, node.b])
            assert node.a == "c", f"{node} has no value"
            return Fraction(node.b)  # a number that is written as its text
        parts = [of(part) for part in (node.a, node.b) if part is not None]
        exact = all(isinstance(part, Fraction) for part in parts)
        if node.op in ARITHMETIC:
            return ARITHMETIC[node.op](*(parts if exact else map(precise, parts)))
        function = OTHERS.get(node.op) or getattr(PRECISE, node.op)
        return function(*map(precise, parts))

    return of(x)


def precise(x: Any) -> Any:
    """A number with forty digits."""
    if isinstance(x, Fraction):
        return PRECISE.mpf(x.numerator) / x.denominator
    return PRECISE.convert(x)


def slope(x: Any, at: Mapping[Symbol, Any], by: Symbol, order: int = 1) -> float:
    """The derivative with respect to one symbol by differences in forty digits."""
    start = precise(at[by])
    return float(PRECISE.diff(lambda z: precise(value(x, {**at, by: z})), start, order))
