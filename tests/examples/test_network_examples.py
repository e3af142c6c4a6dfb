"""The examples of scalar networks: what is emitted against the physics, stated apart from it.

Expected equations are those of textbooks, of data sheets and of the test sets named beside them, written for
each system by itself. States, inputs and parameters are random.
"""

from __future__ import annotations

import cmath
import ctypes
import inspect
import math
import re
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from scipy.integrate import odeint, solve_ivp
from scipy.optimize import brentq, minimize_scalar
from support.compiled import Compiled
from support.emitted import load

import linegraph as lg
from linegraph.emission.emit import render
from linegraph.readers import modelfile

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    Array = np.ndarray
    Find = Callable[[str], "System"]

FOLDER = Path(__file__).parents[2] / "examples"
NAMES = (
    *("rlc_ladder", "cauer_filter", "ring_modulator", "quarter_car_1d", "loudspeaker"),
    *("electro_hydraulic_servo", "motor_warming_up", "synchronous_machine"),
)
STATES = 20
EXACT = 1e-12


@dataclass
class System:
    """A network emitted as Python; where it is asked for, also as compiled C.

    Attributes:
        files: what was emitted, by name.
        module: the emitted Python.
        folder: where the C is compiled.
    """

    files: Mapping[str, str]
    module: Any
    folder: Path

    @cached_property
    def compiled(self) -> Compiled:
        return Compiled(self.files, self.module.__name__, self.folder, flags=("-O2",))

    @cached_property
    def defaults(self) -> dict[str, float]:
        found = inspect.signature(self.module.Parameters).parameters
        return {name: entry.default for name, entry in found.items()}

    @cached_property
    def states(self) -> tuple[str, ...]:
        return tuple(self.module.STATE_NAMES)

    def arguments(self, function: str) -> list[str]:
        return list(inspect.signature(getattr(self.module, function)).parameters)

    def call(
        self, function: str, p: Mapping[str, float], x: Any, u: Any = (), t: float = 0.0
    ) -> Array:
        """The value of an emitted function: of x, or of q and v, whichever it takes."""
        values = {"p": self.module.Parameters(**p), "x": x, "q": [], "v": x, "u": u, "t": t}
        given = [values[name] for name in self.arguments(function)]
        return np.asarray(getattr(self.module, function)(*given))

    def in_c(
        self, function: str, size: int, p: Mapping[str, float], x: Any, u: Any, t: float
    ) -> Array:
        """The value of an emitted C function."""
        values = {"p": list(p.values()), "x": x, "q": [], "v": x, "u": u, "t": t}
        given = [values[name] for name in self.arguments(function)]
        return np.asarray(self.compiled.call(function, *given, out=[(size,)]))

    def by_name(self, function: str, names: str, *given: Any) -> dict[str, float]:
        """The values of an emitted function by what the emitted lists call them."""
        found = self.call(function, *given)
        return dict(zip(getattr(self.module, names), found.tolist(), strict=True))

    def outputs(self, *given: Any) -> dict[str, float]:
        return self.by_name("outputs", "OUTPUT_NAMES", *given)

    def random_parameters(self, rng: np.random.Generator) -> dict[str, float]:
        """Each differs from its default by up to 20 %."""
        return {name: value * rng.uniform(0.8, 1.2) for name, value in self.defaults.items()}

    def linear(self, p: Mapping[str, float], function: str = "rhs") -> tuple[Array, Array]:
        """The matrices of states and inputs of a linear network: the answers to unit vectors."""
        nx, nu = len(self.states), self.module.NU
        x = [self.call(function, p, row, np.zeros(nu)) for row in np.eye(nx)]
        u = [self.call(function, p, np.zeros(nx), row) for row in np.eye(nu)]
        return np.array(x).T, np.array(u).T

    def response(self, p: Mapping[str, float], output: str, s: complex) -> complex:
        """The transfer function of a linear network's only input to one of its outputs."""
        A, B = self.linear(p)
        C, D = self.linear(p, "outputs")
        k = self.module.OUTPUT_NAMES.index(output)
        return complex(C[k] @ np.linalg.solve(s * np.eye(len(A)) - A, B[:, 0]) + D[k, 0])

    def power(self, p: Mapping[str, float], x: Array, u: Array) -> float:
        """The rate of the stored energy along the motion, by central differences of fourth order."""
        rate = self.call("rhs", p, x, u)
        h = 1e-3 / (1 + np.max(np.abs(rate) / (1 + np.abs(x))))
        there = {k: self.call("energy", p, x + k * h * rate).sum() for k in (-2, -1, 1, 2)}
        return float((8 * (there[1] - there[-1]) - (there[2] - there[-2])) / (12 * h))


def build(model: lg.Model, folder: Path) -> System:
    files = render(model)
    return System(files, load(files, model.name, folder), folder)


def text(name: str) -> str:
    return (FOLDER / name / f"{name}.toml").read_text(encoding="utf-8")


def of_text(given: str, folder: Path) -> lg.Model:
    path = folder / "model.toml"
    path.write_text(given, encoding="utf-8")
    return modelfile.read(path)


@pytest.fixture(scope="module")
def find(tmp_path_factory: pytest.TempPathFactory) -> Find:
    """An example by its name, emitted once."""
    found: dict[str, System] = {}

    def example(name: str) -> System:
        if name not in found:
            model = modelfile.read(FOLDER / name / f"{name}.toml")
            found[name] = build(model, tmp_path_factory.mktemp(name))
        return found[name]

    return example


