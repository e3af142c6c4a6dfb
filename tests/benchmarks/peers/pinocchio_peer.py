"""Pinocchio's own C++ over doubles, compiled with the flags of the emitted C: no code for one robot."""

from __future__ import annotations

import ctypes
from functools import cache, partial
from typing import TYPE_CHECKING

from calls import Call, Layout, folder
from environment import VALGRIND, pinocchio_library

if TYPE_CHECKING:
    from pathlib import Path

    from robots import Robot


def calls(robot: Robot, joints: tuple[str, ...], function: str) -> list[Call]:
    """In both conventions of crba and aba; rnea has one."""
    library, counted = pinocchio_library(), partial(pinocchio_library, VALGRIND)
    found = []
    for convention in ("local", "world"):
        if convention == "world" and function == "inverse_dynamics":
            continue
        peer = "Pinocchio C++" + ", world" * (convention == "world")
        options = f"{function} {convention} {saved(robot)}"
        theirs = [name for name in names(library, options) if name != "root"]
        layout = Layout.of(joints, theirs, 6 if robot.floating else 0)
        found.append(Call(peer, function, library, counted, layout, options))
    return found


@cache
def saved(robot: Robot) -> Path:
    """The robot as Pinocchio's Python reads it, in a file."""
    import pinocchio

    path = folder("pinocchio") / f"{robot.name}.bin"
    free = (pinocchio.JointModelFreeFlyer(), "root") if robot.floating else ()
    pinocchio.buildModelFromUrdf(str(robot.urdf), *free).saveToBinary(str(path))
    return path


def names(library: Path, options: str) -> list[str]:
    """The joints of a robot in the order of a library."""
    loaded = ctypes.CDLL(str(library))
    loaded.setup.restype = ctypes.c_void_p
    text = ctypes.create_string_buffer(100_000)
    model = loaded.setup(options.encode())
    if not model:
        raise SystemExit(f"{library.stem} does not read the robot: {options}")
    loaded.names(ctypes.c_void_p(model), text)
    return text.value.decode().split()
