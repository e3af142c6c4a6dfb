"""linegraph itself: what it emits, as libraries for the harness, and what emitting costs."""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING

from calls import FUNCTIONS, Call, Layout, Sizes, compile_seconds, compiled, folder, spent
from environment import run
from operations import operations

if TYPE_CHECKING:
    from pathlib import Path

    from robots import Robot

BATCH = 1024
ARGUMENTS = {
    "equations": "x, x + {nq}, y, y + {nv} * {nv}",
    "inverse_dynamics": "x, x + {nq}, x + {nq} + {nv}, y",
    "forward_dynamics": "x, x + {nq}, x + {nq} + {nv}, y",
}
GLUE = """#include "{name}.h"
void call(void *self, const double *x, double *y);
void call(void *self, const double *x, double *y)
{{
    (void)self;
    {body}
}}
"""
ALONE = """for (int k = 0; k < {n}; ++k) {{
        {name}_equations(x + k * {nq}, v + k * {nv}, M + k * {nv} * {nv}, h + k * {nv});
    }}"""
TOGETHER = "{name}_equations_batch({n}, x, v, M, h);"
POINTERS = "const double *v = x + {n} * {nq}; double *M = y, *h = y + {n} * {nv} * {nv};"
# CPU time after the interpreter has started, importing linegraph included
INSIDE = (
    "import sys, time; start = time.process_time(); from linegraph.cli.main import main; "
    "main(sys.argv[1:], standalone_mode=False); print(time.process_time() - start)"
)


@dataclass(frozen=True)
class Emitted:
    """What linegraph has written for a robot.

    Attributes:
        name: prefix of functions and files.
        folder: where they are.
        joints: names of the joints of one freedom, in order.
        sizes: how many coordinates there are.
    """

    name: str
    folder: Path
    joints: tuple[str, ...]
    sizes: Sizes

    @property
    def source(self) -> str:
        """The C file."""
        return (self.folder / f"{self.name}.c").read_text()

    @property
    def layout(self) -> Layout:
        """Its own order."""
        return Layout(tuple(range(len(self.joints))), self.sizes.nv - len(self.joints))


def command(robot: Robot, out: Path, *extra: str) -> list[str]:
    """Words of the command line, without the program."""
    words = ["emit", str(robot.urdf), "--base", robot.base, "--name", robot.name]
    return [*words, "--lang", "c", "--out", str(out), *extra]


def emit(robot: Robot, variant: str = "plain", *extra: str) -> Emitted:
    """The C files of a robot."""
    out = folder("linegraph", robot.name, variant)
    run([sys.executable, "-m", "linegraph", *command(robot, out, *extra)])
    header = (out / f"{robot.name}.h").read_text()
    size = {
        letter: int(re.search(rf"_N{letter} (\d+)", header)[1])  # type: ignore[index]
        for letter in "QVU"
    }
    names = re.findall(
        r'"([^"]*)"',
        re.search(r"_v_names\[.*?\{(.*?)\};", (out / f"{robot.name}.c").read_text(), re.DOTALL)[1],
    )
    joints = tuple(names[6 if robot.floating else 0 :])
    return Emitted(robot.name, out, joints, Sizes(size["Q"], size["V"], size["U"]))


def calls(robot: Robot, function: str, runs: int) -> list[Call]:
    """The function as emitted, and with `--trig inline`."""
    emitted = emit(robot, function, "--only", function)
    found = [_call("linegraph", emitted, function)]
    found[0].figures |= {"operations": counted(emitted), **whole(emitted, runs)}
    inline = emit(robot, f"{function}_inline", "--only", function, "--trig", "inline")
    return [*found, _call("linegraph, --trig inline", inline, function)]


def batches(robot: Robot) -> list[Call]:
    """Many states one by one and together."""
    emitted = emit(robot, "batch", "--only", "equations", "--batch")
    sizes = {"n": BATCH, "nq": emitted.sizes.nq, "nv": emitted.sizes.nv, "name": emitted.name}
    found = []
    for peer, function, body in (
        (f"{BATCH} states one by one", "equations", ALONE),
        ("in a batch", "equations_batch", TOGETHER),
    ):
        text = (POINTERS + body).format(**sizes)
        call = _call(f"linegraph, {peer}", emitted, function, text)
        call.function = "equations"
        call.states = BATCH
        call.figures["states"] = BATCH
        found.append(call)
    return found


def _call(peer: str, emitted: Emitted, function: str, body: str = "") -> Call:
    sizes = {"nq": emitted.sizes.nq, "nv": emitted.sizes.nv}
    body = body or f"{emitted.name}_{function}({ARGUMENTS[function].format(**sizes)});"
    slug = re.sub(r"\W+", "_", peer)
    glue = emitted.folder / f"{slug}_{function}_call.c"
    name = emitted.name
    glue.write_text(GLUE.format(name=name, body=body))
    source = emitted.folder / f"{name}.c"
    library, for_valgrind = compiled(f"{slug}_{function}", [glue, source], emitted.folder)
    return Call(peer, function, library, for_valgrind, emitted.layout)


def counted(emitted: Emitted) -> int:
    """Operations of all functions together; a sign costs nothing."""
    return sum(operations(emitted.source, signs=False).values())


def generation(robot: Robot, functions: tuple[str, ...]) -> dict[str, float]:
    """What emitting functions as C costs, all if none are named: with and without the interpreter's start."""
    extra = [word for function in functions for word in ("--only", function)]
    words = command(robot, folder("linegraph", robot.name, "timed"), *extra)
    cpu, memory, _ = spent([sys.executable, "-m", "linegraph", *words])
    _, _, printed = spent([sys.executable, "-c", INSIDE, *words])
    inside = float(printed.splitlines()[-1])
    return {"process": cpu, "inside": inside, "MiB": memory}


def whole(emitted: Emitted, runs: int) -> dict[str, float]:
    """Bytes and compile time of the C file."""
    path = emitted.folder / f"{emitted.name}.c"
    return {"bytes": path.stat().st_size, "compile_seconds": compile_seconds(path, runs)}


assert set(ARGUMENTS) == set(FUNCTIONS)
