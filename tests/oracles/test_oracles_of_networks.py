"""The sparse tableau in exact arithmetic, on networks that every textbook has."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from oracles.network_pencil import NotStates, Part, Singular, basis, characteristic, order, poles
from oracles.network_pencil import reduce as reduced

R, L, C = Fraction(3), Fraction(1, 2), Fraction(1, 5)

SERIES = (
    Part("voltage_source", "V", "a", "ground", 0),
    Part("resistor", "R", "a", "b", R),
    Part("inductor", "L", "b", "c", L),
    Part("capacitor", "C", "c", "ground", C),
)


def test_a_series_circuit_has_the_polynomial_of_its_differential_equation() -> None:
    """L q'' + R q' + q / C = u."""
    assert order(SERIES) == 2
    assert characteristic(SERIES) == [1 / (L * C), R / L, 1]
    assert poles(SERIES) == pytest.approx(np.sort_complex(np.roots([1, R / L, 1 / (L * C)])))


def test_its_states_obey_kirchhoff() -> None:
    """C v' = i, L i' = u - R i - v."""
    found = reduced(SERIES, [("C", "X"), ("L", "Y")])
    assert np.array_equal(found.A, [[0, float(1 / C)], [float(-1 / L), float(-R / L)]])
    assert np.array_equal(found.B0, [[0], [float(1 / L)]])
    assert not found.B1.any()


def test_a_capacitor_across_a_source_follows_its_rate() -> None:
    """Its current is C u': no state, and a derivative of the input."""
    parts = (
        Part("voltage_source", "V", "a", "ground", 0),
        Part("capacitor", "C", "a", "ground", C),
    )
    assert order(parts) == 0
    assert basis(parts) == []
    found = reduced(parts, [])
    current = next(k for k, w in enumerate(found.variables) if w[:2] == ("C", "Y"))
    assert [float(found.D[n][current, 0]) for n in range(3)] == [0.0, float(C), 0.0]
    with pytest.raises(NotStates):
        reduced(parts, [("C", "X")])


def test_of_capacitors_in_parallel_one_is_a_state() -> None:
    parts = (
        Part("capacitor", "C1", "a", "ground", C),
        Part("capacitor", "C2", "a", "ground", 2 * C),
        Part("resistor", "R", "a", "ground", R),
    )
    assert basis(parts) == [("C1", "X")]
    assert characteristic(parts) == [1 / (R * 3 * C), 1]


def test_two_sources_in_parallel_have_no_solution() -> None:
    parts = (
        Part("voltage_source", "V", "a", "ground", 0),
        Part("voltage_source", "W", "a", "ground", 1),
    )
    with pytest.raises(Singular):
        characteristic(parts)
