"""Functions of different peers for the same robot: whether they agree, how long they take, what they execute.

Every function is a shared library of a common form, which `harness.c` describes. The order of coordinates
is linegraph's; a `Layout` turns states into a peer's order, and results back.
"""

from __future__ import annotations

import ctypes
import re
import shutil
import statistics
import subprocess
from dataclasses import dataclass, field
from functools import cache, partial
from typing import TYPE_CHECKING

import numpy as np
from environment import BUILD, OPTIMISED, VALGRIND, harness, run

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

FUNCTIONS = ("equations", "inverse_dynamics", "forward_dynamics")
FIVE = ("mass_matrix", "bias", *FUNCTIONS)
"""What both generators write."""
STATES = 16
TOLERANCE = 1e-9
LONG = 2.0
"""CPU seconds of compiling after which once more tells nothing new."""


@dataclass(frozen=True)
class Layout:
    """The order of a peer's coordinates: a floating base first, then joints of one freedom.

    Attributes:
        order: for each of the peer's joints, its place among linegraph's.
        free: 6 if the base floats, else 0.
    """

    order: tuple[int, ...]
    free: int

    @classmethod
    def of(cls, ours: Sequence[str], theirs: Sequence[str], free: int) -> Layout:
        """By the names of the joints."""
        return cls(tuple(ours.index(name) for name in theirs), free)

    @property
    def velocities(self) -> list[int]:
        """Where each of the peer's velocities stands in linegraph's."""
        return [*range(self.free), *(self.free + place for place in self.order)]

    @property
    def positions(self) -> list[int]:
        """The same of positions; a free joint has one more."""
        first = self.free and self.free + 1
        return [*range(first), *(first + place for place in self.order)]

    def arranged(self, function: str, q: Array, v: Array, w: Array) -> Array:
        """The peer's input; w is an acceleration, or the efforts of the joints."""
        last = {"equations": [], "forward_dynamics": list(self.order)}.get(
            function, self.velocities
        )
        return np.concatenate((q[self.positions], v[self.velocities], w[last]))

    def restored(self, function: str, y: Array, q: Array, v: Array) -> Array:
        """The output of linegraph: M, then h, or a vector."""
        places = self.velocities
        n = len(places)
        vector = np.empty(n)
        vector[places] = y[-n:]
        if function != "equations":
            return vector
        M = np.empty((n, n))
        M[np.ix_(places, places)] = y[:-n].reshape(n, n)
        return np.concatenate((M.ravel(), vector))


@dataclass
class Call:
    """One function of one peer.

    Attributes:
        peer: what its row is called.
        function: one of `FUNCTIONS`.
        library: compiled as the user would.
        counted: compiles the same without what valgrind does not know.
        options: what its setup takes.
        layout: the peer's order of coordinates.
        figures: what is known of it: operations, bytes of C, seconds of compiling, ...
        states: so many states in one call.
        tolerance: how far its results may be from those of linegraph.
    """

    peer: str
    function: str
    library: Path
    counted: Callable[[], Path]
    layout: Layout
    options: str = "-"
    figures: dict[str, float] = field(default_factory=dict)
    states: int = 1
    tolerance: float = TOLERANCE

    def results(self, x: Array, size: int) -> Array:
        """What the library computes from an input."""
        library = ctypes.CDLL(str(self.library))
        vector = ctypes.POINTER(ctypes.c_double)
        self_ = ctypes.c_void_p(None)
        if hasattr(library, "setup"):
            library.setup.restype = ctypes.c_void_p
            self_ = ctypes.c_void_p(library.setup(self.options.encode()))
        x, y = np.ascontiguousarray(x), np.zeros(size)
        library.call(self_, x.ctypes.data_as(vector), y.ctypes.data_as(vector))
        if hasattr(library, "fetch"):
            library.fetch(self_, y.ctypes.data_as(vector))
        return y


@dataclass(frozen=True)
class Sizes:
    """How many positions, velocities and driven joints a robot has."""

    nq: int
    nv: int
    nu: int

    def inputs(self, function: str) -> int:
        """Doubles that a function reads."""
        last = {"equations": 0, "inverse_dynamics": self.nv, "forward_dynamics": self.nu}
        return self.nq + self.nv + last[function]

    def outputs(self, function: str) -> int:
        """Doubles that a function writes, M dense."""
        return self.nv * (self.nv + 1) if function == "equations" else self.nv

    def states(self, function: str, count: int = STATES) -> list[tuple[Array, Array, Array]]:
        """Random ones, always the same; of a floating base with a normalised quaternion."""
        rng = np.random.default_rng(len(function))
        found = []
        for _ in range(count):
            q, v = rng.uniform(-2, 2, self.nq), rng.uniform(-2, 2, self.nv)
            if self.nq > self.nv:
                q[3:7] /= np.linalg.norm(q[3:7])
            found.append((q, v, rng.uniform(-5, 5, self.nv)))
        return found


def compiled(name: str, sources: Sequence[Path], include: Path) -> tuple[Path, Callable[[], Path]]:
    """A shared library, and how to make the same for valgrind."""

    def made(suffix: str, *extra: str) -> Path:
        path = include / f"{name}{suffix}.so"
        command = [*OPTIMISED, *extra, "-w", "-fPIC", "-shared", "-Wl,-Bsymbolic", f"-I{include}"]
        run([*command, *map(str, sources), "-lm", "-o", str(path)])
        return path

    return made(""), partial(made, "-counted", *VALGRIND)


