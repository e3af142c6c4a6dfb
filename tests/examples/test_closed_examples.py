"""The examples with closed loops, through their emitted C: published numbers, closed forms, audits.

Numbers are copied from the sources named beside them; closed forms are written apart, here and in
`one_freedom`; the rest are theorems of mechanics. Nothing expected comes from code of this project.
"""

from __future__ import annotations

import inspect
import math
import subprocess
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mpmath import mp
from oracles import one_freedom
from oracles.newton_euler import rotation_of_quaternion
from oracles.one_freedom import Body, Moving, Pin, course
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq
from support.closed_examples import (
    BIG,
    CLOSED,
    EXAMPLES,
    KINDS,
    State,
    System,
    read,
    robot,
    system,
    twin,
)
from support.closed_examples import with_values as changed
from support.compiled import COMPILERS, WARNINGS, available, has_no_warnings

from linegraph.emission.emit import render
from linegraph.numeric.between_trees import body_frames, transfer

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    Array = np.ndarray

G = 9.81
EXACT = 1e-12
"""Relative to 1 + the largest entry; measured 1e-14."""

FIRST = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
"""Weights of central differences of eighth order."""


def derivative(function: Callable[[float], Any], step: float) -> Any:
    """At 0, by central differences of eighth order."""
    return sum(w * (function(k * step) - function(-k * step)) for k, w in FIRST.items()) / step


def error(found: Any, expected: Any) -> float:
    """The largest difference, relative to 1 + the largest entry expected."""
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape
    largest = np.max(np.abs(found - expected), initial=0.0)
    return float(largest / (1 + np.max(np.abs(expected), initial=0.0)))


def relative(found: Any, expected: Any) -> float:
    """The largest difference relative to the entry; to the largest one where 0 is expected."""
    found, expected = np.asarray(found), np.asarray(expected)
    size = np.abs(expected)
    size[size == 0] = size.max()
    return float(np.max(np.abs(found - expected) / size))


@pytest.mark.parametrize("name", CLOSED)
def test_readme_says_what_it_is_and_how_it_is_used(name: str) -> None:
    readme = (EXAMPLES / name / "README.md").read_text(encoding="utf-8")
    path = f"examples/{name}/{name}.toml"
    assert f"linegraph show {path}" in readme
    assert f"linegraph emit {path} --out build/{name}" in readme


# ---- Andrews' squeezing mechanism


@dataclass(frozen=True)
class Squeezed:
    """A state of Andrews' mechanism; q in the order of Q_NAMES."""

    q: tuple[float, ...]
    qd: tuple[float, ...]
    qdd: tuple[float, ...]
    lam: tuple[float, ...]


ANDREWS_START = Squeezed(
    q=(
        -0.06171389001427645,
        0.0,
        0.45527981916307037,
        0.22266839016588588,
        0.48736497954384256,
        -0.22266839016588588,
        1.2305474445498212,
    ),
    qd=(0.0,) * 7,
    qdd=(14222.443919954114, -10666.832939965585, 0.0, 0.0, 0.0, 0.0, 0.0),
    lam=(98.56687039624109, -6.122688344255662, 0.0, 0.0, 0.0, 0.0),
)
ANDREWS_END = Squeezed(
    q=(
        15.81077119629904,
        -15.75637105984298,
        0.04082224013073101,
        -0.5347301163226948,
        0.5244099658805303,
        0.5347301163226948,
        1.048080741042263,
    ),
    qd=(
        1139.920302151208,
        -1424.379294994111,
        11.03291221937134,
        19.29337464421385,
        0.5735699284790808,
        -19.29337464421385,
        0.3231791658026955,
    ),
    qdd=(
        -24631.76316946196,
        51850.37701610329,
        324102.5686413781,
        566749.3645176213,
        16743.62929479361,
        -566749.3645176222,
        9826.520791458423,
    ),
    lam=(
        199.175333373191,
        -29.75531228015052,
        23.06654119098399,
        31.45271365475927,
        22.64249232082739,
        11.61740700019673,
    ),
)
"""Test Set for IVP Solvers (Univ. Bari / CWI), andrews.f; Hairer & Wanner II, VII.7: at t = 0 and 0.03."""


def andrews_multipliers(s: System, q: Any, v: Any) -> list[float]:
    """λ of M q̈ + G^T λ = f.

    G's six rows are K2's end less the ends of K3, K4 and K6, so these are forces on the latter: the
    reactions on K2, which is the tail of the joints, with signs from head to tail and of the equation.
    """
    found = s.named("reactions", q, v, s.idle)
    return [-found[f"E{k}_f{c}"] for k in (3, 4, 6) for c in "xy"]


def test_andrews_starts_as_published() -> None:
    s, start = system("andrews_squeezer"), ANDREWS_START
    q, v = s.project(start.q, start.qd)
    assert np.max(np.abs(q - start.q)) < 1e-14
    a, _ = s.accelerate(q, v, s.idle)
    assert relative(a, start.qdd) < 5e-6
    assert relative(andrews_multipliers(s, q, v), start.lam) < 5e-6


def test_andrews_ends_as_published() -> None:
    s, end = system("andrews_squeezer"), ANDREWS_END
    q, v = s.run(*s.project(ANDREWS_START.q, ANDREWS_START.qd), s.idle, 0.03)
    a, _ = s.accelerate(q, v, s.idle)
    assert relative(q, end.q) < 1e-8
    assert relative(v, end.qd) < 2e-7
    assert relative(a, end.qdd) < 5e-6
    assert relative(andrews_multipliers(s, q, v), end.lam) < 5e-6


# ---- car axis

