"""Exact judgement of expressions: their values modulo a large prime, each symbol a number like any other.

Two expressions that are the same rational function have the same residue; two that are not differ but for
one chance in 10^18. So whether a coefficient is zero, and what the rank of a matrix of expressions is, is
decided without tolerance. Sine and cosine of one argument keep sin² + cos² = 1; other functions are taken for
numbers without a relation.
"""

from __future__ import annotations

import hashlib
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from linegraph.ir.dag import ADD, DIV, MUL, NEG, SUB, SYMBOL, Node

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar

PRIME = 2**61 - 1
CONSTANT = "c"
"""The argument of symbols that stand for a number, which is the text of their place."""

Row = dict[Any, int]
"""A sparse row of residues."""


class Residues:
    """Values of scalars modulo `PRIME`.

    Example:
        >>> from linegraph.ir.dag import Dag
        >>> dag = Dag()
        >>> x, y = dag.symbol("x"), dag.symbol("y")
        >>> residues = Residues()
        >>> residues((x + y) * (x - y) - (x * x - y * y)), residues(x - y) != 0
        (0, True)
    """

    def __init__(self) -> None:
        """Nothing is known yet."""
        self._known: dict[int, int] = {}

    def __call__(self, x: Scalar) -> int:
        """The residue of a scalar."""
        if not isinstance(x, Node):
            return of_number(x)
        pending = [x]
        while pending:
            node = pending[-1]
            if node.index in self._known:
                pending.pop()
                continue
            parts = (node.a, node.b) if node.op != SYMBOL else ()
            waiting = [p for p in parts if isinstance(p, Node) and p.index not in self._known]
            if waiting:
                pending += waiting
                continue
            self._known[node.index] = self._of(node)
            pending.pop()
        return self._known[x.index]

    def _of(self, node: Node) -> int:
        if node.op == SYMBOL:
            known = node.a == CONSTANT
            return of_number(Fraction(node.b)) if known else _hashed("symbol", node.a, node.b)
        a = self._operand(node.a)
        b = self._operand(node.b) if node.b is not None else 0
        if node.op == NEG:
            return -a % PRIME
        if node.op == ADD:
            return (a + b) % PRIME
        if node.op == SUB:
            return (a - b) % PRIME
        if node.op == MUL:
            return a * b % PRIME
        if node.op == DIV:
            return a * inverse(b) % PRIME
        if node.op in ("sin", "cos"):
            t = _hashed("half angle", a)
            below = inverse(1 + t * t)
            return (2 * t if node.op == "sin" else 1 - t * t) * below % PRIME
        return _hashed(node.op, a, b)

    def _operand(self, x: Any) -> int:
        return self._known[x.index] if isinstance(x, Node) else of_number(x)


def of_number(x: Any) -> int:
    """A number as its decimal digits say it: 0.1 is one tenth."""
    exact = Fraction(repr(float(x))) if isinstance(x, float) else Fraction(x)
    return exact.numerator * inverse(exact.denominator) % PRIME


def inverse(x: int) -> int:
    """One over a residue; of zero, which only chance meets, zero."""
    return pow(x, PRIME - 2, PRIME)


def _hashed(*parts: Any) -> int:
    digest = hashlib.blake2b(repr(parts).encode(), digest_size=8).digest()
    return int.from_bytes(digest, "big") % PRIME


class Span:
    """The space that rows of residues span, grown row by row.

    Example:
        >>> span = Span()
        >>> span.add({"a": 1, "b": 2}, "first"), span.add({"a": 2, "b": 4}, "second")
        (None, {'first': 2305843009213693949, 'second': 1})
    """

    def __init__(self) -> None:
        """The space of nothing."""
        self._rows: list[tuple[Any, Row, Row]] = []

    def __len__(self) -> int:
        """Its dimension."""
        return len(self._rows)

    def add(self, row: Row, name: Any) -> Row | None:
        """Grow by a row.

        Returns:
            None if it was independent; else the combination of rows, by their names, that vanishes.
        """
        rest, made = self._reduced(row)
        made[name] = 1
        if not rest:
            return made
        column = min(rest, key=repr)
        scale = inverse(rest[column])
        self._rows.append((column, _scaled(rest, scale), _scaled(made, scale)))
        return None

    def holds(self, row: Row) -> bool:
        """Whether a row lies in it."""
        return not self._reduced(row)[0]

    def _reduced(self, row: Row) -> tuple[Row, Row]:
        rest = {column: value % PRIME for column, value in row.items() if value % PRIME}
        made: Row = {}
        for column, basis, origin in self._rows:
            factor = -rest.get(column, 0) % PRIME
            if factor:
                _add(rest, basis, factor)
                _add(made, origin, factor)
        return rest, made


def _add(row: Row, other: Row, factor: int) -> None:
    for column, value in other.items():
        total = (row.get(column, 0) + factor * value) % PRIME
        if total:
            row[column] = total
        else:
            row.pop(column, None)


def _scaled(row: Row, factor: int) -> Row:
    return {column: value * factor % PRIME for column, value in row.items()}


def rank(rows: Sequence[Row]) -> int:
    """The rank of a matrix."""
    span = Span()
    for k, row in enumerate(rows):
        span.add(row, k)
    return len(span)
