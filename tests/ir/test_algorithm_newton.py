"""Newton's method for algebraic loops, piece by piece."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from particle import Particle, filled

from linegraph.ir.algorithms.language import Failed, reals
from linegraph.ir.algorithms.newton import (
    advance,
    begin_near,
    descend,
    follow,
    is_only,
    newton,
    search,
)

if TYPE_CHECKING:
    from collections.abc import Callable

array = Particle.list


class Loop:
    """An algebraic loop of given residuals, whose unknowns and resistances are noted."""

    def __init__(
        self, size: int, law: Callable[[Any, float, float], Any], terms: float = 1.0
    ) -> None:
        """Derivatives are those of complex steps unless the law is real."""
        self.size, self.law, self.terms = size, law, terms
        self.seen: list[tuple[tuple[float, ...], tuple[float, float]]] = []

    def loop_equations(self, r: Any, K: Any, s: Any, *, loop: Any, ease: Any) -> None:
        x = np.array([loop[i] for i in range(self.size)])
        self.seen.append((tuple(x), (ease[0], ease[1])))
        with np.errstate(all="ignore"):
            filled(r, np.real(self.law(x + 0j, ease[0], ease[1])))
            step = 1e-30
            slopes = [
                np.imag(self.law(x + 1j * step * e, ease[0], ease[1])) / step
                for e in np.eye(self.size)
            ]
        filled(K, np.array(slopes).T)
        filled(s, np.full(self.size, self.terms))

    @property
    def eases(self) -> list[tuple[float, float]]:
        """The resistances, each as often as they are others than before."""
        found = [ease for _, ease in self.seen]
        return [x for k, x in enumerate(found) if k == 0 or x != found[k - 1]]


def loop(size: int, law: Any, terms: float = 1.0) -> Any:
    return Loop(size, law, terms)


MATRIX = np.array([[2.0, 1.0], [0.5, -3.0]])


def linear(x: Any, series: float, parallel: float) -> Any:
    return MATRIX @ x - [1.0, 2.0]


def bent(x: Any, series: float, parallel: float) -> Any:
    """``atan(x)``, which whole steps from afar miss ever further."""
    return np.array([np.arctan(x[0])])


def test_a_step_of_a_linear_loop_ends_at_its_solution() -> None:
    m = loop(2, linear)
    r, K, s, at = reals(2), reals(4), reals(2), array([5.0, -4.0])
    m.loop_equations(r, K, s, loop=at, ease=array([0.0, 0.0]))
    after = advance(m, array([0.0, 0.0]), False, 21.5, r, K, s, at)
    expected = np.linalg.solve(MATRIX, [1.0, 2.0])
    assert [at[0], at[1]] == pytest.approx(expected, rel=1e-14)
    assert after == pytest.approx(0.0, abs=1e-14)
    assert len(m.seen) == 2
    assert [K[i] for i in range(4)] == pytest.approx(MATRIX.ravel())


def test_steps_are_halved_as_often_as_they_must_be() -> None:
    m = loop(1, bent)
    at = array([3.0])
    r, K, s = reals(1), reals(1), reals(1)
    m.loop_equations(r, K, s, loop=at, ease=array([0.0, 0.0]))
    after = advance(m, array([0.0, 0.0]), False, math.atan(3.0), r, K, s, at)
    step = -10 * math.atan(3.0)
    tried = [x[0] for x, _ in m.seen[1:]]
    assert tried == pytest.approx([3 + step, 3 + step / 2, 3 + step / 4])
    assert at[0] == tried[-1]
    assert after == pytest.approx(math.atan(abs(tried[-1])))
    # it falls in proportion to what is left of the step
    for length, x in zip((1.0, 0.5, 0.25), tried, strict=True):
        assert (abs(math.atan(x)) <= (1 - 1e-4 * length) * math.atan(3.0)) is (length == 0.25)


def test_a_step_must_gain_a_ten_thousandth_of_its_length() -> None:
    for gain, taken in ((0.9e-4, False), (1.1e-4, True)):

        def law(x: Any, series: float, parallel: float, gain: float = gain) -> Any:
            """From 1 at 0 the slope promises 0 at 1, where hardly less is left."""
            return np.array([1 - x[0] if x[0].real < 1e-15 else 1 - gain + 0 * x[0]])

        m = loop(1, law)
        at, r, K, s = array([0.0]), reals(1), reals(1), reals(1)
        m.loop_equations(r, K, s, loop=at, ease=array([0.0, 0.0]))
        found = advance(m, array([0.0, 0.0]), False, 1.0, r, K, s, at)
        assert found == pytest.approx(1 - gain)
        assert (len(m.seen) == 2) is taken


def test_where_a_slope_is_infinite_no_step_leads() -> None:
    def law(x: Any, series: float, parallel: float) -> Any:
        return np.array([np.sqrt(x[0])]) if x[0].real > 0 else np.array([0 * x[0] + 1j * math.inf])

    m = loop(1, lambda x, a, b: np.array([x[0] ** 3]) if x[0].real > 0.4 else law(x, a, b))
    at, r, K, s = array([1.0]), reals(1), reals(1), reals(1)
    m.loop_equations(r, K, s, loop=at, ease=array([0.0, 0.0]))
    assert advance(m, array([0.0, 0.0]), False, 1.0, r, K, s, at) < 1.0
    assert at[0] > 0.4


def test_a_singular_jacobian_gives_no_step() -> None:
    m = loop(1, lambda x, a, b: np.array([1 + 0 * x[0]]))
    at, r, K, s = array([1.0]), reals(1), reals(1), reals(1)
    m.loop_equations(r, K, s, loop=at, ease=array([0.0, 0.0]))
    assert advance(m, array([0.0, 0.0]), False, 1.0, r, K, s, at) == math.inf


@pytest.mark.parametrize("strict", [False, True])
def test_rows_may_have_roundings_of_their_own(strict: bool) -> None:
    """All residuals become rounding, though the largest does not fall: taken unless `strict`."""

    def law(x: Any, series: float, parallel: float) -> Any:
        first = x[0] if x[0].real > 0.5 else 1.5e-13 + 0 * x[0]
        return np.array([first * 1e-13, 0 * x[0] + x[1]])

    m = loop(2, law, 1.0)
    at, r, K, s = array([1.0, 0.0]), reals(2), reals(4), reals(2)
    m.loop_equations(r, K, s, loop=at, ease=array([0.0, 0.0]))
    small = 1e-27
    found = advance(m, array([0.0, 0.0]), strict, small, r, K, s, at)
    assert (found < math.inf) is not strict


def test_newton_descends_to_the_solution_with_halved_steps() -> None:
    for start in (0.3, 3.0, -20.0, 1e3):
        m = loop(1, bent)
        at = array([start])
        assert descend(m, 0.0, 0.0, at)
        assert at[0] == pytest.approx(0.0, abs=1e-13)
        assert {ease for _, ease in m.seen} == {(0.0, 0.0)}
        assert len(m.seen) < 60


def test_it_goes_on_while_rounding_still_becomes_less() -> None:
    m = loop(1, lambda x, a, b: np.array([x[0] ** 2]), terms=1.0)
    at = array([1e-3])
    assert descend(m, 0.0, 0.0, at)
    # r = x² is rounding at 3e-7, but falls to a quarter in each step, until there are no more
    assert at[0] == pytest.approx(1e-3 * 0.5**200)
    slow = loop(1, lambda x, a, b: np.array([x[0] ** 1.5 if x[0].real > 0 else 0 * x[0]]))
    at = array([1e-12])
    assert descend(slow, 0.0, 0.0, at)
    assert at[0] < 1e-12


def test_what_has_no_zero_is_no_solution() -> None:
    for law in (
        lambda x, a, b: np.array([x[0] ** 2 + 1]),
        lambda x, a, b: np.array([0 * x[0] + 1]),
    ):
        assert not descend(loop(1, law), 0.0, 0.0, array([0.7]))
    assert not descend(
        loop(1, lambda x, a, b: np.array([0 * x[0] + math.inf])), 0.0, 0.0, array([1])
    )


@pytest.mark.parametrize(("left", "arrived"), [(0.9e-3, True), (1.1e-3, False)])
def test_on_the_way_most_of_the_residual_must_go(left: float, arrived: bool) -> None:
    def law(x: Any, series: float, parallel: float) -> Any:
        """From 3 at 0 it falls to a part of that, and no further."""
        assert (series, parallel) == (0.25, 4.0)
        return np.array([3 - 3 * x[0] if x[0].real < 0.5 else 3 * left + 0 * x[0]])

    assert descend(loop(1, law), 0.25, 4.0, array([0.0])) is arrived


def test_the_way_begins_where_residuals_are_finite() -> None:
    for limit, count in ((1.0, 0), (2e-3, 1), (2e-5, 3), (0.0, 12)):
        m = loop(
            3,
            lambda x, a, b, limit=limit: x + (math.inf if max(x.real) > limit else 0.0),
        )
        at = reals(3)
        begin_near(m, 0.5, 0.25, at)
        expected = 0.01 * np.array([1.0, 1.125, 1.25]) * 0.1**count
        assert [at[i] for i in range(3)] == pytest.approx(expected)
        assert set(m.eases) == {(0.5, 0.25)}


@pytest.mark.parametrize("resistance", [1.0, 1e3, 1e-3])
def test_resistances_vanish_level_by_level(resistance: float) -> None:
    m = loop(1, lambda x, series, parallel: np.array([x[0] - 3 - series]))
    at = reals(1)
    assert follow(m, resistance, at)
    assert at[0] == pytest.approx(3.0)
    soft = [0.5 * 0.1 ** (k / 2) for k in range(24)]
    assert [x for x, _ in m.eases] == pytest.approx([*(x * resistance for x in soft), 0.0])
    assert [x for _, x in m.eases] == pytest.approx([*(x / resistance for x in soft), 0.0])


def test_three_levels_missed_in_turn_end_the_search() -> None:
    m = loop(1, lambda x, a, b: np.array([x[0] ** 2 + 1]))
    assert not follow(m, 1.0, reals(1))
    assert len(m.eases) == 3
    # two missed, then one that is solved, and again: the way goes on
    levels: list[float] = []

    def law(x: Any, series: float, parallel: float) -> Any:
        if series not in levels:
            levels.append(series)
        hard = len(levels) % 3 and series > 0
        return np.array([x[0] ** 2 + 1 if hard else x[0] - 1])

    m = loop(1, law)
    assert follow(m, 1.0, reals(1))
    assert len(m.eases) == 25


def test_the_search_begins_without_resistances() -> None:
    for zero, starts in ((0.25, [0.0]), (1.25, [0.0, 1.0]), (-1.25, [0.0, 1.0, -1.0])):

        def law(x: Any, series: float, parallel: float, zero: float = zero) -> Any:
            """Flat but near its zero."""
            near = abs(x[0].real - zero) < 0.5
            return np.array([x[0] - zero if near else 1 + 0 * x[0]])

        m = loop(1, law)
        at = reals(1)
        assert search(m, at)
        assert at[0] == pytest.approx(zero)
        begun = [x[0] for x, _ in m.seen]
        assert [x for x in begun if x in (0.0, 1.0, -1.0)] == starts


def test_resistances_of_all_sizes_are_tried() -> None:
    m = loop(1, lambda x, a, b: np.array([x[0] ** 2 + 1]))
    assert not search(m, reals(1))
    assert [x for x in m.eases if x != (0.0, 0.0)][::3] == [
        (0.5, 0.5),
        (500.0, 5e-4),
        (5e-4, 500.0),
    ]


def test_a_solution_is_the_only_one_unless_another_lies_beside_it() -> None:
    def square(x: Any, series: float, parallel: float) -> Any:
        return np.array([x[0] * (x[0] if x[0].real > 0 else -x[0]) + parallel * x[0]])

    def zone(x: Any, series: float, parallel: float) -> Any:
        return np.array([0 * x[0] + parallel * x[0], x[1] - 2])

    def above(x: Any, series: float, parallel: float) -> Any:
        """Flat on one side alone."""
        return np.array([x[0] + parallel * x[0] if x[0].real > 0 else parallel * x[0]])

    def below(x: Any, series: float, parallel: float) -> Any:
        return -above(-x, series, parallel)

    assert is_only(loop(2, linear), array(np.linalg.solve(MATRIX, [1.0, 2.0])))
    assert is_only(loop(1, square), array([0.0]))
    assert not is_only(loop(2, zone), array([7.0, 2.0]))
    assert not is_only(loop(1, above), array([-1e-9]))
    assert not is_only(loop(1, below), array([1e-9]))
    # where the Jacobian is not finite, nothing is flat
    assert is_only(loop(1, lambda x, a, b: np.array([1j * math.inf + 0 * x[0]])), array([0.0]))
    # singular with resistances, too
    assert not is_only(loop(1, lambda x, a, b: np.array([0 * x[0]])), array([0.0]))


def test_another_solution_is_looked_for_at_a_millionth_of_the_unknowns() -> None:
    def zone(x: Any, series: float, parallel: float) -> Any:
        return np.array([parallel * x[0], x[1] - 2 + 0.5 * x[0] * parallel])

    m = loop(2, zone)
    assert not is_only(m, array([7.0, 2.0]))
    x, ease = m.seen[-1]
    assert ease == (0.0, 0.0)
    assert m.seen[1][1] == (1e-8, 1e-8)
    assert abs(x[0] - 7) == pytest.approx(8e-6)


def test_a_loop_without_solution_or_with_several_fails() -> None:
    def zone(x: Any, series: float, parallel: float) -> Any:
        return np.array([parallel * x[0]])

    at = reals(2)
    newton(loop(2, linear), at)
    assert [at[0], at[1]] == pytest.approx(np.linalg.solve(MATRIX, [1.0, 2.0]))
    for law in (zone, lambda x, a, b: np.array([x[0] ** 2 + 1])):
        with pytest.raises(Failed) as caught:
            newton(loop(1, law), reals(1))
        assert caught.value.status.name == "NO_LOOP_SOLUTION"