def error(found: Any, expected: Any, scale: Any = None) -> float:
    """The largest difference of an entry, relative to it, or to `scale`."""
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape
    size = np.abs(expected) if scale is None else np.asarray(scale)
    return float(np.max(np.abs(found - expected) / np.where(size == 0, 1, size), initial=0.0))


def rows(found: Array, expected: Array) -> float:
    """The largest difference of matrices, each row relative to its largest entry."""
    return error(found, expected, np.max(np.abs(expected), axis=1, keepdims=True))


# ---- all of them


@pytest.mark.parametrize("name", NAMES)
def test_c_and_python_agree(name: str, find: Find) -> None:
    system, rng = find(name), np.random.default_rng(1)
    sizes = {"rhs": len(system.states), "energy": 3, "outputs": system.module.NY}
    for _ in range(5):
        p = system.random_parameters(rng)
        x = rng.uniform(-0.3, 0.3, len(system.states))
        u = rng.uniform(-0.3, 0.3, system.module.NU)
        for function, size in sizes.items():
            python = system.call(function, p, x, u, 1e-4)
            assert error(system.in_c(function, size, p, x, u, 1e-4), python) <= 1e-10


@pytest.mark.parametrize("name", NAMES)
def test_orientation_does_not_matter(name: str, find: Find, tmp_path: Path) -> None:
    """An edge turned around turns its own variables around and nothing else."""
    system, rng = find(name), np.random.default_rng(2)
    turned = "resistor|conductance|pipe|translational_damper|rotational_damper|conduction"
    swapped, count = re.subn(
        rf'(\[(?:{turned})\.\w+\]\nbetween = )\["(.+)", "(.+)"\]', r'\1["\3", "\2"]', text(name)
    )
    assert count
    other = build(of_text(swapped, tmp_path), tmp_path)
    assert other.states == system.states
    x = rng.uniform(-0.3, 0.3, len(system.states))
    u = rng.uniform(-0.3, 0.3, system.module.NU)
    expected = system.call("rhs", system.defaults, x, u, 1e-4)
    assert error(other.call("rhs", system.defaults, x, u, 1e-4), expected) <= 1e-9


# ---- a ladder of R, L, C


def ladder(p: Mapping[str, float], s: complex) -> tuple[complex, complex]:
    """Voltage at the load and current of the generator for one volt, by chain matrices.

    Of each section that of a series impedance times that of a shunt admittance.
    """
    impedance = p["section"] * (p["r"] + s * p["l"])
    admittance = p["section"] * (p["g"] + s * p["c"])
    series = np.array([[1, impedance], [0, 1]])
    shunt = np.array([[1, 0], [admittance, 1]])
    whole = np.array([[1, p["R_s"]], [0, 1]])
    for _ in range(3):
        whole = whole @ series @ shunt
    (a, b), (c, d) = whole
    load = 1 / (a + b / p["R_l"])
    return load, load * (c + d / p["R_l"])


def test_ladder(find: Find) -> None:
    system, rng = find("rlc_ladder"), np.random.default_rng(3)
    assert system.states == ("i_L1", "v_C1", "i_L2", "v_C2", "i_L3", "v_C3")
    for _ in range(STATES):
        p = system.random_parameters(rng)
        R, L, C, G = (p["section"] * p[name] for name in ("r", "l", "c", "g"))
        end = G + 1 / p["R_l"]
        expected = np.array(
            [
                [-(R + p["R_s"]) / L, -1 / L, 0, 0, 0, 0],
                [1 / C, -G / C, -1 / C, 0, 0, 0],
                [0, 1 / L, -R / L, -1 / L, 0, 0],
                [0, 0, 1 / C, -G / C, -1 / C, 0],
                [0, 0, 0, 1 / L, -R / L, -1 / L],
                [0, 0, 0, 0, 1 / C, -end / C],
            ]
        )
        A, B = system.linear(p)
        assert rows(A, expected) <= EXACT
        assert error(B[:, 0], [1 / L, 0, 0, 0, 0, 0]) <= EXACT
        for w in (0.0, 1e6, 1e8, 3e8):
            load, current = ladder(p, 1j * w)
            assert abs(system.response(p, "v_load", 1j * w) - load) <= EXACT
            assert abs(system.response(p, "i_in", 1j * w) - current) <= EXACT * abs(current)
        x = rng.uniform(-1, 1, 6)
        assert system.outputs(p, x, [1.0])["p_load"] == pytest.approx(
            x[5] ** 2 / p["R_l"], rel=1e-13
        )


# ---- the elliptic filter

CAUER = np.array(
    [
        [-0.7657012988813078, 0, -0.04631647496121808, -0.679177408582615, -0.04020741533747472],
        [-0.0865238902986928, 0, -0.23453075325476128, 0.35160343228525104, -0.20359656932918263],
        [-0.046316474961218074, 0, -0.7654475514556126, 0.18821427829354317, 0.5309167982008514],
        [0.7668711656441718, -0.7668711656441718, 0, 0, 0],
        [0, 1.1646866992778941, -1.1646866992778941, 0, 0],
    ]
)
CAUER_INPUT = np.array([0.7657012988813079, 0.0865238902986928, 0.046316474961218074, 0, 0])
CAUER_POLES = (
    -0.6453911447515945,
    -0.3596289792290571 - 0.7320149453243563j,
    -0.3596289792290571 + 0.7320149453243563j,
    -0.08324987356360614 - 0.9307992001369738j,
    -0.08324987356360614 + 0.9307992001369738j,
)
"""Of the filter CauerLowPassAnalog of the Modelica Standard Library, by its elements' values."""


