"""Systems of the examples, emitted as C, compiled, and integrated with SciPy's DOP853."""

from __future__ import annotations

import ctypes
import functools
import itertools
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.integrate import solve_ivp
from support.compiled import Compiled, Failed
from support.emitted import load

import linegraph as lg
from linegraph.emission.emit import render
from linegraph.readers import modelfile, urdf

if TYPE_CHECKING:
    from collections.abc import Callable

    from support.compiled import Array

EXAMPLES = Path(__file__).parents[2] / "examples"
CLOSED = (
    "four_bar",
    "slider_crank",
    "andrews_squeezer",
    "bricard",
    "stewart_platform",
    "rolling_disc",
    "bicycle",
    "car_axis",
    "crane_hoist",
    "parallelograms",
)
BIG = ("stewart_platform",)
"""What a compiler optimizes for longer than the test runs."""

NAMES = {
    "across": "ACROSS_NAMES",
    "reactions": "REACTION_NAMES",
    "outputs": "OUTPUT_NAMES",
    "power": "POWER_NAMES",
}

SPREAD = 0.1


@dataclass(frozen=True)
class State:
    """A state on the constraints, with inputs, at a time."""

    q: Array
    v: Array
    u: Array
    t: float = 0.0

    def __iter__(self) -> Any:
        """What most functions take."""
        return iter((self.q, self.v, self.u))