CAR_P = (0.04934557842755629, 0.4969894602303324, 1.0417425248854, 0.3739110272652214)
CAR_PD = (-0.07705836840321485, 0.007446866596327776, 0.01755681574942899, 0.770341043779403)
CAR_LAM = (-0.00473688675078463, -0.00110468041134573)
"""Test Set for IVP Solvers (Univ. Bari / CWI), caraxis.f: (xl, yl, xr, yr), rates and λ at t = 3."""


def car_state(s: System, q: Array, v: Array, t: float) -> tuple[list[float], list[float]]:
    """(xl, yl, xr, yr) and rates."""
    seen = s.named("outputs", q, v, s.idle, t=t)
    moving = s.named("across", q, v, t=t)
    place = [seen["left_x"], seen["left_y"], q[s.at("place_x")], q[s.at("place_y")]]
    return place, [moving[f"{side}/inertia_v{c}"] for side in ("left", "right") for c in "xy"]


def test_car_axis_as_published() -> None:
    """λ of k p̈ = f + G^T λ: of the road x_b x + y_b y = 0 and of the axle's squared length."""
    s = system("car_axis")
    q, v = s.project([0.5, 1.0, 0.5], s.vector(place_x=-0.5))
    place, rate = car_state(s, q, v, 0.0)
    assert np.max(np.abs(np.subtract(place, (0, 0.5, 1, 0.5)))) < 1e-14
    assert np.max(np.abs(np.subtract(rate, (-0.5, 0, -0.5, 0)))) < 1e-14
    q, v = s.run(q, v, s.idle, 3.0)
    place, rate = car_state(s, q, v, 3.0)
    assert np.max(np.abs(np.subtract(place, CAR_P))) < 1e-8
    assert np.max(np.abs(np.subtract(rate, CAR_PD))) < 1e-8
    _, (axle,) = s.accelerate(q, v, s.idle, 3.0)
    normal = s.named("reactions", q, v, s.idle, t=3.0)["height_fx"]
    assert np.max(np.abs(np.subtract((normal, axle / 2), CAR_LAM))) < 1e-7


# ---- Bricard's linkage

BRICARD = ((0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1))
"""IFToMM benchmark A04: the hinges at the start, from ground to ground."""


def test_bricard_moves_against_the_count_of_freedoms() -> None:
    """Five rods, six hinges: 6 * 5 - 5 * 6 = 0, yet it moves; one of the five rows is redundant."""
    s = system("bricard")
    found = body_frames(s.derivation.numeric(), list(s.start), [0.0] * s.py.NV)
    origins = [found[f"rod{k}"].origin for k in range(1, 6)]
    assert error(origins, BRICARD[:5]) < 1e-12
    end = found["rod5"].at((0, 1, 0)).origin
    assert error(end, BRICARD[5]) < 1e-12
    assembled = s.derivation.assembled
    assert s.py.NV - s.py.NC == 0
    assert (assembled.freedoms, assembled.redundant, s.py.RANK) == (1, 1, 4)


# ---- bicycle

BICYCLE_M = ((80.81722, 2.31941332208709), (2.31941332208709, 0.29784188199686))
BICYCLE_K0 = ((-80.95, -2.59951685249872), (-2.59951685249872, -0.80329488458618))
BICYCLE_K2 = ((0, 76.59734589573222), (0, 2.65431523794604))
BICYCLE_C1 = ((0, 33.86641391492494), (-0.85035641456978, 1.68540397397560))
BICYCLE_AT_REST = (-5.53094371765393, -3.13164324790656, 3.13164324790656, 5.53094371765393)
WEAVE, CAPSIZE = 4.29238253634111, 6.02426201538837
"""Meijaard, Papadopoulos, Ruina & Schwab, Proc. R. Soc. A 463 (2007): the benchmark bicycle.

``M q̈ + v C1 q̇ + (g K0 + v² K2) q = 0`` with q = (lean, steer); 14 decimals.
"""

STEP = 0.01
"""Of differences of eighth order: at twice the step the error grows from 1e-15 to 2e-11."""


def riding(lean: float, steer: float, rates: Sequence[float], speed: float) -> Any:
    """Reduced M and bias for lean and steer at a state of the bicycle."""
    s = system("bicycle")
    w = [*rates, -speed / 0.3]
    return s.reduced(*s.complete(s.start, [lean, steer, 0.0], w))


def stiffness(speed: float) -> Array:
    """The matrix g K0 + v² K2."""
    lean = derivative(lambda x: riding(x, 0, (0, 0), speed)[1], STEP)
    steer = derivative(lambda x: riding(0, x, (0, 0), speed)[1], STEP)
    return np.column_stack([lean, steer])[:2]


def damping(speed: float) -> Array:
    """The matrix v C1."""
    lean = derivative(lambda x: riding(0, 0, (x, 0), speed)[1], STEP)
    steer = derivative(lambda x: riding(0, 0, (0, x), speed)[1], STEP)
    return np.column_stack([lean, steer])[:2]


def test_bicycle_mass_matrix_as_published() -> None:
    found, bias = riding(0, 0, (0, 0), 5.0)
    assert relative(found[:2, :2], BICYCLE_M) < 1e-12
    assert np.max(np.abs(found[2, :2])) < 1e-12
    assert np.max(np.abs(bias)) < 1e-12


def test_bicycle_linear_equations_as_published() -> None:
    """Measured 1e-15 of the largest entry."""
    still = stiffness(0.0)
    assert error(still / G, BICYCLE_K0) < 1e-12
    for speed in (3.0, 5.0):
        assert error((stiffness(speed) - still) / speed**2, BICYCLE_K2) < 1e-12
        assert error(damping(speed) / speed, BICYCLE_C1) < 1e-12