def compile_seconds(source: Path, runs: int) -> float:
    """Median CPU seconds of compiling one file; what takes long is not compiled as often."""
    command = [*OPTIMISED, "-w", "-c", str(source), "-o", str(source.with_suffix(".o"))]
    samples: list[float] = []
    while len(samples) < runs and sum(samples) < LONG:
        samples.append(spent(command)[0])
    return statistics.median(samples)


def spent(command: Sequence[str]) -> tuple[float, float, str]:
    """CPU seconds and peak memory (MiB) of a process, and what it prints."""
    *lines, last = run([str(harness()), "spend", *command]).splitlines()
    cpu, memory = map(float, last.split())
    return cpu, memory, "\n".join(lines)


def verify(calls: Sequence[Call], sizes: Sizes) -> dict[str, float]:
    """The largest relative difference of each call from the first, at random states.

    Each relative to the largest entry of M, or of a vector. What is beyond its tolerance ends the benchmark.
    """
    single = [call for call in calls if call.states == 1]
    worst: dict[str, float] = {}
    if not single:
        return worst
    first, *others = single
    for q, v, w in sizes.states(first.function, 5):
        size = sizes.outputs(first.function)
        inputs = [call.layout.arranged(call.function, q, v, w) for call in (first, *others)]
        expected = first.results(inputs[0], size)
        for call, x in zip(others, inputs[1:], strict=True):
            got = call.layout.restored(call.function, call.results(x, size), q, v)
            worst[call.peer] = max(worst.get(call.peer, 0.0), _difference(got, expected, sizes.nv))
    for call in others:
        if not worst[call.peer] < call.tolerance:
            text = f"{call.function}: {call.peer} and {first.peer} differ by {worst[call.peer]:.1e}"
            raise SystemExit(text)
    return worst


def verify_batches(calls: Sequence[Call], sizes: Sizes) -> None:
    """The same of calls that take many states: their results must be those of the first such call."""
    many = [call for call in calls if call.states > 1]
    if not many:
        return
    size = many[0].states * sizes.outputs(many[0].function)
    expected, *others = (call.results(_inputs(call, sizes), size) for call in many)
    for call, got in zip(many[1:], others, strict=True):
        if not np.abs(got - expected).max() < TOLERANCE * np.abs(expected).max():
            raise SystemExit(f"{call.peer} and {many[0].peer} differ")


def _difference(got: Array, expected: Array, nv: int) -> float:
    """The worst of the parts: the vector at the end, and the matrix before it if there is one."""
    parts = [slice(-nv, None)] + [slice(0, -nv)] * (len(expected) > nv)
    return max(
        float(np.abs(got[part] - expected[part]).max() / np.abs(expected[part]).max())
        for part in parts
    )


def time_calls(
    calls: Sequence[Call], sizes: Sizes, processes: int, rounds: int, milliseconds: float
) -> None:
    """Add the median nanoseconds per state, and the quartiles, to the figures of each call.

    Where code comes to lie decides what fits in a processor's caches, up to a factor of two: so processes
    are many, each with addresses of its own, and the median is that of all their rounds.
    """
    words = [word for call in calls for word in _words(call, sizes, call.library)]
    samples: list[list[float]] = [[] for _ in calls]
    for _ in range(processes):
        printed = run([str(harness()), "time", str(rounds), str(milliseconds), *words])
        for call, found, line in zip(calls, samples, printed.splitlines(), strict=True):
            found += [float(word) / call.states for word in line.split()]
    for call, found in zip(calls, samples, strict=True):
        low, middle, high = statistics.quantiles(found, n=4)
        call.figures |= {"ns": middle, "ns_low": low, "ns_high": high}


def count_instructions(calls: Sequence[Call], sizes: Sizes) -> None:
    """Add the instructions per state: those of many calls less those of half as many."""
    if shutil.which("valgrind") is None:
        return
    for call in calls:
        many = max(2 * STATES // call.states, 2)
        library = call.counted()
        counts = [_executed(call, library, sizes, number) for number in (many, 2 * many)]
        call.figures["instructions"] = (counts[1] - counts[0]) / (many * call.states)


def _executed(call: Call, library: Path, sizes: Sizes, number: int) -> int:
    tool = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]
    words = _words(call, sizes, library)
    command = [*tool, str(harness()), "count", str(number), *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    found = re.search(r"I\s+refs:\s+([\d,]+)", done.stderr)
    if done.returncode or not found:
        raise SystemExit(f"failed: {' '.join(command)}\n{done.stderr[-2000:]}")
    return int(found[1].replace(",", ""))


def _words(call: Call, sizes: Sizes, library: Path) -> list[str]:
    """How the harness is told of a call."""
    file = library.with_suffix(f".{_slug(call.peer)}.{call.function}.bin")
    _inputs(call, sizes).tofile(file)
    nx = call.states * sizes.inputs(call.function)
    ny = call.states * sizes.outputs(call.function)
    return [str(file), str(library), call.options, str(nx), str(ny)]


def _inputs(call: Call, sizes: Sizes) -> Array:
    """Random states as the call takes them: one after the other, or all positions, then all velocities."""
    function = call.function
    if call.states == 1:
        sets = sizes.states(function)
        return np.concatenate([call.layout.arranged(function, *state) for state in sets])
    parts = zip(*sizes.states(function, call.states), strict=True)
    return np.concatenate([np.concatenate(part) for part in list(parts)[:2]])


@cache
def _slug(text: str) -> str:
    return re.sub(r"\W+", "_", text)


def folder(*parts: str) -> Path:
    """A folder for what is generated, made if need be."""
    path = BUILD.joinpath(*parts)
    path.mkdir(parents=True, exist_ok=True)
    return path
