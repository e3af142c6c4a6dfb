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
from scipy.integrate import DOP853, RK45, solve_ivp
from support.compiled import Compiled, Failed
from support.emitted import load

from linegraph import Model
from linegraph.emission.emit import render
from linegraph.ir.statuses import SINGULAR_POSITION

if TYPE_CHECKING:
    from collections.abc import Callable

SIGNS = np.array([1.0, -1.0, 1.0])
END = 10.0
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)


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
        return np.concatenate([angle * SIGNS, rate * SIGNS])

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

    ``0.5 sin(theta / 2) = 0.3 sin(psi)`` with theta the angle of AB to the ground AD; the kinetic energy, a
    function of psi times psi'^2, is constant.
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
        """Theta and its derivative by psi."""
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
def made(name: str) -> tuple[Case, Any, Any]:
    """A case, its emitted Python and its emitted C."""
    case = CASES[name]()
    only = ("rhs", "forward_dynamics", "project", "reduction")
    files = render(case.model, only=only)
    with TemporaryDirectory() as folder:
        module = load(
            {k: x for k, x in files.items() if k.endswith(".py")}, case.model.name, Path(folder)
        )
        return case, module, Compiled(files, case.model.name, Path(folder))


def timed(name: str, t: float) -> list[float]:
    """The time, where the motion is driven by it."""
    return [t] if name == "parallelogram" else []


RUNS = [
    (name, method, tolerance)
    for name in CASES
    for method in (DOP853, RK45)
    for tolerance in TOLERANCES
    if name != "ten windows" or tolerance >= 1e-8
]
FEW = [RUNS.index(run) for run in (
    ("parallelogram", DOP853, 1e-4),
    ("parallelogram", RK45, 1e-8),
    ("parallelogram", DOP853, 1e-12),
    ("two windows", RK45, 1e-4),
    ("two windows", DOP853, 1e-10),
    ("kite", RK45, 1e-4),
    ("kite", DOP853, 1e-6),
)]  # fmt: skip


@pytest.mark.seeds(FEW, range(len(RUNS)))
def test_an_integrator_arrives_at_the_exact_motion_or_is_stopped(seed: int) -> None:
    """10 s by methods that choose their steps: never another motion, and none before it is stopped."""
    name, method, tolerance = RUNS[seed]
    case, module, _ = made(name)
    run = method(
        lambda t, x: module.rhs(*timed(name, t), x, np.zeros(0)),
        0.0,
        case.exact(0.0),
        END,
        rtol=tolerance,
        atol=tolerance / 100,
    )
    stopped = False
    while run.status == "running" and not stopped:
        try:
            run.step()
        except module.StatusError as error:
            if error.name != "SINGULAR_POSITION":
                raise
            stopped = True
    wrong = np.abs(run.y - case.exact(run.t)).max()
    # gravity alone carries errors of the windows away from the upright, some hundred times
    assert wrong < tolerance * (1000 if stopped else 100)


def beside(draw: np.random.Generator, name: str, off: float) -> tuple[float, Any, Any, Any]:
    """A time, a state near a flat position, off the exact one by a part of its size, and v' there."""
    case = made(name)[0]
    t = float(draw.uniform(0.0, 2.0))
    angle = 10.0 ** draw.uniform(-5.0, 0.0)
    speed = float(draw.choice([0.5, 4.0]))
    if name == "parallelogram":
        q, v = (2 * math.pi - angle) * SIGNS, speed * SIGNS
        a = math.sin(3 * t) / 0.24 * SIGNS
    else:
        count = (len(case.exact(0.0)) // 2 - 1) // 2
        signs = np.array([1.0] * (count + 1) + [-1.0] * count)
        q, v = (math.pi / 2 - angle) * signs, speed * signs
        share = ((count + 1) / 2 + count) / ((count + 1) / 3 + count) * 9.81
        a = share * math.sin(math.pi / 2 - angle) * signs
    q = q + off * draw.uniform(-1, 1, len(q))
    return t, q, v + off * speed * draw.uniform(-1, 1, len(v)), a


@pytest.mark.parametrize("off", [0.0, 1e-15, 1e-13, 1e-11, 1e-9])
@pytest.mark.parametrize("name", ["parallelogram", "two windows"])
def test_accelerations_near_flat_positions_are_right_or_have_a_status(
    name: str, off: float
) -> None:
    """1e-5 to 1 rad from flat, states off by up to 1e-9: what is returned is right to 1e-6, in C as well."""
    draw = np.random.default_rng(7)
    _, module, compiled = made(name)
    returned = far = 0
    for _ in range(100):
        t, q, v, exact = beside(draw, name, off)
        scale = max(np.abs(exact).max(), 0.01 * np.abs(v).max() ** 2)
        size = len(v), module.NC
        try:
            a, _ = module.forward_dynamics(*timed(name, t), q, v, np.zeros(0))
        except module.StatusError as error:
            if error.name != "SINGULAR_POSITION":
                raise
            a = None
        try:
            given = (*timed(name, t), q, v, np.zeros(1))
            in_c = compiled.call("forward_dynamics", *given, out=[(n,) for n in size])[0]
        except Failed as failed:
            if failed.status != SINGULAR_POSITION.number:
                raise
            in_c = None
        for found in (a, in_c):
            if found is not None:
                assert np.abs(found - exact).max() < 1e-6 * scale
                returned += 1
        far += 2 * (abs(abs(q[0]) - (2 if name == "parallelogram" else 0.5) * math.pi) > 0.5)
    assert returned >= far > 0