def test_bicycle_eigenvalues_and_speeds_as_published() -> None:
    """Measured 5e-15 for the eigenvalues, 3e-14 for the weave speed, 2e-13 for the capsize speed."""
    mass, gravity = riding(0, 0, (0, 0), 0.0)[0][:2, :2], stiffness(0.0)
    growth = (stiffness(5.0) - gravity) / 25
    gyroscopic = damping(5.0) / 5
    squares = np.linalg.eigvals(np.linalg.solve(mass, -gravity)).real
    roots = np.sort(np.concatenate([np.sqrt(squares), -np.sqrt(squares)]))
    assert np.max(np.abs(roots - BICYCLE_AT_REST)) < 1e-9

    def stiff(v: float) -> Array:
        return gravity + v * v * growth

    def weaving(v: float) -> float:
        below = -np.linalg.solve(mass, np.hstack([stiff(v), v * gyroscopic]))
        values = np.linalg.eigvals(np.vstack([np.eye(2, 4, 2), below]))
        return float(max(values[np.abs(values.imag) > 1e-3].real))

    assert abs(brentq(weaving, 4, 5, xtol=1e-14) - WEAVE) < 1e-12
    capsize = brentq(lambda v: np.linalg.det(stiff(v)), 5.5, 6.5, xtol=1e-14)
    assert abs(capsize - CAPSIZE) < 1e-12


# ---- parallelograms


def test_parallelograms_move_as_one_angle() -> None:
    """((N+1)/3 + N) m L² θ̈ = ((N+1)/2 + N) m g L sin θ, N = 2, from the upright with ``θ̇ = 1``.

    IFToMM benchmark A02. The time to 79 degrees is an integral of ``1/θ̇``, known from the energy.
    """
    s = system("parallelograms")
    q, v = s.complete(s.start, [0.0], [-1.0])

    def speed(angle: float) -> float:
        return math.sqrt(1 + 7 / 3 * G * (1 - math.cos(angle)))

    end = math.radians(79)
    time, _ = quad(lambda angle: 1 / speed(angle), 0, end, epsabs=1e-14, epsrel=1e-13)
    q, v = s.run(q, v, s.idle, time)
    found = s.named("outputs", q, v, s.idle)
    assert abs(found["B0_x"] - math.sin(end)) < 1e-7
    assert abs(found["B0_y"] - math.cos(end)) < 1e-7
    assert abs(v[s.at("A0")] + speed(end)) < 1e-7


# The benchmark's own run of 10 s, through the singular positions where all rods lie flat, has its place here.


# ---- mechanisms of one freedom


@dataclass(frozen=True)
class Mechanism:
    """A mechanism of one freedom in closed form.

    Attributes:
        bodies: by name.
        known: the inputs' and elements' part at (s, w, u): the generalised force, and what acts on each
            body beside gravity, as (force x, force y, torque).
        pins: the joints at s.
        coordinates: those of the example as functions of s, in the order of its q.
    """

    bodies: Mapping[str, Body]
    known: Callable[[float, float, Array], tuple[float, dict[str, tuple[float, float, float]]]]
    pins: Callable[[float], Mapping[str, Pin]]
    coordinates: Callable[[Any], tuple[Any, ...]]

    def loads(self, s: float, w: float, u: Array) -> dict[str, Array]:
        """All that acts on each body beside the joints."""
        _, given = self.known(s, w, u)
        return {
            name: np.array([0, -G * body.mass, 0]) + given.get(name, (0, 0, 0))
            for name, body in self.bodies.items()
        }

    def acceleration(self, s: float, w: float, u: Array) -> float:
        """s̈."""
        bodies, (force, _) = list(self.bodies.values()), self.known(s, w, u)
        return one_freedom.acceleration(bodies, s, w, G, force)

    def moving(self, s: float, w: float, u: Array) -> dict[str, Moving]:
        """All bodies in motion."""
        a, loads = self.acceleration(s, w, u), self.loads(s, w, u)
        return {n: one_freedom.moving(b, s, w, a, loads[n]) for n, b in self.bodies.items()}


def four_bar() -> Mechanism:
    """Crank, coupler and rocker: the knee is where two circles meet."""
    a, b, c, d, rho, bearing = 0.1, 0.4, 0.3, 0.35, 2.0, 0.01

    def knee(s: Any) -> Any:
        x, y = d - a * mp.cos(s), -a * mp.sin(s)
        between = mp.sqrt(x * x + y * y)
        along = (b * b - c * c + between**2) / (2 * between)
        aside = mp.sqrt(b * b - along**2)
        return d - x + (along * x - aside * y) / between, -y + (along * y + aside * x) / between

    def coupler(s: Any) -> Any:
        x, y = knee(s)
        return mp.atan2(y - a * mp.sin(s), x - a * mp.cos(s))

    def rocker(s: Any) -> Any:
        x, y = knee(s)
        return mp.atan2(y, x - d)

    def bar(length: float, x: Any, y: Any, angle: Any) -> tuple[Any, Any, Any]:
        return x + length / 2 * mp.cos(angle), y + length / 2 * mp.sin(angle), angle

    def rod(length: float, place: Callable[[Any], tuple[Any, Any, Any]]) -> Body:
        return Body(rho * length, rho * length**3 / 12, place)

    bodies = {
        "crank": rod(a, lambda s: bar(a, 0, 0, s)),
        "coupler": rod(b, lambda s: bar(b, a * mp.cos(s), a * mp.sin(s), coupler(s))),
        "rocker": rod(c, lambda s: bar(c, d, 0, rocker(s))),
    }

    def known(s: float, w: float, u: Array) -> Any:
        swing = course(rocker, s)
        braking = -bearing * swing.rate(w)
        return u[0] + braking * swing.dx, {"rocker": (0, 0, braking)}

    def pins(s: float) -> dict[str, Pin]:
        at = tuple(map(float, knee(s)))
        tip = (a * math.cos(s), a * math.sin(s))
        return {
            "motor": Pin(None, "crank", (0, 0), (0, 1, 2)),
            "elbow": Pin("crank", "coupler", tip),
            "swing": Pin(None, "rocker", (d, 0)),
            "knee": Pin("coupler", "rocker", at),
        }

    return Mechanism(bodies, known, pins, lambda s: (s, coupler(s) - s, rocker(s)))


