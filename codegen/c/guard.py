"""Wrappers of C functions that report a status: they check that arguments and results are finite.

The function itself looks at its arguments, has the work done by another one, which writes into arrays of its
own, and copies these where all is well. So nothing is written unless the status is that of success.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from codegen import failures, layout
from codegen.algorithms import CONSTANTS
from codegen.c import declare, frames
from codegen.c.frames import FINITE, Definition, StackFrame
from linegraph.ir.statuses import NOT_FINITE, NOT_FINITE_INPUT

if TYPE_CHECKING:
    from linegraph.ir.program import Argument, Module, Program, Result, Routine


def is_needed(module: Module) -> bool:
    """Whether any function reports a status, so that the common helpers are needed."""
    return any(failures.statuses(module).values())


def reads_parameters(module: Module) -> bool:
    """Whether a function that reports a status takes parameters."""
    return any(
        argument.name == "p" and found
        for program, found in zip(module.programs, failures.statuses(module).values(), strict=True)
        for argument in program.arguments
    )


def definition(
    module: Module, program: Program | Routine, statuses: dict[str, dict[int, str]]
) -> Definition:
    """The public function that reports a status, around the internal one that computes.

    It rejects arguments that are not finite, and writes the results only if all are finite.

    Args:
        module: the module.
        program: the function.
        statuses: for each function of the module, the meaning of each status; empty if it has none.
    """
    lines = _lines(module, program)
    frame = StackFrame(
        doubles=sum(math.prod(result.shape) for result in program.results),
        ints=2,
        parameters=len(program.arguments) + len(program.results),
        statements=frames.statements(lines),
        calls={program.name + declare.CORE, *FINITE},
    )
    head = declare.signature(module, program, statuses)
    return Definition(program.name, head, lines, frame)


def _lines(module: Module, program: Program | Routine) -> list[str]:
    """The lines of a function that reports a status."""
    macro, prefix = module.name.upper(), module.name
    bad_input, bad_result = (f"{macro}_{x.name}" for x in (NOT_FINITE_INPUT, NOT_FINITE))
    results = [result for result in program.results if math.prod(result.shape)]
    names = [argument.name for argument in program.arguments]
    names += [_local(x) if x in results else x.name for x in program.results]
    made = [f"    double {_local(x)}[{_size(module, x)}];" for x in results]
    made += [
        f"    int status = {bad_input};",
        *_counted([_of_argument(module, x) for x in program.arguments]),
        "    if (amiss == 0) {",
        f"        status = {prefix}_{program.name}{declare.CORE}({', '.join(names)});",
        "    }",
    ]
    if results:
        counts = [f"{prefix}_not_finite({_size(module, x)}, {_local(x)})" for x in results]
        copies = [
            f"            {prefix}_copy({_size(module, x)}, {_local(x)}, {x.name});"
            for x in results
        ]
        made += [
            f"    if (status == {macro}_{failures.OK}) {{",
            *(f"        amiss += {count};" for count in counts),
            "        if (amiss == 0) {",
            *copies,
            "        } else {",
            f"            status = {bad_result};",
            "        }",
            "    }",
        ]
    return [*made, "    return status;"]


def _counted(counts: list[str]) -> list[str]:
    """The lines that count arguments that are not finite."""
    found = [count for count in counts if count] or ["0"]
    return [
        f"    {'int amiss =' if place == 0 else 'amiss +='} {count};"
        for place, count in enumerate(found)
    ]


def _of_argument(module: Module, given: Argument) -> str:
    """How many entries of an argument are not finite; nothing where it has none or is not looked at."""
    if given.name == "p":
        return f"{module.name}_parameters_not_finite(p)"
    if given.size == 0 or given.name == CONSTANTS:
        return ""
    if given.size is None:
        return f"{module.name}_not_finite(1, &{given.name})"
    size = layout.extent(given, f"{module.name.upper()}_")
    return f"{module.name}_not_finite({size}, {given.name})"


def _local(result: Result) -> str:
    return f"found_{result.name}"


def _size(module: Module, result: Result) -> str:
    return " * ".join(layout.shape(result, f"{module.name.upper()}_"))
