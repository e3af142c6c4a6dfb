"""Derivatives of scalars of the DAG by changes of q, by v, by u, by parameters: columns of matrices."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph import tangent
from linegraph.differentiation import Calculus
from linegraph.loop_slopes import loop_slopes
from linegraph.program import Result, reads

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.differentiation import Symbol
    from linegraph.shared import Functions
    from linegraph.vector import Scalar

Columns = list[list["Scalar"]]
"""A column for each symbol, with an entry for each scalar that is differentiated."""


def variables(f: Functions) -> tuple[list[Symbol], list[Symbol], list[Symbol]]:
    """Changes of q, velocities and inputs."""
    velocities: list[Symbol] = [("v", k) for k in range(f.sizes["v"])]
    return tangent.changes(f.tree), velocities, [("u", k) for k in range(f.sizes["u"])]


def columns(f: Functions, given: Sequence[Scalar], by: Sequence[Symbol]) -> Columns:
    """The derivatives of some scalars by each of some symbols.

    Raises:
        ModelError: an algebraic loop has too many unknowns, or a function no derivative.
    """
    f.dag.label = "derivatives"
    chain = tangent.chain(f.tree, f.dag, f.q)
    if reads("loop", (Result("", (), tuple(given), ""),)):
        chain |= loop_slopes(f, chain)
    calculus = Calculus(f.dag, chain=chain)
    found = [calculus.gradient(x) for x in given]
    return [[slopes.get(symbol, 0) for slopes in found] for symbol in by]


def turned(rows: Sequence[Sequence[Scalar]]) -> Columns:
    """The columns of a matrix given by rows, or the other way round."""
    return [list(column) for column in zip(*rows, strict=True)]


def matrix(name: str, given: Columns, about: str) -> Result:
    """A result of these columns."""
    rows = turned(given)
    entries = tuple(entry for row in rows for entry in row)
    return Result(name, (len(rows), len(given)), entries, about)