def slider_crank() -> Mechanism:
    """Crank, connecting rod and piston."""
    r, long, inertia, m, own, at, piston = 0.05, 0.2, 2e-3, 0.4, 1.5e-3, 0.07, 0.5

    def rod(s: Any) -> Any:
        return -mp.asin(r * mp.sin(s) / long)

    def stroke(s: Any) -> Any:
        return r * mp.cos(s) + long * mp.cos(rod(s))

    def center(s: Any) -> tuple[Any, Any, Any]:
        x = r * mp.cos(s) + at * mp.cos(rod(s))
        return x, r * mp.sin(s) + at * mp.sin(rod(s)), rod(s)

    bodies = {
        "crank": Body(0.0, inertia, lambda s: (mp.mpf(0), mp.mpf(0), s)),
        "rod": Body(m, own, center),
        "piston": Body(piston, 0.0, lambda s: (stroke(s), mp.mpf(0), mp.mpf(0))),
    }

    def known(s: float, w: float, u: Array) -> Any:
        return u[0] - u[1] * course(stroke, s).dx, {"piston": (-u[1], 0, 0)}

    def pins(s: float) -> dict[str, Pin]:
        end = (float(stroke(s)), 0)
        return {
            "shaft": Pin(None, "crank", (0, 0), (0, 1, 2)),
            "big_end": Pin("crank", "rod", (r * math.cos(s), r * math.sin(s))),
            "bore": Pin(None, "piston", end, (1, 2)),
            "small_end": Pin("rod", "piston", end),
        }

    return Mechanism(bodies, known, pins, lambda s: (s, rod(s) - s, stroke(s)))


MECHANISMS = {"four_bar": four_bar(), "slider_crank": slider_crank()}


def turning(name: str) -> list[tuple[float, float, State]]:
    """States all around a turn of the crank: s, its rate, and all coordinates with inputs."""
    s, rng = system(name), np.random.default_rng(17)
    q, found = s.start, []
    for k in range(12):
        angle, w = 0.5 + k * math.pi / 6, float(rng.normal(scale=8))
        q, v = s.complete(q, [angle], [w])
        found.append(
            (angle, w, State(q, v, rng.normal(size=s.py.NU) * np.array([1, 50][: s.py.NU])))
        )
    return found


@pytest.mark.parametrize("name", MECHANISMS)
def test_motion_agrees_with_lagrange(name: str) -> None:
    """All coordinates, velocities and accelerations from one; the automatic tree's are those written here."""
    s, mechanism = system(name), MECHANISMS[name]
    for angle, w, state in turning(name):
        size = range(s.py.NQ)
        along = [course(lambda x, k=k: mechanism.coordinates(x)[k], angle) for k in size]
        a = mechanism.acceleration(angle, w, state.u)
        behind = [state.q[k] - along[k].x for k in size]
        assert np.max(np.abs(np.sin(behind))) < 1e-12
        assert error(state.v, [c.rate(w) for c in along]) < 1e-12
        assert error(s.accelerate(*state)[0], [c.acceleration(w, a) for c in along]) < EXACT


@pytest.mark.parametrize("name", MECHANISMS)
def test_reactions_agree_with_newton_and_euler(name: str) -> None:
    """Each body by itself. Across the plane nothing acts, and reactions are those of least norm."""
    s, mechanism = system(name), MECHANISMS[name]
    for angle, w, state in turning(name):
        found = s.named("reactions", *state)
        pins = mechanism.pins(angle)
        expected = one_freedom.reactions(mechanism.moving(angle, w, state.u), pins)
        if name == "four_bar":
            assert error(expected["motor"][2], state.u[0]) < EXACT
        for joint, (x, y, torque) in expected.items():
            at = float(mechanism.bodies[pins[joint].head].place(mp.mpf(angle))[2])
            c, sine = math.cos(at), math.sin(at)
            wanted = [c * x + sine * y, c * y - sine * x, 0, 0, 0, torque]
            ends = ("fx", "fy", "fz", "tx", "ty", "tz")
            assert error([found[f"{joint}_{end}"] for end in ends], wanted) < EXACT, joint


@pytest.mark.parametrize("name", MECHANISMS)
def test_reduced_equations_are_those_of_one_freedom(name: str) -> None:
    """``Mr ẇ + hr = T^T Q``, Q from all equations, agree with forward dynamics; so does their motion."""
    s = system(name)
    size, count = s.py.NV, s.nc
    out = [(size, size), (size,), (count, size), (count,)]
    for _, _, state in turning(name):
        tangent, _ = s.call("reduction", state.q, state.v, out=[(size, 1), (size,)])
        inertia, bias = s.reduced(state.q, state.v)
        _, force, _, _ = s.call("constrained_equations", *state, out=out)
        applied = force + s.call("bias", state.q, state.v, out=[(size,)])
        w = (tangent.T @ applied - bias) / inertia[0, 0]
        assert error(w, s.accelerate(*state)[0][:1]) < EXACT


