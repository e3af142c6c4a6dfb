"""The examples that join networks to mechanics, against the physics written down once more, apart.

What is expected comes from equations written here, from textbooks' sources as said beside them; of the arm of
six joints the mechanics come from the same file without its drives. States, inputs and parameters are random.
"""

from __future__ import annotations

import inspect
import json
import math
import tomllib
from dataclasses import dataclass, field
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

    Array = np.ndarray
    Find = Callable[[str], "System"]

FOLDER = Path(__file__).parents[2] / "examples"
NAMES = (
    "cart_pole_motor",
    "arm_with_drives",
    "magnetic_levitation",
    "condenser_microphone",
    "excavator_arm",
)
STATES = 20
EXACT = 1e-11
"""Relative to the entry, or to the sum of the terms that it is the difference of."""
STEP = 1e-30
"""Of derivatives by a complex step: exact, as nothing is subtracted."""


def text(name: str) -> str:
    return (FOLDER / name / f"{name}.toml").read_text(encoding="utf-8")


@dataclass
class State:
    """What the functions of a system are given."""

    p: dict[str, float]
    q: Array
    v: Array
    u: Array


@dataclass
class System:
    """A model emitted as Python, with the power audit.

    Attributes:
        module: the emitted module.
        files: all that was emitted.
    """

    module: Any
    files: dict[str, str]
    _defaults: dict[str, float] = field(default_factory=dict)

    @property
    def defaults(self) -> dict[str, float]:
        """Parameters as in the file."""
        found = inspect.signature(self.module.Parameters).parameters
        return {name: entry.default for name, entry in found.items()}

    def __call__(self, function: str, state: State, **more: Any) -> Any:
        """The value of an emitted function."""
        values = {**vars(state), **more, "p": self.module.Parameters(**state.p)}
        names = inspect.signature(getattr(self.module, function)).parameters
        return getattr(self.module, function)(*(values[name] for name in names))

    def named(self, function: str, state: State) -> dict[str, float]:
        """Outputs or reactions by their names."""
        names = {"outputs": "OUTPUT_NAMES", "reactions": "REACTION_NAMES"}[function]
        return dict(zip(getattr(self.module, names), self(function, state), strict=True))

    def at(self, state: State) -> dict[str, float]:
        """Parameters, inputs, coordinates and states of networks by name; rates as NAME_dot."""
        py = self.module
        values = [*state.q, *state.v]
        return {
            **state.p,
            **dict(zip(py.U_NAMES, map(float, state.u), strict=True)),
            **dict(zip(py.STATE_NAMES, map(float, values), strict=True)),
        }

    def rate_of_energy(self, state: State, a: Array) -> float:
        """dE/dt along the motion."""
        py = self.module
        p = py.Parameters(**state.p)
        rates = py.coordinate_rates(p, state.q, state.v)
        q = [complex(x, STEP * dx) for x, dx in zip(state.q, rates, strict=True)]
        v = [complex(x, STEP * dx) for x, dx in zip(state.v, a, strict=True)]
        return float(np.imag(sum(py._energy(p, q, v))) / STEP)


def build(model: Any, folder: Path) -> System:
    files = render(model, name=model.name, functions=("power",))
    return System(load(files, model.name, folder), files)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("mechatronic")


@pytest.fixture(scope="module")
def find(folder: Path) -> Find:
    """An example by its name, emitted once."""
    found: dict[str, System] = {}

    def example(name: str) -> System:
        if name not in found:
            found[name] = build(modelfile.read(FOLDER / name / f"{name}.toml"), folder / name)
        return found[name]

    return example


def variant(name: str, old: str, new: str, folder: Path) -> System:
    """An example with one line of its file changed."""
    before = text(name)
    assert before.count(f"\n{old}\n") == 1
    path = folder / f"{name}_variant.toml"
    path.write_text(before.replace(f"\n{old}\n", f"\n{new}\n"), encoding="utf-8")
    return build(modelfile.read(path), folder / f"{name}_variant")


