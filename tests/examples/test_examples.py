"""The examples: every model file is read, emitted, compiled and run, and obeys published physics.

Formulas and numbers are copied from the sources named beside them, or are theorems of mechanics; none comes
from code of this project. Motions are computed with the emitted C functions and a Runge-Kutta method.
"""

from __future__ import annotations

import ctypes
import inspect
import math
import re
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.compiled import Compiled
from support.emitted import load

from linegraph.emission.emit import render
from linegraph.readers import modelfile

if TYPE_CHECKING:
    from collections.abc import Callable

    from support.compiled import Array

    import linegraph as lg

    Find = Callable[[str], "System"]

FOLDER = Path(__file__).parents[2] / "examples"
NAMES = (
    "moving_support_pendulum",
    "elastic_pendulum",
    "double_pendulum",
    "cart_pole",
    "furuta",
    "heavy_top",
    "gyroscope",
    "spherical_pendulum_chain",
    "crane",
    "quarter_car_3d",
    "ship_arm",
)
STATES = 20
EXACT = 1e-12
DRIFT = 1e-9


def text(name: str) -> bytes:
    return (FOLDER / name / f"{name}.toml").read_bytes()


@dataclass
class State:
    """What the functions of a system are given, by the names of their arguments."""

    p: dict[str, float]
    q: Array
    v: Array
    u: Array
    a: Array
    t: float = 0.0


@dataclass
class System:
    """A model emitted as Python and as compiled C.

    Attributes:
        module: the emitted Python.
        compiled: the emitted C.
    """

    module: Any
    compiled: Compiled
    _raw: dict[str, Any] = field(default_factory=dict)

    @cached_property
    def defaults(self) -> dict[str, float]:
        found = inspect.signature(self.module.Parameters).parameters
        return {name: entry.default for name, entry in found.items()}

    def arguments(self, function: str) -> list[str]:
        return list(inspect.signature(getattr(self.module, function)).parameters)

    def __call__(self, function: str, state: State) -> Any:
        """The value of an emitted Python function."""
        values = {**vars(state), "p": self.module.Parameters(**state.p)}
        given = [values[name] for name in self.arguments(function)]
        return getattr(self.module, function)(*given)

    def in_c(self, function: str, state: State, *shapes: tuple[int, ...]) -> Any:
        """The value of an emitted C function."""
        values = {**vars(state), "p": list(state.p.values())}
        given = [values[name] for name in self.arguments(function)]
        return self.compiled.call(function, *given, out=shapes)

    def random(self, rng: np.random.Generator, **parameters: float) -> State:
        """A state; parameters differ from their defaults by up to 20 %."""
        p = {name: value * rng.uniform(0.8, 1.2) for name, value in self.defaults.items()}
        nq, nv, nu = self.module.NQ, self.module.NV, self.module.NU
        q, v, u, a = (rng.uniform(-1.5, 1.5, n) for n in (nq, nv, nu, nv))
        for first, name in enumerate(self.module.Q_NAMES):
            if name.endswith("_qx"):
                q[first : first + 4] /= np.linalg.norm(q[first : first + 4])
        return State(p | parameters, q, v, u, a, float(rng.uniform(0, 3)))

    def start(self, q: Any, v: Any, **parameters: float) -> State:
        """A state without inputs, parameters as in the file unless given."""
        assert parameters.keys() <= self.defaults.keys()
        nv, nu = self.module.NV, self.module.NU
        p = self.defaults | parameters
        return State(p, np.array(q, float), np.array(v, float), np.zeros(nu), np.zeros(nv))

    def run(self, state: State, until: float, steps: int) -> State:
        """The state at a later time: Runge and Kutta's method of fourth order, in equal steps."""
        h = (until - state.t) / steps
        now = State(dict(state.p), state.q.copy(), state.v.copy(), state.u, state.a, state.t)
        rates = self._bind("coordinate_rates", now, self.module.NQ)
        forward = self._bind("forward_dynamics", now, self.module.NV)
        nq = self.module.NQ

        def slope(t: float, y: Array) -> Array:
            now.q[:], now.v[:] = y[:nq], y[nq:]
            return np.concatenate((rates(t), forward(t)))

        y = np.concatenate((state.q, state.v))
        for i in range(steps):
            t = state.t + i * h
            k1 = slope(t, y)
            k2 = slope(t + h / 2, y + h / 2 * k1)
            k3 = slope(t + h / 2, y + h / 2 * k2)
            k4 = slope(t + h, y + h * k3)
            y = y + h / 6 * (k1 + 2 * (k2 + k3) + k4)
        return State(state.p, y[:nq], y[nq:], state.u, state.a, until)

    def _bind(self, function: str, state: State, size: int) -> Callable[[float], Array]:
        """A C function that reads the arrays of `state` as they are when it is called."""
        out = np.empty(size)
        emitted = self.compiled.library[f"{self.compiled.name}_{function}"]
        header = self.compiled.header
        can_fail = re.search(rf"^int {self.compiled.name}_{function}\(", header, re.M) is not None
        emitted.restype = ctypes.c_int if can_fail else None
        arrays = {**vars(state), "p": np.array(list(state.p.values()))}
        names = self.arguments(function)
        pointers = {n: ctypes.c_void_p(arrays[n].ctypes.data) for n in names if n != "t"}
        result = ctypes.c_void_p(out.ctypes.data)

        def call(t: float) -> Array:
            given = [ctypes.c_double(t) if n == "t" else pointers[n] for n in names]
            assert not emitted(*given, result), f"{function} fails"
            assert arrays  # the pointers are into these
            return out

        return call