def test_cauer_filter(find: Find) -> None:
    system = find("cauer_filter")
    p = system.defaults
    assert system.states == ("v_C1", "v_C3", "v_C5", "i_L1", "i_L2")
    A, B = system.linear(p)
    assert np.max(np.abs(A - CAUER)) <= 1e-10
    assert np.max(np.abs(B[:, 0] - CAUER_INPUT)) <= 1e-10
    poles = np.linalg.eigvals(A)
    assert all(np.min(np.abs(poles - pole)) <= 1e-10 for pole in CAUER_POLES)
    assert system.response(p, "v_out", 0) == pytest.approx(0.5, abs=1e-14)
    for notch in (p["w1"], p["w2"]):
        assert abs(system.response(p, "v_out", 1j * notch)) < 1e-9
        assert abs(system.response(p, "v_out", 1j * notch * 1.01)) > 1e-4


def test_capacitors_in_loops_add_by_congruence(find: Find, tmp_path: Path) -> None:
    """Nodal analysis: the currents into a, b, c of capacitors among them and to ground."""
    system, rng = find("cauer_filter"), np.random.default_rng(4)
    derivation = lg.derive(of_text(text("cauer_filter"), tmp_path))
    assert dict(derivation.formulation.network.dependent) == {
        "C2": ("C1", "C3"),
        "C4": ("C3", "C5"),
    }
    for _ in range(STATES):
        p = system.random_parameters(rng)
        C2, C4 = 1 / (p["w1"] ** 2 * p["L1"]), 1 / (p["w2"] ** 2 * p["L2"])
        mass = np.array(
            [
                [p["C1"] + C2, -C2, 0],
                [-C2, C2 + p["C3"] + C4, -C4],
                [0, -C4, C4 + p["C5"]],
            ]
        )
        x, (u,) = rng.uniform(-1, 1, 5), rng.uniform(-1, 1, 1)
        into = [(u - x[0]) / p["R1"] - x[3], x[3] - x[4], x[4] - x[2] / p["R2"]]
        volts = np.linalg.solve(mass, into)
        amperes = [(x[0] - x[1]) / p["L1"], (x[1] - x[2]) / p["L2"]]
        assert error(system.call("rhs", p, x, [u]), [*volts, *amperes], 1) <= EXACT
        around = system.outputs(p, x, [u])["i_C2"]
        assert around == pytest.approx(C2 * (volts[0] - volts[1]), abs=1e-13)


# ---- the ring modulator


def ring_modulator(p: Mapping[str, float], t: float, y: Any, uncharged: bool = False) -> Array:
    """The fifteen equations of the Test Set for IVP Solvers.

    With `uncharged`, the third to the sixth are not divided by Cs.
    """
    y1, y2, y3, y4, y5, y6, y7, y8, y9, y10, y11, y12, y13, y14, y15 = y
    U1 = p["U_1"] * math.sin(2 * math.pi * p["f_1"] * t)
    U2 = p["U_2"] * math.sin(2 * math.pi * p["f_2"] * t)
    over = (y3 - y5 - y7 - U2, -y4 + y6 - y7 - U2, y4 + y5 + y7 + U2, -y3 - y6 + y7 + U2)
    q1, q2, q3, q4 = (p["gamma"] * (math.exp(p["delta"] * u) - 1) for u in over)
    Cs = 1 if uncharged else p["Cs"]
    return np.array(
        [
            (y8 - 0.5 * y10 + 0.5 * y11 + y14 - y1 / p["R"]) / p["C"],
            (y9 - 0.5 * y12 + 0.5 * y13 + y15 - y2 / p["R"]) / p["C"],
            (y10 - q1 + q4) / Cs,
            (-y11 + q2 - q3) / Cs,
            (y12 + q1 - q3) / Cs,
            (-y13 - q2 + q4) / Cs,
            (-y7 / p["Rp"] + q1 + q2 - q3 - q4) / p["Cp"],
            -y1 / p["Lh"],
            -y2 / p["Lh"],
            (0.5 * y1 - y3 - p["Rg2"] * y10) / p["Ls2"],
            (-0.5 * y1 + y4 - p["Rg3"] * y11) / p["Ls3"],
            (0.5 * y2 - y5 - p["Rg2"] * y12) / p["Ls2"],
            (-0.5 * y2 + y6 - p["Rg3"] * y13) / p["Ls3"],
            (-y1 + U1 - (p["Ri"] + p["Rg1"]) * y14) / p["Ls1"],
            (-y2 - (p["Rc"] + p["Rg1"]) * y15) / p["Ls1"],
        ]
    )


RING = [*(f"v_C{k}" for k in range(1, 8)), *(f"i_L{k}" for k in range(8, 16))]
"""y1 to y15."""

RING_AT_END = (
    *(-0.02339057358486745, -0.007367485485540825, 0.2582956709291169, -0.406446572128345),
    *(-0.4039455665149794, 0.2607966765422943, 0.1106761861269975, 2.939904342435596e-07),
    *(-2.840029933642329e-08, 0.0007267198267264553, 0.000792948719696084),
    *(-0.0007255283495698965, -0.0007941401968526521, 7.088495416976114e-05),
    2.39005907523657e-05,
)
"""Its reference solution at t = 1 ms, all of it from zero."""