def close(found: Any, expected: Any, size: Any = None) -> None:
    """Equal, relative to each entry or to `size`."""
    found, expected = np.asarray(found, float), np.asarray(expected, float)
    assert found.shape == expected.shape
    scale = np.abs(expected) if size is None else np.asarray(size, float)
    assert np.all(np.abs(found - expected) <= EXACT * scale)


# ---- random states: displacements and sizes as such systems have them

SPANS: dict[str, dict[str, tuple[float, float]]] = {
    "cart_pole_motor": {
        **{"slide": (-1, 1), "swing": (-3, 3), "slide_dot": (-2, 2), "swing_dot": (-5, 5)},
        **{"i_motor": (-4, 4), "voltage": (-12, 12)},
    },
    "arm_with_drives": {},
    "magnetic_levitation": {
        **{"gap": (1e-3, 3e-2), "gap_dot": (-0.5, 0.5), "i_magnet": (-3, 3)},
        "voltage": (-24, 24),
    },
    "condenser_microphone": {
        **{"gap": (15e-6, 35e-6), "gap_dot": (-5e-3, 5e-3), "q_capsule": (4e-10, 2e-9)},
        "pressure": (-20, 20),
    },
    "excavator_arm": {
        **{"boom": (-0.4, 0.9), "stick": (-2.2, -0.8), "bucket": (-1.6, 0.2)},
        **{f"{name}_dot": (-0.5, 0.5) for name in ("boom", "stick", "bucket")},
        **{"p_line": (5e6, 38e6), "pump_flow": (0, 5e-3), "soil_x": (-5e4, 5e4)},
        **{f"spool_{name}": (-1, 1) for name in ("boom", "stick", "bucket")},
        "soil_z": (-5e4, 5e4),
    },
}
OTHER = {
    "arm_with_drives": lambda name: (-20, 20) if name[0] in "ui" else (-3, 3),
    "excavator_arm": lambda name: (-1e5, 30e6),
}
"""Spans of what is not named above."""


def random_state(system: System, rng: np.random.Generator) -> State:
    """Parameters differ from their values in the file by up to 20 %."""
    py = system.module
    p = {name: value * rng.uniform(0.8, 1.2) for name, value in system.defaults.items()}

    def draw(name: str) -> float:
        span = SPANS[py.__name__].get(name)
        return float(rng.uniform(*(OTHER[py.__name__](name) if span is None else span)))

    x = np.array([draw(name) for name in py.STATE_NAMES])
    u = np.array([draw(name) for name in py.U_NAMES])
    return State(p, x[: py.NQ], x[py.NQ :], u)


def states(system: System, seed: int = 11) -> list[State]:
    rng = np.random.default_rng(seed)
    return [random_state(system, rng) for _ in range(STATES)]


# ---- all of them


@pytest.mark.parametrize("name", NAMES)
def test_readme_says_what_it_is_and_how_it_is_used(name: str) -> None:
    readme = (FOLDER / name / "README.md").read_text(encoding="utf-8")
    path = f"examples/{name}/{name}.toml"
    assert f"linegraph show {path}" in readme
    assert f"linegraph emit {path} --out build/{name}" in readme


@pytest.mark.parametrize("name", NAMES)
def test_every_parameter_and_input_says_what_it_is(name: str) -> None:
    table = tomllib.loads(text(name))
    for entry in (*table["parameters"].values(), *table["inputs"].values()):
        assert entry["about"]
    assert all(entry["about"] and entry["unit"] for entry in table["outputs"].values())


@pytest.mark.parametrize("name", NAMES)
def test_the_mass_matrix_is_symmetric_and_positive(name: str, find: Find) -> None:
    system = find(name)
    for s in states(system):
        M, h = system("equations", s)
        close(M, M.T)
        size = 1 / np.sqrt(np.diag(M))
        assert np.linalg.eigvalsh(M * np.outer(size, size))[0] > 0
        a = system("forward_dynamics", s)
        left = system("inverse_dynamics", s, a=a)
        close(left, M @ a + h, np.abs(M) @ np.abs(a) + np.abs(h))


