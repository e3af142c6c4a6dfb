"""Placements against 4 x 4 matrices."""

from __future__ import annotations

import math

import numpy as np
import sympy
from support.rigid_motion import pose, rows, turned, undone

from linegraph.spatial.placement import Placement, compose, inverse, swept

OUTER = pose(turned((1, 1, 0), 0.7), (0.1, 0.2, -0.3))
INNER = pose(turned((0, -1, 2), -1.2), (1.0, 0.0, 0.5))


def placement(p: np.ndarray) -> Placement:
    return Placement(tuple(p[:3, 3].tolist()), rows(p[:3, :3]))  # type: ignore[arg-type]


def matrix(p: Placement) -> np.ndarray:
    return pose(np.array(p.rotation, float), np.array(p.at, float))


def test_composed_placements_multiply_like_matrices() -> None:
    found = compose(placement(OUTER), placement(INNER), snap=0.0)
    np.testing.assert_allclose(matrix(found), OUTER @ INNER, atol=4e-16)


def test_the_inverse_placement_is_the_inverse_matrix() -> None:
    np.testing.assert_allclose(matrix(inverse(placement(OUTER))), undone(OUTER), atol=4e-16)


def test_two_quarter_turns_compose_to_exact_entries() -> None:
    quarter = placement(pose(turned((0, 0, 1), math.pi / 2), (1.0, 0.0, 0.0)))
    found = compose(quarter, quarter, snap=1e-12)
    assert found.rotation == ((-1, 0, 0), (0, -1, 0), (0, 0, 1))
    assert found.at == (1.0, 1.0, 0)  # cos(pi/2) = 6e-17 left nothing in x


def test_dust_is_swept_by_the_size_of_the_vector_it_came_from() -> None:
    assert swept((1e-16, 1.0, -3e-16), (1.0, 0, 0)) == (0, 1.0, 0)
    assert swept((1e-16, 1e-15, 0.0), (0, 1e-15, 0)) == (1e-16, 1e-15, 0)
    assert swept((1e-10, 1.0, 0), (1.0, 0, 0), within=1e-9) == (0, 1.0, 0)


def test_symbols_are_never_swept() -> None:
    x = sympy.Symbol("x")
    assert swept((x, 1e-17, 0), (1.0, x, 0)) == (x, 1e-17, 0)