class System:
    """An example: its derivation, its emitted Python and its compiled C.

    Attributes:
        py: the emitted Python module, for names and sizes; nothing is computed with it.
        c: the emitted C.
    """

    def __init__(self, model: lg.Model, folder: Path, optimize: str = "-O1") -> None:
        """Emit with the parameters folded, and the power audit."""
        self.model = model
        self.derivation = lg.derive(model)
        name = model.name.replace("-", "_")
        files = render(model, name=name, folded=True, functions=("power",))
        self.py = load(files, name, folder / "py")
        self.c = Compiled(files, name, folder / "c", flags=(optimize, "-ffp-contract=off"))
        self.head = [0.0] if model.depends_on_time else []
        self.nc = getattr(self.py, "NC", 0)

    def call(self, function: str, *arguments: Any, out: Any, t: float = 0.0) -> Any:
        """A function of the emitted C."""
        head = [float(t)] * len(self.head)
        return self.c.call(function, *head, *arguments, out=out)

    def named(self, function: str, *arguments: Any, t: float = 0.0) -> dict[str, float]:
        """The value of `across`, `reactions`, `outputs` or `power` by name."""
        names = getattr(self.py, NAMES[function])
        out: list[tuple[int, ...]] = [(len(names),)]
        if function == "power":
            out.append((2,))
        found = self.call(function, *arguments, out=out, t=t)
        return dict(zip(names, found[0] if function == "power" else found, strict=True))

    def at(self, name: str) -> int:
        """The place of a velocity."""
        return self.py.V_NAMES.index(name)

    def vector(self, **values: float) -> Array:
        """Velocities by name, others 0."""
        found = np.zeros(self.py.NV)
        for name, value in values.items():
            found[self.at(name)] = value
        return found

    @property
    def start(self) -> Array:
        """A position that closes all loops."""
        return np.array(self.derivation.assembled.q)

    @property
    def idle(self) -> Array:
        """Inputs that are all 0."""
        return np.zeros(self.py.NU)

    def project(self, q: Any, v: Any, t: float = 0.0) -> tuple[Array, Array]:
        """A state on the constraints."""
        if self.nc == 0:
            return self._normal(np.array(q, float)), np.array(v, float)
        return self.call("project", q, v, out=[(self.py.NQ,), (self.py.NV,)], t=t)

    def complete(self, q: Any, s: Any, w: Any, t: float = 0.0) -> tuple[Array, Array]:
        """A state from the independent coordinates and their rates."""
        return self.call("complete", q, s, w, out=[(self.py.NQ,), (self.py.NV,)], t=t)

    def reduced(self, q: Any, v: Any) -> tuple[Array, Array]:
        """Mass matrix and bias in the independent coordinates."""
        size = self.py.NI
        return self.call("reduced_equations", q, v, out=[(size, size), (size,)])

    def accelerate(self, q: Any, v: Any, u: Any, t: float = 0.0) -> tuple[Array, Array]:
        """v̇ and λ."""
        out = [(self.py.NV,)] + [(self.nc,)] * (self.nc > 0)
        found = self.call("forward_dynamics", q, v, u, out=out, t=t)
        return found if self.nc else (found, np.zeros(0))

    def energy(self, q: Any, v: Any, t: float = 0.0) -> float:
        """Kinetic and potential energy together."""
        return float(np.sum(self.call("energy", q, v, out=[(2,)], t=t)))

    def random(self, rng: np.random.Generator, spread: float = SPREAD) -> State:
        """A state near the start, on the constraints, with inputs, at some time."""
        py = self.py
        start = self.start if self.nc else np.zeros(py.NQ)
        for _ in range(5):
            t = float(rng.uniform(0, 3)) if self.head else 0.0
            q = self._normal(start + rng.uniform(-spread, spread, py.NQ))
            try:
                q, v = self.project(q, rng.normal(size=py.NV), t)
            except Failed:
                continue
            return State(q, v, rng.normal(size=py.NU), t)
        raise AssertionError("no state of five could be projected onto the constraints")

    def run(
        self, q: Any, v: Any, u: Any, end: float, tolerance: float = 1e-12, pieces: int = 1
    ) -> tuple[Array, Array]:
        """The state at time `end`, projected onto the constraints after each of so many pieces."""
        q, v = np.array(q, float), np.array(v, float)
        slope = self._slope(u)
        times = np.linspace(0.0, end, pieces + 1)
        for begin, stop in itertools.pairwise(times):
            done = solve_ivp(
                slope,
                (begin, stop),
                np.concatenate([q, v]),
                method="DOP853",
                rtol=tolerance,
                atol=tolerance,
            )
            assert done.success, done.message
            q, v = np.split(done.y[:, -1], [len(q)])
            if pieces > 1:
                q, v = self.project(q, v, stop)
        return q, v

    def _slope(self, u: Any) -> Callable[[float, Array], Array]:
        """q̇ and v̇ by the emitted C, without `call`'s guards: an integrator asks 1e5 times."""
        py, library, name = self.py, self.c.library, self.c.name
        q, v, inputs = np.zeros(py.NQ), np.zeros(py.NV), np.array([*u, 0.0], float)
        rates, a, multipliers = np.zeros(py.NQ), np.zeros(py.NV), np.zeros(self.nc + 1)
        accelerate = library[f"{name}_forward_dynamics"]
        advance = library[f"{name}_coordinate_rates"]
        own = [ctypes.c_void_p(x.ctypes.data) for x in (q, v, inputs, a, multipliers)]
        own = own if self.nc else own[:-1]
        turning = [ctypes.c_void_p(x.ctypes.data) for x in (q, v, rates)]
        accelerate.restype = ctypes.c_int
        advance.restype = None
        fails = f"int {name}_forward_dynamics(" in self.c.header

        def slope(t: float, x: Array) -> Array:
            head = [ctypes.c_double(t)] * len(self.head)
            q[:], v[:] = x[: py.NQ], x[py.NQ :]
            status = accelerate(*head, *own)
            assert not (fails and status), f"forward_dynamics returned {status} at {t}"
            advance(*head, *turning)
            assert inputs.size + multipliers.size  # the pointers are into these
            return np.concatenate([rates, a])

        return slope

    def _normal(self, q: Array) -> Array:
        """Quaternions of length 1."""
        for first, name in enumerate(self.py.Q_NAMES):
            if name.endswith("_qx"):
                q[first : first + 4] /= np.linalg.norm(q[first : first + 4]) or 1.0
        return q