@pytest.mark.parametrize("name", MECHANISMS)
def test_reduced_motion_is_the_motion(name: str) -> None:
    """Half a second without inputs, more than a turn: one equation against all with multipliers."""
    s = system(name)
    guess = [s.start]

    def slope(t: float, x: Array) -> list[float]:
        guess[0], v = s.complete(guess[0], x[:1], x[1:])
        inertia, bias = s.reduced(guess[0], v)
        return [x[1], -bias[0] / inertia[0, 0]]

    begin = [s.start[0], 25.0]
    done = solve_ivp(slope, (0, 0.5), begin, method="DOP853", rtol=1e-12, atol=1e-12)
    q, v = s.run(*s.complete(s.start, begin[:1], begin[1:]), s.idle, 0.5)
    assert q[0] > begin[0] + 2 * math.pi
    assert error(done.y[:, -1], [q[0], v[0]]) < 1e-9


# ---- Stewart-Gough platform


def rising() -> tuple[list[Body], Callable[[Any], Any]]:
    """The platform straight up and down: its bodies at height h, a leg in its plane; a leg's length."""
    a, b = math.pi / 15, math.pi / 12
    run = abs(0.4 * np.exp(1j * (math.pi / 3 - b)) - 0.6 * np.exp(1j * a))

    def leg(h: Any) -> Any:
        return mp.sqrt(h * h + run**2)

    def lean(h: Any) -> Any:
        return mp.atan2(run, h)

    def cylinder(h: Any) -> tuple[Any, Any, Any]:
        return 0.2 * mp.sin(lean(h)), 0.2 * mp.cos(lean(h)), lean(h)

    def piston(h: Any) -> tuple[Any, Any, Any]:
        return run - 0.25 * mp.sin(lean(h)), h - 0.25 * mp.cos(lean(h)), lean(h)

    platform = Body(30, 0.0, lambda h: (mp.mpf(0), h + 0.03, mp.mpf(0)))
    legs = [Body(4, 0.05, cylinder), Body(1.5, 0.03, piston)]
    return [platform, *(6 * legs)], leg


def test_stewart_platform_assembles_in_the_middle() -> None:
    s = system("stewart_platform")
    found = s.named("outputs", s.start, np.zeros(s.py.NV), s.idle)
    assert error([found["x"], found["y"], found["z"]], (0, 0, 0.8)) < 1e-14
    lengths = [s.start[s.py.Q_NAMES.index(f"leg{k}")] for k in range(1, 7)]
    assert np.ptp(lengths) < 1e-14
    assert list(s.py.INDEPENDENT_NAMES) == [f"leg{k}" for k in range(1, 7)]
    assert s.derivation.assembled.redundant == 0


def test_stewart_platform_rises_as_lagrange_says() -> None:
    """Equal efforts: a motion of one freedom, the height. All six legs move alike."""
    s = system("stewart_platform")
    bodies, leg = rising()
    legs = [s.at(f"leg{k}") for k in range(1, 7)]
    rng = np.random.default_rng(4)
    for h in (0.7, 0.75, 0.8, 0.85, 0.9):
        rate, effort = float(rng.normal()), float(rng.normal(scale=200))
        long = course(leg, h)
        q, v = s.complete(s.start, [long.x] * 6, [long.rate(rate)] * 6)
        a = one_freedom.acceleration(bodies, h, rate, G, 6 * effort * long.dx)
        found, _ = s.accelerate(q, v, [effort] * 6)
        assert error(found[legs], [long.acceleration(rate, a)] * 6) < EXACT


def test_stewart_platform_is_held_by_the_efforts_of_virtual_work() -> None:
    """``6 F cos β = g (mp + 6 mc sc s²/l³ + 6 mr (1 - sr s²/l³))``, s the run of a leg, β its lean."""
    s = system("stewart_platform")
    long = course(rising()[1], 0.8)
    bend = (long.x**2 - 0.8**2) / long.x**3
    effort = G * (30 + 6 * 4 * 0.2 * bend + 6 * 1.5 * (1 - 0.25 * bend)) / (6 * 0.8 / long.x)
    a, _ = s.accelerate(s.start, np.zeros(s.py.NV), [effort] * 6)
    assert np.max(np.abs(a)) < 1e-12


# ---- rolling disc

R = 0.2


def disc_rates(q: Array, v: Array) -> tuple[float, float, float, float, float]:
    """Yaw and lean, and the spin about the line of lean, the disc's axis, and the diameter normal to both."""
    yaw, lean = q[3:5]
    return yaw, lean, v[4], v[5] + v[3] * math.sin(lean), v[3] * math.cos(lean)


def test_rolling_disc_obeys_its_known_equations() -> None:
    """Of yaw, lean and roll, as in SymPy's documentation (a rolling disc by Kane's method).

    u1' = (4 g sin q2 + 6 r u2 u3 - r u3² tan q2)/(5 r),  u2' = -2 u1 u3/3,  u3' = (u3 tan q2 - 2 u2) u1
    """
    s, rng = system("rolling_disc"), np.random.default_rng(8)
    for _ in range(20):
        q, v = s.complete(s.start, rng.uniform(-1, 1, 3), rng.normal(scale=3, size=3))
        a, _ = s.accelerate(q, v, s.idle)
        _, lean, u1, u2, u3 = disc_rates(q, v)
        sine, cosine = math.sin(lean), math.cos(lean)
        found = (
            a[4],
            a[5] + a[3] * sine + v[3] * v[4] * cosine,
            a[3] * cosine - v[3] * v[4] * sine,
        )
        tangent = sine / cosine
        expected = (
            (4 * G * sine + 6 * R * u2 * u3 - R * u3 * u3 * tangent) / (5 * R),
            -2 * u1 * u3 / 3,
            (u3 * tangent - 2 * u2) * u1,
        )
        assert error(found, expected) < EXACT