def build(model: lg.Model, folder: Path) -> System:
    """Emit a model and compile it."""
    files = render(model)
    assert set(files) == {f"{model.name}.{ending}" for ending in ("h", "c", "py")}
    module = load(files, model.name, folder)
    return System(module, Compiled(files, model.name, folder))


@pytest.fixture(scope="module")
def find(tmp_path_factory: pytest.TempPathFactory) -> Find:
    """An example by its name, emitted and compiled once."""
    found: dict[str, System] = {}

    def example(name: str) -> System:
        if name not in found:
            model = modelfile.read(FOLDER / name / f"{name}.toml")
            found[name] = build(model, tmp_path_factory.mktemp(name))
        return found[name]

    return example


def close(found: Any, expected: Any, tolerance: float = EXACT) -> None:
    """Equal, compared with 1 + the largest entry."""
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape
    error = np.max(np.abs(found - expected), initial=0.0)
    assert error <= tolerance * (1 + np.max(np.abs(expected), initial=0.0))


def states(system: System, **parameters: float) -> list[State]:
    rng = np.random.default_rng(7)
    return [system.random(rng, **parameters) for _ in range(STATES)]


# ---- all of them


CLOSED = (
    *("andrews_squeezer", "bicycle", "bricard", "car_axis", "crane_hoist"),
    *("four_bar", "parallelograms", "rolling_disc", "slider_crank", "stewart_platform"),
)
"""Systems with constraints: `test_closed_examples` compares them."""


NETWORKS = (
    *("arm_with_drives", "cart_pole_motor", "cauer_filter", "condenser_microphone"),
    *("electro_hydraulic_servo", "excavator_arm", "loudspeaker", "magnetic_levitation"),
    *("motor_warming_up", "quarter_car_1d", "ring_modulator", "rlc_ladder", "synchronous_machine"),
)
"""Scalar networks: `test_network_examples` and `test_mechatronic_examples` compare them."""


def test_every_example_is_here() -> None:
    folders = {path.name for path in FOLDER.iterdir() if list(path.glob("*.toml"))}
    assert folders == {*NAMES, *CLOSED, *NETWORKS}


@pytest.mark.parametrize("name", [*NAMES, *CLOSED, *NETWORKS])
def test_readme_says_what_it_is_and_how_it_is_used(name: str) -> None:
    readme = (FOLDER / name / "README.md").read_text(encoding="utf-8")
    path = f"examples/{name}/{name}.toml"
    assert f"linegraph show {path}" in readme
    assert f"linegraph emit {path} --out build/{name}" in readme