@pytest.mark.parametrize("name", NAMES)
def test_powers_sum_to_zero(name: str, find: Find) -> None:
    """Through times across: in translation, in rotation, and in each subspace of the network."""
    system = find(name)
    for s in states(system):
        P, sums = system("power", s)
        close(sums, np.zeros(len(sums)), np.full(len(sums), np.sum(np.abs(P))))


@pytest.mark.parametrize("name", NAMES)
def test_energy_changes_by_sources_and_losses(name: str, find: Find) -> None:
    """dE/dt = what sources deliver - what becomes heat."""
    system = find(name)
    for s in states(system):
        a = system("forward_dynamics", s)
        terms = POWERS[name](system, s)
        size = sum(map(abs, terms)) + np.abs(s.v) @ np.abs(system("bias", s))
        close(system.rate_of_energy(s, a), sum(terms), size)


@pytest.mark.parametrize("name", NAMES)
def test_c_and_python_agree(name: str, find: Find, folder: Path) -> None:
    system = find(name)
    compiled = Compiled(system.files, name, folder / f"{name}_c")
    for s in states(system)[:5]:
        given = (list(s.p.values()), s.q, s.v, s.u)
        a = compiled.call("forward_dynamics", *given, out=[(system.module.NV,)])
        close(a, system("forward_dynamics", s), 1e-9 * np.max(np.abs(a)) + np.abs(a))


# ---- a cart-pole driven by a motor


def test_cart_pole_with_its_motor(find: Find) -> None:
    """By Lagrange's equations and Kirchhoff's, with p from hanging and the pinion's radius ρ.

    (M + m + J_m/ρ²) ẍ + m l cos p p̈ - m l sin p ṗ² = K i/ρ,
    (J + m l²) p̈ + m l cos p ẍ + m g l sin p = 0,    L di/dt = u - R i - K ẋ/ρ.
    """
    system = find("cart_pole_motor")
    for s in states(system):
        x = system.at(s)
        m, c, rho, K = x["m_pole"], x["l"], x["rho"], x["K"]
        sine, cosine = math.sin(x["swing"]), math.cos(x["swing"])
        mass = np.array(
            [
                [x["m_cart"] + m + x["J_rotor"] / rho**2, m * c * cosine],
                [m * c * cosine, x["J_pole"] + m * c * c],
            ]
        )
        right = np.array(
            [
                K * x["i_motor"] / rho + m * c * sine * x["swing_dot"] ** 2,
                -m * x["g"] * c * sine,
            ]
        )
        current = (x["voltage"] - x["R"] * x["i_motor"] - K * x["slide_dot"] / rho) / x["L"]
        a = system("forward_dynamics", s)
        close(a, [*np.linalg.solve(mass, right), current])
        y = system.named("outputs", s)
        torque = K * x["i_motor"] - x["J_rotor"] * a[0] / rho
        close(y["push"], torque / rho, (abs(K * x["i_motor"]) + abs(torque)) / rho)
        close(y["speed"], x["slide_dot"] / rho)
        close([y["current"], y["drawn"]], [x["i_motor"], x["voltage"] * x["i_motor"]])


def test_the_rail_carries_no_force_along(find: Find) -> None:
    """The pinion pushes the cart as an edge of its own; the slide's reaction is across it."""
    system = find("cart_pole_motor")
    for s in states(system):
        x, a = system.at(s), system("forward_dynamics", s)
        r = system.named("reactions", s)
        push = r["mount.translation_1d"]
        along = x["m_cart"] * a[0] - push
        pole = x["m_pole"] * (
            a[0]
            + x["l"] * (math.cos(x["swing"]) * a[1] - math.sin(x["swing"]) * x["swing_dot"] ** 2)
        )
        size = abs(push) + abs(x["m_cart"] * a[0]) + abs(pole)
        close(along + pole, 0.0, size)
        close(r["slide_fx"], 0.0, size)


# ---- magnetic levitation


def magnet(x: dict[str, float]) -> tuple[float, float]:
    """L(x) and L'(x)."""
    near = 1 + x["gap"] / x["d"]
    return x["L_far"] + x["L_near"] / near, -x["L_near"] / (x["d"] * near**2)


