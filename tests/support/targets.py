"""Emitted C on other machines and in other numbers: many models, and a program that calls all functions.

The program is generated from the module itself: every function is called at the same states and prints its
outputs, whatever the type of the numbers. It is compiled for this machine, where it may also call the
functions very often at drawn states, and for a Cortex-M4, which QEMU runs.
"""

from __future__ import annotations

import contextlib
import re
import shutil
import subprocess
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from agreement import test_closed_loops, test_random_networks
from numpy.typing import NDArray
from oracles import closed_systems
from support import spec_models
from systems import random_mixed, random_networks, random_trees

import codegen
import codegen.layout
from linegraph import ModelError
from linegraph.emission.emit import module_for
from linegraph.ir import rounding
from linegraph.programs.register import OF_FRAMES, ON_REQUEST
from linegraph.readers import modelfile, urdf

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph import Model
    from linegraph.ir.program import Module, Program, Routine

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
BOARD = ROOT / "tests" / "emitted" / "cortex_m4"
Array = NDArray[np.float64]

WARNINGS = (
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wconversion",
    "-Wdouble-promotion",
    "-Wshadow",
    "-Wcast-qual",
    "-Wundef",
    "-Wformat=2",
    "-Werror",
)
OF_C = ("-Wstrict-prototypes", "-Wmissing-prototypes", "-Wbad-function-cast", "-Wnested-externs")
CORTEX_M4 = ("-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard")
COMPILERS = {
    "gcc": ("gcc", "-std=c99", *OF_C),
    "clang": ("clang", "-std=c99", *OF_C),
    "g++": ("g++", "-std=c++17", "-x", "c++"),
    "arm": ("arm-none-eabi-gcc", "-std=c99", *CORTEX_M4, *OF_C),
}
EMULATOR = ("qemu-system-arm", "-M", "mps2-an386", "-nographic", "-semihosting", "-kernel")


MORE = "+"
REQUESTED = (
    "furuta",
    "four_bar",
    "bicycle",
    "cart_pole_motor",
    "panda_floating",
    "anymal_floating",
    "ship_arm",
    "tree3",
)
"""Models that are emitted with all functions on request, too, under names that end in +."""


def _file(path: Path) -> Callable[[], Model]:
    return lambda: modelfile.read(path)


def _trees() -> dict[str, Callable[[], Model]]:
    def tree(seed: int) -> Callable[[], Model]:
        rng = np.random.default_rng([seed, 77])
        return lambda: spec_models.model_of(random_trees.random_tree(rng, bodies=2 + seed % 7))

    return {f"tree{seed}": tree(seed) for seed in range(28)}


def _closed() -> dict[str, Callable[[], Model]]:
    def loop(seed: int) -> Callable[[], Model]:
        return lambda: test_closed_loops.model_of(closed_systems.random_system(seed), f"loop{seed}")

    return {f"loop{seed}": loop(seed) for seed in range(14)}


NO_MODEL = ("network10",)
"""A random network that contradicts itself, which is refused."""


def _networks() -> dict[str, Callable[[], Model]]:
    def network(seed: int) -> Callable[[], Model]:
        return lambda: test_random_networks.model_of(random_networks.draw(seed))

    def mixed(seed: int) -> Callable[[], Model]:
        return lambda: random_mixed.model_of(random_mixed.random_system(seed))

    found = {
        f"network{seed}": network(seed) for seed in range(12) if f"network{seed}" not in NO_MODEL
    }
    return found | {f"mixed{seed}": mixed(seed) for seed in range(8)}


def _robots() -> dict[str, Callable[[], Model]]:
    panda, anymal = EXAMPLES / "panda" / "panda.urdf", EXAMPLES / "anymal_c" / "anymal.urdf"
    return {
        "panda": lambda: urdf.read(panda),
        "panda_symbolic": lambda: urdf.read(panda, symbolic=True),
        "panda_floating": lambda: urdf.read(panda, base="floating"),
        "anymal": lambda: urdf.read(anymal),
        "anymal_floating": lambda: urdf.read(anymal, base="floating"),
    }


