"""Elimination with complete pivoting over floats, against singular values and null spaces of numpy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from linegraph.algebra.pivoting import apart_columns, free_motions, without_inertia


def random_matrix(seed: int, rows: int, columns: int, rank: int) -> Any:
    draw = np.random.default_rng(seed)
    return draw.normal(size=(rows, rank)) @ draw.normal(size=(rank, columns))


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize(("rows", "columns", "rank"), [(2, 4, 2), (3, 5, 2), (4, 4, 3), (1, 3, 1)])
def test_free_motions_move_nothing_that_is_constrained(
    seed: int, rows: int, columns: int, rank: int
) -> None:
    J = random_matrix(seed, rows, columns, rank)
    T = free_motions(J, rank)
    assert T.shape == (columns, columns - rank)
    assert np.abs(J @ T).max() < 1e-10 * max(1, np.abs(T).max())
    assert np.linalg.matrix_rank(T) == columns - rank


def test_each_free_velocity_stands_alone_in_one_motion() -> None:
    T = free_motions(random_matrix(1, 2, 5, 2), 2)
    ones = [k for k in range(5) if sorted(np.abs(T[k])) == [0, 0, 1]]
    assert len(ones) >= 3


def test_without_constraints_every_velocity_is_free() -> None:
    assert np.array_equal(free_motions(np.zeros((0, 3)), 0), np.eye(3))
    assert np.array_equal(free_motions(np.full((1, 3), 1e-9), 1), np.eye(3))


def test_a_motion_without_inertia_is_found() -> None:
    """Of two masses on one line without a third: M has no inertia along the third velocity."""
    M = np.diag([2.0, 3.0, 0.0])
    (found,) = without_inertia(M, np.eye(3), 1e-9)
    assert np.array_equal(found, [0, 0, 1])


@pytest.mark.parametrize("seed", range(4))
def test_motions_without_inertia_are_a_null_space(seed: int) -> None:
    """Light and heavy bodies side by side do not hide one another."""
    draw = np.random.default_rng(seed)
    heavy, light = draw.normal(size=2) * 1e3, draw.normal(size=2) * 1e-3
    factor = np.array([[*heavy, 0, 0], [0, 0, *light]])
    M = factor.T @ factor
    found = without_inertia(M, np.eye(4), 1e-9)
    assert len(found) == 2
    for x in found:
        assert np.abs(factor @ x / np.abs(factor).max(axis=1)).max() < 1e-9 * np.abs(x).max()


def test_a_light_body_is_no_body_without_inertia() -> None:
    assert without_inertia(np.diag([1e-12, 1.0]), np.eye(2), 1e-9) == []


def test_a_regular_inertia_leaves_none() -> None:
    factor = random_matrix(3, 4, 3, 3)
    assert without_inertia(factor.T @ factor, np.eye(3), 1e-9) == []


@pytest.mark.parametrize("seed", range(5))
def test_taken_columns_keep_the_least_singular_value_above_the_bound(seed: int) -> None:
    """Each column that was left would bring it below."""
    J = random_matrix(seed, 4, 7, 4)
    J /= np.linalg.norm(J, axis=0)
    order = list(np.random.default_rng(seed).permutation(7))
    apart = 0.3
    expected: list[int] = []
    for k in order:
        if len(expected) < 3:
            values = np.linalg.svd(J[:, [*expected, k]], compute_uv=False)
            if values.min() > apart:
                expected.append(k)
    assert apart_columns(J, order, 3, apart) == expected


def test_orthogonal_columns_are_as_far_apart_as_one_alone() -> None:
    """Their Frobenius norm alone would not decide that."""
    assert apart_columns(np.eye(3), [0, 1, 2], 3, 0.9) == [0, 1, 2]


def test_no_more_columns_are_taken_than_asked_for() -> None:
    assert apart_columns(np.eye(4), [2, 0, 1, 3], 2, 0.5) == [2, 0]
    assert apart_columns(np.array([[1.0, 1.0], [0.0, 1e-3]]), [0, 1], 2, 1e-2) == [0]
