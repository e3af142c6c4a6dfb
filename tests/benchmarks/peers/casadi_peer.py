"""CasADi: Pinocchio's algorithms over its symbols, common subexpressions eliminated, written as C.

Pinocchio expresses the frames of crba and aba in one of two conventions; shown is what takes fewer
operations for the robot, which is the default one but for long chains.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

import casadi
from calls import FIVE, Call, Layout, compile_seconds, compiled, folder, spent
from environment import HERE, casadi_generator, run

if TYPE_CHECKING:
    from pathlib import Path

    from robots import Robot

FREE = (
    casadi.OP_ASSIGN,
    casadi.OP_NEG,
    casadi.OP_CONST,
    casadi.OP_INPUT,
    casadi.OP_OUTPUT,
)
"""Operation codes that cost nothing; all others are an arithmetic operation, a sine, a cosine or a root."""
CONVENTIONS = {"local": "", "world": "_world"}


@dataclass(frozen=True)
class Generated:
    """What CasADi has written for a robot.

    Attributes:
        folder: where it is.
        report: what the generator prints.
    """

    folder: Path
    report: dict[str, Any]

    @property
    def joints(self) -> list[str]:
        """Names of the joints, in order, without the free one."""
        return [name for name in self.report["joints"] if name != "root"]

    def operations(self, name: str) -> int:
        """Of a function."""
        codes = self.report["functions"][name]["codes"]
        return sum(count for code, count in codes.items() if int(code) not in FREE)


@cache
def generated(robot: Robot) -> Generated:
    """Every function in both conventions."""
    out = folder("casadi", robot.name)
    names = [f"{name}{mark}" for name in _variants() for mark in CONVENTIONS.values()]
    words = [str(robot.urdf), robot.base, str(out), *names]
    return Generated(out, json.loads(run([str(casadi_generator()), *words])))


def _variants() -> list[str]:
    return [*FIVE, "equations_dense"]


def calls(robot: Robot, joints: tuple[str, ...], function: str, runs: int) -> list[Call]:
    """The function; of M and h also with both triangles of M, as linegraph writes them."""
    made = generated(robot)
    found = []
    for peer, variant in (("CasADi", function), ("CasADi, dense M", f"{function}_dense")):
        if variant not in _variants():
            continue
        name = min((f"{variant}{mark}" for mark in CONVENTIONS.values()), key=made.operations)
        source = made.folder / f"{name}.c"
        glue = made.folder / f"{name}_call.c"
        glue.write_text(f'#define NAME {name}\n#include "{HERE / "casadi_calls.c"}"\n')
        library, counted = compiled(f"{name}_call", [glue, source], made.folder)
        layout = Layout.of(joints, made.joints, 6 if robot.floating else 0)
        call = Call(peer, function, library, counted, layout)
        call.figures |= {
            "operations": made.operations(name),
            "bytes": source.stat().st_size,
            "compile_seconds": compile_seconds(source, runs),
            "world": float(name.endswith("_world")),
        }
        found.append(call)
    return found


def counts(robot: Robot) -> dict[str, dict[str, int]]:
    """Operations of every function in both conventions."""
    made = generated(robot)
    return {
        name: {word: made.operations(f"{name}{mark}") for word, mark in CONVENTIONS.items()}
        for name in FIVE
    }


def generation(robot: Robot, functions: tuple[str, ...]) -> dict[str, float]:
    """What generating functions costs, in the convention of fewer operations for M and h."""
    made = generated(robot)
    mark = min(CONVENTIONS.values(), key=lambda mark: made.operations(f"equations{mark}"))
    words = [str(robot.urdf), robot.base, str(folder("casadi", robot.name, "timed"))]
    cpu, memory, printed = spent(
        [str(casadi_generator()), *words, *(f"{name}{mark}" for name in functions)]
    )
    report = json.loads(printed)
    inside = report["seconds"] + sum(made["seconds"] for made in report["functions"].values())
    return {"process": cpu, "inside": inside, "MiB": memory}


def whole(robot: Robot, runs: int) -> dict[str, float]:
    """Bytes and compile time of the five functions."""
    made = generated(robot)
    mark = min(CONVENTIONS.values(), key=lambda mark: made.operations(f"equations{mark}"))
    paths = [made.folder / f"{name}{mark}.c" for name in FIVE]
    return {
        "bytes": sum(path.stat().st_size for path in paths),
        "compile_seconds": sum(compile_seconds(path, runs) for path in paths),
    }
