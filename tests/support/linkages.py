"""A four-bar linkage said twice: as a model, and as plane geometry."""

from __future__ import annotations

from typing import Any

import numpy as np

import linegraph as lg

CRANK, COUPLER, ROCKER, BASE = 0.3, 0.8, 0.6, 1.0


def four_bar(
    crank: float = CRANK, coupler: float = COUPLER, rocker: float = ROCKER, base: float = BASE
) -> lg.Model:
    """Hinges about z: a and d on ground, b on the crank, and c, the chord, between coupler and rocker."""
    model = lg.Model("four_bar", gravity=(0, -9.81, 0))
    made = [
        model.body(name, mass=1.0, mass_center=(length / 2, 0, 0), inertia=(0.01, 0.02, 0.03))
        for name, length in (("crank", crank), ("coupler", coupler), ("rocker", rocker))
    ]
    first, middle, last = made
    there = model.ground.frame("there", at=(base, 0, 0))
    model.revolute("a", between=("ground", first))
    model.revolute("b", between=(first.frame("tip", at=(crank, 0, 0)), middle))
    model.revolute("d", between=(there, last))
    ends = (middle.frame("tip", at=(coupler, 0, 0)), last.frame("tip", at=(rocker, 0, 0)))
    model.revolute("c", between=ends)
    model.formulation(tree=("a", "b", "d"))
    return model


def tips(q: Any) -> tuple[Any, Any]:
    """The ends of coupler and rocker for the angles of a, b and d; complex angles are welcome."""
    a, b, d = q
    coupler = [
        CRANK * np.cos(a) + COUPLER * np.cos(a + b),
        CRANK * np.sin(a) + COUPLER * np.sin(a + b),
    ]
    rocker = [BASE + ROCKER * np.cos(d), ROCKER * np.sin(d)]
    return np.array(coupler), np.array(rocker)


def gap(q: Any) -> Any:
    """From the coupler's end to the rocker's, in the coupler's axes."""
    coupler, rocker = tips(q)
    c, s = np.cos(q[0] + q[1]), np.sin(q[0] + q[1])
    return np.array([[c, s], [-s, c]]) @ (rocker - coupler)


def closed(a: float, sign: int = 1) -> Any:
    """The angles that close the loop for one of a, by the law of cosines; two ways to assemble it."""
    x, y = BASE - CRANK * np.cos(a), -CRANK * np.sin(a)
    far = np.hypot(x, y)
    inner = np.arccos((COUPLER**2 + far**2 - ROCKER**2) / (2 * COUPLER * far))
    coupler = np.arctan2(y, x) + sign * inner
    end = CRANK * np.exp(1j * a) + COUPLER * np.exp(1j * coupler) - BASE
    return np.array([a, coupler - a, np.angle(end)])
