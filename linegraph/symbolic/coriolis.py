"""The Coriolis matrix C: ``C v`` is the part of the bias quadratic in v, and ``Ṁ - 2C`` is skew.

If velocities are derivatives of coordinates, it consists of Christoffel's symbols of M,

    C_ij = Σ_k Γ_ikj v_k        Γ_ikj = (∂M_ij/∂q_k + ∂M_ik/∂q_j - ∂M_jk/∂q_i)/2

Angular velocities are not such derivatives, and the formula fails for them. With derivatives D_k along
the columns of N (q̇ = N v), the symmetric part of Γ_i comes from the bias, S_ijk = (∂²h_i/∂v_j∂v_k)/2.
The remainder of D_k M = C + Cᵀ determines the rest up to a part that is skew in all three indices,
which is set to zero.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.algebra.differentiation import Calculus

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.ir.dag import Dag

Rows = list[list["Scalar"]]


def coriolis_matrix(
    dag: Dag,
    mass: Rows,
    bias: Sequence[Scalar],
    rates: Sequence[Scalar],
) -> Rows:
    """The Coriolis matrix C(q, v) over a DAG.

    Args:
        dag: of all scalars; q and v are its symbols ``q, k`` and ``v, k``.
        mass: M, n x n.
        bias: h without force elements; its part quadratic in v is used.
        rates: N v, the rates of the coordinates.
    """
    size = len(mass)
    calculus = Calculus(dag)
    v = [dag.symbol("v", k) for k in range(size)]
    along = _directions(calculus, rates, size)
    slopes = [
        [[_along(calculus, entry, along[k]) for k in range(size)] for entry in row] for row in mass
    ]

    def christoffel(i: int, k: int, j: int) -> Scalar:
        return (slopes[i][j][k] + slopes[i][k][j] - slopes[j][k][i]) / 2

    natural = len(rates) == size and all(x is y for x, y in zip(rates, v, strict=True))
    symbols = christoffel if natural else _of_bias(calculus, bias, slopes)
    return [
        [_sum(symbols(i, k, j) * v[k] for k in range(size)) for j in range(size)]
        for i in range(size)
    ]


def gradient_along(dag: Dag, x: Scalar, rates: Sequence[Scalar], size: int) -> list[Scalar]:
    """Gradient of a potential along the velocities, ``Nᵀ ∂x/∂q``: minus its generalised force.

    Args:
        dag: of all scalars.
        x: the potential (J).
        rates: N v, the rates of the coordinates.
        size: the number of velocities.
    """
    calculus = Calculus(dag)
    return [_along(calculus, x, direction) for direction in _directions(calculus, rates, size)]


def _of_bias(
    calculus: Calculus, bias: Sequence[Scalar], slopes: list[Rows]
) -> Callable[[int, int, int], Scalar]:
    """Christoffel's symbols Γ for velocities that are not derivatives of coordinates."""
    size = len(bias)
    first = [[calculus.derivative(h, ("v", j)) for j in range(size)] for h in bias]
    second = [
        [[calculus.derivative(d, ("v", k)) for k in range(size)] for d in row] for row in first
    ]

    def symmetric(i: int, j: int, k: int) -> Scalar:
        return second[i][j][k] / 2

    def left(k: int, i: int, j: int) -> Scalar:
        return slopes[i][j][k] - symmetric(i, k, j) - symmetric(j, k, i)

    def symbol(i: int, k: int, j: int) -> Scalar:
        return symmetric(i, j, k) + (2 * left(k, i, j) + left(i, j, k)) / 3

    return symbol


def _directions(
    calculus: Calculus, rates: Sequence[Scalar], size: int
) -> list[list[tuple[int, Scalar]]]:
    """The columns of N, by their non-zero entries."""
    return [
        [
            (place, entry)
            for place, rate in enumerate(rates)
            if (entry := calculus.derivative(rate, ("v", k))) != 0
        ]
        for k in range(size)
    ]


def _along(calculus: Calculus, x: Scalar, direction: list[tuple[int, Scalar]]) -> Scalar:
    return _sum(calculus.derivative(x, ("q", place)) * entry for place, entry in direction)


def _sum(parts: Iterable[Scalar]) -> Scalar:
    total: Scalar = 0
    for part in parts:
        total = total + part
    return total