def test_magnetic_levitation(find: Find) -> None:
    """With z down, m z̈ = m g + L'(z) i²/2 and L(z) di/dt = u - R i - L'(z) ż i."""
    system = find("magnetic_levitation")
    for s in states(system):
        x = system.at(s)
        L, slope = magnet(x)
        i, rate = x["i_magnet"], x["gap_dot"]
        voltages = (x["voltage"], -x["R"] * i, -slope * rate * i)
        forces = (x["m"] * x["g"], slope * i * i / 2)
        size = sum(map(abs, forces)) / x["m"], sum(map(abs, voltages)) / L
        a = system("forward_dynamics", s)
        close(a, [sum(forces) / x["m"], sum(voltages) / L], size)
        y = system.named("outputs", s)
        close([y["pull"], y["flux"]], [-slope * i * i / 2, L * i])


def test_the_ball_hovers(find: Find) -> None:
    system = find("magnetic_levitation")
    for s in states(system):
        current = system.named("outputs", s)["hover_current"]
        s.v[:] = 0, current
        s.u[:] = s.p["R"] * current
        close(system("forward_dynamics", s), [0, 0], [s.p["g"], s.u[0] / s.p["L_far"]])


def test_magnetic_levitation_by_its_energy(find: Find, folder: Path) -> None:
    """The same with the flux linkage λ = L(z) i as the state, of which W = λ²/(2 L) is the energy.

    m z̈ = m g + λ² L'/(2 L²) and dλ/dt = u - R λ/L.
    """
    system = find("magnetic_levitation")
    law = "(L_far + L_near/(1 + x/d))"
    other = variant(
        "magnetic_levitation",
        f'inductance = "{law[1:-1]}"',
        f'energy = "psi**2/(2*{law})"',
        folder,
    )
    assert other.module.V_NAMES == ("gap", "psi_magnet")
    for s in states(system):
        x = system.at(s)
        L, slope = magnet(x)
        flux = L * x["i_magnet"]
        there = State(s.p, s.q, np.array([s.v[0], flux]), s.u)
        a, b = system("forward_dynamics", s), other("forward_dynamics", there)
        lent = slope * x["gap_dot"] * x["i_magnet"], L * a[1]
        close(b[0], a[0], x["g"] + abs(a[0]))
        close(b[1], sum(lent), sum(map(abs, lent)) + abs(x["voltage"]))
        pull = x["m"] * x["g"], flux**2 * slope / (2 * L**2)
        close(b[0], sum(pull) / x["m"], sum(map(abs, pull)) / x["m"])
        drop = x["voltage"], -x["R"] * flux / L
        close(b[1], sum(drop), sum(map(abs, drop)))
        close(other("energy", there), system("energy", s))
        close(other("outputs", there), system("outputs", s))


# ---- a condenser microphone


def test_condenser_microphone(find: Find) -> None:
    """By forces and voltages, m ẍ + b ẋ + k (x - x₀) = -q²/(2 ε A) + p A and R dq/dt + q x/(ε A) = V."""
    system = find("condenser_microphone")
    for s in states(system):
        x = system.at(s)
        q, plates = x["q_capsule"], x["eps"] * x["A"]
        forces = (
            -x["b"] * x["gap_dot"],
            -x["k"] * (x["gap"] - x["x0"]),
            -q * q / (2 * plates),
            x["pressure"] * x["A"],
        )
        voltages = x["V"], -q * x["gap"] / plates
        size = sum(map(abs, forces)) / x["m"], sum(map(abs, voltages)) / x["R"]
        a = system("forward_dynamics", s)
        close(a, [sum(forces) / x["m"], sum(voltages) / x["R"]], size)
        y = system.named("outputs", s)
        expected = [-sum(voltages), -forces[2], sum(voltages) / x["R"]]
        close(list(y.values()), expected, [abs(x["V"]) + y["signal"], y["attraction"], size[1]])


