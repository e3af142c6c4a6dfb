"""What the functions of emitted C keep on the stack and whom they call: records made as they are written.

Functions that are printed from programs keep their record while their lines are made. Those of templates,
helpers and algorithms, have it here: a variable or a call added to a template is added here, too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from linegraph.ir.functions import ARITY

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from linegraph.ir.program import Routine

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
        """Note variables: of the type ``double`` or of registers."""
        if number == "double":
            self.doubles += count
        else:
            self.registers += count

    def name(self, number: str) -> None:
        """Note an intermediate result with a name."""
        self.add(number)
        self.named += 1


class Definition(NamedTuple):
    """A function: its name after that of the module, its head, the lines between its braces, its record."""

    name: str
    head: str
    lines: list[str]
    frame: StackFrame


class Counts(dict[str, int]):
    """The counts of a module; those that it lacks are 0."""

    def __missing__(self, name: str) -> int:
        return 0


def statements(lines: Iterable[str]) -> int:
    """How many lines end a statement: the others are heads and braces."""
    return sum(line.endswith(";") for line in lines)


FUNCTIONS = {
    "finite": ("not_finite", "parameters_not_finite", "copy"),
    "eliminate": ("eliminate",),
    "large": ("too_large",),
    "norm": ("size_of",),
    "pure": ("pure",),
    "largest": ("largest_of",),
    "rounding": ("is_rounding",),
    "backward": ("backward",),
    "constrained": ("constrained",),
    "determined": ("determined",),
    "unit": ("unit",),
}
"""The functions of each helper that algorithms call."""


def of_helpers(counts: Mapping[str, int]) -> dict[str, StackFrame]:
    """The functions of all helpers."""
    n, c = counts["NV"], counts["NC"]
    within = {"eliminate", "too_large"}
    found = {
        "not_finite": StackFrame(ints=2, parameters=2, statements=5),
        "parameters_not_finite": StackFrame(ints=1, parameters=1),
        "copy": StackFrame(ints=1, parameters=3, statements=3),
        "too_large": StackFrame(ints=2, parameters=2, statements=5),
        "eliminate": StackFrame(doubles=4, ints=15, pointers=2, parameters=7),
        "size_of": StackFrame(doubles=2, ints=1, parameters=2, statements=6),
        "is_rounding": StackFrame(ints=2, parameters=3, statements=5),
        "backward": StackFrame(ints=4, parameters=7),
        "pure": StackFrame(doubles=2, ints=3, parameters=6),
        "largest_of": StackFrame(doubles=2, ints=1, parameters=3, statements=5),
        "least_norm": StackFrame(doubles=4 + c * c, ints=14, pointers=1, parameters=7),
        "constrained": StackFrame(
            doubles=10 + 4 * (n + c) + n * c + 2 * n * n,
            ints=37 + n + c,
            parameters=16,
            calls={*within, "pure", "largest_of", "size_of", "least_norm"},
        ),
        "determined": StackFrame(
            doubles=1 + (c + n) * (n + 1) + 2 * n,
            ints=12 + c + 2 * n,
            parameters=9,
            calls={*within, "pure", "largest_of"},
        ),
        "unit": StackFrame(doubles=1, ints=1, pointers=1, parameters=1),
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


Made = Callable[[Counts, "dict[str, object]"], StackFrame]

_ROUTINES: dict[str, Made] = {
    "after_dynamics": lambda n, _: StackFrame(doubles=n["NV"] + 1 + n["NC"], ints=1),
    "rhs": lambda n, _: StackFrame(doubles=n["NC"]),
    "constrained_dynamics": lambda n, _: StackFrame(
        doubles=17 + n["NV"] * (n["NV"] + 2 * n["NC"] + 6) + 9 * n["NC"] + n["NP"] + 2 * n["NQ"],
        ints=14,
    ),
    "reduction": lambda n, _: _of_reduction(n),
    "reduced_equations": lambda n, _: StackFrame(
        doubles=1 + n["NV"] * (n["NV"] + n["NI"] + 2), ints=9
    ),
    "complete": lambda n, _: StackFrame(
        doubles=4 + 2 * n["NQ"] + n["NV"] * (n["NC"] + 3) + 3 * n["NC"] + n["NI"] + n["NP"],
        ints=11,
    ),
    "project": lambda n, _: StackFrame(
        doubles=5 + 3 * n["NQ"] + n["NV"] * (n["NV"] + n["NC"] + 3) + 3 * n["NC"] + n["NP"],
        ints=11,
    ),
    "linearization": lambda n, details: _of_linearization(n, len(details["d_at"])),  # type: ignore[arg-type]
    "newton": lambda _, details: _of_newton(int(details["size"])),  # type: ignore[call-overload]
}
"""The algorithms of templates, their arguments and calls left out."""


def of_routine(
    routine: Routine, counts: Mapping[str, int], helpers: Iterable[str], statements: int
) -> StackFrame:
    """The record of a function whose algorithm is a template, written in so many statements.

    Args:
        routine: the function.
        counts: the counts of the module.
        helpers: what the algorithm shares with others.
        statements: about how many it has.
    """
    frame = _ROUTINES[routine.algorithm](Counts(counts), dict(routine.details))
    frame.parameters = len(routine.arguments) + len(routine.results)
    frame.statements = statements
    frame.calls = {*routine.uses, *(x for helper in helpers for x in FUNCTIONS[helper])}
    return frame


def _of_reduction(n: Counts) -> StackFrame:
    v, c, i = n["NV"], n["NC"], n["NI"]
    sides = (v + c + i) * (2 * i + 3)
    return StackFrame(doubles=14 + 2 * c * v + 4 * c + v + sides + n["NP"] + 2 * n["NQ"], ints=16)


def _of_linearization(n: Counts, free: int) -> StackFrame:
    v, c, i, t = n["NV"], n["NC"], n["NI"], n["NT"]
    width, sides = t + v + n["NU"], n["NDX"] + n["NU"]
    vectors = 6 * v + 5 * c + width
    matrices = v * v + c * v + (v + c) * width + c * t + t * t + v * i
    return StackFrame(
        doubles=5 + vectors + matrices + (v + c + free) * free + (v + c + i) * free + i * sides,
        ints=21,
    )


def _of_newton(size: int) -> StackFrame:
    return StackFrame(doubles=8 + size * size + 6 * size, ints=22 + 2 * size)
