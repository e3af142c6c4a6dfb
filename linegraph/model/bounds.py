"""Bounds of the states at which `check` and golden vectors evaluate a model."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Mapping

Interval = tuple[float, float]

GROUPS = ("coordinates", "velocities", "inputs", "parameters")
"""The groups of quantities that are bounded by name; the time ``t`` is bounded as such."""


@dataclass(frozen=True)
class Bounds:
    """Bounds of drawn states; quantities that are not named are drawn from default intervals.

    Attributes:
        coordinates: (low, high) of entries of q, by name, in their units.
        velocities: of entries of v, states of networks among them.
        inputs: of entries of u.
        parameters: of parameters: they are drawn, too, instead of having the model's value.
        t: of the time (s); None where it is not bounded.
    """

    coordinates: Mapping[str, Interval] = field(default_factory=dict)
    velocities: Mapping[str, Interval] = field(default_factory=dict)
    inputs: Mapping[str, Interval] = field(default_factory=dict)
    parameters: Mapping[str, Interval] = field(default_factory=dict)
    t: Interval | None = None

    @property
    def sometime(self) -> float:
        """A time within the bounds that is not special (s)."""
        return 0.37 if self.t is None else sum(self.t) / 2


class Bounded:
    """A builder whose drawn states can be bounded."""

    bounds: Bounds = Bounds()

    def check_within(
        self,
        *,
        coordinates: Mapping[str, Any] | None = None,
        velocities: Mapping[str, Any] | None = None,
        inputs: Mapping[str, Any] | None = None,
        parameters: Mapping[str, Any] | None = None,
        t: Any = None,
    ) -> Bounds:
        """Bound the states at which `check` and golden vectors evaluate the equations.

        Args:
            coordinates: (low, high) by name of coordinate, in its unit.
            velocities: by name of velocity, or of a state of a network.
            inputs: by name of input.
            parameters: by name of parameter.
            t: of the time (s).

        Returns:
            The bounds, which replace earlier ones.

        Raises:
            ModelError: a bound is not a pair of finite numbers, the lower one first.

        Example:
            >>> from linegraph import Model
            >>> Model("valve").check_within(inputs={"flow": (0, 2)}).inputs
            {'flow': (0.0, 2.0)}
        """
        given = zip(GROUPS, (coordinates, velocities, inputs, parameters), strict=True)
        found = {
            group: {name: _interval(pair, f"{group} {name}") for name, pair in (x or {}).items()}
            for group, x in given
        }
        time = None if t is None else _interval(t, "t")
        self.bounds = Bounds(t=time, **found)
        return self.bounds


def _interval(pair: Any, what: str) -> Interval:
    try:
        low, high = map(float, pair)
    except (TypeError, ValueError):
        raise ModelError("check", f"{what}: two numbers are needed, (low, high)") from None
    if not (math.isfinite(low) and math.isfinite(high) and low <= high):
        problem = f"{what}: ({low:g}, {high:g}) is no interval; give (low, high), both finite"
        raise ModelError("check", problem)
    return low, high
