"""Derivatives of scalars of the DAG by changes of q, by v, by u and by parameters, as columns."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.algebra.differentiation import Calculus
from linegraph.dynamics.composite_derivatives import has_slopes
from linegraph.dynamics.composite_derivatives import slopes as composite_slopes
from linegraph.ir.program import Result, operations_of, reads
from linegraph.kinematics import tangent_space as tangent
from linegraph.programs.implicit_slopes import loop_slopes

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.applied_forces import Applied
    from linegraph.programs.workspace import Workspace

Columns = list[list["Scalar"]]
"""One column per symbol, with an entry for each differentiated scalar."""

SMALL = 8
"""Up to this number of velocities, both kinds of derivatives are made and compared."""


def variables(f: Workspace) -> tuple[list[Symbol], list[Symbol], list[Symbol]]:
    """The symbols of changes of q, velocities and inputs."""
    velocities: list[Symbol] = [("v", k) for k in range(f.sizes["v"])]
    return tangent.changes(f.tree), velocities, [("u", k) for k in range(f.sizes["u"])]


def columns(f: Workspace, given: Sequence[Scalar], by: Sequence[Symbol]) -> Columns:
    """The derivatives of some scalars with respect to some symbols, by the rules of differentiation.

    Args:
        f: the shared equations.
        given: the scalars.
        by: the symbols.

    Returns:
        One column per symbol.

    Raises:
        ModelError: an algebraic loop has too many unknowns, or a function has no derivative.
    """
    wanted = {argument for argument, _ in by}
    fixed = {"v", "u", "p"} - wanted if tangent.CHANGE in wanted else {"q", "v", "u", "p"} - wanted
    f.dag.label = "derivatives"
    chain = tangent.chain(f.tree, f.q)
    if reads("loop", (Result("", (), tuple(given), ""),)):
        chain |= loop_slopes(f, chain)
    calculus = Calculus(f.dag, fixed, chain)
    found = [calculus.gradient(x) for x in given]
    return [[slopes.get(symbol, 0) for slopes in found] for symbol in by]


def of_motion(
    f: Workspace, acting: Applied, less: Sequence[Scalar], by: Sequence[Symbol]
) -> Columns:
    """The derivatives of ``M a + h - less`` with respect to some symbols.

    Those of mechanics by q and v come from composites, unless the rules of differentiation take fewer
    operations, as they do for a few joints. All others come by the rules.

    Args:
        f: the shared equations.
        acting: applied forces that are part of h.
        less: generalised forces to subtract.
        by: the symbols.

    Returns:
        One column per symbol.
    """
    required = f.required_by(acting, f.symbols("a"))
    whole = [x - y for x, y in zip(required, less, strict=True)]
    if not has_slopes(f.working):
        return columns(f, whole, by)
    found = _from_composites(f, acting, less, by, whole)
    if len(f.v) > SMALL:
        return found
    return min(found, columns(f, whole, by), key=_cost)


def _from_composites(
    f: Workspace,
    acting: Applied,
    less: Sequence[Scalar],
    by: Sequence[Symbol],
    whole: Sequence[Scalar],
) -> Columns:
    moving = [symbol for symbol in by if symbol[0] in (tangent.CHANGE, "v")]
    if not moving:
        return columns(f, whole, by)
    mechanics = composite_slopes(f.working, f.symbols("a"))
    parts = {
        tangent.CHANGE: turned(mechanics.by_change),
        "v": turned(mechanics.by_velocity),
    }
    rest = [-x - y for x, y in zip(f.along(acting), less, strict=True)]
    for i, j, entry in f.stored:
        rest[i] = rest[i] + entry * f.dag.symbol("a", j)
    others = [symbol for symbol in by if symbol not in moving]
    found = dict(zip(others, columns(f, whole, others), strict=True))
    for (argument, place), column in zip(moving, columns(f, rest, moving), strict=True):
        own = parts[argument][place]
        found[argument, place] = [x + y for x, y in zip(own, column, strict=True)]
    return [found[symbol] for symbol in by]


def _cost(given: Columns) -> int:
    return operations_of((matrix("", given, ""),))


def turned(rows: Sequence[Sequence[Scalar]]) -> Columns:
    """The columns of a matrix given by rows, or the reverse."""
    return [list(column) for column in zip(*rows, strict=True)]


def matrix(name: str, given: Columns, about: str) -> Result:
    """A result from the columns of a matrix.

    Args:
        name: of the result.
        given: the columns.
        about: its description.
    """
    rows = turned(given)
    entries = tuple(entry for row in rows for entry in row)
    return Result(name, (len(rows), len(given)), entries, about)