@pytest.mark.parametrize("name", NAMES)
def test_c_and_python_agree(name: str, find: Find) -> None:
    system = find(name)
    nq, nv = system.module.NQ, system.module.NV
    shapes: dict[str, list[tuple[int, ...]]] = {
        "mass_matrix": [(nv, nv)],
        "bias": [(nv,)],
        "equations": [(nv, nv), (nv,)],
        "inverse_dynamics": [(nv,)],
        "forward_dynamics": [(nv,)],
        "coordinate_rates": [(nq,)],
        "energy": [(2,)],
    }
    for state in states(system)[:5]:
        for function, shape in shapes.items():
            both = system.in_c(function, state, *shape), system(function, state)
            several = len(shape) > 1
            for one, other in zip(*(x if several else (x,) for x in both), strict=True):
                close(one, other, 1e-13)


@pytest.mark.parametrize("name", NAMES)
def test_what_is_emitted_is_consistent(name: str, find: Find) -> None:
    """M is symmetric and positive definite, and inverse dynamics are M a + h."""
    system = find(name)
    for state in states(system):
        mass, bias = system("equations", state)
        close(mass, mass.T)
        assert np.linalg.eigvalsh(mass)[0] > 0
        close(system("inverse_dynamics", state), mass @ state.a + bias)


# ---- energy


def quiet(system: System, **parameters: float) -> State:
    """A random state in lively motion without effort."""
    state = system.random(np.random.default_rng(3), **parameters)
    state.v *= 3
    state.p = system.defaults | parameters
    state.u[:] = 0
    state.t = 0.0
    return state


CONSERVATIVE: dict[str, dict[str, float]] = {
    "moving_support_pendulum": {"a": 0, "b": 0},
    "elastic_pendulum": {},
    "double_pendulum": {},
    "cart_pole": {},
    "furuta": {"d_shaft": 0, "d_hinge": 0},
    "heavy_top": {},
    "gyroscope": {"W": 0},
    "spherical_pendulum_chain": {},
    "crane": {},
    "quarter_car_3d": {"b_s": 0, "b_t": 0},
    "ship_arm": {"d": 0},
}
"""Parameters without which nothing moves or brakes a system from outside."""


@pytest.mark.parametrize("name", NAMES)
def test_energy_is_conserved(name: str, find: Find) -> None:
    system = find(name)
    before = quiet(system, **CONSERVATIVE[name])
    if name == "quarter_car_3d":
        before.q[:] = 0.3, 0.55  # no deeper than the tyre lets it
    if name == "crane":
        before.q[:] = 1.0, 2.0, 0.4, 0.2
    first = system("energy", before)
    last = system("energy", system.run(before, 1.0, 8000))
    assert abs(last.sum() - first.sum()) <= DRIFT * np.max(np.abs((*first, *last)))


def power(system: System, state: State) -> float:
    """The rate of the energy, by central differences of fourth order along the motion."""
    h = 1e-3
    total = {}
    for k in (-2, -1, 1, 2):
        there = system.run(state, state.t + k * h, 8)
        total[k] = system("energy", there).sum()
    return float((8 * (total[1] - total[-1]) - (total[2] - total[-2])) / (12 * h))


def test_dampers_take_what_they_should(find: Find) -> None:
    furuta = find("furuta")
    state = quiet(furuta)
    expected = -(state.p["d_shaft"] * state.v[0] ** 2 + state.p["d_hinge"] * state.v[1] ** 2)
    assert power(furuta, state) == pytest.approx(expected, rel=1e-6)
    ship = find("ship_arm")
    state = quiet(ship)
    assert power(ship, state) == pytest.approx(-state.p["d"] * state.v @ state.v, rel=1e-6)


# ---- pendulum on a moving support


