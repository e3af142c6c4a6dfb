"""Energy balance of each component of a network, along the motion.

    power taken in at all edges = d/dt stored energy + heat

The rate of stored energy is not taken from a formula of the derivation. The whole state, inputs and time
take a complex step along the motion, and the stored energy is evaluated there. Power that changes a store
from outside is therefore included: a capacitance that depends on a joint's position exchanges energy with
the mechanism, and no edge of the component carries it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.networks.network import INPUTS
from linegraph.verification.golden.steps import STEP, Beside, stepped

if TYPE_CHECKING:
    from linegraph.dynamics.network_state import Exchange
    from linegraph.networks import Network
    from linegraph.numeric.derived import Derived
    from linegraph.verification.golden.point import Point

FINE = 1e-2
"""Factor on sizes: balances of one component are checked more finely than solved quantities, so that a small
change of stored energy shows beside a large power through the component.
"""

DRIVEN = "what it stores is changed from outside, by {}"
UNKNOWN = "the energy that it stores is not known"
HOT = "its through times across is no power"
SOURCE = "it is a source"


def balances(point: Point) -> dict[str, tuple[float, float]]:
    """Power imbalance of each component that can be judged, and its size (W).

    The imbalance is the rate of stored energy plus heat less the power taken in at all edges.

    Args:
        point: the state.
    """
    exchange = point.edges.cuts.acting.exchange
    if exchange is None:
        return {}
    network, found = exchange.network, {}
    rates = _stored_rates(point)
    sizes = _stored_sizes(point, exchange)
    unjudged = unjudged_components(point.derivation)
    for component in dict.fromkeys(branch.component for branch in network.branches):
        name = component.name
        if name in unjudged:
            continue
        heat = float(exchange.heat(name))
        total = rates[name] + heat
        size = abs(rates[name]) + abs(heat) + sizes[name]
        for branch in network.branches:
            if branch.component is component:
                x, y = exchange.across(branch.name), exchange.through(branch.name)
                of = [float(exchange.size(branch.name, k)) for k in (0, 1)]
                total -= float(x * y)
                size += max(abs(float(x)), of[0]) * max(abs(float(y)), of[1])
        found[name] = (total, FINE * size)
    return found


def unjudged_components(derivation: Derived) -> dict[str, str]:
    """Components whose balance proves nothing, each with the reason."""
    network = derivation.formulation.network
    if network is None:
        return {}
    found = {}
    for component in dict.fromkeys(branch.component for branch in network.branches):
        own = [branch for branch in network.branches if branch.component is component]
        outside = _outside(network, component)
        if component.source:
            found[component.name] = SOURCE
        elif any(branch.port.domain in network.heats for branch in own):
            found[component.name] = HOT
        elif component.name in network.unknown:
            found[component.name] = UNKNOWN
        elif outside:
            found[component.name] = DRIVEN.format(outside)
    return found


def _outside(network: Network, component: Any) -> str:
    """The variable from outside the model that changes a component's stored energy, in words.

    Empty if there is none.
    """
    support = network.laws.calculus.support(network.energy[component.name])
    for kind, place in sorted(support, key=repr):
        if kind == "t":
            return "the time"
        if kind in INPUTS:
            return f"the input {place}"
    return ""


def _stored_rates(point: Point) -> dict[str, float]:
    """Rate of the stored energy of each component (W)."""
    (a, _), walk = point.motion[0], point.walk
    rates = walk.rates[0]
    q = [complex(x, STEP * float(dx)) for x, dx in zip(point.q, rates, strict=True)]
    v = [complex(x, STEP * float(dx)) for x, dx in zip(point.v, a, strict=True)]
    u = [complex(x, STEP * dx) for x, dx in zip(point.u, _input_rates(point), strict=True)]
    numeric: Any = stepped(walk.numeric, Beside(q, v, u, complex(point.t, STEP)))
    beside = numeric.exchange(q, v)
    assert beside is not None
    stored = beside.network.energy
    return {name: complex(beside.still(x)).imag / STEP for name, x in stored.items()}


def _input_rates(point: Point) -> list[float]:
    """Rate of each input where another input gives it; otherwise 0."""
    slopes = point.walk.tree.layout.slopes
    return [point.u[slopes[k]] if k in slopes else 0.0 for k in range(len(point.u))]


def _stored_sizes(point: Point, exchange: Exchange) -> dict[str, float]:
    """Size of the rate of each stored energy: its slopes times the sizes of the states' rates."""
    network, (_, of_a) = exchange.network, point.motion[0]
    found = {}
    for name, stored in network.energy.items():
        slopes = network.laws.calculus.gradient(stored)
        found[name] = sum(
            abs(float(exchange.still(slope))) * float(of_a[exchange.first + network.places[symbol]])
            for symbol, slope in slopes.items()
            if symbol in network.places
        )
    return found