def everything() -> dict[str, Callable[[], Model]]:
    """Every model by name: examples, robots, random trees, closed systems, networks."""
    examples = {path.stem: _file(path) for path in sorted(EXAMPLES.glob("*/*.toml"))}
    found = examples | _robots() | _trees() | _closed() | _networks()
    return found | {f"{name}{MORE}": found[name] for name in REQUESTED}


@cache
def module(name: str) -> Module:
    """All functions of a model, of names that end in + those on request, too; `model` in the files.

    The audit of powers is left out: its sums are rounding and nothing else.
    """
    model = everything()[name]()
    if not name.endswith(MORE):
        return module_for(model, "model")
    frames = (list(model.bodies)[-1],)
    wanted = []
    for function in sorted({*ON_REQUEST} - {"power"}):
        with contextlib.suppress(ModelError):
            module_for(model, "model", only=(function,), frames=frames * (function in OF_FRAMES))
            wanted.append(function)
    return module_for(model, "model", functions=wanted, frames=frames)


@cache
def emitted(name: str, real: str = "double") -> dict[str, str]:
    """The C files of a model."""
    return codegen.render(module(name), "c", codegen.Options(real=real))


class State(NamedTuple):
    """What functions are called with."""

    t: float
    values: Mapping[str, Array]


def size_of(program: Program | Routine, argument: str) -> int:
    """How many numbers an argument has."""
    return next(x.size or 0 for x in program.arguments if x.name == argument)


def drawn(of: Module, rng: np.random.Generator) -> State:
    """Any state, in numbers that are floats; quaternions have length 1 up to rounding."""
    values = {name: rng.uniform(-1, 1, size) for name, size in sizes_of(of).items()}
    names = [x.name for x in of.positions]
    for k, name in enumerate(names):
        if name.endswith("qx") and [x[-2:] for x in names[k : k + 4]] == ["qx", "qy", "qz", "qw"]:
            values["q"][k : k + 4] /= np.linalg.norm(values["q"][k : k + 4])
    if "x" in values and "q" in values:
        values["x"] = np.concatenate((values["q"], values["x"][len(names) :]))
    exact = {name: x.astype(np.float32).astype(float) for name, x in values.items()}
    return State(float(np.float32(rng.uniform(0, 1))), exact)


def shaken(state: State, rng: np.random.Generator) -> State:
    """A state whose numbers are off by the rounding of a float, up or down."""
    step = 2.0**-24
    values = {
        name: x + step * np.maximum(np.abs(x), 2.0**-4) * rng.choice((-1.0, 1.0), x.shape)
        for name, x in state.values.items()
    }
    return State(state.t * (1 + step * float(rng.choice((-1.0, 1.0)))), values)


def sizes_of(of: Module) -> dict[str, int]:
    """How many numbers each argument has, but p, c and t."""
    arguments = [x for program in of.programs for x in program.arguments]
    return {x.name: x.size for x in arguments if x.size is not None and x.name != "c"}


HARNESS = """
#include <stdio.h>
#include "{name}.h"

typedef {real} number;

static void show(const char *name, int status, const number *x, int n)
{{
    printf("%s %d", name, status);
    for (int i = 0; i < n; ++i) {{
        printf(" %.17e", (double)x[i]);
    }}
    printf("\\n");
}}

{body}
"""

SHOWING = """
{data}

int main(void)
{{
{prologue}
    for (int s = 0; s < {count}; ++s) {{
{calls}
    }}
    return 0;
}}
"""

DRAWING = """
static unsigned long long state = 88172645463325252ULL;

static number draw(void)
{{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (number)((double)(state >> 11) / 4503599627370496.0 - 1.0);
}}

int main(void)
{{
    number sum = 0;
{prologue}
    for (int turn = 0; turn < {count}; ++turn) {{
{calls}
    }}
    show("sum", 0, &sum, 1);
    return 0;
}}
"""