def test_ring_modulator_has_the_published_equations(find: Find) -> None:
    system, rng = find("ring_modulator"), np.random.default_rng(5)
    assert sorted(system.states) == sorted(RING)
    place = [system.states.index(name) for name in RING]
    for k in range(2 * STATES):
        p = system.random_parameters(rng) if k % 2 else system.defaults
        y, t = rng.uniform(-0.5, 0.5, 15), rng.uniform(0, 1e-3)
        y[7:] *= 10.0 ** rng.uniform(-6, 0)
        x = np.empty(15)
        x[place] = y
        assert error(system.call("rhs", p, x, (), t)[place], ring_modulator(p, t, y)) <= EXACT


def test_ring_modulator_arrives_at_the_reference(find: Find) -> None:
    """By LSODA, which is stiff where it has to be, over the emitted C."""
    system = find("ring_modulator")
    emitted = system.compiled.library["ring_modulator_rhs"]
    p, x, u, rate = (
        np.array(list(system.defaults.values())),
        np.zeros(15),
        np.zeros(1),
        np.zeros(15),
    )
    before = ctypes.c_void_p(p.ctypes.data)
    after = [ctypes.c_void_p(array.ctypes.data) for array in (x, u, rate)]

    def slope(t: float, y: Array) -> Array:
        x[:] = y
        assert not emitted(before, ctypes.c_double(t), *after)
        return rate

    options = {"rtol": 1e-9, "atol": 1e-11, "mxstep": 10**7}
    end = odeint(slope, np.zeros(15), [0, 1e-3], tfirst=True, **options)[-1]
    found = end[[system.states.index(name) for name in RING]]
    assert np.max(np.abs(found - RING_AT_END)) <= 1e-5


@pytest.fixture(scope="module")
def uncharged(tmp_path_factory: pytest.TempPathFactory) -> tuple[lg.Model, System]:
    """The ring modulator without its four stray capacitors: by itself of index two."""
    given = text("ring_modulator")
    for k in (3, 4, 5, 6):
        given, count = re.subn(rf"\[capacitor\.C{k}\]\n(.+\n)+\n", "", given)
        assert count == 1
    folder = tmp_path_factory.mktemp("uncharged")
    model = of_text(given, folder)
    return model, build(model, folder)


def test_ring_modulator_without_stray_capacitance_has_ten_states(
    uncharged: tuple[lg.Model, System],
) -> None:
    model, system = uncharged
    network = lg.derive(model).formulation.network
    assert len(network.states) == len(system.states) == 10
    ((name, on),) = network.dependent.items()
    assert {name, *on} == {"L10", "L11", "L12", "L13"}
    assert any(f"{name} stores, but is no state" in remark for remark in network.remarks)
    assert any("D1" in remark and "algebraic loop" in remark for remark in network.remarks)


def test_ring_modulator_without_stray_capacitance(uncharged: tuple[lg.Model, System]) -> None:
    """The published equations with Cs = 0: corners follow from rates, and then all fifteen hold."""
    _, system = uncharged
    rng = np.random.default_rng(6)
    for k in range(STATES):
        p = system.random_parameters(rng) if k % 2 else system.defaults
        t = rng.uniform(0, 1e-3)
        x = np.where([name[0] == "v" for name in system.states], 0.5, 2e-3) * rng.uniform(-1, 1, 10)
        y = dict(zip(system.states, x, strict=True))
        with np.errstate(over="ignore", invalid="ignore"):  # Newton's first steps are long
            rate = dict(zip(system.states, system.call("rhs", p, x, (), t), strict=True))
        missing = [f"i_L{k}" for k in (10, 11, 12, 13) if f"i_L{k}" not in y]
        for values in (y, rate):  # the currents at the corners add up to nothing
            values[missing[0]] = -sum(v for n, v in values.items() if n in ring_of(missing[0]))
        half1, half2 = 0.5 * y["v_C1"], 0.5 * y["v_C2"]
        y["v_C3"] = half1 - p["Rg2"] * y["i_L10"] - p["Ls2"] * rate["i_L10"]
        y["v_C4"] = half1 + p["Rg3"] * y["i_L11"] + p["Ls3"] * rate["i_L11"]
        y["v_C5"] = half2 - p["Rg2"] * y["i_L12"] - p["Ls2"] * rate["i_L12"]
        y["v_C6"] = half2 + p["Rg3"] * y["i_L13"] + p["Ls3"] * rate["i_L13"]
        expected = ring_modulator(p, t, [y[name] for name in RING], uncharged=True)
        named = dict(zip(RING, expected, strict=True))
        for name in system.states:
            assert rate[name] == pytest.approx(named[name], rel=1e-9, abs=1e-9)
        corners = [named[f"v_C{k}"] for k in (3, 4, 5, 6)]
        assert np.max(np.abs(corners)) <= 1e-11 * max(abs(y[f"i_L{k}"]) for k in (10, 11, 12, 13))


def ring_of(missing: str) -> list[str]:
    return [f"i_L{k}" for k in (10, 11, 12, 13) if f"i_L{k}" != missing]


# ---- the quarter car


