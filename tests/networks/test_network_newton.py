"""Newton's method for algebraic loops: against bisection, and where there is no solution or more than one."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from network_parts import system

from linegraph.components.scalar.electrical import CurrentSource, Diode, Resistor, VoltageSource
from linegraph.components.scalar.element import AnyElement
from linegraph.errors import ModelError
from linegraph.networks.equations import network_of
from linegraph.networks.newton import solved

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.components.scalar.base import Component
    from linegraph.networks.network import Network

AT_B = ("b", "ground")


def behind_a_resistor(part: Component) -> Network:
    """An input u, a resistor R and another part, in series."""
    source = VoltageSource("V", ("a", "ground"), "u"), Resistor("R", ("a", "b"), "R")
    network = network_of(system(*source, part, parameters=["R"], inputs=["u"]))
    assert network is not None
    assert len(network.loop) == 1
    return network


def voltage(network: Network, u: float, R: float) -> float:
    """The voltage of the part, whichever variable the loop is solved for."""
    known = {("u", "u"): u, ("p", "R"): R}
    (x,) = solved(network, lambda s: known[s] if s in known else float(Fraction(s[1])))
    (letter,) = network.loop_names
    return x if letter == "v_N" else u - R * x if letter[0] == "i" else u - x


def bisected(f: Callable[[float], float], low: float, high: float) -> float:
    """The zero of a function that rises."""
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (low, middle) if f(middle) > 0 else (middle, high)
    return (low + high) / 2


RISING: dict[str, Callable[[float], float]] = {
    "y = x + x**3": lambda x: x + x**3,
    "y = x*abs(x)": lambda x: x * abs(x),
    "y = tanh(3*x)": lambda x: math.tanh(3 * x),
    "y = exp(x) - 1": lambda x: math.exp(x) - 1,
    "y = max(x - 1, 0) + min(x + 1, 0)": lambda x: max(x - 1, 0) + min(x + 1, 0),
    "y = sign(x)*sqrt(abs(x))": lambda x: math.copysign(math.sqrt(abs(x)), x),
}
NETWORKS = {law: behind_a_resistor(AnyElement("N", AT_B, law=law)) for law in RISING}


@settings(derandomize=True, deadline=None, max_examples=60)
@given(st.sampled_from(sorted(RISING)), st.integers(-40, 40), st.sampled_from([0.1, 1.0, 7.5]))
def test_rising_laws_have_the_solution_of_bisection(law: str, u: int, R: float) -> None:
    f = RISING[law]
    reach = abs(u) + 1.0
    expected = bisected(lambda x: R * f(min(x, 300.0)) + x - u, -reach, reach)
    assert math.isclose(voltage(NETWORKS[law], u, R), expected, rel_tol=1e-9, abs_tol=1e-9)


@pytest.mark.parametrize("u", [0.0, 0.5, 12.0, 300.0, -300.0])
def test_a_diode_takes_what_the_resistor_lets_through(u: float) -> None:
    """Its exponential overflows at the source's voltage, so that the whole step is never possible."""
    found = voltage(behind_a_resistor(Diode("N", AT_B, 1e-12, 0.026)), u, 10.0)
    flow = 1e-12 * math.expm1(found / 0.026)
    assert math.isclose(10 * flow + found, u, rel_tol=1e-9, abs_tol=1e-9)


@pytest.mark.parametrize("law", ["y = atan2(x - 1, 1e-9)", "y = atan((x - 1)*1e9)"])
@pytest.mark.parametrize("u", [1.3, 1.7, -0.2])
def test_a_steep_angle_is_solved_as_well_as_rounding_allows(law: str, u: float) -> None:
    """Of R = 1: the voltage is 1 but for some 1e-9, and the angle what the resistor lets through."""
    found = voltage(behind_a_resistor(AnyElement("N", AT_B, law=law)), u, 1.0)
    assert math.isclose(found, 1 + 1e-9 * math.tan(u - 1), abs_tol=1e-14)


@pytest.mark.parametrize("u", [0.0, -3.1, -9.0])
def test_an_angle_whose_sine_is_limited_is_solved_at_its_limits(u: float) -> None:
    """Its slope there is infinite from within and zero from without."""
    network = behind_a_resistor(AnyElement("N", AT_B, law="y = asin(min(1, max(-1, x + 3)))"))
    expected = bisected(
        lambda x: 0.1 * math.asin(min(1, max(-1, x + 3))) + x - u, abs(u) * -2 - 1, abs(u) * 2 + 1
    )
    assert math.isclose(voltage(network, u, 0.1), expected, rel_tol=1e-9)


def fed(law: str) -> Network:
    """An element that one ampere flows through."""
    parts = CurrentSource("I", ("ground", "b"), "u"), AnyElement("N", AT_B, law=law)
    network = network_of(system(*parts, inputs=["u"]))
    assert network is not None
    return network


def of_current(law: str, u: float) -> Any:
    return solved(fed(law), {("u", "u"): u}.__getitem__)


@pytest.mark.parametrize("law", ["y = exp(x) + 2", "y = tanh(x)/2", "y = x*x + 2"])
def test_a_current_that_a_law_never_takes_is_refused(law: str) -> None:
    with pytest.raises(ModelError, match="no solution"):
        of_current(law, 1.0)


def test_a_dead_zone_without_current_has_several_solutions() -> None:
    law = "y = max(x - 1, 0) + min(x + 1, 0)"
    with pytest.raises(ModelError, match="several solutions"):
        of_current(law, 0.0)
    assert of_current(law, 0.5) == pytest.approx([1.5], rel=1e-9)


@pytest.mark.parametrize(("u", "x"), [(0.5, 2.5), (-3.0, -5.0)])
def test_a_law_that_is_flat_wherever_the_search_begins_is_solved_over_resistances(
    u: float, x: float
) -> None:
    assert of_current("y = max(x - 2, 0) + min(x + 2, 0)", u) == pytest.approx([x], rel=1e-9)


def test_a_flat_law_with_one_zero_has_one_solution() -> None:
    """The slope of x |x| is zero at zero, but nothing beside it solves the loop."""
    assert of_current("y = x*abs(x)", 0.0) == pytest.approx([0.0], abs=1e-6)


def test_two_unknowns_are_solved_together() -> None:
    """N and M share the voltage of the source: with w across M, N has 3 - w, and the currents balance."""
    chain = (
        AnyElement("N", ("a", "b"), law="y = x + x**3"),
        AnyElement("M", ("b", "ground"), law="y = exp(x) - 1"),
        Resistor("R", ("b", "ground"), 2),
        VoltageSource("V", ("a", "ground"), 3),
    )
    network = network_of(system(*chain))
    assert network is not None
    x = solved(network, lambda s: float(Fraction(s[1])))
    assert len(x) == len(network.loop) <= 2
    by_name = dict(zip(network.loop_names, x, strict=True))
    w = bisected(lambda w: math.exp(w) - 1 + w / 2 - (3 - w) - (3 - w) ** 3, -1.0, 3.0)
    expected = {"v_N": 3 - w, "v_M": w, "i_N": 3 - w + (3 - w) ** 3, "i_M": math.exp(w) - 1}
    for name, found in by_name.items():
        assert math.isclose(found, expected[name], rel_tol=1e-9)
