"""What a mutant that golden vectors do not notice does elsewhere: nothing, less than rounding, or something.

The mutated code runs beside the original one at hundreds of further states: others than those of the
golden vectors, legal ones like these, and corners (nothing moves, nothing acts, one velocity alone, inputs
far beyond what golden vectors draw). Statuses and all results are compared.
"""

from __future__ import annotations

import contextlib
import ctypes
import random
import re
import subprocess
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from support import mutants

import codegen
from linegraph import derive
from linegraph.errors import ModelError
from linegraph.ir.golden_vectors import CONSTANTS, RETURNED
from linegraph.ir.program import Routine
from linegraph.programs.frame_names import named_frames
from linegraph.programs.register import OF_FRAMES, PROGRAMS, module_of
from linegraph.programs.request import Request
from linegraph.verification import golden
from linegraph.verification.golden import states as written
from linegraph.verification.golden.beside import beside
from linegraph.verification.golden.draws import Drawing
from linegraph.verification.golden.point import Kept
from linegraph.verification.golden.references import references

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from linegraph import Model
    from linegraph.derivation import Derivation
    from linegraph.ir.golden_vectors import Vectors
    from linegraph.ir.program import Module
    from linegraph.kinematics.frame_trees import NamedFrame
    from linegraph.verification.golden.point import Point

    Array = Any

NAME = "mutated"
"""What every module is called."""

EQUIVALENT, ROUNDING = 1e-15, 1e-12
"""Differences up to these parts of the terms are none, and below rounding."""

LOUD = " at loud states"
"""How the labels of results at states end where steep laws act far more than at others."""

STATUS = ".status"
"""How the labels of statuses end."""

SEEDS = 16
"""So many times ten states, and as many corners."""


@dataclass(frozen=True)
class Subject:
    """A model with all its functions, and their golden vectors.

    Attributes:
        derivation: the model.
        module: its functions, those on request and those of a frame among them.
        frames: the frame.
        vectors: golden vectors.
        files: the emitted C.
    """

    derivation: Derivation
    module: Module
    frames: Sequence[NamedFrame]
    vectors: Vectors
    files: dict[str, str]


def subject(model: Model) -> Subject:
    """All functions that a model has, and the last body's frame."""
    derivation = derive(model)
    frames = named_frames(model, list(model.bodies)[-1:])
    able = []
    for key in PROGRAMS:
        own = frames if key in (*OF_FRAMES, "kinematics") else ()
        if key in OF_FRAMES and not own:
            continue
        with contextlib.suppress(ModelError):  # it has none of the kind
            module_of(derivation, NAME, Request(only=(key,), frames=own))
            able.append(key)
    module, vectors = _compared(derivation, able, frames)
    files = codegen.render(module, "c") | codegen.render_tests(module, vectors, "c")
    return Subject(derivation, module, frames, vectors, files)


def _compared(
    derivation: Derivation, able: Sequence[str], frames: Sequence[NamedFrame]
) -> tuple[Module, Vectors]:
    """The functions and their golden vectors; without operational space where a frame cannot move so."""
    try:
        module = module_of(derivation, NAME, Request(only=able, frames=frames))
        return module, golden.vectors(derivation, module, frames=frames)
    except ModelError:
        less = [key for key in able if not key.startswith("operational")]
        if less == able:
            raise
        return _compared(derivation, less, frames)


# ---- states


def states(subject: Subject, seeds: range, *, corners: bool = True) -> Iterator[Point]:
    """Further legal states, each with its corners."""
    module, derivation = subject.module, subject.derivation
    register = references(subject.frames)
    if derivation.structure.closed:
        register = {label: beside(label, known) for label, known in register.items()}
    compared = written._compared(register, module)
    details: dict[str, Any] = {}
    for p in module.programs:
        details |= dict(p.details) if isinstance(p, Routine) else {}
    kept = Kept(*(tuple(details.get(key, ())) for key in ("s_at", "w_at", "d_at")))
    few = ("a", "h", "Lambda")
    asked = [written._asked(program, reference) for _, program, reference in compared]
    asked = [{k: made for k, made in one.items() if k in few} for one in asked]
    for seed in seeds:
        draw = random.Random(1000 + seed)
        drawing = Drawing(derivation, draw, kept, asked, varied=bool(module.parameters))
        for point in drawing.points():
            yield point
            if corners:
                yield _corner(point, draw)


