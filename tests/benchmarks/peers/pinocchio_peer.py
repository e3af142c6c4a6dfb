"""Pinocchio's own C++ over doubles, compiled with the flags of the emitted C: no code for one robot."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

from calls import Call, Layout
from environment import VALGRIND, pinocchio_library

if TYPE_CHECKING:
    from pathlib import Path

    from robots import Robot


def calls(robot: Robot, joints: tuple[str, ...], function: str) -> list[Call]:
    """In both conventions of crba and aba; rnea has one."""
    library, counted = pinocchio_library(), pinocchio_library(VALGRIND)
    found = []
    for convention in ("local", "world"):
        if convention == "world" and function == "inverse_dynamics":
            continue
        peer = "Pinocchio C++" + ", world" * (convention == "world")
        options = f"{function} {robot.base} {convention} {robot.urdf}"
        theirs = [name for name in names(library, options) if name != "root"]
        layout = Layout.of(joints, theirs, 6 if robot.floating else 0)
        found.append(Call(peer, function, library, counted, layout, options))
    return found


def names(library: Path, options: str) -> list[str]:
    """The joints of a robot in the order of a library."""
    loaded = ctypes.CDLL(str(library))
    loaded.setup.restype = ctypes.c_void_p
    text = ctypes.create_string_buffer(100_000)
    loaded.names(ctypes.c_void_p(loaded.setup(options.encode())), text)
    return text.value.decode().split()