def test_moving_support(find: Find) -> None:
    """(J + m l²) θ̈ + m g l sin θ + m l (cos θ Ẍ + sin θ Z̈) = 0, by Lagrange's equations.

    With J = 0: Landau & Lifshitz, Mechanics, § 5, problem 3.
    """
    system = find("moving_support_pendulum")
    for s in states(system):
        g, m, c, J, a, b, w = (s.p[n] for n in ("g", "m", "l", "J", "a", "b", "w"))
        (angle,) = s.q
        x = -a * w * w * math.sin(w * s.t)
        z = -b * w * w * math.cos(w * s.t)
        right = -m * g * c * math.sin(angle)
        right -= m * c * (math.cos(angle) * x + math.sin(angle) * z)
        close(system("forward_dynamics", s), [right / (J + m * c * c)])


PERIOD = 2.3678419475762373
"""Of a pendulum of 1 m released from the horizontal at g = 9.81 (IFToMM benchmark A01): 4 K(1/√2) √(l/g)."""


def test_simple_pendulum_has_its_exact_period(find: Find) -> None:
    system = find("moving_support_pendulum")
    simple = {"m": 1.0, "l": 1.0, "g": 9.81, "J": 0.0, "a": 0.0, "b": 0.0}
    mean: tuple[float, float] = 1.0, math.sqrt(0.5)
    for _ in range(6):  # the arithmetic-geometric mean, which gives the elliptic integral
        mean = (mean[0] + mean[1]) / 2, math.sqrt(mean[0] * mean[1])
    assert pytest.approx(2 * math.pi / mean[0] / math.sqrt(9.81), rel=1e-14) == PERIOD
    released = system.start([-math.pi / 2], [0], **simple)
    quarter = system.run(released, PERIOD / 4, 1000)
    assert quarter.q[0] == pytest.approx(0, abs=1e-11)
    assert quarter.v[0] == pytest.approx(math.sqrt(2 * 9.81), rel=1e-11)
    back = system.run(quarter, PERIOD, 3000)
    close([*back.q, *back.v], [-math.pi / 2, 0], 1e-10)


def test_a_fast_shaken_pendulum_stands(find: Find) -> None:
    """Upright is stable where b² w² > 2 g l, l the reduced length (Landau & Lifshitz, Mechanics, § 30)."""
    system = find("moving_support_pendulum")
    p = system.defaults
    length = p["l"] + p["J"] / (p["m"] * p["l"])
    critical = math.sqrt(2 * p["g"] * length) / p["b"]
    leaning = math.pi - 0.1
    for w, stands in ((1.5 * critical, True), (0.7 * critical, False)):
        state = system.start([leaning], [0], a=0, w=w)
        farthest = 0.0
        for end in np.arange(0.05, 4, 0.05):
            state = system.run(state, float(end), 60)
            farthest = max(farthest, abs(math.pi - state.q[0]))
        assert (farthest < 0.3) == stands


# ---- elastic pendulum


def test_elastic_pendulum(find: Find) -> None:
    """In every upright plane, by Lagrange's equations in polar coordinates.

    m r̈ = m r φ̇² + m g cos φ − k (r − r₀) and r φ̈ + 2 ṙ φ̇ + g sin φ = 0.
    """
    system = find("elastic_pendulum")
    rng = np.random.default_rng(5)
    for s in states(system):
        g, m, k, r0, height = (s.p[n] for n in ("g", "m", "k", "r0", "height"))
        r, phi, azimuth = rng.uniform(0.3, 1.5), rng.uniform(-3, 3), rng.uniform(-3, 3)
        dr, dphi = rng.uniform(-1, 1, 2)
        ddr = r * dphi**2 + g * math.cos(phi) - k / m * (r - r0)
        ddphi = -(2 * dr * dphi + g * math.sin(phi)) / r
        away = np.array([math.cos(azimuth), math.sin(azimuth), 0])
        up = np.array([0, 0, 1])
        along = math.sin(phi) * away - math.cos(phi) * up
        across = math.cos(phi) * away + math.sin(phi) * up
        s.q = height * up + r * along
        s.v = dr * along + r * dphi * across
        expected = (ddr - r * dphi**2) * along + (r * ddphi + 2 * dr * dphi) * across
        close(system("forward_dynamics", s), expected)


# ---- double pendulum, cart-pole, Furuta pendulum


