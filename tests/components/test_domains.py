"""Power subspaces: through times across is a power, by an arithmetic of units of our own."""

from __future__ import annotations

from dataclasses import FrozenInstanceError

import pytest

from linegraph.components.domains import DOMAINS, POWER, ROTATION, TRANSLATION, Domain, Variable

# how many kg, m, s, A, K multiply to each unit; from the definitions of the SI, not from the library
SI = {
    "kg": (1, 0, 0, 0, 0),
    "m": (0, 1, 0, 0, 0),
    "s": (0, 0, 1, 0, 0),
    "A": (0, 0, 0, 1, 0),
    "K": (0, 0, 0, 0, 1),
    "rad": (0, 0, 0, 0, 0),
    "N": (1, 1, -2, 0, 0),
    "Pa": (1, -1, -2, 0, 0),
    "J": (1, 2, -2, 0, 0),
    "W": (1, 2, -3, 0, 0),
    "V": (1, 2, -3, -1, 0),
}
TEMPERATURE = Variable("temperature", "K", (0, 0, 0, 0, 1))
HEAT_FLOW = Variable("heat flow", "W", (1, 2, -3, 0, 0))


def exponents(symbol: str) -> tuple[int, ...]:
    """``N*m/s`` as exponents of the base units: factors before the first slash up, after it down."""
    above, *below = symbol.split("/")
    total = [0] * 5
    for names, sign in [(above, 1), *((part, -1) for part in below)]:
        for factor in names.split("*"):
            name, _, power = factor.partition("^")
            times = sign * int(power or 1)
            total = [t + times * e for t, e in zip(total, SI[name], strict=True)]
    return tuple(total)


def test_power_is_a_watt() -> None:
    assert exponents("W") == exponents("J/s") == exponents("V*A") == POWER


@pytest.mark.parametrize("domain", DOMAINS.values(), ids=DOMAINS)
def test_through_times_across_is_a_power(domain: Domain) -> None:
    assert domain.power == (domain.name != "thermal")
    if domain.power:
        pair = zip(*map(exponents, (domain.through.symbol, domain.across.symbol)), strict=True)
        assert tuple(a + b for a, b in pair) == exponents("W")


@pytest.mark.parametrize("domain", DOMAINS.values(), ids=DOMAINS)
def test_symbols_say_what_the_units_say(domain: Domain) -> None:
    for variable in (domain.across, domain.through):
        assert exponents(variable.symbol) == variable.unit, variable.name


def test_the_register_is_keyed_by_name() -> None:
    assert {name: domain.name for name, domain in DOMAINS.items()} == {n: n for n in DOMAINS}
    assert DOMAINS["translation"] is TRANSLATION
    assert DOMAINS["rotation"] is ROTATION
    assert {domain.dimension for domain in DOMAINS.values()} <= {1, 3}


@pytest.mark.parametrize(
    ("across", "through", "power"),
    [
        (TRANSLATION.across, ROTATION.through, True),
        (ROTATION.across, TRANSLATION.through, True),
        (TRANSLATION.through, TRANSLATION.through, True),
        (TEMPERATURE, HEAT_FLOW, True),
        (TRANSLATION.across, TRANSLATION.through, False),
    ],
)
def test_a_pair_that_is_not_what_it_says_is_refused(
    across: Variable, through: Variable, power: bool
) -> None:
    with pytest.raises(ValueError, match="domain wrong: through x across must be a power"):
        Domain("wrong", across=across, through=through, power=power)


def test_the_thermal_pair_is_allowed_when_it_says_so() -> None:
    assert not Domain("thermal", across=TEMPERATURE, through=HEAT_FLOW, power=False).power


def test_domains_do_not_change() -> None:
    with pytest.raises(FrozenInstanceError):
        TRANSLATION.dimension = 1  # type: ignore[misc]