def test_condenser_microphone_by_its_coenergy(find: Find, folder: Path) -> None:
    """The same with the voltage v = q x/(ε A) as the state: it changes with the charge and with the gap."""
    system = find("condenser_microphone")
    other = variant(
        "condenser_microphone",
        'energy = "q**2*x/(2*eps*A)"',
        'capacitance = "eps*A/x"',
        folder,
    )
    assert other.module.V_NAMES == ("gap", "v_capsule")
    for s in states(system):
        x = system.at(s)
        plates = x["eps"] * x["A"]
        there = State(s.p, s.q, np.array([s.v[0], x["q_capsule"] * x["gap"] / plates]), s.u)
        a, b = system("forward_dynamics", s), other("forward_dynamics", there)
        parts = a[1] * x["gap"] / plates, x["q_capsule"] * x["gap_dot"] / plates
        stiff = x["k"] * (abs(x["gap"]) + x["x0"]) / x["m"]
        biased = abs(x["V"]) * x["gap"] / (x["R"] * plates)
        close(b, [a[0], sum(parts)], [stiff, sum(map(abs, parts)) + biased])
        close(other("energy", there), system("energy", s))
        signal, attraction, current = system("outputs", s)
        size = abs(signal) + x["V"], attraction, abs(current) + x["V"] / x["R"]
        close(other("outputs", there), (signal, attraction, current), size)


# ---- an arm of six joints with its drives

NETWORK = ("voltage_source", "resistor", "inductor", "dc_motor", "inputs")
JOINTS = ("waist", "shoulder", "elbow", "roll", "pitch", "flange")


@pytest.fixture(scope="module")
def bare(folder: Path) -> System:
    """The arm without its drives: the same file, networks left out, joints with efforts."""
    table = tomllib.loads(text("arm_with_drives"))
    kept = {key: value for key, value in table.items() if key not in NETWORK}
    kept["outputs"] = {k: v for k, v in table["outputs"].items() if k.startswith("tip_")}
    kept["name"] = "bare_arm"
    for joint in kept["revolute"].values():
        del joint["effort"]
    path = folder / "bare_arm.json"
    path.write_text(json.dumps(kept), encoding="utf-8")
    return build(modelfile.read(path), folder / "bare_arm")


@dataclass
class Drives:
    """The six drives of the arm: constants, and what they do at a state."""

    n: Array
    K: Array
    J: Array
    b: Array
    R: Array
    L: Array

    @classmethod
    def of(cls, p: dict[str, float]) -> Drives:
        """Numbers by axis."""

        def each(letter: str) -> Array:
            return np.array([p[f"{letter}{k}"] for k in range(1, 7)])

        rotors = np.array([p["J1"], p["J2"], p["J3"], *[p["J_wrist"]] * 3])
        ohms = p["R_bridge"] + np.repeat([p["R_arm"], p["R_wrist"]], 3)
        henries = p["L_choke"] + np.repeat([p["L_arm"], p["L_wrist"]], 3)
        return cls(each("n"), each("K"), rotors, each("b"), ohms, henries)

    def torque(self, v: Array, i: Array, a: Array) -> Array:
        """At the joints, behind the gears."""
        return self.n * self.K * i - self.n**2 * (self.b * v + self.J * a)


def test_the_arm_and_its_circuits(find: Find, bare: System) -> None:
    """(M + n² J) v̇ + h = n K i - n² b v and (L + L_choke) di/dt = u - (R + R_bridge) i - n K v.

    M and h are those of the arm without drives; elements of the circuits are all in series.
    """
    system = find("arm_with_drives")
    assert list(system.module.V_NAMES) == [*JOINTS, *(f"i_motor{k}" for k in range(1, 7))]
    for s in states(system):
        d = Drives.of(s.p)
        v, i = s.v[:6], s.v[6:]
        M, h = bare.module.equations(bare.module.Parameters(g=s.p["g"]), s.q, v)
        mass = M + np.diag(d.n**2 * d.J)
        right = d.n * d.K * i - d.n**2 * d.b * v - h
        expected = np.linalg.solve(mass, right)
        a = system("forward_dynamics", s)
        close(a[:6], expected, np.abs(np.linalg.inv(mass)) @ np.abs(right))
        voltages = s.u, -d.R * i, -d.n * d.K * v
        close(a[6:], sum(voltages) / d.L, sum(map(np.abs, voltages)) / d.L)
        found, bias = system("equations", s)
        close(found[:6, :6], mass, np.sqrt(np.outer(np.diag(mass), np.diag(mass))))
        close(np.diag(found)[6:], d.L)
        off = found.copy()
        off[:6, :6] = 0
        assert np.count_nonzero(off) == 6
        close(bias[:6], -right, np.abs(h) + np.abs(d.n * d.K * i) + np.abs(d.n**2 * d.b * v))