def test_double_pendulum(find: Find) -> None:
    """The closed form in relative angles, as in textbooks of robotics for the planar arm of two links."""
    system = find("double_pendulum")
    for s in states(system):
        names = ("g", "m1", "m2", "l1", "c1", "c2", "I1", "I2")
        g, m1, m2, l1, c1, c2, i1, i2 = (s.p[n] for n in names)
        (a, b), (da, db) = s.q, s.v
        m12 = i2 + m2 * c2**2 + m2 * l1 * c2 * math.cos(b)
        m22 = i2 + m2 * c2**2
        m11 = i1 + i2 + m1 * c1**2 + m2 * (l1**2 + c2**2 + 2 * l1 * c2 * math.cos(b))
        h = m2 * l1 * c2 * math.sin(b)
        lower = g * m2 * c2 * math.sin(a + b)
        upper = g * (m1 * c1 + m2 * l1) * math.sin(a)
        mass, bias = system("equations", s)
        close(mass, [[m11, m12], [m12, m22]])
        close(bias, [-h * (2 * da * db + db**2) + upper + lower, h * da**2 + lower])


def test_cart_pole(find: Find) -> None:
    """(M + m) ẍ + m l cos p p̈ − m l sin p ṗ² = F and (J + m l²) p̈ + m l cos p ẍ + m g l sin p = 0."""
    system = find("cart_pole")
    for s in states(system):
        g, M, m, c = (s.p[n] for n in ("g", "m_cart", "m_pole", "l"))
        J = m * c * c / 3
        (_, p), (_, dp) = s.q, s.v
        mass, bias = system("equations", s)
        close(mass, [[M + m, m * c * math.cos(p)], [m * c * math.cos(p), J + m * c * c]])
        close(bias, [-m * c * math.sin(p) * dp**2, m * g * c * math.sin(p)])
        close(mass @ system("forward_dynamics", s) + bias, [s.u[0], 0])


def test_furuta(find: Find) -> None:
    """Full inertias, the pendulum's the same in all directions across it; by Lagrange's equations.

    The system of Cazzolato & Prime, On the Dynamics of the Furuta Pendulum (2011).
    """
    system = find("furuta")
    for s in states(system):
        names = ("g", "L", "m_arm", "c_arm", "m", "l", "J_axial", "J_transverse")
        g, L, m_arm, c_arm, m, c, axial, transverse = (s.p[n] for n in names)
        (_, al), (dth, dal) = s.q, s.v
        sin, cos = math.sin(al), math.cos(al)
        shaft = 2e-3 + m_arm * c_arm**2
        outer = transverse + m * c * c
        m11 = shaft + m * L * L + outer * sin**2 + axial * cos**2
        m12 = m * L * c * cos
        double = (outer - axial) * math.sin(2 * al)
        mass, bias = system("equations", s)
        close(mass, [[m11, m12], [m12, outer]])
        row1 = double * dal * dth - m * L * c * sin * dal**2 + s.p["d_shaft"] * dth
        row2 = -double / 2 * dth**2 + m * g * c * sin + s.p["d_hinge"] * dal
        close(bias, [row1, row2])
        close(mass @ system("forward_dynamics", s) + bias, [s.u[0], 0])


# ---- heavy top

QUATERNIONS = {
    0.02: (0.070614, 0.045708, 0.99644, -0.0063419),
    0.2: (-0.70828, 0.43878, 0.54573, 0.0894),
}
"""Time and (w, x, y, z): Géradin & Cardona's heavy top as verified with Exudyn, model heavyTop."""


def test_heavy_top_reaches_the_published_orientations(find: Find) -> None:
    top = find("heavy_top")
    state = top.start([0, 0, 0, 1], [0, 150, -4.61538])
    for t, expected in QUATERNIONS.items():
        state = top.run(state, t, round((t - state.t) / 1e-4))
        x, y, z, w = state.q
        np.testing.assert_allclose([w, x, y, z], expected, rtol=0, atol=2e-5)