def test_quarter_car(find: Find) -> None:
    """The state equations as StateMint prints them, with v_B, v_W, F_s, F_t."""
    system, rng = find("quarter_car_1d"), np.random.default_rng(7)
    assert system.states == ("v_body", "v_wheel", "F_suspension", "F_tyre")
    for _ in range(STATES):
        p = system.random_parameters(rng)
        mB, mW, ks, bs, kt, bt = (p[n] for n in ("m_B", "m_W", "k_s", "b_s", "k_t", "b_t"))
        A, B = system.linear(p)
        expected = np.array(
            [
                [-bs / mB, bs / mB, 1 / mB, 0],
                [bs / mW, -(bs + bt) / mW, -1 / mW, 1 / mW],
                [-ks, ks, 0, 0],
                [0, -kt, 0, 0],
            ]
        )
        assert rows(A, expected) <= EXACT
        assert error(B[:, 0], [0, bt / mW, 0, kt]) <= EXACT
        C, D = system.linear(p, "outputs")
        assert rows(C, np.array([expected[0], [0, 0, 1 / ks, 0], [0, -bt, 0, 1]])) <= EXACT
        assert error(D[:, 0], [0, 0, bt]) <= EXACT
        vB, vW, Fs, Ft = x = rng.uniform(-1, 1, 4) * (1, 1, 1e3, 1e3)
        stored = (mB * vB**2 + mW * vW**2 + Fs**2 / ks + Ft**2 / kt) / 2
        assert system.call("energy", p, x).sum() == pytest.approx(stored, rel=1e-13)


# ---- two masses that share their heat

TWO_MASSES = """
name = "two_masses"

[parameters]
C = { value = 15.0, unit = "J/K" }
G = { value = 10.0, unit = "W/K" }

[heat_capacity.hot]
between = ["a", "ground"]
capacity = "C"

[heat_capacity.cold]
between = ["b", "ground"]
capacity = "C"

[conduction.rod]
between = ["a", "b"]
conductance = "G"

[outputs]
flow = { value = "through(rod)", unit = "W" }
"""
"""TwoMasses of the Modelica Standard Library, whose exact solution is known."""


def test_two_masses_share_their_heat(tmp_path: Path) -> None:
    system = build(of_text(TWO_MASSES, tmp_path), tmp_path)
    p = system.defaults
    assert system.states == ("T_hot", "T_cold")
    course = solve_ivp(
        lambda t, x: system.call("rhs", p, x),
        (0, 5),
        (373.15, 273.15),
        method="DOP853",
        rtol=1e-13,
        atol=1e-11,
        t_eval=np.linspace(0, 5, 11),
    )
    for t, (hot, cold) in zip(course.t, course.y.T, strict=True):
        apart = 50 * math.exp(-2 * 10 * t / 15)
        assert hot == pytest.approx(323.15 + apart, abs=1e-9)
        assert cold == pytest.approx(323.15 - apart, abs=1e-9)
        flow = system.outputs(p, (hot, cold))["flow"]
        assert flow == pytest.approx(20 * apart, abs=1e-8)
    assert not system.call("energy", p, (373.15, 273.15)).any()  # heat is no work


# ---- the loudspeaker


@dataclass
class Driver:
    """What follows from Thiele and Small's parameters."""

    p: Mapping[str, float]

    @property
    def w(self) -> float:
        return 2 * math.pi * self.p["f_s"]

    @property
    def air(self) -> float:
        return self.p["rho"] * self.p["c"] ** 2

    @property
    def stiffness(self) -> float:
        return self.air * self.p["S_d"] ** 2 / self.p["V_as"]

    @property
    def mass(self) -> float:
        return self.stiffness / self.w**2

    @property
    def losses(self) -> float:
        return self.w * self.mass / self.p["Q_ms"]

    @property
    def force_factor(self) -> float:
        return math.sqrt(self.w * self.mass * self.p["R_e"] / self.p["Q_es"])

    def mobility(self, s: complex) -> complex:
        """Velocity of the cone by force on it, with the box behind it."""
        box = 1 / (1 / self.p["R_ab"] + s * self.p["V_b"] / self.air)
        cone = self.losses + s * self.mass + self.stiffness / s + self.p["S_d"] ** 2 * box
        return 1 / cone

    def impedance(self, s: complex) -> complex:
        """Of the terminals."""
        p = self.p
        return p["R_e"] + s * p["L_e"] + self.force_factor**2 * self.mobility(s)


def test_loudspeaker(find: Find) -> None:
    system, rng = find("loudspeaker"), np.random.default_rng(8)
    assert system.states == ("i_coil", "v_moving", "F_suspension", "p_air")
    for _ in range(STATES):
        p = system.random_parameters(rng)
        driver = Driver(p)
        for f in (5, 30, 60, 100, 1e3, 2e4):
            s = 2j * math.pi * f
            i = 1 / driver.impedance(s)
            v = driver.force_factor * i * driver.mobility(s)
            far = p["rho"] * p["S_d"] * s * v / (2 * math.pi * p["d"])
            for output, expected in (("i", i), ("x", v / s), ("p_far", far)):
                assert abs(system.response(p, output, s) - expected) <= 1e-11 * abs(expected)