def test_reactions_of_the_arm(find: Find, bare: System) -> None:
    """Joints and drives together carry what the joints of the bare arm carry in the same motion.

    The bare arm's effort along a joint's axis is what its inverse dynamics ask; here the drive gives it, and
    the joint itself gives nothing along its axis.
    """
    system = find("arm_with_drives")
    py = bare.module
    for s in states(system):
        a = system("forward_dynamics", s)
        p = py.Parameters(g=s.p["g"])
        whole = dict(zip(py.REACTION_NAMES, py.reactions_at(p, s.q, s.v[:6], a[:6]), strict=True))
        asked = py.inverse_dynamics(p, s.q, s.v[:6], a[:6])
        d = Drives.of(s.p)
        drives = d.torque(s.v[:6], s.v[6:], a[:6])
        size = np.abs(d.n * d.K * s.v[6:]) + np.abs(d.n**2 * d.b * s.v[:6])
        size += np.abs(d.n**2 * d.J * a[:6])
        close(drives, asked, size + max(map(abs, whole.values())))
        y = system.named("outputs", s)
        close([y[f"torque{k}"] for k in range(1, 7)], drives, size)
        r = system.named("reactions", s)
        for joint, drive in zip(JOINTS, drives, strict=True):
            for part in ("fx", "fy", "fz", "tx", "ty", "tz"):
                name = f"{joint}_{part}"
                total = r[name] + (drive if part == "tz" else 0)
                close(total, whole[name], max(map(abs, whole.values())) + max(size))
            close(r[f"{joint}_tz"], 0, max(map(abs, whole.values())))
        for k in range(6):
            names = (f"bridge{k + 1}", f"switches{k + 1}", f"choke{k + 1}")
            flows = [r[name] for name in (*names, f"motor{k + 1}.electrical")]
            close(flows, s.v[6 + k] * np.array([-1, 1, 1, 1]))
        close(y["drawn"], s.u @ s.v[6:], np.abs(s.u) @ np.abs(s.v[6:]))
        tip = py.outputs(p, s.q, s.v[:6])
        close([y["tip_x"], y["tip_y"], y["tip_z"]], tip, np.ones(3))


# ---- the arm of an excavator

BODIES = ("boom", "stick", "bucket")


