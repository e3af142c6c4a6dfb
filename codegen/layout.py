"""What the files of all languages say alike: sizes by name, the head, functions that may fail."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING

from codegen import prose

if TYPE_CHECKING:
    from linegraph.program import Module, Program, Quantity, Result

_SIZES = {
    "q": "NQ",
    "qdot": "NQ",
    "v": "NV",
    "a": "NV",
    "tau": "NV",
    "h": "NV",
    "M": "NV",
    "u": "NU",
}
"""Which of the three counts a reader expects as an array's size; all others are plain numbers."""


def counts(module: Module) -> dict[str, int]:
    """How many positions, velocities and inputs there are, by the names all languages give them."""
    return {
        "NQ": len(module.positions),
        "NV": len(module.velocities),
        "NU": len(module.inputs),
    }


def extent(module: Module, name: str, size: int, prefix: str = "") -> str:
    """The size of the array `name` as a reader expects it: ``prefix + NV`` rather than ``7``."""
    count = _SIZES.get(name, "")
    return f"{prefix}{count}" if counts(module).get(count) == size else str(size)


def shape(module: Module, result: Result) -> list[str]:
    """The extents of a result, each as `extent` says it."""
    return [extent(module, result.name, size) for size in result.shape]


def quantities(module: Module) -> list[tuple[str, str, tuple[Quantity, ...]]]:
    """What the head of a file lists: symbol, heading, and the quantities themselves."""
    return [
        ("q", "positions", module.positions),
        ("v", "velocities", module.velocities),
        ("u", "inputs", module.inputs),
        ("p", "parameters", module.parameters),
    ]


def head(module: Module) -> list[str]:
    """What the head of a file says of this module, in plain lines: description and quantities."""
    lines: list[str] = []
    for text in module.about:
        lines += [*prose.paragraph(text), ""]
    for symbol, heading, listed in quantities(module):
        if listed:
            value = "value, " if symbol == "p" else ""
            title = f"{symbol}, the {heading}: index, name, {value}unit, meaning"
            lines += [title, *prose.table(listed), ""]
    return lines[:-1]


def default(parameter: Quantity) -> float:
    """The value of a parameter unless the caller says otherwise."""
    if parameter.value is None:
        raise ValueError(f"parameter {parameter.name!r} has no value")
    return parameter.value


def statuses(module: Module) -> dict[str, dict[int, str]]:
    """For each function: what each status other than 0 means; empty where it cannot fail."""
    programs = {program.name: program for program in module.programs}
    found: dict[str, dict[int, str]] = {}

    def visit(program: Program) -> dict[int, str]:
        if program.name not in found:
            own: dict[int, str] = {}
            inherited = (visit(programs[call.program]).items() for call in program.calls)
            reasons = [(check.status, check.about) for check in program.checks]
            for status, about in chain(*inherited, reasons):
                known = own.get(status, about)
                own[status] = known if about in known else f"{known}; or {about}"
            found[program.name] = own
        return found[program.name]

    return {program.name: visit(program) for program in module.programs}
