"""Functions that divide by the mass matrix, and are left out if that is singular."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.dynamics.regularity import cause, listed
from linegraph.ir.program import Routine

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.ir.program import Program
    from linegraph.programs.workspace import Workspace

    Made = tuple[Program | Routine, ...]
    """The functions made for a key of the register."""

DIVIDING = (
    "forward_dynamics",
    "linearize",
    "forward_dynamics_derivatives",
    "forward_dynamics_parameter_derivatives",
    "operational_space",
    "operational_position",
)
"""Keys of functions that themselves divide by M; functions that call them do so too."""

WITH_LOOPS = ("project",)
"""Further such keys if there are loops: the steps of `project` minimise kinetic energy."""


def barred(functions: Workspace) -> set[str]:
    """The keys of functions that cannot be made because M is singular; none if it is regular."""
    if not functions.derivation.idle:
        return set()
    return {*DIVIDING, *(WITH_LOOPS if functions.tree.closed else ())}


def without(made: Mapping[str, Made], names: set[str]) -> tuple[dict[str, Made], list[str]]:
    """Remove all functions that call some others.

    Args:
        made: the functions by key.
        names: the functions that may not be called.

    Returns:
        The remaining functions by key, without keys that have lost all of theirs; and the removed
            names.
    """
    left: dict[str, Made] = {}
    lost: list[str] = []
    for key, found in made.items():
        able = tuple(program for program in found if not names & {*called(program)})
        lost += [program.name for program in found if program not in able]
        if able or not found:
            left[key] = able
    return left, lost


def called(program: Program | Routine) -> tuple[str, ...]:
    """The names of the functions that a function calls."""
    if isinstance(program, Routine):
        return program.uses
    return tuple(call.program for call in program.calls)


def remarks(functions: Workspace, omitted: Sequence[str]) -> tuple[str, ...]:
    """Remark in the head of a file about functions that are left out.

    Args:
        functions: the shared equations.
        omitted: names of the functions that are left out.
    """
    if not omitted:
        return ()
    verb = "is" if len(omitted) == 1 else "are"
    why = cause(functions.derivation.idle)
    return (f"{listed(omitted)} {verb} left out: the mass matrix is singular, as {why}.",)