def test_loudspeaker_peaks_at_the_resonance_of_the_box(find: Find) -> None:
    """f_c = f_s sqrt(1 + V_as/V_b), where what moves is a resistance: R_e (1 + Q_mc/Q_ec), both up alike."""
    system = find("loudspeaker")
    p = system.defaults | {"R_ab": 1e18, "L_e": 1e-9}
    ratio = math.sqrt(1 + p["V_as"] / p["V_b"])
    resonance = p["f_s"] * ratio
    peak = minimize_scalar(
        lambda f: -1 / abs(system.response(p, "i", 2j * math.pi * f)),
        bounds=(0.7 * resonance, 1.4 * resonance),
        method="bounded",
        options={"xatol": 1e-9},
    )
    assert peak.x == pytest.approx(resonance, rel=1e-6)
    assert -peak.fun == pytest.approx(p["R_e"] * (1 + p["Q_ms"] / p["Q_es"]), rel=1e-6)
    leaking = system.defaults
    at = 2j * math.pi * resonance
    assert abs(Driver(leaking).impedance(at)) < 0.95 * -peak.fun
    assert abs(cmath.phase(Driver(p).impedance(at))) < 1e-6


# ---- the servo


def servo(p: Mapping[str, float], x: Any, u: Any) -> tuple[Array, Array]:
    """The rates of pressures, velocity and spring force by hand, and the sizes of their terms."""
    pP, pA, pB, v, F = x
    spool, load = u

    def edge(opening: float, drop: float) -> float:
        root = (drop**2 + p["dp"] ** 2) ** 0.25
        return float(p["K_v"] * max(opening, 0) * drop / root)

    PA, AT = edge(spool, pP - pA), edge(-spool, pA)
    PB, BT = edge(-spool, pP - pB), edge(spool, pB)
    line, leak = (p["p_P"] - pP) / p["R_P"], (pA - pB) / p["R_i"]
    friction = p["b"] * v + p["F_c"] * math.tanh(v / p["v_c"])
    terms = [
        (p["C_P"], [line, -PA, -PB]),
        (p["V_A"] / p["beta"], [PA, -AT, -leak, -p["A_A"] * v]),
        (p["V_B"] / p["beta"], [PB, -BT, leak, p["A_B"] * v]),
        (p["m"], [p["A_A"] * pA, -p["A_B"] * pB, -friction, -F, -load]),
        (1 / p["k"], [v]),
    ]
    found = np.array([sum(flows) / store for store, flows in terms])
    sizes = np.array([sum(map(abs, flows)) / store for store, flows in terms])
    return found, sizes


def test_servo(find: Find) -> None:
    system, rng = find("electro_hydraulic_servo"), np.random.default_rng(9)
    assert system.states == ("p_supply", "p_chamber_A", "p_chamber_B", "v_load", "F_spring")
    for _ in range(2 * STATES):
        p = system.random_parameters(rng)
        x = rng.uniform(-1, 1, 5) * (5e6, 1e7, 1e7, 0.2, 2e3) + (1e7, 3e6, 3e6, 0, 0)
        u = rng.uniform(-1, 1, 2) * (1, 1e3)
        expected, sizes = servo(p, x, u)
        assert error(system.call("rhs", p, x, u), expected, sizes) <= EXACT
        outputs = system.outputs(p, x, u)
        assert outputs["x"] == pytest.approx(x[4] / p["k"], rel=1e-13)
        force = p["A_A"] * x[1] - p["A_B"] * x[2]
        assert outputs["F"] == pytest.approx(force, rel=1e-11, abs=1e-6)
        assert outputs["Q_P"] == pytest.approx((p["p_P"] - x[0]) / p["R_P"], rel=1e-12)


def test_servo_moves_as_fast_as_its_valve_lets_it(find: Find) -> None:
    """Steady against no load: v = K u / sqrt((A_A³ + A_B³) / (A_A p)), forward.

    As K u sqrt(p - p_A) = A_A v, K u sqrt(p_B) = A_B v and A_A p_A = A_B p_B.
    """
    system = find("electro_hydraulic_servo")
    p = system.defaults | {"b": 0.0, "F_c": 0.0, "k": 1e-3, "R_P": 1e3, "R_i": 1e20, "dp": 1.0}
    start = [p["p_P"], p["p_P"] / 3, p["p_P"] / 2, 0, 0]
    end = solve_ivp(
        lambda t, x: system.call("rhs", p, x, [0.5, 0]),
        (0, 2),
        start,
        "LSODA",
        rtol=1e-9,
        atol=1e-9,
    ).y[:, -1]
    A, B = p["A_A"], p["A_B"]
    assert end[3] == pytest.approx(
        0.5 * p["K_v"] * math.sqrt(A * p["p_P"] / (A**3 + B**3)), rel=1e-5
    )


# ---- the motor that warms up


@dataclass
class Warm:
    """The motor's powers and rates in one state, by hand."""

    p: Mapping[str, float]
    x: Any
    u: Any

    @property
    def resistance(self) -> float:
        return self.p["R_20"] * (1 + self.p["alpha"] * (self.x[2] - self.p["T_20"]))

    @property
    def copper(self) -> float:
        return self.resistance * self.x[0] ** 2

    @property
    def friction(self) -> float:
        """Torque of bearings and brushes."""
        w = self.x[1]
        return self.p["b"] * w + self.p["T_c"] * math.tanh(w / self.p["w_c"])

    @property
    def fan(self) -> float:
        return self.p["c_fan"] * self.x[1] * abs(self.x[1])

    @property
    def cooling(self) -> float:
        p, (_, w, _, housing), air = self.p, self.x, self.u[1]
        convected = (p["h_0"] + p["h_1"] * abs(w)) * p["A_h"] * (housing - air)
        return convected + p["epsilon"] * p["sigma"] * p["A_h"] * (housing**4 - air**4)

    @property
    def rates(self) -> list[float]:
        p, (i, w, winding, housing), (u, _) = self.p, self.x, self.u
        across = p["G_wh"] * (winding - housing)
        return [
            (u - self.resistance * i - p["k"] * w) / p["L"],
            (p["k"] * i - self.friction - self.fan) / p["J"],
            (self.copper - across) / p["C_w"],
            (self.friction * w + across - self.cooling) / p["C_h"],
        ]


