"""Named constants for what functions return where they cannot compute."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING

from codegen import naming
from linegraph.program import Routine, Status

if TYPE_CHECKING:
    from linegraph.program import Module, Program

OK = "OK"
"""The name of 0."""


def own(program: Program | Routine) -> tuple[Status, ...]:
    """What a function itself returns, not what it passes on."""
    if isinstance(program, Routine):
        return program.statuses
    return tuple(dict.fromkeys(Status(x.status, x.about, x.name) for x in program.checks))


def constants(module: Module) -> dict[tuple[int, str], tuple[str, list[str]]]:
    """For every number and name of a status: the constant, in capitals, and all that it means.

    Constants of different numbers differ, whatever the joints are called.
    """
    found: dict[tuple[int, str], tuple[str, list[str]]] = {}
    taken: set[str] = set()
    for status in sorted(set(chain(*map(own, module.programs)))):
        key = (status.number, status.name)
        if key not in found:
            name = _name(status)
            while name in taken:
                name = f"{name}_{status.number}"
            taken.add(name)
            found[key] = (f"{module.name.upper()}_{name}", [])
        if status.about not in found[key][1]:
            found[key][1].append(status.about)
    return found


def of(module: Module, program: Program | Routine) -> list[Status]:
    """All that a function returns other than 0, with names of constants, by number."""
    programs = {x.name: x for x in module.programs}
    named = constants(module)
    pending, seen = [program], {program.name}
    found: dict[Status, None] = {}
    while pending:
        now = pending.pop()
        for number, about, name in own(now):
            found[Status(number, about, named[number, name][0])] = None
        called = now.uses if isinstance(now, Routine) else tuple(x.program for x in now.calls)
        pending += [programs[x] for x in called if x not in seen]
        seen.update(called)
    return sorted(found)


def _name(status: Status) -> str:
    """The end of a constant: letters, digits and single underscores."""
    if not status.name:
        return f"STATUS_{status.number}"
    return naming.identifier(f"x_{status.name}")[2:].upper()