def axes(q: Array) -> Array:
    """The rotation matrix of a quaternion (x, y, z, w): columns are the head's axes."""
    vector, w = q[:3], q[3]
    x, y, z = vector
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    rotation: Array = np.eye(3) + 2 * w * skew + 2 * skew @ skew
    return rotation


def test_heavy_top_in_steady_precession(find: Find) -> None:
    """A Ω² cos θ − C n Ω + m g s = 0, the textbook's condition: A about the fixed point, n axial."""
    top = find("heavy_top")
    p = top.defaults
    theta, rate = 1.1, 0.8
    across = p["A"] + p["m"] * p["s"] ** 2
    n = (across * rate**2 * math.cos(theta) + p["m"] * p["g"] * p["s"]) / (p["C"] * rate)
    # the axis y leans by theta from z, towards -y of ground
    half = (math.pi / 2 + theta) / 2
    q = np.array([math.sin(half), 0, 0, math.cos(half)])
    along = axes(q)[:, 1]
    assert along[2] == pytest.approx(math.cos(theta))
    spin = (n - rate * math.cos(theta)) * along + np.array([0, 0, rate])
    end = top.run(top.start(q, axes(q).T @ spin), 0.5, 30000)
    c, s = math.cos(rate * 0.5), math.sin(rate * 0.5)
    turned = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    close(axes(end.q)[:, 1], turned @ along, 1e-8)


# ---- gyroscope


def turn(axis: Array, angle: float) -> Array:
    """Rodrigues' rotation."""
    x, y, z = axis / np.linalg.norm(axis)
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    rotation: Array = np.eye(3) + math.sin(angle) * skew + (1 - math.cos(angle)) * skew @ skew
    return rotation


X, Y, Z = np.eye(3)


def rotor(p: dict[str, float], state: State) -> tuple[Array, Array]:
    """The rotor's axis and its angular momentum, in ground axes."""
    table = turn(Z, p["W"] * state.t)
    ring = table @ turn(X, state.q[0])
    housing = ring @ turn(Y, state.q[1])
    omega = p["W"] * Z + state.v[0] * table[:, 0] + state.v[1] * ring[:, 1]
    axis = housing[:, 2]
    omega = omega + state.v[2] * axis
    return axis, p["A"] * omega + (p["C"] - p["A"]) * (omega @ axis) * axis


def test_a_gyroscope_does_not_feel_the_table(find: Find) -> None:
    """With massless rings L is constant, and the axis turns about it at |L| / A (Euler, Poinsot)."""
    system = find("gyroscope")
    state = system.start([0.2, -0.3, 0], [0.5, 0.4, 40], Hx=0, Hy=0, Hz=0)
    axis, momentum = rotor(state.p, state)
    end = system.run(state, 1.0, 4000)
    later, same = rotor(state.p, end)
    close(same, momentum, 1e-9)
    close(later, turn(momentum, float(np.linalg.norm(momentum)) / state.p["A"]) @ axis, 1e-7)


def test_a_gyroscope_nutates_at_the_published_rate(find: Find) -> None:
    """H / √(A B), with A and B the inertia about the two axes of suspension (Magnus, Kreisel, 1971)."""
    system = find("gyroscope")
    p = system.defaults
    spin, small = 300.0, 1e-7
    rates = []
    for k in (0, 1):
        v = [small * (k == 0), small * (k == 1), spin]
        rates.append(system("forward_dynamics", system.start([0, 0, 0], v, W=0))[1 - k] / small)
    A, B = p["A"] + p["Hx"], p["A"] + p["Hy"]
    nutation = p["C"] * spin / math.sqrt(A * B)
    assert math.sqrt(-rates[0] * rates[1]) == pytest.approx(nutation, rel=1e-9)


# ---- chain of spherical pendulums

LAGUERRE = (0.415774556783479, 2.294280360279042, 6.289945082937479)
"""Zeros of the Laguerre polynomial L₃ (Abramowitz & Stegun, table 25.9)."""