def harness(of: Module, states: Sequence[State], real: str, count: int = 0) -> str:
    """A program that shows what all functions give at some states, or calls them at `count` drawn ones."""
    sizes = sizes_of(of)
    prologue, calls, data = [], [], []
    constants = next((p for p in of.programs if p.name == "prepare"), None)
    if constants is not None:
        entries = constants.results[0].shape[0]
        prologue += [
            f"    number c[{entries}];",
            f"    {of.name}_prepare(&{of.name}_default_parameters, c);",
        ]
        if not count:
            prologue.append(f'    show("prepare", 0, c, {entries});')
    for name, size in sizes.items():
        if count:
            prologue.append(f"    number {name}[{size or 1}] = {{0}};")
            calls.append(f"        for (int i = 0; i < {size}; ++i) {{ {name}[i] = draw(); }}")
        else:
            rows = [
                ", ".join(repr(float(x)) + "F" * (real == "float") for x in s.values[name])
                for s in states
            ]
            lines = ",\n".join(f"    {{{row or '0'}}}" for row in rows)
            data.append(
                f"static const number {name}s[{len(states)}][{size or 1}] = {{\n{lines}\n}};"
            )
    times = ", ".join(repr(s.t) + "F" * (real == "float") for s in states) or "0"
    data.append(f"static const number times[{len(states) or 1}] = {{{times}}};")
    for program in of.programs:
        if program.name != "prepare":
            calls += _called(of, program, bool(count))
    body = DRAWING if count else SHOWING
    text = body.format(
        data="\n".join(data),
        prologue="\n".join(prologue),
        count=count or len(states),
        calls="\n".join(calls),
    )
    return HARNESS.format(name=of.name, real=real, body=text)


def _called(of: Module, program: Program | Routine, draws: bool) -> list[str]:
    """The lines that call a function."""
    texts = {
        "p": f"&{of.name}_default_parameters",
        "c": "c",
        "t": "(number)0.25" if draws else "times[s]",
    }
    given = [texts.get(x.name, x.name if draws else f"{x.name}s[s]") for x in program.arguments]
    lines, outputs = [], []
    for k, result in enumerate(program.results):
        size = int(np.prod(result.shape)) or 1
        lines.append(f"            number out{k}[{size}] = {{0}};")
        outputs.append((f"out{k}", size))
    call = f"{of.name}_{program.name}({', '.join([*given, *(name for name, _ in outputs)])})"
    fails = bool(codegen.failures.statuses(of)[program.name])
    lines.append(f"            const int status = {call};" if fails else f"            {call};")
    status = "status" if fails else "0"
    for name, size in outputs:
        if draws:
            lines.append(f"            if ({status} == 0) {{ sum += {name}[{size - 1}]; }}")
        else:
            lines.append(f'            show("{program.name}", {status}, {name}, {size});')
    return ["        {", *lines, "        }"]


def compiled(
    files: Mapping[str, str], folder: Path, command: Sequence[str], flags: Sequence[str] = ()
) -> Path:
    """The object file of the emitted files; the first complaint of the compiler is an error."""
    folder.mkdir(parents=True, exist_ok=True)
    for file, text in files.items():
        (folder / file).write_text(text, encoding="ascii", newline="\n")
    source = next(file for file in files if file.endswith(".c"))
    run([*command, *flags, "-c", source, "-o", "model.o"], folder)
    return folder / "model.o"


def run(command: Sequence[str], folder: Path) -> str:
    """What a command prints; it must succeed."""
    done = subprocess.run(
        command,
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        stdin=subprocess.DEVNULL,
        timeout=300,
    )
    if done.returncode:
        raise AssertionError(f"{' '.join(command)}\n{done.stdout[-2000:]}\n{done.stderr[-4000:]}")
    return done.stdout


def on_this_machine(text: str, object_file: Path, flags: Sequence[str] = ()) -> str:
    """What a harness prints, run here."""
    folder = object_file.parent
    (folder / "harness.c").write_text(text)
    run(["gcc", "-std=c99", *flags, "harness.c", object_file.name, "-lm", "-o", "harness"], folder)
    return run(["./harness"], folder)


