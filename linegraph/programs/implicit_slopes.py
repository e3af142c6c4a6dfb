"""Derivatives of the unknowns of a network's algebraic loop, by the implicit function theorem.

The unknowns z solve r(z, x) = 0, so ``∂z/∂x = -K^-1 ∂r/∂x`` with K = ∂r/∂z. Newton's iteration itself
is not differentiated.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.algebra.differentiation import Calculus
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.algebra.differentiation import Gradient, Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.programs.workspace import Workspace

MOST = 3
"""The most unknowns for which K is inverted in straight-line code. Minors are used, since elimination
would need pivots that are known to be non-zero."""


def loop_slopes(f: Workspace, chain: Mapping[Symbol, Gradient]) -> dict[Symbol, Gradient]:
    """The derivatives of each unknown with respect to all symbols that it depends on.

    Args:
        f: the shared equations.
        chain: the derivatives of symbols that are not independent.

    Raises:
        ModelError: the loop has more unknowns than `MOST`.
    """
    assert f.networks is not None
    network = f.networks.network
    if len(network.loop) > MOST:
        problem = (
            f"its network has an algebraic loop of {len(network.loop)} unknowns; derivatives are taken "
            f"through loops of {MOST} at most"
        )
        raise ModelError(f'model "{f.tree.system.name}"', problem)
    calculus = Calculus(f.dag, ("loop",), chain)
    slopes = [calculus.gradient(f.networks.still(r)) for r in network.loop]
    inverse = _inverse([[f.networks.still(e) for e in row] for row in network.loop_jacobian])
    found: dict[Symbol, Gradient] = {}
    for i, row in enumerate(inverse):
        total: Gradient = {}
        for entry, slope in zip(row, slopes, strict=True):
            for symbol, x in slope.items():
                total[symbol] = total.get(symbol, 0) - entry * x
        found["loop", i] = total
    return found


def _inverse(rows: Sequence[Sequence[Scalar]]) -> list[list[Scalar]]:
    """The inverse by minors: defined wherever the matrix is regular."""
    size = len(rows)
    whole = _determinant(rows)

    def entry(i: int, j: int) -> Scalar:
        minor = [[x for k, x in enumerate(row) if k != i] for n, row in enumerate(rows) if n != j]
        return (-1) ** (i + j) * _determinant(minor) / whole

    return [[entry(i, j) for j in range(size)] for i in range(size)]


def _determinant(rows: Sequence[Sequence[Scalar]]) -> Scalar:
    if not rows:
        return 1
    total: Scalar = 0
    for k, x in enumerate(rows[0]):
        if x != 0:
            minor = [[*row[:k], *row[k + 1 :]] for row in rows[1:]]
            total = total + (-1) ** k * (x * _determinant(minor))
    return total