def steady() -> tuple[float, float, float]:
    """Lean, yaw rate and roll rate of a disc that runs round in a circle: ``u1' = 0`` above."""
    lean, yaw = 0.3, 1.5
    u3 = yaw * math.cos(lean)
    u2 = (R * u3 * u3 * math.tan(lean) - 4 * G * math.sin(lean)) / (6 * R * u3)
    return lean, yaw, u2 - yaw * math.sin(lean)


def test_rolling_disc_runs_round_in_a_circle() -> None:
    s = system("rolling_disc")
    lean, yaw, roll = steady()
    q, v = s.complete(s.start, [0, lean, 0], [yaw, 0, roll])
    period = 2 * math.pi / yaw
    half, _ = s.run(q, v, s.idle, period / 2)
    after, rates = s.run(q, v, s.idle, period)
    assert np.hypot(*(half - q)[:2]) > 0.5
    assert error(after, q + np.array([0, 0, 0, 2 * math.pi, 0, roll * period])) < 1e-9
    assert error(rates, v) < 1e-9


def test_rolling_disc_does_not_slip() -> None:
    """The velocity of the material at the lowest point of the rim, after 5 s without projection."""
    s = system("rolling_disc")
    q, v = s.complete(s.start, [0.4, 0.3, 0], [1.0, -0.5, 8.0])
    q, v = s.run(q, v, s.idle, 5.0)
    yaw, lean = q[3:5]
    axis = np.array([-math.sin(yaw), math.cos(yaw), 0]) * math.cos(lean) + [0, 0, math.sin(lean)]
    up = np.array([0, 0, 1.0])
    down = math.sin(lean) * axis - up
    contact = R * down / np.linalg.norm(down)
    moving = s.named("across", q, v)
    center, spin = ([moving[f"contact_{x}{c}"] for c in "xyz"] for x in "vw")
    assert np.linalg.norm(center) > 1.0
    assert np.max(np.abs(np.add(center, np.cross(spin, contact)))) < 1e-10
    assert abs(q[2] + contact[2]) < 1e-10


# ---- crane with a hoist


def hoisting() -> tuple[State, Array, Array]:
    """A state at t = 0, the unit vector from trolley to eye, and the axes of the load."""
    s = system("crane_hoist")
    q = [1.5, 3.0, 1.0, -7.5, 0.1, -0.2, 0.1, 0.9]
    q, v = s.project(q, [0.5, 0.6, -0.4, 0.1, 0.2, -0.3, 0.1])
    axes = np.array(rotation_of_quaternion(q[4:]))
    line = q[1:4] + axes @ [0, 0, 0.6] - [q[0], 0, 0]
    assert abs(np.linalg.norm(line) - 8) < 1e-12
    return State(q, v, np.array([700.0])), line / 8, axes


def test_crane_rope_pulls_as_newton_says() -> None:
    """The same tension accelerates the trolley and the load, and is what the output and the reaction say."""
    s = system("crane_hoist")
    state, along, axes = hoisting()
    a, _ = s.accelerate(*state)
    v = state.v
    load = 2000 * (axes @ (a[1:4] + np.cross(v[4:], v[1:4])) + [0, 0, G])
    tension = -load @ along
    assert error(-tension * along, load) < EXACT
    assert error(700 + tension * along[0], 800 * a[0]) < EXACT
    found = s.named("reactions", *state)
    assert error([found[f"rope_f{c}"] for c in "xyz"], -tension * along) < EXACT
    assert error(s.named("outputs", *state)["rope_force"], tension) < EXACT


def test_crane_energy_comes_from_hoist_and_drive() -> None:
    """dE/dt = tension * rate + effort * velocity; dE/dt by differences along the motion."""
    s = system("crane_hoist")
    state, _, _ = hoisting()

    def energy(t: float) -> float:
        return s.energy(*s.run(state.q, state.v, state.u, t), t)

    tension = s.named("outputs", *state)["rope_force"]
    power = tension * 0.5 + 700 * state.v[0]
    assert derivative(energy, 0.005) == pytest.approx(power, rel=1e-10)


# ---- energy

QUIET: dict[str, tuple[dict[str, float], Callable[[System], tuple[Array, Array]]]] = {
    "four_bar": ({"k": 0}, lambda s: s.project(s.start, s.vector(motor=10))),
    "slider_crank": ({}, lambda s: s.project(s.start, s.vector(shaft=10))),
    "bricard": ({}, lambda s: s.project(s.start, s.vector())),
    "stewart_platform": (
        {"g": 0},
        lambda s: s.complete(s.start, s.start[leg_places(s)], [0.02, 0, -0.02, 0.01, 0.01, 0]),
    ),
    "rolling_disc": ({}, lambda s: s.complete(s.start, [0, 0.2, 0], [1.0, 0.3, 12.0])),
    "bicycle": ({}, lambda s: s.complete(s.start, [0.1, 0, 0], [0, 0, -5 / 0.3])),
    "car_axis": ({"r": 0}, lambda s: s.project(s.start, s.vector(place_x=-0.5, height=0.3))),
    "crane_hoist": ({"rate": 0}, lambda s: s.project(s.start, [1, 1, 2, 0, 0.1, 0.2, 0.3])),
    "parallelograms": (
        {},
        lambda s: s.complete(np.array([1, 1, 1, -1, -1]) * math.pi, [math.pi], [1.0]),
    ),
    "double_pendulum": ({}, lambda s: s.project([1.0, 0.5], [3.0, -2.0])),
    "heavy_top": ({}, lambda s: s.project([0.1, 0.2, 0.1, 0.9], [1.0, 30.0, 2.0])),
    "elastic_pendulum": ({}, lambda s: s.project([0.3, 0.4, 0.1], [1.0, 2.0, 0.5])),
}
"""What nothing moves or brakes from outside, with the values that see to that, and how it begins.

Of the ten closed ones Andrews' mechanism is left out: 10 s are 1e4 turns of its crank. The
platform, which nothing holds, drifts without gravity; the parallelograms swing below, away from where
they are singular.
"""


