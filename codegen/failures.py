"""The statuses that each function may return, and the names of their constants.

A function that reports a status at all reports arguments and results that are not finite, too.
"""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING

from codegen import naming
from linegraph.ir.program import Routine, Status
from linegraph.ir.statuses import NOT_FINITE, NOT_FINITE_INPUT

if TYPE_CHECKING:
    from linegraph.ir.program import Module, Program

OK = "OK"
"""The name of 0."""


def own(program: Program | Routine) -> tuple[Status, ...]:
    """The statuses of a function itself, without those of the functions it calls."""
    if isinstance(program, Routine):
        found = program.statuses
    else:
        found = tuple(dict.fromkeys(Status(x.status, x.about, x.name) for x in program.checks))
    return (NOT_FINITE_INPUT, NOT_FINITE, *found) if program.status or found else ()


def called(program: Program | Routine) -> tuple[str, ...]:
    """The functions that a function calls."""
    if isinstance(program, Routine):
        return program.uses
    return tuple(call.program for call in program.calls)


def constants(module: Module) -> dict[tuple[int, str], tuple[str, list[str]]]:
    """For every number and name of a status: the constant, in capitals, and all that it means.

    Constants of different numbers differ, whatever the joints are called.

    Raises:
        ValueError: two statuses have the same number.
    """
    found: dict[tuple[int, str], tuple[str, list[str]]] = {}
    taken: set[str] = set()
    for status in sorted(set(chain(*map(own, module.programs)))):
        key = (status.number, status.name)
        if key not in found:
            if any(number == status.number for number, _ in found):
                raise ValueError(f"two statuses have the number {status.number}")
            name = _name(status)
            while name in taken:
                name = f"{name}_{status.number}"
            taken.add(name)
            found[key] = (f"{module.name.upper()}_{name}", [])
        if status.about not in found[key][1]:
            found[key][1].append(status.about)
    return found


def name_of(module: Module, constant: str) -> str:
    """The name of a status without the prefix, for languages with namespaces.

    Args:
        module: the module; its name in capitals is the prefix.
        constant: the name of the constant as `constants` gives it.
    """
    return constant.removeprefix(f"{module.name.upper()}_")


def of(module: Module, program: Program | Routine) -> list[Status]:
    """The statuses other than 0 that a function may return, including those of functions it calls.

    Args:
        module: the module.
        program: one of its functions.

    Returns:
        The statuses with names of constants, sorted by number.
    """
    programs = {x.name: x for x in module.programs}
    named = constants(module)
    pending, seen = [program], {program.name}
    found: dict[Status, None] = {}
    while pending:
        now = pending.pop()
        for number, about, name in own(now):
            found[Status(number, about, named[number, name][0])] = None
        pending += [programs[x] for x in called(now) if x not in seen]
        seen.update(called(now))
    return sorted(found)


def statuses(module: Module) -> dict[str, dict[int, str]]:
    """For each function: what each status other than 0 means; empty where it cannot fail."""
    return {
        program.name: {status.number: status.about for status in of(module, program)}
        for program in module.programs
    }


def _name(status: Status) -> str:
    """The end of a constant: letters, digits and single underscores."""
    if not status.name:
        return f"STATUS_{status.number}"
    return naming.identifier(f"x_{status.name}")[2:].upper()