def test_motor_warming_up(find: Find) -> None:
    system, rng = find("motor_warming_up"), np.random.default_rng(10)
    assert system.states == ("i_motor", "w_rotor", "T_winding", "T_housing")
    for _ in range(2 * STATES):
        p = system.random_parameters(rng)
        x = np.array(
            [*rng.uniform(-8, 8, 1), *rng.uniform(-400, 400, 1), *rng.uniform(280, 400, 2)]
        )
        u = np.array([rng.uniform(-24, 24), rng.uniform(270, 310)])
        warm = Warm(p, x, u)
        rates = system.call("rhs", p, x, u)
        assert error(rates, warm.rates) <= 1e-11
        outputs = system.outputs(p, x, u)
        assert outputs["P_loss"] == pytest.approx(warm.copper + warm.friction * x[1], rel=1e-12)
        assert outputs["P_cooling"] == pytest.approx(warm.cooling, rel=1e-11)
        # what goes in is stored, heats, cools or blows
        heating = p["C_w"] * rates[2] + p["C_h"] * rates[3]
        balance = system.power(p, x, u) + heating + outputs["P_cooling"] + warm.fan * x[1]
        assert balance == pytest.approx(outputs["P_in"], rel=1e-9, abs=1e-6)


def test_motor_keeps_its_energy_for_an_hour(find: Find) -> None:
    """Work done on the motor is what is stored, what became heat and what the fan has taken."""
    system = find("motor_warming_up")
    p, u = system.defaults, np.array([12.0, 293.15])

    def slope(t: float, z: Array) -> Array:
        warm = Warm(p, z[:4], u)
        powers = [u[0] * z[0], warm.cooling, warm.fan * z[1]]
        return np.array([*system.call("rhs", p, z[:4], u), *powers])

    start = np.array([0, 0, u[1], u[1], 0, 0, 0])
    end = solve_ivp(slope, (0, 3600), start, "LSODA", rtol=1e-10, atol=1e-9).y[:, -1]
    stored = system.call("energy", p, end[:4]).sum()
    heat = p["C_w"] * (end[2] - u[1]) + p["C_h"] * (end[3] - u[1])
    assert stored + heat + end[5] + end[6] == pytest.approx(end[4], rel=1e-7)
    assert 300 < end[3] < end[2] < 400
    assert np.max(np.abs(system.call("rhs", p, end[:4], u))) < 1e-3  # an hour is long enough


# ---- the synchronous machine


@dataclass
class Machine:
    """A machine at an angle: inductances and flux of the magnets with their derivatives, by dq theory."""

    p: Mapping[str, float]
    x: float

    @property
    def axes(self) -> Array:
        """From (d, q, 0) to the phases, amplitudes kept."""
        turned = self.p["pairs"] * self.x - 2 * math.pi / 3 * np.arange(3)
        return np.stack([np.cos(turned), -np.sin(turned), np.ones(3)], axis=1)

    @property
    def spin(self) -> Array:
        """The derivative of `axes` by the angle, in these axes again."""
        return self.p["pairs"] * np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 0]])

    @property
    def inductance(self) -> Array:
        diagonal = np.diag([self.p["L_d"], self.p["L_q"], self.p["L_0"]])
        return np.asarray(self.axes @ diagonal @ np.linalg.inv(self.axes))

    @property
    def inductance_slope(self) -> Array:
        turning = self.axes @ self.spin @ np.linalg.inv(self.axes)
        return np.asarray(turning @ self.inductance - self.inductance @ turning)

    @property
    def flux(self) -> Array:
        return np.asarray(self.axes[:, 0] * self.p["psi"])

    @property
    def flux_slope(self) -> Array:
        return np.asarray(self.axes @ self.spin[:, 0] * self.p["psi"])

    def torque(self, i: Array) -> float:
        return float(i @ self.inductance_slope @ i / 2 + i @ self.flux_slope)

    def rates(self, i: Array, w: float, volts: Array) -> Array:
        """Rates of all currents, which add up to zero, and the star point's potential, by Kirchhoff."""
        induced = (self.inductance_slope @ i + self.flux_slope) * w
        star = np.ones((3, 1))
        whole = np.block([[self.inductance, star], [star.T, np.zeros((1, 1))]])
        return np.asarray(np.linalg.solve(whole, [*(volts - self.p["R"] * i - induced), 0]))


def machine_state(system: System, i: Any, x: float, w: float) -> Array:
    values = {f"i_machine_winding{k + 1}": i[k] for k in range(3)} | {"x_machine": x, "w_rotor": w}
    return np.array([values[name] for name in system.states])


def currents(system: System, p: Mapping[str, float], x: Array, u: Array) -> Array:
    found = system.outputs(p, x, u)
    return np.array([found["i_a"], found["i_b"], found["i_c"]])