def _corner(point: Point, draw: random.Random) -> Point:
    """A state with something at its end."""
    n = len(point.v)
    first = point.walk.tree.layout.mechanical
    kind = draw.randrange(5)
    if kind == 0 and not point.walk.tree.closed:
        return replace(point, v=[*(0.0 for _ in range(first)), *point.v[first:]])
    if kind == 1:
        return replace(point, u=[0.0 for _ in point.u], a=[0.0] * n)
    if kind == 2:
        far = draw.choice((10.0, 100.0))
        return replace(point, u=[far * x for x in point.u])
    if kind == 3 and not point.walk.tree.closed and first:
        one = draw.randrange(first)
        v = [x if k == one or k >= first else 0.0 for k, x in enumerate(point.v)]
        return replace(point, v=v, v_off=[3 * x for x in point.v_off])
    return replace(point, a=[10 * x for x in point.a], lam=[10 * x for x in point.lam])


# ---- the code beside itself


class Beside:
    """Emitted C with mutants in it, called from here.

    Args:
        subject: whose functions.
        chosen: the mutants.
        folder: where it is compiled.
    """

    def __init__(self, subject: Subject, chosen: Sequence[mutants.Mutant], folder: Path) -> None:
        """Compile and load."""
        self._subject = subject
        code_ = subject.files[f"{NAME}.c"]
        prefix = f"{NAME}_"
        self._reached = [
            {x.removeprefix(prefix) for x in mutants.callers(code_, one.function)} for one in chosen
        ]
        folder.mkdir(parents=True, exist_ok=True)
        files = subject.files
        header, code = f"{NAME}.h", f"{NAME}.c"
        (folder / header).write_text(files[header], encoding="ascii")
        (folder / code).write_text(mutants.schemata(files[code], chosen), encoding="ascii")
        library = folder / "beside.so"
        command = [*mutants.COMPILER, "-fPIC", "-shared", code, "-lm", "-o", str(library)]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr[:2000]
        self._library = ctypes.CDLL(str(library))
        self._which = ctypes.c_int.in_dll(self._library, "lg_mutant")
        self._programs = {p.name: p for p in subject.module.programs}
        found = re.findall(rf"^int {NAME}_(\w+)\(", files[header], re.M)
        self._fails = set(found)

    def results(
        self, which: int, point: Point, of: Sequence[int]
    ) -> Iterator[tuple[str, str, Array]]:
        """What functions return that one of the mutants `of` is in: label, key of golden vectors, numbers.

        The status is one of the results.
        """
        reached = set().union(*(self._reached[k - 1] for k in of))
        self._which.value = which
        parameters = self._parameters(point)
        for expected in self._subject.vectors.expected:
            returned: dict[str, Array] = {}
            functions = {expected.function, *(t.function for t in expected.then)}
            if not functions & reached and not (
                CONSTANTS in expected.given and "prepare" in reached
            ):
                continue
            one = (expected.function, expected.given, expected.results)
            for function, given, keys in (
                one,
                *((t.function, t.given, t.results) for t in expected.then),
            ):
                status, out = self._call(function, given, point, parameters, returned)
                yield f"{expected.label}.{function}{STATUS}", "", np.array([float(status)])
                if status:
                    break
                names = [r.name for r in self._programs[function].results]
                returned |= dict(zip(names, out, strict=True))
                for name, key, numbers in zip(names, keys, out, strict=True):
                    yield f"{expected.label}.{function}.{name}", key, numbers

    def _parameters(self, point: Point) -> Array:
        values = {x.name: float(x.value or 0.0) for x in self._subject.module.parameters}
        return np.array(list((values | dict(point.p)).values()) or [0.0])

    def _call(
        self,
        function: str,
        given: Sequence[str],
        point: Point,
        parameters: Array,
        returned: Mapping[str, Array],
    ) -> tuple[int, list[Array]]:
        program = self._programs[function]
        keys = iter(given)
        kept: list[Any] = []
        for argument in program.arguments:
            if argument.name == "p":
                kept.append(_pointer(parameters))
                continue
            key = next(keys)
            if key == CONSTANTS:
                kept.append(_pointer(self._constants(parameters)))
            elif key.startswith(RETURNED):
                kept.append(_pointer(returned[key.removeprefix(RETURNED)]))
            elif key == "t":
                kept.append(ctypes.c_double(point.t))
            else:
                kept.append(_pointer(np.array([*written._argument(point, key), 0.0])))
        out = [np.zeros(int(np.prod(r.shape)) + 1) for r in program.results]
        emitted = self._library[f"{NAME}_{function}"]
        fails = function in self._fails
        emitted.restype = ctypes.c_int if fails else None
        status = emitted(*kept, *map(_pointer, out))
        return (status if fails else 0), [x[:-1] for x in out]

    def _constants(self, parameters: Array) -> Array:
        prepare = self._programs["prepare"]
        constants = np.zeros(int(np.prod(prepare.results[0].shape)) + 1)
        emitted = self._library[f"{NAME}_prepare"]
        emitted.restype = None
        emitted(_pointer(parameters), _pointer(constants))
        return constants