def folder_for(name: str) -> Path:
    """A new folder."""
    return Path(tempfile.mkdtemp(prefix=f"linegraph-{name}-"))


def read(name: str) -> lg.Model:
    """The model of an example, from its model file."""
    return modelfile.read(EXAMPLES / name / f"{name}.toml")


def changed(model: lg.Model, **values: float) -> lg.Model:
    """A model with other values of some parameters."""
    for name, value in values.items():
        model.parameters[name] = replace(model.parameters[name], value=value)
    return model


def accelerating(model: lg.Model) -> lg.Model:
    """A model that returns every body's acceleration, in ground axes, among its outputs."""
    for body in model.bodies:
        for c in "xyz":
            model.output(f"{body}_linear_{c}", f"acceleration({body}.mass_center).{c}")
            model.output(f"{body}_angular_{c}", f"angular_acceleration({body}).{c}")
    return model


@functools.cache
def system(name: str) -> System:
    """An example by name, emitted and compiled once."""
    optimize = "-O0" if name in BIG else "-O1"
    return System(accelerating(read(name)), folder_for(name), optimize)


@functools.cache
def with_values(name: str, *values: tuple[str, float]) -> System:
    """An example with other values of some parameters."""
    optimize = "-O0" if name in BIG else "-O1"
    return System(changed(read(name), **dict(values)), folder_for(name), optimize)


@functools.cache
def robot(name: str, base: str) -> System:
    """An example that is a URDF file."""
    (path,) = (EXAMPLES / name).glob("*.urdf")
    return System(urdf.read(path, base=base), folder_for(name), "-O0")


# ---- the same mechanisms in other coordinates

PLAIN = {
    "rolling_disc": """
[free.motion]
between = ["ground", "disc"]
start = [0, 0, 0.2, 0, 0, 0, 1]
""",
    "bicycle": """
[free.frame]
between = ["ground", "rear"]
""",
}
"""What may stand for a compound joint, which is a branch of every tree, for absolute coordinates."""

TREES: dict[str, tuple[str, ...]] = {
    "four_bar": ("motor", "elbow", "knee"),
    "slider_crank": ("shaft", "bore", "small_end"),
    "andrews_squeezer": ("beta", "Theta", "E3", "E4", "Phi", "E6", "Omega"),
    "bricard": ("hinge1", "hinge2", "hinge3", "hinge4", "hinge5"),
    "stewart_platform": (
        "platform/inertia",
        *(f"{joint}{k}" for joint in ("ball", "leg") for k in range(1, 7)),
    ),
    "bicycle": ("front/inertia", "rear_spin", "front_spin"),
    "car_axis": ("left/inertia",),
    "crane_hoist": ("rail", "load/inertia"),
    "parallelograms": ("A0", "B0", "C1", "B1", "C2"),
}
"""Another tree than the automatic one, for all but the rolling disc, which has but one joint."""

KINDS = [
    *((name, kind) for name in CLOSED for kind in ("absolute", "absolute-angle")),
    *((name, "tree") for name in TREES),
    *((name, "plain") for name in PLAIN),
]


def reformulated(name: str, kind: str) -> lg.Model:
    """An example in other coordinates, of which the independent ones are chosen automatically."""
    if kind == "plain":
        text = (EXAMPLES / name / f"{name}.toml").read_text(encoding="utf-8")
        blocks = [PLAIN[name] if b.startswith("[compound.") else b for b in text.split("\n\n")]
        model = modelfile.parse("\n\n".join(blocks).encode(), f"{name}.toml")
        kind = "absolute"
    else:
        model = read(name)
    if kind == "tree":
        model.formulation(independent=None, tree=TREES[name])
    else:
        model.formulation(independent=None, coordinates=kind)
    return model


@functools.cache
def twin(name: str, kind: str) -> System:
    """A closed example in other coordinates, emitted and compiled once."""
    return System(accelerating(reformulated(name, kind)), folder_for(name), "-O0")