def turned(angle: Any) -> Any:
    """A quarter turn's matrix by an angle up: columns are where a body's x and z point."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


@dataclass
class Arm:
    """The excavator's arm in its plane, x forward and z up; angles may be complex."""

    p: dict[str, float]
    q: Any

    def place(self, body: int, *at: float) -> Any:
        """Where a point of a body is."""
        p, angle, found = self.p, 0, np.array([0.1, 1.9])
        for k, length in enumerate((p["L_boom"], p["L_stick"], 0)):
            angle = angle + self.q[k]
            if k == body:
                return found + turned(angle) @ np.array(at)
            found = found + turned(angle) @ np.array([length, 0])
        raise AssertionError(body)

    def lengths(self) -> list[Any]:
        """Of the three cylinders, pin to pin."""
        arms = (
            self.place(0, 2.5, 0.8) - np.array([0.75, 1.4]),
            self.place(1, -0.75, 0.3) - self.place(0, 2.9, 1.25),
            self.place(2, -0.05, 0.45) - self.place(1, 0.1, 0.65),
        )
        return [np.sqrt(x @ x) for x in arms]

    def slope(self, of: Callable[[Arm], Any]) -> Array:
        """Derivatives of a quantity by the angles, by a complex step."""
        steps = STEP * 1j * np.eye(3)
        found = [np.imag(of(Arm(self.p, self.q + step))) / STEP for step in steps]
        return np.moveaxis(np.array(found), 0, -1)

    def masses(self) -> list[tuple[float, float, int, tuple[float, float]]]:
        """Of everything rigid: mass, central inertia, body, mass centre."""
        p = self.p
        return [
            (p["m_boom"], 4200, 0, (2.7, 0.55)),
            (p["m_stick"], 900, 1, (0.9, 0.15)),
            (p["m_bucket"], 250, 2, (0.6, 0.25)),
            (p["payload"], 0, 2, (0.7, 0.45)),
        ]

    def equations(self, v: Array) -> tuple[Array, Array]:
        """M and h with gravity, from the velocities of the mass centres: h = Σ m Jᵀ (J̇ v + g)."""
        M, h = np.zeros((3, 3)), np.zeros(3)
        for mass, inertia, body, at in self.masses():
            J = self.slope(lambda arm, body=body, at=at: arm.place(body, *at))
            turning = (np.arange(3) <= body).astype(float)
            M += mass * J.T @ J + inertia * np.outer(turning, turning)
            h += mass * J.T @ (self.centrifugal(v, body, at) + np.array([0, self.p["g"]]))
        return M, h

    def centrifugal(self, v: Array, body: int, at: tuple[float, float]) -> Array:
        """A point's acceleration at v̇ = 0: towards each hinge by the square of the rate of turning."""
        p = self.p
        links = [*((p["L_boom"], 0.0), (p["L_stick"], 0.0))[:body], at]
        angles, rates = np.cumsum(self.q), np.cumsum(v)
        parts = [
            -(rates[k] ** 2) * (turned(angles[k]) @ np.array(link)) for k, link in enumerate(links)
        ]
        return np.sum(parts, axis=0)


def edge(drop: float, width: float) -> float:
    """Flow through an orifice of coefficient 1: Torricelli's law, laminar where the pressure is small."""
    return drop / (drop * drop + width * width) ** 0.25


@dataclass
class Hydraulics:
    """What flows in the excavator at a state.

    Attributes:
        rates: of the seven pressures, in their order.
        sizes: the sums of what they are made of.
        pushes: of the three cylinders.
        friction: of their seals, against extension.
        heat: what becomes heat in valves and seals.
        relieved: what of it in the relief valve.
    """

    rates: list[float]
    sizes: list[float]
    pushes: Array
    friction: Array
    heat: float
    relieved: float

    @classmethod
    def of(cls, x: dict[str, float], speeds: Array) -> Hydraulics:
        """From parameters, inputs and pressures by name, and the rates of the cylinders' lengths."""
        line, width = x["p_line"], x["p_laminar"]
        opened = min(max((line - x["p_relief"]) / x["p_band"], 0), 1)
        relief = x["c_relief"] * opened * edge(line, width)
        relieved = heat = relief * line
        leaving, rates, sizes, pushes = [relief], [], [], []
        for name, speed in zip(BODIES, speeds, strict=True):
            opening = x[f"spool_{name}"]
            for chamber, area, sign in (
                ("bottom", x[f"A_{name}"], 1),
                ("rod", -x[f"a_{name}"], -1),
            ):
                pressure = x[f"p_{name}_{chamber}_oil"]
                feeding, emptying = max(sign * opening, 0), max(-sign * opening, 0)
                fed = x["c_spool"] * feeding * edge(line - pressure, width)
                emptied = x["c_spool"] * emptying * edge(pressure, width)
                flows = fed, -emptied, -area * speed
                capacity = x[f"V_{name}"] / x["beta"]
                rates.append(sum(flows) / capacity)
                sizes.append(sum(map(abs, flows)) / capacity)
                heat += fed * (line - pressure) + emptied * pressure
                leaving.append(fed)
                pushes.append(area * pressure)
        capacity = x["V_line"] / x["beta"]
        rates.insert(0, (x["pump_flow"] - sum(leaving)) / capacity)
        sizes.insert(0, (x["pump_flow"] + sum(map(abs, leaving))) / capacity)
        friction = x["d_seal"] * speeds + x["F_seal"] * np.tanh(speeds / x["v_seal"])
        heat += friction @ speeds
        both = np.add(pushes[::2], pushes[1::2])
        return cls(rates, sizes, both, friction, float(heat), relieved)