def test_synchronous_machine(find: Find) -> None:
    """Voltage = R i + d/dt (L i + psi), torque = i^T L' i / 2 + i^T psi', and no power is lost."""
    system, rng = find("synchronous_machine"), np.random.default_rng(11)
    assert len(system.states) == 4
    for _ in range(2 * STATES):
        p = system.random_parameters(rng)
        i = rng.uniform(-10, 10, 3)
        i -= i.mean()
        angle, w = rng.uniform(-3, 3), rng.uniform(-200, 200)
        u = rng.uniform(-1, 1, 4) * (30, 30, 30, 1)
        x = machine_state(system, i, angle, w)
        assert error(currents(system, p, x, u), i, 10) <= EXACT
        machine = Machine(p, angle)
        torque = machine.torque(i)
        outputs = system.outputs(p, x, u)
        assert outputs["torque"] == pytest.approx(torque, rel=1e-11, abs=1e-11)
        rate = dict(zip(system.states, system.call("rhs", p, x, u), strict=True))
        accelerated = (torque - p["b"] * w - u[3]) / p["J"]
        assert rate["w_rotor"] == pytest.approx(accelerated, rel=1e-10, abs=1e-9)
        assert rate["x_machine"] == w
        *expected, star = machine.rates(i, w, u[:3])
        for k in range(3):
            name = f"i_machine_winding{k + 1}"
            if name in rate:
                assert rate[name] == pytest.approx(expected[k], rel=1e-9, abs=1e-7)
        across = system.by_name("across", "ACROSS_NAMES", p, x, u)
        terminals = np.array([across[f"machine.winding{k + 1}"] for k in range(3)])
        assert error(terminals, u[:3] - star, 100) <= 1e-11
        # and by energies
        given = u[:3] @ i - u[3] * w - p["R"] * i @ i - p["b"] * w**2
        stored = i @ machine.inductance @ i / 2 + p["J"] * w**2 / 2
        assert system.call("energy", p, x).sum() == pytest.approx(stored, rel=1e-12)
        assert system.power(p, x, u) == pytest.approx(given, rel=1e-7, abs=1e-4)
        assert outputs["power"] == pytest.approx(u[:3] @ i, rel=1e-11, abs=1e-9)


def test_no_angle_of_a_strongly_salient_machine_is_singular(find: Find) -> None:
    """Where phases couple least, L12 - L13 - L23 + L33 = 0, the matrix is as regular as elsewhere."""
    system = find("synchronous_machine")
    p = system.defaults | {"L_d": 1e-3, "L_q": 6e-3}

    def coupling(x: float) -> float:
        L = Machine(p, x).inductance
        return float(L[0, 1] - L[0, 2] - L[1, 2] + L[2, 2])

    angles = np.linspace(0, 2 * math.pi / p["pairs"], 100)
    around = [pair for pair in pairwise(angles) if coupling(pair[0]) * coupling(pair[1]) < 0]
    assert len(around) == 4
    i, u = np.array([3.0, -1.0, -2.0]), np.array([10.0, -5.0, 2.0, 0.0])
    for pair in around:
        angle = brentq(coupling, *pair, xtol=1e-16)
        expected = Machine(p, angle).rates(i, 50.0, u[:3])
        x = machine_state(system, i, angle, 50.0)
        rate = dict(zip(system.states, system.call("rhs", p, x, u), strict=True))
        for k in range(3):
            if f"i_machine_winding{k + 1}" in rate:
                assert rate[f"i_machine_winding{k + 1}"] == pytest.approx(expected[k], rel=1e-9)


def test_synchronous_machine_runs_as_its_axes_say(find: Find) -> None:
    """Steady in its axes, with w the electrical speed.

    v_d = R i_d - w L_q i_q, v_q = R i_q + w (L_d i_d + psi), T = 3/2 pairs (psi + (L_d - L_q) i_d) i_q.
    """
    system, rng = find("synchronous_machine"), np.random.default_rng(12)
    for _ in range(STATES):
        p = system.random_parameters(rng)
        (d, q), angle, w = rng.uniform(-10, 10, 2), rng.uniform(-3, 3), rng.uniform(-200, 200)
        electrical = p["pairs"] * w
        v = [
            p["R"] * d - electrical * p["L_q"] * q,
            p["R"] * q + electrical * (p["L_d"] * d + p["psi"]),
            rng.uniform(-5, 5),  # which the floating star point does not feel
        ]
        torque = 1.5 * p["pairs"] * (p["psi"] + (p["L_d"] - p["L_q"]) * d) * q
        machine = Machine(p, angle)
        u = np.array([*(machine.axes @ v), torque - p["b"] * w])
        x = machine_state(system, machine.axes @ [d, q, 0], angle, w)
        rate = dict(zip(system.states, system.call("rhs", p, x, u), strict=True))
        turning = machine.axes @ machine.spin @ [d, q, 0] * w
        for k in range(3):
            if f"i_machine_winding{k + 1}" in rate:
                assert rate[f"i_machine_winding{k + 1}"] == pytest.approx(
                    turning[k], rel=1e-8, abs=1e-7
                )
        assert rate["w_rotor"] == pytest.approx(0, abs=1e-8)
        assert system.outputs(p, x, u)["torque"] == pytest.approx(torque, rel=1e-11, abs=1e-11)
