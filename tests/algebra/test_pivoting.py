"""Columns of J and motions that it allows, beside what NumPy's decompositions say."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from linegraph.algebra.pivoting import apart_columns, free_motions

SEEDS = range(200)


def matrix(seed: int) -> tuple[Any, int]:
    """A matrix and its rank; columns of very different size, and nearly dependent ones, are among them."""
    rng = np.random.default_rng(seed)
    rows, columns = (int(x) for x in rng.integers(1, 18, size=2))
    rank = int(rng.integers(0, min(rows, columns) + 1))
    J = rng.normal(size=(rows, rank)) @ rng.normal(size=(rank, columns))
    if seed % 2:
        J = J * 10.0 ** rng.integers(-6, 1, size=columns)
    if seed % 3 == 0:
        J = J + 1e-5 * rng.normal(size=J.shape)
    return J, rank


def by_decomposition(J: Any, most: int, apart: float) -> list[int]:
    """The same columns by the singular values of every set that is tried."""
    taken: list[int] = []
    for k in reversed(range(J.shape[1])):
        least = np.linalg.svd(J[:, [*taken, k]], compute_uv=False).min()
        if len(taken) < most and least > apart:
            taken.append(k)
    return taken


@pytest.mark.parametrize("apart", [1e-4, 1e-6])
def test_columns_far_from_dependent_are_those_that_singular_values_choose(apart: float) -> None:
    chosen = set()
    for seed in SEEDS:
        J, most = matrix(seed)
        found = apart_columns(J, list(reversed(range(J.shape[1]))), most, apart)
        assert found == by_decomposition(J, most, apart), seed
        chosen.add(len(found) == most)
    assert chosen == {True, False}  # of some there are not as many as asked for


def test_free_motions_are_a_basis_of_what_j_allows() -> None:
    for seed in SEEDS:
        rng = np.random.default_rng(seed)
        rows, columns = (int(x) for x in rng.integers(1, 18, size=2))
        rank = int(rng.integers(0, min(rows, columns) + 1))
        J = rng.normal(size=(rows, rank)) @ rng.normal(size=(rank, columns))
        T = free_motions(J, rank)
        assert T.shape == (columns, columns - rank)
        assert np.abs(J @ T).max(initial=0.0) < 1e-11 * np.abs(J).max(initial=1.0)
        assert np.linalg.matrix_rank(T) == columns - rank if T.size else True