def _pointer(array: Array) -> Any:
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))


def largest(
    beside: Beside, subject: Subject, points: Sequence[Point], numbers: Sequence[int]
) -> dict[int, tuple[float, str]]:
    """For each mutant the largest relative difference from the original, and where that is.

    Relative as golden vectors are: to the largest values that an entry is made of over all states, these too;
    at loud states apart from others.
    """
    sizes = {key: np.array(values.scale) for key, values in subject.vectors.values.items()}
    apart: dict[int, dict[tuple[str, str], tuple[Array, Array]]] = {k: {} for k in numbers}
    for place, point in enumerate(points):
        right = list(beside.results(0, point, numbers))
        among = LOUD * point.loud
        for label, key, x in right:
            calm = sizes.get(key or label, 0.0)
            known = sizes.get((key or label) + among, calm)
            size = np.maximum(known, np.where(np.isfinite(x), np.abs(x), 0.0))
            sizes[(key or label) + among] = size
        for number in numbers:
            others = {label: x for label, _, x in beside.results(number, point, [number])}
            for label, key, x in right:
                if label in others:  # else a status before it differs, and that counts
                    pair = (label + among, key and key + among)
                    most, where = apart[number].get(pair, (np.zeros(len(x)), np.zeros(len(x))))
                    error = _error(x, others[label])
                    apart[number][pair] = (
                        np.maximum(most, error),
                        np.where(error > most, place, where),
                    )
    return {k: _most(found, sizes) for k, found in apart.items()}


def _error(x: Array, y: Array) -> Array:
    """Differences; of what is no number originally, nothing is said."""
    with np.errstate(all="ignore"):
        error = np.abs(x - y)
    return np.where(np.isfinite(x), np.where(np.isfinite(error), error, 1e300), 0.0)


def _most(
    found: Mapping[tuple[str, str], tuple[Array, Array]], sizes: Mapping[str, Array]
) -> tuple[float, str]:
    """The largest of all differences, by its size, and whose it is."""
    worst, whose = 0.0, ""
    numbers = {pair: x for pair, x in found.items() if STATUS not in pair[0]}
    for (label, key), (error, where) in numbers.items():
        size = sizes[key or label]
        if not key:  # what golden vectors do not compare themselves: all entries alike
            size = np.full(len(error), size.max(initial=0.0))
        parts = error / np.where(size > 0, size, 1.0)
        if parts.max(initial=0.0) > worst:
            k = int(parts.argmax())
            worst, whose = float(parts[k]), f"{label}[{k}] at {int(where[k])}"
    for (label, _), (error, where) in found.items():
        if worst <= ROUNDING and STATUS in label and error[0] > 0:
            return float(error[0]), f"{label} at {int(where[0])}"
    return worst, whose


def verdict(error: float) -> str:
    """What a mutant is whose results differ by so much at most; another status differs by 1 or more."""
    if error <= EQUIVALENT:
        return "equivalent"
    return "below rounding" if error <= ROUNDING else "MISSED"


@dataclass(frozen=True)
class Outcome:
    """What became of the mutants of a model.

    Attributes:
        tried, killed: how many there were, and how many golden vectors notice.
        survivors: of each other one what it is, how large the difference is and where, and the mutant.
    """

    tried: int
    killed: int
    survivors: tuple[tuple[str, float, str, mutants.Mutant], ...]


def judged(subject: Subject, count: int, seed: int, folder: Path, seeds: int = SEEDS) -> Outcome:
    """Mutants of a model against its golden vectors; what these miss runs beside the original."""
    draw = random.Random(seed)
    chosen = mutants.mutants(subject.files[f"{NAME}.c"], draw, count)
    program = mutants.build(subject.files, NAME, chosen, folder)
    holds, told = mutants.run(program, 0)
    assert holds, told
    left = [k for k in range(1, len(chosen) + 1) if mutants.run(program, k)[0]]
    survivors = []
    if left:
        beside = Beside(subject, chosen, folder / "beside")
        points = list(states(subject, range(seeds)))
        found = largest(beside, subject, points, left)
        survivors = [(verdict(x), x, where, chosen[k - 1]) for k, (x, where) in found.items()]
    return Outcome(len(chosen), len(chosen) - len(left), tuple(survivors))
