"""Mass distributions against clouds of point masses, whose moments are plain sums."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from support.rigid_motion import UPPER, rows, tensor, turned

from linegraph.spatial.inertia import (
    NO_MOMENTS,
    Moments,
    carried,
    carried_in_plane,
    joined,
    point_apart,
    round_apart,
    second_moments,
)
from linegraph.spatial.rotation import Full, Relabel, Rotation, Turn
from linegraph.spatial.vector import ZERO

EXACT = 4e-15
ANGLE = 0.7
ROTATIONS = {
    "full": Rotation((Full(rows(turned((1, -2, 0.5), 1.1))),)),
    "about x, then axes exchanged": Rotation(
        (Turn(0, math.cos(ANGLE), math.sin(ANGLE)), Relabel((1, 2, 0), (1, 1, 1)))
    ),
    "none": Rotation(),
}
MATRICES = {
    "full": turned((1, -2, 0.5), 1.1),
    "about x, then axes exchanged": turned((1, 0, 0), ANGLE)
    @ np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]]),
    "none": np.eye(3),
}
AT = (0.3, -0.7, 1.1)

Cloud = tuple[Any, Any]


def cloud(seed: int) -> Cloud:
    rng = np.random.default_rng(seed)
    return rng.uniform(0.1, 1.0, size=5), rng.normal(size=(5, 3))


def packed(m: Any) -> tuple[float, ...]:
    return tuple(float(m[i, j]) for i, j in UPPER)


def moments_of(points: Cloud) -> Moments:
    m, r = points
    first = tuple(float(x) for x in m @ r)
    return Moments(float(m.sum()), first, packed((m[:, None] * r).T @ r))  # type: ignore[arg-type]


def inertia_of(points: Cloud) -> Any:
    return sum(m * ((r @ r) * np.eye(3) - np.outer(r, r)) for m, r in zip(*points, strict=True))


def same(found: Moments, expected: Moments) -> None:
    np.testing.assert_allclose(found.mass, expected.mass, atol=EXACT)
    np.testing.assert_allclose(found.first, expected.first, atol=EXACT)
    np.testing.assert_allclose(found.second, expected.second, atol=4 * EXACT)


def test_the_inertia_of_second_moments_is_that_of_the_points() -> None:
    points = cloud(1)
    np.testing.assert_allclose(
        tensor(moments_of(points).inertia), inertia_of(points), atol=4 * EXACT
    )


def test_second_moments_of_an_inertia_are_those_of_the_points() -> None:
    points = cloud(2)
    found = second_moments(packed(inertia_of(points)))  # type: ignore[arg-type]
    np.testing.assert_allclose(found, moments_of(points).second, atol=4 * EXACT)


def test_a_slender_body_keeps_its_small_moment_to_the_last_digit() -> None:
    small = 1.2345678901234567e-17
    found = second_moments((0.1, 0, 0, 0.1, 0, small))
    assert found[0] == found[3] == small / 2
    # without what is known of the diagonal, the sums of other rotated moments would lose it
    rod = Moments(1.0, (0.1, 0, 0), (0, 0, 0, 0.1, 0, 0.1), (small, 0.1, 0.1))
    assert rod.inertia[0] == small


@pytest.mark.parametrize("name", ROTATIONS)
def test_carried_moments_are_those_of_the_moved_points(name: str) -> None:
    m, r = cloud(3)
    found = carried(moments_of((m, r)), ROTATIONS[name], AT)
    same(found, moments_of((m, r @ MATRICES[name].T + np.array(AT))))


def test_a_known_diagonal_of_the_inertia_is_carried_with_the_moments() -> None:
    m, r = cloud(4)
    given = moments_of((m, r))
    xx, _, _, yy, _, zz = packed(inertia_of((m, r)))
    turn = Rotation((Turn(2, math.cos(ANGLE), math.sin(ANGLE)),))
    found = carried(given._replace(about=(xx, yy, zz)), turn, AT)
    moved = inertia_of((m, r @ turned((0, 0, 1), ANGLE).T + np.array(AT)))
    # a turn about z mixes xx and yy, of which nothing is then known
    assert found.about[:2] == (None, None)
    assert found.about[2] == pytest.approx(moved[2, 2], abs=4 * EXACT)
    shifted = carried(given._replace(about=(xx, yy, zz)), Rotation(), AT)
    expected = np.diag(inertia_of((m, r + np.array(AT))))
    np.testing.assert_allclose(shifted.about, expected, atol=4 * EXACT)


def test_in_a_plane_only_the_inertia_about_z_is_carried() -> None:
    m, r = cloud(5)
    r[:, 2] = 0
    whole = inertia_of((m, r))[2, 2]
    given = Moments(*moments_of((m, r))[:2], (whole, 0, 0, 0, 0, 0), (None, None, whole))
    turn = Rotation((Turn(2, math.cos(ANGLE), math.sin(ANGLE)),))
    at = (0.4, -0.9, 0)
    found = carried_in_plane(given, turn, at)
    moved = r @ turned((0, 0, 1), ANGLE).T + np.array(at)
    assert found.inertia[5] == pytest.approx(inertia_of((m, moved))[2, 2], abs=4 * EXACT)
    assert found.second[0] == found.inertia[5]
    np.testing.assert_allclose(found.first, m @ moved, atol=EXACT)


def test_joined_moments_are_those_of_both_clouds() -> None:
    (m, r), (n, s) = cloud(6), cloud(7)
    found = joined(moments_of((m, r)), moments_of((n, s)))
    same(found, moments_of((np.concatenate([m, n]), np.vstack([r, s]))))
    assert found.about == (None, None, None)


def test_the_diagonals_of_two_bodies_add_up_where_both_are_known() -> None:
    a = NO_MOMENTS._replace(about=(1.0, None, 3.0))
    b = NO_MOMENTS._replace(about=(0.5, 0.5, None))
    assert joined(a, b).about == (1.5, None, None)


def test_a_point_set_apart_leaves_moments_that_add_up_and_no_mass() -> None:
    given = moments_of(cloud(8))
    kept, handed = point_apart(given)
    same(joined(kept, handed), given)
    assert (kept.mass, kept.first, kept.second) == (0, given.first, given.second)
    assert (handed.first, handed.second) == (ZERO, (0, 0, 0, 0, 0, 0))


def test_what_is_round_about_z_set_apart_makes_no_turn_about_z_felt() -> None:
    given = moments_of(cloud(9))
    kept, handed = round_apart(given)
    same(joined(kept, handed), given)
    assert kept.inertia[5] == given.inertia[5]
    # a spread along z is an inertia about x and y, the same in all directions across z
    assert handed.inertia == (given.second[5], 0, 0, given.second[5], 0, 0)
    assert (handed.mass, handed.first) == (0, ZERO)