def test_the_excavator(find: Find) -> None:
    """Chambers by (V/β) dp/dt = flow in - A dl/dt, joints by the virtual work of pushes along lengths."""
    system = find("excavator_arm")
    for s in states(system):
        x, v = system.at(s), s.v[:3]
        arm = Arm(s.p, s.q)
        levers = arm.slope(lambda arm: np.array(arm.lengths()))
        oil = Hydraulics.of(x, levers @ v)
        M, h = arm.equations(v)
        teeth = arm.slope(lambda arm: arm.place(2, 1.5, 0))
        soil = np.array([x["soil_x"], x["soil_z"]])
        right = levers.T @ (oil.pushes - oil.friction) + teeth.T @ soil - h
        a = system("forward_dynamics", s)
        parts = np.abs(levers.T) @ np.abs(oil.pushes) + np.abs(teeth.T @ soil) + np.abs(h)
        close(a[:3], np.linalg.solve(M, right), np.abs(np.linalg.inv(M)) @ parts)
        close(a[3:], oil.rates, oil.sizes)
        y = system.named("outputs", s)
        expected = [*arm.place(2, 1.5, 0), *arm.lengths(), *oil.pushes]
        expected += [x["pump_flow"] * x["p_line"], oil.relieved]
        metres, others = np.full(5, 10.0), np.full(5, 1e5)
        close(list(y.values()), expected, np.abs(expected) + np.concatenate((metres, others)))


def test_cylinders_of_the_excavator_push_the_way_their_spools_say(find: Find) -> None:
    """Raise, in and curl lengthen the cylinders, all over the arm's reach."""
    system = find("excavator_arm")
    for s in states(system):
        levers = Arm(s.p, s.q).slope(lambda arm: np.array(arm.lengths()))
        assert levers[0, 0] > 0.2
        assert levers[1, 1] < -0.2
        assert levers[2, 2] < -0.1


# ---- what sources deliver and what becomes heat, term by term


def _cart_pole_powers(system: System, s: State) -> tuple[float, ...]:
    x = system.at(s)
    return x["voltage"] * x["i_motor"], -x["R"] * x["i_motor"] ** 2


def _arm_powers(system: System, s: State) -> tuple[float, ...]:
    d, v, i = Drives.of(s.p), s.v[:6], s.v[6:]
    return float(s.u @ i), -float(d.R @ i**2), -float((d.n**2 * d.b) @ v**2)


def _magnet_powers(system: System, s: State) -> tuple[float, ...]:
    x = system.at(s)
    return x["voltage"] * x["i_magnet"], -x["R"] * x["i_magnet"] ** 2


def _microphone_powers(system: System, s: State) -> tuple[float, ...]:
    x = system.at(s)
    current = (x["V"] - x["q_capsule"] * x["gap"] / (x["eps"] * x["A"])) / x["R"]
    sound = x["pressure"] * x["A"] * x["gap_dot"]
    return x["V"] * current, -x["R"] * current**2, sound, -x["b"] * x["gap_dot"] ** 2


def _excavator_powers(system: System, s: State) -> tuple[float, ...]:
    x, arm = system.at(s), Arm(s.p, s.q)
    speeds = arm.slope(lambda arm: np.array(arm.lengths())) @ s.v[:3]
    teeth = arm.slope(lambda arm: arm.place(2, 1.5, 0)) @ s.v[:3]
    soil = x["soil_x"] * teeth[0] + x["soil_z"] * teeth[1]
    return x["pump_flow"] * x["p_line"], float(soil), -Hydraulics.of(x, speeds).heat


POWERS: dict[str, Callable[[System, State], tuple[float, ...]]] = {
    "cart_pole_motor": _cart_pole_powers,
    "arm_with_drives": _arm_powers,
    "magnetic_levitation": _magnet_powers,
    "condenser_microphone": _microphone_powers,
    "excavator_arm": _excavator_powers,
}
