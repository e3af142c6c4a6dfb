"""Rotations: every factor against numpy's matrices, classification, alignment, snapping, quaternions.

Errors are a few units in the last place throughout.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from systems import random_trees as trees

from linegraph.spatial.rotation import (
    IDENTITY_MATRIX,
    Full,
    Relabel,
    Rotation,
    Turn,
    about,
    from_quaternion,
    from_rpy,
    product,
    rotation_of,
    snapped,
    z_onto,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

EXACT = 4e-15  # measured 1.6e-15
SEEDS = range(20)
UPPER = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
E3 = np.eye(3)


def relabels() -> list[Relabel]:
    """The 24 signed permutations that are rotations."""
    found = []
    for source in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            if np.linalg.det(np.diag(signs) @ E3[list(source)]) > 0:
                found.append(Relabel(source, signs))  # type: ignore[arg-type]
    return found


def rows(a: NDArray[np.float64]) -> Any:
    return tuple(tuple(float(x) for x in row) for row in a)


def matrix_of(factor: Any) -> NDArray[np.float64]:
    """The factor's matrix by its definition, not by its own methods."""
    if isinstance(factor, Turn):
        i, j = (factor.axis + 1) % 3, (factor.axis + 2) % 3
        m = np.eye(3)
        m[i, i] = m[j, j] = factor.cosine
        m[i, j], m[j, i] = -factor.sine, factor.sine
        return m
    if isinstance(factor, Relabel):
        return np.asarray(np.diag(factor.signs) @ E3[list(factor.source)], dtype=float)
    return np.array(factor.rows, dtype=float)


def random_factor(rng: np.random.Generator) -> Any:
    kind = rng.integers(3)
    if kind == 0:
        angle = float(rng.uniform(-np.pi, np.pi))
        return Turn(int(rng.integers(3)), math.cos(angle), math.sin(angle))
    if kind == 1:
        return relabels()[int(rng.integers(24))]
    return Full(rows(trees.random_rotation(rng)))


def tensor(packed: Any) -> NDArray[np.float64]:
    m = np.zeros((3, 3))
    for (i, j), x in zip(UPPER, packed, strict=True):
        m[i, j] = m[j, i] = x
    return m


def close(found: Any, expected: Any) -> None:
    np.testing.assert_allclose(found, expected, rtol=0, atol=EXACT)


def check(rotation: Any, m: NDArray[np.float64], rng: np.random.Generator) -> None:
    """Applications of a factor or a product against its matrix."""
    a = rng.normal(size=3)
    j = rng.normal(size=6)
    given = tuple(a.tolist())
    close(rotation.out(given), m @ a)
    close(rotation.into(given), m.T @ a)
    turned = m @ tensor(j) @ m.T
    expected = [turned[place] for place in UPPER]
    close(rotation.congruence(tuple(j.tolist())), expected)
    back = rotation.inverse()
    close(back.out(given), m.T @ a)
    close(back.into(given), m @ a)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("axis", range(3))