def on_cortex_m4(text: str, object_file: Path) -> str:
    """What a harness prints, run by QEMU on a Cortex-M4."""
    folder = object_file.parent
    (folder / "harness.c").write_text(text)
    command = ["arm-none-eabi-gcc", "-std=c99", *CORTEX_M4, "--specs=rdimon.specs", "-nostartfiles"]
    command += [
        "-T",
        str(BOARD / "memory.ld"),
        str(BOARD / "start.c"),
        "harness.c",
        object_file.name,
    ]
    run([*command, "-lm", "-o", "harness.elf"], folder)
    return run([*EMULATOR, "harness.elf"], folder)


def shown(text: str) -> list[tuple[str, int, Array]]:
    """What a harness has printed: function, status and output, one after the other."""
    rows = [line.split() for line in text.splitlines()]
    return [(row[0], int(row[1]), np.array([float(x) for x in row[2:]])) for row in rows]


SHAKES = 8
"""How many states off by rounding show how much a function makes of it."""

ACCURACY = 1e-5
"""How far floats may be off, as a part of the largest entry of the output."""

ROUNDING = 2.0**-24
LOST = 30
"""How many times more than rounding of what a function is given its own may be."""


def misfits(of: Module, states: int, double: str, real: str) -> list[str]:
    """Where the results of floats are not those of doubles, as `harness` shows both.

    Args:
        of: the module.
        states: how many there were for floats; for doubles, each is followed by `SHAKES` shaken ones.
        double: what the harness for doubles has printed.
        real: what the harness for floats has printed.

    An output may be off by `ACCURACY` of its largest entry, and beyond this only where the function is badly
    conditioned at this state:

    - by `LOST` times what rounding of the state alone makes of the result of doubles: cancellation, or an
      exponential function, of numbers that are floats;
    - what solves with the mass matrix, by its condition number times rounding;
    - `project`, since it stops where a gap is none, by as much as a gap of this size makes.
    """
    every, few = ([r for r in shown(text) if r[0] != "prepare"] for text in (double, real))
    per = len(every) // (states * (1 + SHAKES))
    assert per * states == len(few) > 0
    found = []
    for state in range(states):
        rows = [every[(state * (1 + SHAKES) + k) * per :][:per] for k in range(1 + SHAKES)]
        condition = _condition(of, rows[0])
        for place, (name, status, wanted) in enumerate(rows[0]):
            _, own, value = few[state * per + place]
            around = [row[place] for row in rows[1:]]
            if bool(status) != bool(own):
                if all(bool(s) == bool(status) for _, s, _ in around):
                    found.append(f"{name}: status {own}, of doubles {status}")
                continue
            if status or not np.isfinite(wanted).all():
                continue  # neither can compute it
            size = np.abs(wanted).max(initial=0.0)
            moved = max(
                (np.abs(x - wanted).max(initial=0.0) for _, s, x in around if not s), default=0.0
            )
            factor = GAP / ROUNDING if name.startswith("project") else LOST
            allowed = ACCURACY * size + factor * moved
            if SOLVING.match(name):
                allowed += condition * ROUNDING * size
            amiss = np.abs(value - wanted).max(initial=0.0)
            if not amiss <= allowed:
                found.append(f"{name}: off by {amiss:.1e} of {size:.1e}, allowed {allowed:.1e}")
    return found


GAP = rounding.FLOAT.closed
SOLVING = re.compile(
    "forward_dynamics|linearize|.*_operational_|rhs|reactions$|drives|power|outputs"
)


def _condition(of: Module, rows: Sequence[tuple[str, int, Array]]) -> float:
    """The condition number of the mass matrix at a state, once its diagonal is made 1."""
    n = len(of.velocities)
    entries = next((x for name, _, x in rows if name == "mass_matrix"), np.ones(0))
    if len(entries) != n * n or not np.isfinite(entries).all():
        return 1.0
    M = entries.reshape(n, n)
    scale = np.sqrt(np.abs(np.diag(M)))
    if not scale.all():
        return 1.0
    return float(np.linalg.cond(M / np.outer(scale, scale)))


def missing(*tools: str) -> str:
    """Which of some programs this machine lacks, as a reason to skip; empty if none."""
    lacking = [tool for tool in tools if shutil.which(tool) is None]
    return f"not installed: {', '.join(lacking)}" if lacking else ""