def leg_places(s: System) -> list[int]:
    """Where the lengths of the legs stand in q."""
    return [s.py.Q_NAMES.index(f"leg{k}") for k in range(1, 7)]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", QUIET)
def test_energy_is_conserved_for_10_s(name: str) -> None:
    """At the end of every second, relative to the larger of both energies."""
    values, begin = QUIET[name]
    s = changed(name, *values.items()) if values else system(name)
    q, v = begin(s)
    energies = [s.call("energy", q, v, out=[(2,)])]
    for _ in range(10):
        q, v = s.project(*s.run(q, v, s.idle, 1.0))
        energies.append(s.call("energy", q, v, out=[(2,)]))
    kinetic, total = np.array(energies)[:, 0], np.sum(energies, axis=1)
    assert np.ptp(kinetic) > 1e-3 * np.max(kinetic) or "g" in values
    assert np.ptp(total) <= 1e-9 * np.max(np.abs(energies))


# ---- power

AUDITED = sorted(path.parent.name for path in EXAMPLES.glob("*/*.toml"))
STATES = 20


def audit(s: System) -> None:
    """Both sums of powers vanish at 20 states on the constraints, with random inputs."""
    rng = np.random.default_rng(23)
    size = len(s.py.POWER_NAMES)
    network = s.derivation.formulation.network
    count = 2 + (sum(d not in network.heats for d in network.domains) if network else 0)
    for _ in range(STATES):
        state = s.random(rng) if s.nc else s.random(rng, 1.0)
        powers, sums = s.call("power", *state, out=[(size,), (count,)], t=state.t)
        assert np.max(np.abs(powers)) > 0
        assert np.max(np.abs(sums)) <= 1e-11 * (1 + np.max(np.abs(powers)))


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", AUDITED)
def test_powers_of_all_edges_sum_to_zero(name: str) -> None:
    audit(system(name))


@pytest.mark.parametrize("base", ["fixed", "floating"])
@pytest.mark.parametrize("name", ["panda", "anymal_c"])
def test_powers_of_robots_sum_to_zero(name: str, base: str) -> None:
    audit(robot(name, base))


@pytest.mark.one_in(4)
@pytest.mark.parametrize(("name", "kind"), KINDS)
def test_powers_sum_to_zero_in_other_coordinates(name: str, kind: str) -> None:
    audit(twin(name, kind))


# ---- the tree is a choice and never the physics


def carried(name: str, state: State, target: System) -> State:
    """A state of an example in the coordinates of another formulation."""
    given, wanted = (x.derivation.numeric(t=state.t) for x in (system(name), target))
    q, v = transfer(given, state.q.tolist(), state.v.tolist(), wanted)
    return State(np.array(q), np.array(v), state.u, state.t)


def unique_reactions(s: System, state: State) -> set[str]:
    """The reactions that no multipliers change which do nothing to the motion."""
    a, multipliers = s.accelerate(*state, t=state.t)
    more = [state.u] if "u" in inspect.signature(s.py.reactions_at).parameters else []

    def at(lam: Array) -> Array:
        out = [(s.py.NR,)]
        return s.call("reactions_at", state.q, state.v, *more, a, lam, out=out, t=state.t)

    jacobian = s.call("constraint_jacobian", state.q, out=[(s.nc, s.py.NV)], t=state.t)
    left, values, _ = np.linalg.svd(jacobian)
    assert np.sum(values > 1e-9 * values[0]) == s.py.RANK
    idle = left[:, s.py.RANK :].T
    base = at(multipliers)
    doubt = np.max([np.abs(at(multipliers + x) - base) for x in idle] or [0 * base], axis=0)
    assert not np.any((doubt > 1e-9) & (doubt < 1e-5))
    return {x for x, change in zip(s.py.REACTION_NAMES, doubt, strict=True) if change <= 1e-9}


@pytest.mark.one_in(5)
@pytest.mark.parametrize(("name", "kind"), KINDS)
def test_other_trees_give_the_same_motion(name: str, kind: str) -> None:
    """Energy, accelerations of all bodies, outputs, unique reactions, and which of them are unique."""
    s, other = system(name), twin(name, kind)
    assert other.derivation.assembled.freedoms == s.derivation.assembled.freedoms
    rng = np.random.default_rng(5)
    for _ in range(5):
        state = s.random(rng)
        there = carried(name, state, other)
        t = state.t
        rates = other.call("constraint_rates", there.q, there.v, out=[(other.nc,)], t=t)
        assert np.max(np.abs(rates)) < 1e-12 * (1 + np.max(np.abs(there.v)))
        assert error(other.energy(there.q, there.v, t), s.energy(state.q, state.v, t)) < 1e-9
        found, expected = other.named("outputs", *there, t=t), s.named("outputs", *state, t=t)
        assert error([found[x] for x in expected], list(expected.values())) < 1e-9
        found, expected = other.named("reactions", *there, t=t), s.named("reactions", *state, t=t)
        common, sure = found.keys() & expected.keys(), unique_reactions(s, state)
        assert sure & common == unique_reactions(other, there) & common
        assert len(sure & common) >= 6
        names = sorted(sure & common)
        assert error([found[x] for x in names], [expected[x] for x in names]) < 1e-9