def test_a_turn_is_its_matrix(axis: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    angle = float(rng.uniform(-np.pi, np.pi))
    turn = Turn(axis, math.cos(angle), math.sin(angle))
    check(turn, matrix_of(turn), rng)
    close(about(rows(E3)[axis], angle), matrix_of(turn))


@pytest.mark.parametrize("relabel", relabels(), ids=str)
def test_a_relabelling_is_its_matrix(relabel: Relabel) -> None:
    rng = np.random.default_rng(0)
    check(relabel, matrix_of(relabel), rng)


def test_a_relabelling_of_integers_stays_integral() -> None:
    for relabel in relabels():
        a = relabel.out((1, 2, 3))
        assert all(isinstance(x, int) for x in a)
        assert relabel.into(a) == (1, 2, 3)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_full_matrix_is_its_matrix(seed: int) -> None:
    rng = np.random.default_rng(seed)
    m = trees.random_rotation(rng)
    check(Full(rows(m)), m, rng)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_product_is_the_product_of_its_factors(seed: int) -> None:
    rng = np.random.default_rng(seed)
    factors = [random_factor(rng) for _ in range(int(rng.integers(0, 5)))]
    m = np.eye(3)
    for factor in factors:
        m = m @ matrix_of(factor)
    whole = Rotation(tuple(factors))
    check(whole, m, rng)
    close(whole.matrix(), m)
    close((whole @ whole.inverse()).matrix(), E3)
    inner = Rotation((random_factor(rng),))
    close((whole @ inner).matrix(), m @ matrix_of(inner.factors[0]))
    close(product(rows(m), inner.matrix()), m @ inner.matrix())


def test_the_empty_product_is_the_identity() -> None:
    assert Rotation().matrix() == IDENTITY_MATRIX
    assert Rotation().inverse() == Rotation()


# ---- the cheapest factor


def test_the_identity_needs_no_factor() -> None:
    assert rotation_of(IDENTITY_MATRIX).factors == ()
    assert rotation_of(((1.0, 0.0, -0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))).factors == ()


@pytest.mark.parametrize("relabel", relabels(), ids=str)
def test_a_signed_permutation_is_relabelled(relabel: Relabel) -> None:
    m = rows(matrix_of(relabel))
    factors = rotation_of(m).factors
    assert factors == (() if m == IDENTITY_MATRIX else (relabel,))


@pytest.mark.parametrize("axis", range(3))
def test_a_turn_about_a_coordinate_axis_is_recognised(axis: int) -> None:
    turn = Turn(axis, 0.6, -0.8)
    assert rotation_of(rows(matrix_of(turn))).factors == (turn,)


@pytest.mark.parametrize("axis", range(3))
def test_a_turn_with_the_axis_reversed_is_no_turn(axis: int) -> None:
    """Half a turn more: the diagonal entry is -1, so only a full matrix says it."""
    flip = np.eye(3)
    flip[axis, axis] = flip[(axis + 1) % 3, (axis + 1) % 3] = -1
    m = matrix_of(Turn(axis, 0.6, -0.8)) @ flip
    (factor,) = rotation_of(rows(m)).factors
    assert isinstance(factor, Full)
    np.testing.assert_array_equal(matrix_of(factor), m)


@pytest.mark.parametrize("seed", SEEDS)
def test_classified_or_not_it_is_the_same_matrix(seed: int) -> None:
    rng = np.random.default_rng(seed)
    m = matrix_of(random_factor(rng))
    np.testing.assert_array_equal(np.array(rotation_of(rows(m)).matrix(), dtype=float), m)


# ---- alignment


def alignments() -> list[tuple[float, float, float]]:
    """Coordinate axes, general ones, and ever closer to -z."""
    rng = np.random.default_rng(0)
    axes = [*E3, *-E3, *rng.normal(size=(10, 3))]
    axes += [np.array([s * 10.0**-k, 2 * 10.0**-k, -1.0]) for k in range(1, 13) for s in (1, -1)]
    axes += [np.array([1.0, 1.0, s * 10.0**-k]) for k in (3, 17) for s in (1, -1)]
    return [tuple((a / np.linalg.norm(a)).tolist()) for a in axes]


@pytest.mark.parametrize("axis", alignments())
def test_the_smallest_rotation_takes_z_onto_an_axis(axis: tuple[float, float, float]) -> None:
    """Against Rodrigues' formula about z x axis, whose angle atan2 knows to the last digit."""
    m = np.array(z_onto(axis), dtype=float)
    np.testing.assert_array_equal(m @ [0, 0, 1], axis)
    close(m @ m.T, E3)
    assert np.linalg.det(m) == pytest.approx(1, abs=EXACT)
    level = np.hypot(axis[0], axis[1])
    if level == 0:
        expected = np.diag([1.0, axis[2], axis[2]])
    else:
        hinge = (-axis[1] / level, axis[0] / level, 0.0)
        expected = np.array(about(hinge, math.atan2(level, axis[2])))
    close(m, expected)


def test_alignment_of_integers_is_integral() -> None:
    assert z_onto((0, 0, 1)) == IDENTITY_MATRIX
    assert z_onto((0, 0, -1)) == ((1, 0, 0), (0, -1, 0), (0, 0, -1))
    for axis in ((1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)):
        factors = rotation_of(z_onto(axis)).factors
        assert [type(factor) for factor in factors] == [Relabel]


# ---- snapping


def test_snapping_replaces_what_is_near_and_nothing_else() -> None:
    m = ((1 - 1e-12, 1e-12, -1e-12), (-1e-12, 0.6, -0.8), (1e-10, 0.8, 0.6))
    assert snapped(m, 1e-11) == ((1, 0, 0), (0, 0.6, -0.8), (1e-10, 0.8, 0.6))
    assert snapped(m, 0) == m
    assert all(isinstance(x, int) for x in snapped(m, 1e-11)[0])


def test_snapping_at_the_bound() -> None:
    within = 2.0**-20
    bound, beyond = 1 + within, 1 + within + 2.0**-40
    assert snapped(((bound,) * 3, (beyond,) * 3, (0.0,) * 3), within) == (
        (1, 1, 1),
        (beyond,) * 3,
        (0, 0, 0),
    )


def test_snapping_leaves_symbols_and_integers() -> None:
    sign = object()
    m: Any = ((sign, 1, 0), (2, sign, 0.0), (0, 0, 1))
    assert snapped(m, 0.1) == m


def test_quarter_turns_written_in_decimals_become_exact() -> None:
    for rpy in itertools.product((0.0, math.pi / 2, -math.pi / 2, math.pi), repeat=3):
        factors = rotation_of(snapped(from_rpy(*rpy), 1e-11)).factors
        assert all(isinstance(factor, Relabel) for factor in factors), rpy


# ---- angles and quaternions


@pytest.mark.parametrize("seed", SEEDS)
def test_roll_pitch_yaw_are_turns_about_fixed_axes(seed: int) -> None:
    roll, pitch, yaw = np.random.default_rng(seed).uniform(-np.pi, np.pi, size=3).tolist()
    x, y, z = (
        matrix_of(Turn(k, math.cos(a), math.sin(a))) for k, a in enumerate((roll, pitch, yaw))
    )
    close(from_rpy(roll, pitch, yaw), z @ y @ x)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_turn_about_a_direction_keeps_it_and_turns_the_rest(seed: int) -> None:
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    angle = float(rng.uniform(-np.pi, np.pi))
    m: NDArray[np.float64] = np.array(about(tuple(axis.tolist()), angle))
    close(m @ axis, axis)
    close(m @ m.T, E3)
    assert np.trace(m) == pytest.approx(1 + 2 * math.cos(angle), abs=EXACT)
    across = np.cross(axis, [1.0, 0.0, 0.0])
    turned = math.cos(angle) * across + math.sin(angle) * np.cross(axis, across)
    close(m @ across, turned)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_quaternion_is_its_axis_and_angle(seed: int) -> None:
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    angle = float(rng.uniform(-np.pi, np.pi))
    x, y, z = (math.sin(angle / 2) * axis).tolist()
    w = math.cos(angle / 2)
    expected = about(tuple(axis.tolist()), angle)
    close(from_quaternion(x, y, z, w), expected)
    close(from_quaternion(-x, -y, -z, -w), expected)


def test_the_quaternion_of_no_rotation() -> None:
    assert from_quaternion(0, 0, 0, 1) == IDENTITY_MATRIX
