"""Upper bounds of the stack that the functions of an emitted C file use, from their records.

A function's frame has its variables, its arguments and what a call costs. Without optimisation a compiler
gives every variable a place of its own; with it, registers take most of them, so that the same sum is an
upper bound for both. To a frame comes the deepest of those it calls. Nothing calls itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from codegen.c.frames import StackFrame

CALL = 32
"""Bytes of every call: the return address, the frame's, alignment."""

SPILLED = 160
"""Bytes of registers that a function saves, and of numbers it holds in between, at most."""

_WORD = 8
"""Bytes of a pointer, and of an argument."""

_INT = 4
_BYTES = {"double": 8, "float": 4}

_REGISTER = 64
"""Bytes of the longest vector register."""


def bounds(frames: Mapping[str, StackFrame], real: str = "double") -> dict[str, int]:
    """Bytes of stack that each function takes at most, with all that it calls but <math.h>.

    Args:
        frames: of all functions of a file, by name.
        real: the type of its numbers.
    """
    found: dict[str, int] = {}

    def depth(name: str) -> int:
        if name not in found:
            frame = frames[name]
            called = [depth(x) for x in frame.calls if x in frames]
            found[name] = -(-(own(frame, real) + max(called, default=0)) // 8) * 8
        return found[name]

    return {name: depth(name) for name in frames}


def variables(frame: StackFrame, real: str = "double") -> int:
    """The size of a function's variables (bytes).

    Args:
        frame: the function's record.
        real: ``double`` or ``float``.
    """
    numbers = frame.doubles * _BYTES[real] + frame.ints * _INT
    return numbers + frame.pointers * _WORD + frame.registers * _REGISTER


def own(frame: StackFrame, real: str = "double") -> int:
    """The stack that one function takes without those it calls (bytes), an upper bound.

    Args:
        frame: the function's record.
        real: ``double`` or ``float``.
    """
    arguments = _WORD * max(frame.parameters, 1)
    if frame.wide:
        arguments += 4 * _REGISTER  # registers are kept in places of their alignment
    # a quarter more, since a compiler that makes one function of several may not use a place twice
    taken = variables(frame, real) * 5 // 4
    return CALL + arguments + taken + min(SPILLED, _WORD * frame.statements)
