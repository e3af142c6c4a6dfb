"""What each emitted function costs, as a table for the head of the file."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from codegen import prose, stack
from linegraph.expression import ADD, DIV, MUL, NEG, SUB, SYMBOL
from linegraph.program import Program, live_nodes

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.program import Module, Routine

_KINDS = {ADD: 0, SUB: 0, MUL: 1, DIV: 2}
_HEADINGS = ("+ -", "*", "/", "functions", "variables", "stack", "lines")


def table(module: Module, source: str, bytes_of: Mapping[str, int]) -> list[str]:
    """The lines: one for each function, counted in the program and in the text that was made of it.

    Args:
        module: whose functions.
        source: the text of the C file.
        bytes_of: the stack of each function.
    """
    texts = stack.functions(source)
    rows: list[tuple[str, ...]] = [("function", *_HEADINGS)]
    for program in module.programs:
        name = f"{module.name}_{program.name}"
        own = [text for part, text in texts.items() if _is_part(part, name)]
        variables = sum(len(re.findall(r"\bconst \w+ t\d+ = (?!kept\[)", body)) for _, body in own)
        lines = sum(head.count("\n") + body.count("\n") + 3 for head, body in own)
        numbers = (variables, bytes_of[name], lines)
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


def _is_part(part: str, name: str) -> bool:
    return part == name or re.fullmatch(rf"{name}_(?:part\d+|core)", part) is not None


def _operations(program: Program | Routine) -> tuple[str, ...]:
    """How many sums, products, quotients and functions."""
    if not isinstance(program, Program) or program.handed:
        return ("-",) * 4
    counts = [0, 0, 0, 0]
    for node in live_nodes(program):
        if node.op not in (SYMBOL, NEG):
            counts[_KINDS.get(node.op, 3)] += 1
    counts[1] += sum(check.fraction is not None for check in program.checks)
    return tuple(map(str, counts))