def test_small_swings_of_the_chain(find: Find) -> None:
    """For n equal particles on equal strings ω² = g/l times the zeros of Lₙ, in each of two directions."""
    system = find("spherical_pendulum_chain")
    step = 1e-4

    def accelerations(angles: Array) -> Array:
        q = [x for a in angles.reshape(3, 3) for x in (*np.sin(a / 2), math.cos(np.sum(a) / 2))]
        return np.asarray(system("forward_dynamics", system.start(q, np.zeros(9), J=0)))

    columns = [(accelerations(d) - accelerations(-d)) / (2 * step) for d in step * np.eye(9)]
    squares = np.sort(np.linalg.eigvals(-np.array(columns).T).real)
    unit = system.defaults["g"] / system.defaults["l"]
    expected = [0, 0, 0, *(unit * x for x in LAGUERRE for _ in "xy")]
    np.testing.assert_allclose(squares, expected, rtol=0, atol=2e-6 * unit)


def test_the_chain_keeps_its_angular_momentum_about_the_vertical(find: Find) -> None:
    system = find("spherical_pendulum_chain")

    def momentum(state: State) -> float:
        turning = np.concatenate((axes(state.q[:4])[2], np.zeros(6)))  # all as one, about z
        return float(turning @ system("mass_matrix", state) @ state.v)

    state = quiet(system)
    end = system.run(state, 1.0, 20000)
    assert momentum(end) == pytest.approx(momentum(state), rel=1e-9)


# ---- crane


def test_crane_in_the_plane_of_the_rail(find: Find) -> None:
    """The planar crane with hoisting, by Lagrange's equations, and J φ̈ of the drum.

    (M + m) ẍ + m (l̈ sin θ + 2 l̇ θ̇ cos θ + l θ̈ cos θ − l θ̇² sin θ) = F
    l θ̈ + 2 l̇ θ̇ + ẍ cos θ + g sin θ = 0 and m (l̈ + ẍ sin θ − l θ̇² − g cos θ) = pull
    The system of Lee, Modeling and Control of a Three-Dimensional Overhead Crane (1998).
    """
    system = find("crane")
    for s in states(system):
        names = ("g", "m_trolley", "m_load", "J_drum", "r_drum", "l0")
        g, M, m, J, r, l0 = (s.p[n] for n in names)
        s.q[3] = s.v[3] = 0
        rope, rate = l0 + r * s.q[1], r * s.v[1]
        sin, cos, dth = math.sin(s.q[2]), math.cos(s.q[2]), s.v[2]
        s.u *= 1000
        ddx, dd_drum, ddth, aside = system("forward_dynamics", s)
        hoist = r * dd_drum
        pull = m * (hoist + ddx * sin - rope * dth**2 - g * cos)
        trolley = (M + m) * ddx + m * (hoist * sin + 2 * rate * dth * cos)
        trolley += m * rope * (ddth * cos - dth**2 * sin)
        close([trolley, J * dd_drum + r * pull], s.u)
        close(rope * ddth + 2 * rate * dth + ddx * cos + g * sin, 0.0)
        close(aside, 0.0)


def test_crane_across_the_rail(find: Find) -> None:
    """A load that swings across the rail does not push the trolley: l φ̈ + 2 l̇ φ̇ + g sin φ = 0."""
    system = find("crane")
    for s in states(system):
        s.q[2] = s.v[2] = s.u[0] = 0
        rope, rate = s.p["l0"] + s.p["r_drum"] * s.q[1], s.p["r_drum"] * s.v[1]
        ddx, _, ddth, ddphi = system("forward_dynamics", s)
        close([ddx, ddth], [0, 0])
        close(rope * ddphi + 2 * rate * s.v[3] + s.p["g"] * math.sin(s.q[3]), 0.0)


# ---- quarter car