# ---- the files

EMITTED = ("four_bar", "bicycle", "stewart_platform")
LIBM = {"sin", "cos", "sincos", "sqrt", "atan2", "fmax"}
CALLS = 20_000

HARNESS = """
#include <stdio.h>
#include "four_bar.h"

static unsigned long long state = 88172645463325252ULL;

static double draw(void)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) / 4503599627370496.0 - 1.0;
}

enum { N = FOUR_BAR_NV, C = FOUR_BAR_NC, I = FOUR_BAR_NI };

int main(void)
{
    const four_bar_parameters *p = &four_bar_default_parameters;
    const double start[FOUR_BAR_NQ] = {0.68, -0.06, 1.39};
    double q[N], v[N], u[FOUR_BAR_NU], s[I], w[I], q1[N], v1[N], a[N], lam[C], M[N * N], h[N];
    double J[C * N], gam[C], phi[FOUR_BAR_NP], T[N * I], c[N], Mr[I * I], hr[I], E[2], rates[C];
    double R[FOUR_BAR_NR] = {0}, X[FOUR_BAR_NX], y[FOUR_BAR_NY], P[FOUR_BAR_NE], sums[2], sum = 0.0;
    int closed = 0;
    for (int call = 0; call < CALLS; ++call) {
        double spread = call % 2 ? 0.3 : 3.0;
        for (int i = 0; i < N; ++i) q[i] = start[i] + spread * draw();
        for (int i = 0; i < N; ++i) v[i] = draw();
        for (int i = 0; i < FOUR_BAR_NU; ++i) u[i] = draw();
        for (int i = 0; i < I; ++i) s[i] = q[i] + draw();
        for (int i = 0; i < I; ++i) w[i] = draw();
        four_bar_constraints(p, q, phi);
        four_bar_constraint_jacobian(p, q, J);
        four_bar_constraint_rates(p, q, v, rates);
        four_bar_constraint_bias(p, q, v, gam);
        four_bar_constrained_equations(p, q, v, u, M, h, J, gam);
        four_bar_forward_dynamics(p, q, v, u, a, lam);
        if (four_bar_complete(p, q, s, w, q1, v1) == 0) sum += v1[0];
        if (four_bar_project(p, q, v, q1, v1) == 0
            && four_bar_forward_dynamics(p, q1, v1, u, a, lam) == 0) {
            ++closed;
            if (four_bar_reduction(p, q1, v1, T, c) == 0) sum += T[0];
            if (four_bar_reduced_equations(p, q1, v1, Mr, hr) == 0) sum += Mr[0];
            four_bar_reactions_at(p, q1, v1, a, lam, R);
            if (four_bar_reactions(p, q1, v1, u, R) == 0) sum += R[0];
            if (four_bar_outputs(p, q1, v1, u, y) == 0) sum += y[0];
            if (four_bar_power(p, q1, v1, u, P, sums) == 0) sum += P[0] + sums[0];
        }
        four_bar_across(p, q, v, X);
        four_bar_energy(p, q, v, E);
        sum += E[0] + X[0] + R[0];
    }
    printf("%d %g\\n", closed, sum);
    return 0;
}
"""


@pytest.mark.one_in(2)
@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("name", EMITTED)
def test_compiles_without_a_warning(name: str, compiler: str, tmp_path: Path) -> None:
    if not available(compiler):
        pytest.skip(f"{compiler} is not installed")
    files = render(read(name), languages=["c"])
    has_no_warnings(files, name, tmp_path, compiler, ("-O0" if name in BIG else "-O2",))


@pytest.mark.parametrize("name", EMITTED)
def test_needs_nothing_but_the_mathematics_library(name: str, tmp_path: Path) -> None:
    """No heap, no I/O, no globals that change: the object file's own symbols say so."""
    for file, text in render(read(name), languages=["c"]).items():
        (tmp_path / file).write_text(text)
    warnings = [w for w in WARNINGS if w != "-Werror"]
    optimize = "-O0" if name in BIG else "-O1"
    command = ["gcc", "-std=c99", optimize, "-Wvla", *warnings, "-c", f"{name}.c"]
    subprocess.run(command, cwd=tmp_path, check=True)
    table = subprocess.run(
        ["nm", f"{name}.o"], cwd=tmp_path, check=True, capture_output=True, text=True
    ).stdout
    rows = [line.split() for line in table.splitlines()]
    assert {row[-1] for row in rows if row[-2] == "U"} <= LIBM
    assert {row[-2] for row in rows} <= {"U", "T", "t", "R", "r", "D", "d"}
    writable = {row[-1] for row in rows if row[-2] in "Dd"}
    assert all(name.endswith("_names") for name in writable)


def test_sanitizers_find_nothing(tmp_path: Path) -> None:
    """2e4 rounds of all functions of a closed system, also far from where its loop closes."""
    for file, text in render(read("four_bar"), languages=["c"], functions=("power",)).items():
        (tmp_path / file).write_text(text)
    (tmp_path / "harness.c").write_text(HARNESS)
    command = ["gcc", "-std=c99", "-O1", "-g", "-fsanitize=address,undefined,float-cast-overflow"]
    command += ["-fno-sanitize-recover=all", "-Wall", "-Wextra", "-Werror", f"-DCALLS={CALLS}"]
    command += ["harness.c", "four_bar.c", "-lm", "-o", "harness"]
    subprocess.run(command, cwd=tmp_path, check=True)
    done = subprocess.run([str(tmp_path / "harness")], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    closed, total = done.stdout.split()
    assert int(closed) > CALLS // 2
    assert math.isfinite(float(total))
