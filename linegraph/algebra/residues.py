"""Exact zero tests and ranks of expressions, by their residues modulo a large prime.

Each symbol has a fixed pseudorandom residue. Expressions that are the same rational function have the same
residue; two different ones have the same with a probability of about their degree over 2^61 [Schwartz 1980;
Zippel 1979]. Whether a coefficient is zero, and what the rank of a matrix of expressions is, is thus decided
without a tolerance, which floats at random points would need. Sine and cosine of one argument satisfy
sin² + cos² = 1 by the half-angle substitution; other functions count as independent of each other.
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
"""A Mersenne prime, large enough that two different residues are equal by chance with probability 4e-19."""

CONSTANT = "c"
"""The argument of symbols that represent a number, given by the text of their place."""

Row = dict[Any, int]
"""A sparse row of residues."""


class Residues:
    """Values of scalars modulo `PRIME`, remembered by node.

    Example:
        >>> from linegraph.ir.dag import Dag
        >>> dag = Dag()
        >>> x, y = dag.symbol("x"), dag.symbol("y")
        >>> residues = Residues()
        >>> residues((x + y) * (x - y) - (x * x - y * y)), residues(x - y) != 0
        (0, True)
    """

    def __init__(self) -> None:
        """Start without known residues."""
        self._known: dict[int, int] = {}

    def __call__(self, x: Scalar) -> int:
        """The residue of a scalar, 0 to PRIME - 1."""
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
    """The residue of a number, a float by its shortest decimal digits: 0.1 is one tenth.

    The binary value of 0.1 would make 0.1 + 0.2 - 0.3 differ from zero.
    """
    exact = Fraction(repr(float(x))) if isinstance(x, float) else Fraction(x)
    return exact.numerator * inverse(exact.denominator) % PRIME


def inverse(x: int) -> int:
    """The reciprocal modulo `PRIME` by Fermat's little theorem; 0 for 0, which occurs by chance only."""
    return pow(x, PRIME - 2, PRIME)


def _hashed(*parts: Any) -> int:
    digest = hashlib.blake2b(repr(parts).encode(), digest_size=8).digest()
    return int.from_bytes(digest, "big") % PRIME


class Span:
    """The space spanned by rows of residues, extended row by row.

    Example:
        >>> span = Span()
        >>> span.add({"a": 1, "b": 2}, "first"), span.add({"a": 2, "b": 4}, "second")
        (None, {'first': 2305843009213693949, 'second': 1})
    """

    def __init__(self) -> None:
        """Start with the space of dimension 0."""
        self._rows: list[tuple[Any, Row, Row]] = []

    def __len__(self) -> int:
        """The dimension of the space."""
        return len(self._rows)

    def add(self, row: Row, name: Any) -> Row | None:
        """Extend the space by a row.

        Args:
            row: residues by column, zeros left out.
            name: of the row, for combinations in which it takes part.

        Returns:
            None if the row was independent; else the factors, by names of rows, of a combination that
            vanishes.
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
        """Whether a row lies in the space."""
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
    """The rank of a matrix of residues, given by sparse rows."""
    span = Span()
    for k, row in enumerate(rows):
        span.add(row, k)
    return len(span)