def test_quarter_car_with_an_upright_strut(find: Find) -> None:
    """The quarter car of StateMint's examples: the rows of its matrices for v_B and v_W.

    States v_B, v_W, F_s, F_t and input v_road; gravity, which it leaves out, is added.
    """
    system = find("quarter_car_3d")
    for s in states(system, camber=0.0, caster=0.0):
        p = s.p
        mB, mW, ks, bs, kt, bt = (p[n] for n in ("m_B", "m_W", "k_s", "b_s", "k_t", "b_t"))
        A = np.array(
            [
                [-bs / mB, bs / mB, 1 / mB, 0],
                [bs / mW, -(bs + bt) / mW, -1 / mW, 1 / mW],
            ]
        )
        s.u[0] = -5.0  # the road stays below the wheel
        body, strut = s.q
        wheel, rate = body + p["height"] - strut, s.v[0] - s.v[1]
        forces = ks * (p["length"] - strut), kt * (p["radius"] - (wheel - s.u[0]))
        expected = A @ [s.v[0], rate, *forces] + [0, bt / mW * s.u[1]] - p["g"]
        dd_body, dd_strut = system("forward_dynamics", s)
        close([dd_body, dd_body - dd_strut], expected)


def test_quarter_car_with_an_inclined_strut(find: Find) -> None:
    """Kinetic energy of chassis and wheel from their velocities, the strut turned by camber and caster."""
    system = find("quarter_car_3d")
    for s in states(system):
        down = -turn(Y, s.p["caster"]) @ turn(X, s.p["camber"]) @ Z
        wheel = s.v[0] * Z + s.v[1] * down
        kinetic = (s.p["m_B"] * s.v[0] ** 2 + s.p["m_W"] * wheel @ wheel) / 2
        mass = system("mass_matrix", s)
        close(system("energy", s)[0], kinetic)
        close(s.v @ mass @ s.v / 2, kinetic)
        at = s.q[0] * Z + s.p["height"] * Z + s.q[1] * down
        tyre = np.linalg.norm(at - s.u[0] * Z) - s.p["radius"]
        stored = s.p["k_t"] * tyre**2 + s.p["k_s"] * (s.q[1] - s.p["length"]) ** 2
        weight = s.p["g"] * (s.p["m_B"] * s.q[0] + s.p["m_W"] * at[2])
        close(system("energy", s)[1], stored / 2 + weight)


# ---- arm on a ship

SIX = """
[body.surged]
[body.swayed]
[body.heaved]
[body.yawed]
[body.pitched]
[body.ship]
[prismatic.surge]
between = ["ground", "surged"]
axis = [1, 0, 0]
[prismatic.sway]
between = ["surged", "swayed"]
axis = [0, 1, 0]
[prismatic.heave]
between = ["swayed", "heaved"]
axis = [0, 0, 1]
[revolute.yaw]
between = ["heaved", "yawed"]
axis = [0, 0, 1]
[revolute.pitch]
between = ["yawed", "pitched"]
axis = [0, 1, 0]
[revolute.roll]
between = ["pitched", "ship"]
axis = [1, 0, 0]
"""
"""Six ordinary joints in place of the basement."""


def test_a_prescribed_ship_is_like_one_that_is_held(find: Find, tmp_path: Path) -> None:
    """The arm's torques are those of the same arm on six ordinary joints that move as prescribed."""
    given = text("ship_arm").decode()
    basement = '[basement]\nposition = "input"\nrotation = "input"\n'
    assert given.count(basement) == 1
    free = given.replace(basement, SIX).replace('"basement"', '"ship"')
    free = free.replace('name = "ship_arm"', 'name = "free_ship"')
    held = build(modelfile.parse(free.encode(), "free_ship.toml"), tmp_path)
    system = find("ship_arm")
    assert held.module.V_NAMES[6:] == system.module.V_NAMES == ("slew", "luff", "fold")
    for s in states(system):
        moved = s.u[3:].reshape(6, 3)
        whole = State(
            s.p,
            np.concatenate((moved[:, 0], s.q)),
            np.concatenate((moved[:, 1], s.v)),
            np.zeros(9),
            np.concatenate((moved[:, 2], s.a)),
        )
        torques = held("inverse_dynamics", whole)[6:]
        close(system("inverse_dynamics", s), torques)
        close(system("mass_matrix", s), held("mass_matrix", whole)[6:, 6:])
        s.u[:3] = torques
        close(system("forward_dynamics", s), s.a)
