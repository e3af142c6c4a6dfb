"""Closed systems of the examples, emitted as C, compiled, and integrated with SciPy's DOP853."""

from __future__ import annotations

import functools
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from compiled import Compiled
from emitted import load
from scipy.integrate import solve_ivp

import linegraph as lg
from linegraph import modelfile
from linegraph.emission import render

EXAMPLES = Path(__file__).parent.parent / "examples"


class System:
    """An example: its derivation, its emitted Python and its compiled C.

    Attributes:
        py: the emitted Python module, for names and sizes.
    """

    def __init__(self, model: lg.Model, folder: Path) -> None:
        """Emit with the parameters folded, and the power audit."""
        self.model = model
        self.derivation = lg.derive(model)
        self.name = model.name
        files = render(model, folded=True, functions=("power",))
        self.py = load(files, self.name, folder / "py")
        self.c = Compiled(files, self.name, folder / "c", flags=("-O2", "-ffp-contract=off"))
        self.head = [0.0] if model.depends_on_time else []

    def call(self, function: str, *arguments: Any, out: Any, t: float = 0.0) -> Any:
        """A function of the emitted C."""
        head = [t] * len(self.head)
        return self.c.call(function, *head, *arguments, out=out)

    @property
    def start(self) -> np.ndarray:
        """A position that closes all loops."""
        return np.array(self.derivation.assembled.q)

    def project(self, q: Any, v: Any, t: float = 0.0) -> Any:
        """A state on the constraints."""
        py = self.py
        if py.NC == 0:
            return np.array(q, float), np.array(v, float)
        return self.call("project", q, v, out=[(py.NQ,), (py.NV,)], t=t)

    def accelerate(self, q: Any, v: Any, u: Any, t: float = 0.0) -> Any:
        """v̇ and λ."""
        py = self.py
        return self.call("forward_dynamics", q, v, u, out=[(py.NV,), (py.NC,)], t=t)

    def rates(self, q: Any, v: Any) -> Any:
        """q̇."""
        (found,) = [self.call("coordinate_rates", q, v, out=[(self.py.NQ,)])]
        return np.ravel(found)

    def energy(self, q: Any, v: Any, t: float = 0.0) -> float:
        """Kinetic and potential energy together."""
        return float(np.sum(self.call("energy", q, v, out=[(2,)], t=t)))

    def run(
        self, q: Any, v: Any, u: Any, end: float, tolerance: float = 1e-12, pieces: int = 1
    ) -> tuple[np.ndarray, np.ndarray]:
        """The state at time `end`, projected onto the constraints after each of so many pieces."""
        q, v = np.array(q, float), np.array(v, float)
        nq = len(q)

        def slope(t: float, x: np.ndarray) -> np.ndarray:
            a, _ = self.accelerate(x[:nq], x[nq:], u, t)
            return np.concatenate([self.rates(x[:nq], x[nq:]), a])

        times = np.linspace(0.0, end, pieces + 1)
        for begin, stop in zip(times[:-1], times[1:], strict=True):
            done = solve_ivp(
                slope,
                (begin, stop),
                np.concatenate([q, v]),
                method="DOP853",
                rtol=tolerance,
                atol=tolerance,
            )
            assert done.success, done.message
            q, v = done.y[:nq, -1], done.y[nq:, -1]
            if pieces > 1:
                q, v = self.project(q, v, stop)
        return q, v


@functools.cache
def system(name: str) -> System:
    """An example by name, emitted and compiled once."""
    folder = Path(tempfile.mkdtemp(prefix=f"linegraph-{name}-"))
    return System(modelfile.read(EXAMPLES / name / f"{name}.toml"), folder)
