"""Records of the stack frames and calls of emitted C functions, made while these are written.

Functions that are printed from programs and algorithms keep their record while their lines are made. Only
the few helpers that stand in templates have it here: a variable or a call added to one of these is added
here, too.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from linegraph.ir.functions import ARITY

if TYPE_CHECKING:
    from collections.abc import Iterable

MANY = 100
"""Statements of a function of templates: more than what is held in registers depends on."""


@dataclass
class StackFrame:
    """A function's variables by type, and the functions that it calls, by their names after the module's.

    Attributes:
        doubles: real numbers, whether they are doubles or floats.
        registers: vectors of real numbers or of bits.
        parameters: how many arguments it takes.
        statements: about how many.
        named: those of the variables that are intermediate results with a name.
        wide: whether it works on registers.
    """

    doubles: int = 0
    ints: int = 0
    pointers: int = 0
    registers: int = 0
    parameters: int = 0
    statements: int = MANY
    named: int = 0
    wide: bool = False
    calls: set[str] = field(default_factory=set)

    def add(self, number: str, count: int = 1) -> None:
        """Add variables to the record.

        Args:
            number: their type; any type other than ``double`` is that of a vector register.
            count: how many there are.
        """
        if number == "double":
            self.doubles += count
        else:
            self.registers += count

    def name(self, number: str) -> None:
        """Note an intermediate result with a name."""
        self.add(number)
        self.named += 1


class Definition(NamedTuple):
    """A function: its name after that of the module, its head, the lines between its braces, its record.

    Attributes:
        of: the emitted function that it belongs to, where its name does not say that.
    """

    name: str
    head: str
    lines: list[str]
    frame: StackFrame
    of: str = ""


def statements(lines: Iterable[str]) -> int:
    """How many lines end a statement: the others are heads and braces."""
    return sum(line.endswith(";") for line in lines)


FINITE = ("not_finite", "parameters_not_finite", "copy")
"""The functions that look at arguments and results."""


def of_helpers() -> dict[str, StackFrame]:
    """The records of the functions written in templates, by name."""
    found = {
        "not_finite": StackFrame(ints=2, parameters=2, statements=5),
        "parameters_not_finite": StackFrame(ints=1, parameters=1),
        "copy": StackFrame(ints=1, parameters=3, statements=3),
        "sincos": StackFrame(doubles=13, ints=1, parameters=3),
        "all_sincos": StackFrame(ints=1, parameters=4, wide=True, calls={"sincos", "lanes_sincos"}),
        "lanes_sincos": StackFrame(registers=17, ints=3, parameters=4, wide=True),
        "turn": StackFrame(registers=4, ints=1, parameters=1, wide=True),
        **dict.fromkeys(("gather", "scatter"), _rows()),
    }
    found |= {
        f"{name}_of": StackFrame(parameters=2, statements=1) for name in ("sign", "min", "max")
    }
    return found | {
        f"lanes_{name}": StackFrame(ints=1, parameters=2, wide=True, calls={f"{name}_of"})
        for name in ARITY
    }


def _rows() -> StackFrame:
    return StackFrame(registers=8, ints=3, parameters=4, wide=True, calls={"turn"})
