"""Triples of scalars against NumPy's arrays."""

from __future__ import annotations

import numpy as np
import pytest
import sympy
from support.rigid_motion import rows

from linegraph.ir.dag import Dag
from linegraph.spatial import vector

RNG = np.random.default_rng(3)
A, B, C = (tuple(float(x) for x in RNG.normal(size=3)) for _ in range(3))
M = rows(RNG.normal(size=(3, 3)))


def close(found: object, expected: object) -> None:
    np.testing.assert_allclose(np.array(found, float), expected, rtol=0, atol=1e-15)


def test_sums_products_and_multiples_are_those_of_arrays() -> None:
    a, b = np.array(A), np.array(B)
    close(vector.add(A, B), a + b)
    close(vector.subtract(A, B), a - b)
    close(vector.negate(A), -a)
    close(vector.scale(0.3, A), 0.3 * a)
    close(vector.dot(A, B), a @ b)
    close(vector.cross(A, B), np.cross(a, b))
    close(vector.times(M, A), np.array(M) @ a)
    close(vector.transpose(M), np.array(M).T)
    close(vector.combine((0.5, -2.0, 3.0), (A, B, C)), 0.5 * a - 2 * b + 3 * np.array(C))


def test_the_skew_matrix_multiplies_like_the_cross_product() -> None:
    close(np.array(vector.skew(A)) @ np.array(B), np.cross(A, B))
    assert (np.array(vector.skew(A)) == -np.array(vector.skew(A)).T).all()


def test_a_sum_of_nothing_is_zero_and_of_unequal_numbers_refused() -> None:
    assert vector.combine((), ()) == (0, 0, 0)
    with pytest.raises(ValueError, match="shorter"):
        vector.combine((1, 2), (A,))


def test_zero_is_known_of_numbers_and_never_of_symbols() -> None:
    assert vector.is_zero((0, 0.0, -0.0))
    assert not any(vector.is_zero(v) for v in ((1, 0, 0), (0, 1e-300, 0), (0, 0, -1)))
    assert not vector.is_zero((0, 0, Dag().symbol("q", 0)))
    assert not vector.is_zero((sympy.Symbol("x"), 0, 0))
