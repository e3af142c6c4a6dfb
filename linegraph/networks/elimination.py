"""Linear equations solved over the DAG, with pivots chosen by exact residues.

Sizes of symbolic pivots are not known, so that the usual choice of the largest one is impossible. Pivots of
±1 come first, so that only resistive loops are ever divided by. Then come those on the diagonal, where a law
is solved for a variable of its own edges: positive resistances make that diagonal positive definite, whatever
their sizes are. Among equals the pivot with the least fill-in is taken [Markowitz 1957].
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from linegraph.algebra.powers import quotient
from linegraph.ir.dag import SYMBOL, Dag, Node
from linegraph.networks.variables import constant

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.algebra.residues import Residues
    from linegraph.algebra.scalar import Scalar


@dataclass
class LinearRow:
    """The linear equation ``Σ entries unknown + rest = 0``.

    Attributes:
        entries: coefficients by unknown.
        rest: the sum of all other terms.
        owner: the component whose law it is; its own variables are preferred as pivots.
    """

    entries: dict[Symbol, Scalar]
    rest: Scalar
    owner: str = ""


@dataclass
class Elimination:
    """The result of an elimination.

    Attributes:
        values: the unknowns that were solved for, in terms of those that were not.
        pivots: the divisors that are not numbers, which must not vanish.
        left: for rows without unknowns, the expression that must be zero.
        steps: the unknown and the scaled row of each pivot, in order.
    """

    values: dict[Symbol, Scalar] = field(default_factory=dict)
    pivots: list[Scalar] = field(default_factory=list)
    left: list[Scalar] = field(default_factory=list)
    steps: list[tuple[Symbol, LinearRow]] = field(default_factory=list)


def eliminate(
    rows: Sequence[LinearRow], dag: Dag, residues: Residues, last: Collection[Symbol] = ()
) -> Elimination:
    """Solve rows for as many unknowns as they determine.

    Args:
        rows: linear equations.
        dag: of all scalars.
        residues: the exact zero test.
        last: unknowns that are solved for only where no other can be.
    """
    found = Elimination()
    open_rows = [_cleaned(row, residues) for row in rows]
    while True:
        choice = _pivot(open_rows, last)
        if choice is None:
            break
        place, unknown = choice
        pivot_row = open_rows.pop(place)
        pivot = pivot_row.entries.pop(unknown)
        if not _plain(pivot):
            found.pivots.append(pivot)
        scaled = LinearRow(
            {symbol: _over(entry, pivot, dag) for symbol, entry in pivot_row.entries.items()},
            _over(pivot_row.rest, pivot, dag),
        )
        found.steps.append((unknown, scaled))
        for row in open_rows:
            factor = row.entries.pop(unknown, None)
            if factor is not None:
                _subtract(row, scaled, factor, residues)
    found.left = [row.rest for row in open_rows]
    for unknown, row in reversed(found.steps):
        total = -row.rest
        for symbol, entry in row.entries.items():
            value = found.values[symbol] if symbol in found.values else dag.symbol(*symbol)
            total = total - entry * value
        found.values[unknown] = total
    return found


def _cleaned(row: LinearRow, residues: Residues) -> LinearRow:
    return LinearRow({s: e for s, e in row.entries.items() if residues(e)}, row.rest, row.owner)


def _subtract(row: LinearRow, scaled: LinearRow, factor: Scalar, residues: Residues) -> None:
    for symbol, entry in scaled.entries.items():
        total = row.entries.get(symbol, 0) - factor * entry
        if residues(total):
            row.entries[symbol] = total
        else:
            row.entries.pop(symbol, None)
    row.rest = row.rest - factor * scaled.rest


def _pivot(rows: Sequence[LinearRow], last: Collection[Symbol]) -> tuple[int, Symbol] | None:
    """The next pivot, by its row and its unknown; None if no row has an unknown."""
    columns: dict[Symbol, int] = {}
    for row in rows:
        for symbol in row.entries:
            columns[symbol] = columns.get(symbol, 0) + 1
    best: tuple[tuple[int, bool, int, int, int], int, Symbol] | None = None
    for place, row in enumerate(rows):
        for symbol, entry in row.entries.items():
            fill = (len(row.entries) - 1) * (columns[symbol] - 1)
            grade = _grade(entry)
            # units first and `last` unknowns last, then the diagonal, then fill-in; ties in declared order
            foreign = str(symbol[1]).partition(".")[0] != row.owner
            cost = (min(grade, 1) + 10 * (symbol in last), foreign, fill, grade, place)
            if best is None or cost < best[0]:
                best = cost, place, symbol
    return None if best is None else (best[1], best[2])


def _grade(entry: Scalar) -> int:
    if not isinstance(entry, Node):
        return 0 if entry in (1, -1) else 1
    return 2 if entry.op == SYMBOL else 3


def _plain(x: Scalar) -> bool:
    return not isinstance(x, Node)


def _over(x: Scalar, pivot: Scalar, dag: Dag) -> Scalar:
    """The quotient by a pivot; that of two numbers is exact, since rounded terms would not cancel."""
    if isinstance(pivot, Node):
        return x / pivot
    if pivot in (1, -1):
        return x if pivot == 1 else -x
    return x / pivot if isinstance(x, Node) else constant(quotient(x, pivot), dag)
