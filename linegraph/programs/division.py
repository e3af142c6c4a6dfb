"""What divides by the mass matrix, and is left out where that is singular."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.dynamics.regularity import cause, listed
from linegraph.ir.program import Routine

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.ir.program import Program
    from linegraph.programs.workspace import Workspace

    Made = tuple[Program | Routine, ...]
    """The functions that a key of the register makes."""

DIVIDING = (
    "forward_dynamics",
    "linearize",
    "forward_dynamics_derivatives",
    "forward_dynamics_parameter_derivatives",
    "operational_space",
    "operational_position",
)
"""The keys of what divides by M by itself; what calls one of these divides, too."""

WITH_LOOPS = ("project",)
"""The same with loops: the steps of `project` take the least kinetic energy."""


def barred(functions: Workspace) -> set[str]:
    """The keys of what cannot be made as M is singular; none where it is regular."""
    if not functions.derivation.idle:
        return set()
    return {*DIVIDING, *(WITH_LOOPS if functions.tree.closed else ())}


def without(made: Mapping[str, Made], names: set[str]) -> tuple[dict[str, Made], list[str]]:
    """What is made less all that calls some functions, and what went; keys of which all went are gone."""
    left: dict[str, Made] = {}
    lost: list[str] = []
    for key, found in made.items():
        able = tuple(program for program in found if not names & {*called(program)})
        lost += [program.name for program in found if program not in able]
        if able or not found:
            left[key] = able
    return left, lost


def called(program: Program | Routine) -> tuple[str, ...]:
    """The functions that a function calls."""
    if isinstance(program, Routine):
        return program.uses
    return tuple(call.program for call in program.calls)


def remarks(functions: Workspace, omitted: Sequence[str]) -> tuple[str, ...]:
    """What the head of a file says of functions that are left out."""
    if not omitted:
        return ()
    verb = "is" if len(omitted) == 1 else "are"
    why = cause(functions.derivation.idle)
    return (f"{listed(omitted)} {verb} left out: the mass matrix is singular, as {why}.",)
