"""Algorithms of mechanisms with loops, for a particle on a curve: against closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from particle import BETA, Particle, on_circle

from linegraph.ir.algorithms.complete import complete
from linegraph.ir.algorithms.dynamics import after_dynamics, constrained_dynamics, rhs
from linegraph.ir.algorithms.language import Failed
from linegraph.ir.algorithms.linearization import linearization
from linegraph.ir.algorithms.project import project
from linegraph.ir.algorithms.reduction import reduced_equations, reduction
from linegraph.ir.statuses import NO_VELOCITY, NOT_CLOSED, NOT_DETERMINED, SINGULAR_POSITION

ANGLES = (0.3, 1.2, 2.5, 4.0, 5.8)


def called(algorithm: Any, particle: Any, *given: Any, sizes: tuple[int, ...]) -> list[Any]:
    """The outputs of an algorithm, which writes all of them whatever stood there."""
    outputs = [Particle.list([7.25] * size) for size in sizes]
    algorithm(particle, *map(Particle.list, given), *outputs)
    return [np.array([x[i] for i in range(len(x))]) for x in outputs]


def refused(status: Any, algorithm: Any, particle: Any, *given: Any, sizes: Any) -> None:
    """The algorithm ends with this status."""
    with pytest.raises(Failed) as caught:
        called(algorithm, particle, *given, sizes=sizes)
    assert caught.value.status == status


def dynamics(p: Particle) -> list[Any]:
    return called(constrained_dynamics, p, p.q, p.v, sizes=(2, p.NC))


# ---- dynamics


@pytest.mark.parametrize("twice", [False, True])
def test_accelerations_and_multipliers_on_a_circle(twice: bool) -> None:
    for angle in ANGLES:
        p = on_circle(angle, 1.5, twice=twice)
        a, lam = dynamics(p)
        expected, multiplier = p.expected()
        assert a == pytest.approx(expected, rel=1e-12)
        shares = np.array([0.2, 0.4]) if twice else np.array([1.0])
        assert lam == pytest.approx(multiplier * shares, rel=1e-12)


def test_a_gap_is_brought_back_at_the_chosen_rate() -> None:
    p = on_circle(0.7, 1.5, baumgarte=True)
    p.q = 1.01 * p.q
    a, _ = dynamics(p)
    assert p.normal(p.q) @ a == pytest.approx(p.bend(p.v) - BETA**2 * p.gap(p.q), rel=1e-12)


SMALL = 4e-3


@pytest.mark.parametrize("baumgarte", [False, True])
@pytest.mark.parametrize(
    ("y", "slope", "certain"),
    [
        *((0.0, 0.0, True), (1e-13, 0.0, True), (1e-6, 0.0, False), (-1e-6, 0.0, False)),
        *((0.0, 1e-11, True), (0.0, 1e-6, False), (0.0, -1e-6, False)),
    ],
)
def test_near_the_centre_of_a_cross_errors_are_seen(
    y: float, slope: float, certain: bool, baumgarte: bool
) -> None:
    """J is (y, x): the smallest pivot is x, and errors of J are those of the state."""
    p = Particle((SMALL, y), (1.0, slope), cross=True, baumgarte=baumgarte)
    if certain:
        a, lam = dynamics(p)
        assert a == pytest.approx([p.u / 2.0, 0.0], abs=1e-6)
        assert lam == pytest.approx([p.weight / SMALL], rel=1e-6)
    else:
        refused(SINGULAR_POSITION, constrained_dynamics, p, p.q, p.v, sizes=(2, 1))


def test_far_from_it_the_same_errors_do_not_matter() -> None:
    for y, slope in ((1e-9, 0.0), (0.0, 1e-9)):
        p = Particle((1.0, y), (1.0, slope), cross=True)
        a, lam = dynamics(p)
        assert a == pytest.approx([p.u / 2.0, 0.0], abs=1e-7)
        assert lam == pytest.approx([p.weight], rel=1e-7)


def test_the_derivative_of_the_state_is_rates_and_accelerations() -> None:
    p = on_circle(0.7, 1.5)
    (found,) = called(rhs, Stated(p), [*p.q, *p.v], sizes=(4,))
    assert found == pytest.approx([*p.v, *p.expected()[0]], rel=1e-12)


class Stated:
    """The particle, whose functions are given positions and velocities."""

    def __init__(self, p: Particle) -> None:
        """Counts are those of the particle."""
        self.p, self.NQ, self.NC, self.NV = p, 2, p.NC, 2
        self.last: Any = None

    def coordinate_rates(self, qdot: Any, *, q: Any, v: Any) -> None:
        assert [q[0], q[1]] == list(self.p.q)
        self.p.coordinate_rates(qdot, v=v)

    def forward_dynamics(self, a: Any, lam: Any, **given: Any) -> None:
        if given:
            assert [given["q"][0], given["v"][0]] == [self.p.q[0], self.p.v[0]]
        self.p.forward_dynamics(a, lam)

    def then(self, a: Any, lam: Any) -> None:
        self.last = [a[0], a[1], lam[0]]


def test_a_function_follows_the_dynamics() -> None:
    p = on_circle(0.7, 1.5)
    stated: Any = Stated(p)
    after_dynamics(stated)
    a, lam = p.expected()
    assert stated.last == pytest.approx([*a, lam], rel=1e-12)


# ---- projection


@pytest.mark.parametrize("twice", [False, True])
def test_projection_takes_the_least_kinetic_energy(twice: bool) -> None:
    for angle in ANGLES:
        p = on_circle(angle, 1.5, twice=twice)
        p.q, p.v = 1.2 * p.q + np.array([0.05, -0.02]), p.v + np.array([0.3, 0.1])
        q, v = called(project, p, p.q, p.v, sizes=(2, 2))
        assert math.hypot(*q) == pytest.approx(1.0, abs=1e-14)
        assert p.normal(q) @ v == pytest.approx(0.0, abs=1e-13)
        # what was added is M^-1 J^T of something
        added = p.M @ (v - p.v)
        assert added[0] * q[1] - added[1] * q[0] == pytest.approx(0.0, abs=1e-13)


def test_what_is_on_the_curve_stays() -> None:
    p = on_circle(0.7, 1.5)
    q, v = called(project, p, p.q, p.v, sizes=(2, 2))
    assert q == pytest.approx(p.q, abs=1e-15)
    assert v == pytest.approx(p.v, abs=1e-15)


class Odd(Particle):
    """A curve that full steps overshoot: ``atan(10 y) = 0``."""

    def gap(self, q: Any) -> float:
        return math.atan(10 * q[1])

    def normal(self, q: Any) -> Any:
        return np.array([0.0, 10 / (1 + (10 * q[1]) ** 2)])


def test_steps_are_halved_until_the_gap_falls() -> None:
    p = Odd((0.2, 1.0), (1.0, 0.0))
    q, v = called(project, p, p.q, p.v, sizes=(2, 2))
    assert q == pytest.approx([0.2, 0.0], abs=1e-15)
    assert v == pytest.approx([1.0, 0.0])


class Never(Particle):
    """No curve at all: ``1 + (x² + y²)/2 = 0``."""

    def gap(self, q: Any) -> float:
        return 1 + (q @ q) / 2


def test_what_never_closes_is_refused() -> None:
    refused(NOT_CLOSED, project, Never((0.3, 0.4), (0, 0)), (0.3, 0.4), (0, 0), sizes=(2, 2))
    centre = on_circle(0.0, 0.0)
    # at the centre J is zero, and beside it the first step leads far away
    for near in (0.0, 1e-6):
        refused(NOT_CLOSED, project, centre, (near, 0.0), (0, 0), sizes=(2, 2))


def test_velocities_that_contradict_each_other_are_refused() -> None:
    class Moving(Particle):
        def constraint_rates(self, rates: Any, **given: Any) -> None:
            rates[0], rates[1] = 1.0, 0.0

    p = Moving((1.0, 0.0), (0.0, 0.0), twice=True)
    refused(NO_VELOCITY, project, p, p.q, p.v, sizes=(2, 2))


# ---- independent coordinates


def test_the_guess_decides_between_two_assemblies() -> None:
    for guess, sign in (((0.1, 0.9), 1), ((0.1, -0.4), -1)):
        p = on_circle(1.0, 0.0)
        q, v = called(complete, p, guess, (0.6,), (2.0,), sizes=(2, 2))
        assert q == pytest.approx([0.6, sign * 0.8], abs=1e-14)
        assert v == pytest.approx([2.0, -sign * 1.5], abs=1e-13)


def test_steps_are_short_so_that_the_assembly_beside_the_guess_is_found() -> None:
    """A whole first step from y = 0.01 would lead to 32 and, for a law that bends, beyond."""
    p = on_circle(1.0, 0.0)
    q, _ = called(complete, p, (0.6, 0.01), (0.6,), (2.0,), sizes=(2, 2))
    assert q == pytest.approx([0.6, 0.8], abs=1e-14)


class Wave(Particle):
    """``sin(3 y) = x``: a whole step from near a crest leads to another branch."""

    def gap(self, q: Any) -> float:
        return math.sin(3 * q[1]) - q[0]

    def normal(self, q: Any) -> Any:
        return np.array([-1.0, 3 * math.cos(3 * q[1])])


def test_a_step_moves_no_coordinate_by_more_than_half_its_size() -> None:
    p = Wave((0.0, 0.0), (0.0, 0.0))
    q, _ = called(complete, p, (0.0, 0.5), (0.1,), (0.0,), sizes=(2, 2))
    assert q == pytest.approx([0.1, math.asin(0.1) / 3], abs=1e-14)


def test_what_cannot_be_completed_is_refused() -> None:
    p = on_circle(1.0, 0.0)
    sizes = (2, 2)
    refused(NOT_CLOSED, complete, p, (1.0, 0.1), (1.5,), (0.0,), sizes=sizes)
    refused(NOT_DETERMINED, complete, p, (1.0, 0.0), (0.9,), (0.0,), sizes=sizes)


def test_velocities_and_accelerations_from_the_independent_ones() -> None:
    for angle in ANGLES:
        p = on_circle(angle, 1.5)
        T, rest = called(reduction, p, p.q, p.v, sizes=(2, 2))
        x, y = p.q
        assert pytest.approx([1.0, -x / y], rel=1e-12) == T
        assert rest == pytest.approx([0.0, -2.25 / y], rel=1e-12)


NEAR = 1e-3


@pytest.mark.parametrize(
    ("gap", "slip", "certain"),
    [
        *((0.0, 0.0, True), (1e-14, 0.0, True), (1e-9, 0.0, False), (-1e-9, 0.0, False)),
        *((0.0, 1e-14, True), (0.0, 1e-8, False), (0.0, -1e-8, False)),
    ],
)
def test_where_the_circle_turns_back_errors_are_seen(
    gap: float, slip: float, certain: bool
) -> None:
    """X no longer tells where the particle is: y changes by gap / y."""
    p = on_circle(NEAR, 1.5)
    p.q, p.v = p.q * (1 + gap), p.v + slip * p.q
    if certain:
        T, rest = called(reduction, p, p.q, p.v, sizes=(2, 2))
        assert pytest.approx([1.0, -1 / math.tan(NEAR)], rel=1e-6) == T
        assert rest == pytest.approx([0.0, -2.25 / math.sin(NEAR)], rel=1e-6)
    else:
        refused(NOT_DETERMINED, reduction, p, p.q, p.v, sizes=(2, 2))


def test_at_the_turn_nothing_is_determined() -> None:
    p = on_circle(0.0, 1.5)
    refused(NOT_DETERMINED, reduction, p, p.q, p.v, sizes=(2, 2))


def reduced_acceleration(x: float, w: float, u: float) -> float:
    """x¨ on the upper half of the circle."""
    y = math.sqrt(1 - x * x)
    p = Particle((x, y), (w, -x / y * w), u)
    return float(p.expected()[0][0])


def test_the_equations_in_the_independent_coordinate() -> None:
    p = on_circle(0.7, 1.5)
    Mr, hr = called(reduced_equations, p, sizes=(1, 1))
    T = np.array([1.0, -p.q[0] / p.q[1]])
    assert Mr == pytest.approx([T @ p.M @ T], rel=1e-12)
    acceleration = (T @ [p.u, 0.0] - hr[0]) / Mr[0]
    assert acceleration == pytest.approx(p.expected()[0][0], rel=1e-12)


@pytest.mark.parametrize("twice", [False, True])
def test_the_linearisation_is_that_of_differences(twice: bool) -> None:
    p = on_circle(0.7, 1.5, twice=twice)
    A, B = called(linearization, p, p.v, sizes=(4, 2))
    given = np.array([p.q[0], p.v[0], p.u])
    steps = 1e-5 * np.eye(3)
    slopes = [
        (reduced_acceleration(*(given + s)) - reduced_acceleration(*(given - s))) / 2e-5
        for s in steps
    ]
    assert A.reshape(2, 2) == pytest.approx(np.array([[0.0, 1.0], slopes[:2]]), rel=1e-6, abs=1e-9)
    assert pytest.approx([0.0, slopes[2]], rel=1e-6) == B
