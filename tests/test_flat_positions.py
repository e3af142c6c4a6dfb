"""Mechanisms that pass positions in which they could fold another way, against their exact motions.

A parallelogram of two cranks driven by a torque, rows of two and of ten square windows that swing in gravity,
and a kite that runs free. Near where all rods lie in one line errors of q and v are amplified without limit:
accelerations are right there, or there is a status; and whoever integrates them arrives at the exact motion,
or is told where it is stopped.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from emitted import load
from scipy.integrate import DOP853, RK45, solve_ivp

from linegraph import Model
from linegraph.emission import render

if TYPE_CHECKING:
    from collections.abc import Callable

FLAT_ONLY = np.array([1.0, -1.0, 1.0])
END = 10.0
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
TIMES = np.linspace(0.0, END, 401)


@dataclass(frozen=True)
class Case:
    """A mechanism and its motion.

    Attributes:
        model: the mechanism.
        exact: the state (q, v) at a time.
    """

    model: Model
    exact: Callable[[float], np.ndarray]


def parallelogram() -> Case:
    """``0.24 theta'' = sin(3 t)`` at every angle."""
    model = Model("parallelogram", gravity=(0, 0, 0))
    pivot = model.ground.frame("pivot", at=(0.5, 0, 0))
    crank = model.body("crank", mass=1, inertia=(0.1, 0.1, 0.1))
    coupler = model.body("coupler", mass=1, mass_center=(0.25, 0, 0), inertia=(0.01, 0.1, 0.1))
    rocker = model.body("rocker", mass=1, inertia=(0.1, 0.1, 0.1))
    tips = [b.frame("tip", at=(x, 0, 0)) for b, x in ((crank, 0.2), (coupler, 0.5), (rocker, 0.2))]
    model.revolute("a", between=("ground", crank), effort=False, start=1)
    model.revolute("b", between=(tips[0], coupler), effort=False, start=-1)
    model.revolute("c", between=(pivot, rocker), effort=False, start=1)
    model.revolute("d", between=(tips[1], tips[2]), effort=False)
    model.law("torque", joint="a", force="-sin(3*t)")

    def exact(t: float) -> np.ndarray:
        angle = 1 + 2 * t + (t - math.sin(3 * t) / 3) / (3 * 0.24)
        rate = 2 + (1 - math.cos(3 * t)) / (3 * 0.24)
        return np.concatenate([angle * FLAT_ONLY, rate * FLAT_ONLY])

    return Case(model, exact)


def windows(count: int) -> Case:
    """IFToMM benchmark A02: ``((N+1)/3 + N) theta'' = ((N+1)/2 + N) g sin(theta)`` from the upright."""
    model = Model("windows", gravity=(0, -9.81, 0))
    posts, slab = [], (0, 1 / 12, 1 / 12)
    for k in range(count + 1):
        foot = model.ground.frame(f"foot{k}", at=(k, 0, 0))
        post = model.body(f"post{k}", mass=1, mass_center=(0, 0.5, 0), inertia=(1 / 12, 0, 1 / 12))
        model.revolute(f"p{k}", between=(foot, post), effort=False)
        posts.append(post.frame("top", at=(0, 1, 0)))
    for k in range(count):
        beam = model.body(f"beam{k}", mass=1, mass_center=(0.5, 0, 0), inertia=slab)
        model.revolute(f"b{k}", between=(posts[k], beam), effort=False)
        end = beam.frame("end", at=(1, 0, 0))
        model.revolute(f"c{k}", between=(end, posts[k + 1]), effort=False)
    share = ((count + 1) / 2 + count) / ((count + 1) / 3 + count) * 9.81
    found = solve_ivp(
        lambda _, x: [x[1], share * math.sin(x[0])],
        (0, END),
        [0.0, 1.0],
        method="DOP853",
        rtol=1e-13,
        atol=1e-14,
        dense_output=True,
    ).sol

    def exact(t: float) -> np.ndarray:
        """Posts turn, beams do not: in the tree of these joints."""
        angle, rate = found(t)
        signs = np.array([1.0] * (count + 1) + [-1.0] * count)
        return np.concatenate([angle * signs, rate * signs])

    return Case(model, exact)


def kite() -> Case:
    """Sides 0.5, 0.5, 0.3, 0.3: B and D meet twice in a turn of psi, the angle of BC to the axis AC.

    ``0.5 sin(theta / 2) = 0.3 sin(psi)`` with theta the angle of AB to the ground AD; the kinetic energy, a function
    of psi times psi'^2, is constant.
    """
    model = Model("kite", gravity=(0, 0, 0))
    pivot = model.ground.frame("pivot", at=(0.5, 0, 0))
    bars = {
        name: model.body(name, mass=1, mass_center=(x / 2, 0, 0), inertia=(0, 0.01, 0.01))
        for name, x in (("ab", 0.5), ("bc", 0.3), ("dc", 0.3))
    }
    ends = {name: bars[name].frame("end", at=(x, 0, 0)) for name, x in LENGTHS.items()}
    model.revolute("a", between=("ground", bars["ab"]), effort=False, start=0.9)
    model.revolute("b", between=(ends["ab"], bars["bc"]), effort=False, start=-1.3)
    model.revolute("d", between=(pivot, bars["dc"]), effort=False, start=1.3)
    model.revolute("c", between=(ends["bc"], ends["dc"]), effort=False)

    def slopes(psi: float) -> tuple[float, float]:
        """theta and its derivative by psi."""
        x = 0.6 * math.sin(psi)
        return 2 * math.asin(x), 1.2 * math.cos(psi) / math.sqrt(1 - x * x)

    def inertia(psi: float) -> float:
        theta, d = slopes(psi)
        bc = d / 2 - 1
        direction = 1j * np.exp(1j * np.array([theta, theta / 2 - psi]))
        center = 0.5 * d * direction[0] + 0.15 * bc * direction[1]
        dc = d / 2 + 1
        about = (0.01 + 0.25**2) * d * d + (0.01 + 0.15**2) * dc * dc + 0.01 * bc * bc
        return float(about + abs(center) ** 2)

    start = math.asin(math.sin(0.45) / 0.6)
    energy = inertia(start) * 4.0
    found = solve_ivp(
        lambda _, x: [math.sqrt(energy / inertia(x[0]))],
        (0, END),
        [start],
        method="DOP853",
        rtol=1e-13,
        atol=1e-13,
        dense_output=True,
    ).sol

    def exact(t: float) -> np.ndarray:
        psi = float(found(t)[0])
        rate = math.sqrt(energy / inertia(psi))
        theta, d = slopes(psi)
        q = [theta, -theta / 2 - psi, theta / 2 + psi]
        return np.array([*q, d * rate, (-d / 2 - 1) * rate, (d / 2 + 1) * rate])

    return Case(model, exact)


LENGTHS = {"ab": 0.5, "bc": 0.3, "dc": 0.3}
CASES: dict[str, Callable[[], Case]] = {
    "parallelogram": parallelogram,
    "two windows": lambda: windows(2),
    "ten windows": lambda: windows(10),
    "kite": kite,
}


@cache
def made(name: str) -> tuple[Case, Any]:
    """A case and its emitted Python."""
    case = CASES[name]()
    files = render(case.model, languages=["python"], only=("rhs", "forward_dynamics", "project"))
    with TemporaryDirectory() as folder:
        return case, load(files, case.model.name, Path(folder))
