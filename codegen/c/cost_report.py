"""The cost of each emitted function, as a table for the head of the file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from codegen import prose
from codegen.c import declare
from linegraph.ir.dag import ADD, DIV, MUL, NEG, SUB, SYMBOL
from linegraph.ir.program import Program

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from codegen.c.frames import Definition
    from linegraph.ir.program import Module, Routine

_KINDS = {ADD: 0, SUB: 0, MUL: 1, DIV: 2}
_HEADINGS = ("+ -", "*", "/", "functions", "variables", "stack", "lines")


def table(
    module: Module, functions: Sequence[Definition], bytes_of: Mapping[str, int]
) -> list[str]:
    """The lines: one for each function, counted in the program and in what is printed of it.

    Args:
        module: whose functions.
        functions: all that is defined for them, as it is printed.
        bytes_of: the stack of each function.
    """
    rows: list[tuple[str, ...]] = [("function", *_HEADINGS)]
    for program in module.programs:
        own = [x for x in functions if program.name in (x.of, _whole(x.name))]
        variables = sum(x.frame.named for x in own)
        lines = sum(x.head.count("\n") + len(x.lines) + 3 for x in own)
        numbers = (variables, bytes_of[program.name], lines)
        rows.append((program.name, *_operations(program), *map(str, numbers)))
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    about = (
        "Cost of each function: operations by kind and calls of mathematical functions, each carried out "
        "once a call, those of functions it calls not counted; - where a function iterates or only calls "
        "others. Variables: named intermediate results. Stack: bytes at most, callees included. Lines: of "
        "source, parts included. Instructions depend on the compiler: compile, then count what objdump -d "
        "shows of a function."
    )
    found = [*prose.paragraph(about), ""]
    for row in rows:
        cells = [
            row[0].ljust(widths[0]),
            *(x.rjust(w) for x, w in zip(row[1:], widths[1:], strict=True)),
        ]
        found.append(f"  {'  '.join(cells)}")
    return found


def _whole(part: str) -> str:
    """The name of the function that a part does some of the work of."""
    own = part.removesuffix(declare.CORE)
    stem, _, place = own.rpartition("_part")
    return stem if place.isdigit() else own


def _operations(program: Program | Routine) -> tuple[str, ...]:
    """How many sums, products, quotients and functions."""
    if not isinstance(program, Program) or program.handed:
        return ("-",) * 4
    counts = [0, 0, 0, 0]
    for node in program.live:
        if node.op not in (SYMBOL, NEG):
            counts[_KINDS.get(node.op, 3)] += 1
    counts[1] += sum(check.fraction is not None for check in program.checks)
    return tuple(map(str, counts))
