"""Bodies of functions that iterate or decide as they run: templates of algorithms, one for each language.

A template says the algorithm; what it needs to know of a module are sizes, places and how to call the
module's other functions.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from codegen import failures, frames, layout, templates
from codegen.frames import StackFrame
from linegraph.ir.program import PREPARED_SUFFIX, Routine
from linegraph.ir.statuses import NOT_FINITE_INPUT

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.ir.program import Module, Program

HELPERS = {
    "constrained_dynamics": (
        "eliminate",
        "pure",
        "large",
        "norm",
        "largest",
        "constrained",
        "unit",
    ),
    "project": ("eliminate", "pure", "large", "largest", "constrained", "unit"),
    "complete": ("eliminate", "pure", "large", "largest", "determined", "unit"),
    "reduction": ("eliminate", "pure", "large", "largest", "determined", "unit"),
    "reduced_equations": (),
    "linearization": ("eliminate", "pure", "large", "largest", "constrained", "determined"),
    "after_dynamics": (),
    "rhs": (),
    "newton": ("eliminate", "norm", "rounding", "backward"),
}
"""The algorithms, and what they share."""


CONSTANTS = "c"
"""The argument that is no input: what `prepare` returned. It may be infinite where a check tells of it."""

BATCHED = ("after_dynamics", "rhs")
"""Algorithms that only call others, so that they take many states at once where those do."""


class Dialect(NamedTuple):
    """How a language has its routines.

    Attributes:
        folder: of its templates.
        prefix: of its functions' names.
        passed: whether results are arguments, which the function writes, and arguments not read are listed.
        checked: the function that calls those that report no status, where a status is reported.
    """

    folder: str
    prefix: str
    passed: bool
    checked: str = ""


def helpers(module: Module) -> list[str]:
    """What the algorithms of a module share, in an order in which each knows those it uses."""
    used = [x for p in module.programs if isinstance(p, Routine) for x in HELPERS[p.algorithm]]
    return [x for x in dict.fromkeys(used) if x != "unit" or quaternions(module)]


def quaternions(module: Module) -> tuple[int, ...]:
    """Where quaternions begin among the coordinates, as far as routines need to know."""
    return _detail(module, "quaternions")


def independent(module: Module) -> tuple[int, ...]:
    """Where the independent velocities are among all."""
    return _detail(module, "w_at")


def _detail(module: Module, name: str) -> tuple[int, ...]:
    details = (dict(p.details) for p in module.programs if isinstance(p, Routine))
    return next((tuple(found[name]) for found in details if name in found), ())


def body(
    module: Module,
    routine: Routine,
    dialect: Dialect,
    small: Mapping[str, str] | None = None,
) -> list[str]:
    """The lines of a routine's body.

    `small` are the tolerances of `real.TOLERANCES`.
    """
    counts = layout.counts(module)
    text = templates.fill(
        f"{dialect.folder}/routines/{routine.algorithm}.jinja",
        counts={"NC": 0, "NP": 0, "NI": 0, **counts},
        results=", ".join(result.name for result in routine.results),
        name=module.name,
        macro=module.name.upper(),
        ok=f"{module.name.upper()}_{failures.OK}",
        status=_constants(module, routine),
        small=small or {},
        call=_calling(module, routine, dialect),
        fails={name for name, found in failures.statuses(module).items() if found},
        **dict(routine.details),
    )
    lines = text.rstrip("\n").split("\n")
    if dialect.passed:
        names = (argument.name for argument in routine.arguments)
        lines[:0] = [f"    (void){x};" for x in names if not re.search(rf"\b{x}\b", text)]
    return lines


def frame(module: Module, routine: Routine, lines: Sequence[str]) -> StackFrame:
    """What a routine with these lines keeps on the stack in C."""
    shared = [x for x in HELPERS[routine.algorithm] if x != "unit" or quaternions(module)]
    return frames.of_routine(routine, layout.counts(module), shared, frames.statements(lines))


def handed_frame(module: Module, program: Program | Routine, lines: Sequence[str]) -> StackFrame:
    """What a function keeps there that hands its work on."""
    return StackFrame(
        doubles=frames.Counts(layout.counts(module))["NK"],
        parameters=len(program.arguments) + len(program.results),
        statements=frames.statements(lines),
        calls={"prepare", program.handed, "parameters_not_finite"},
    )


def _constants(module: Module, routine: Routine) -> dict[str, str]:
    """The named constants of a routine's own statuses, by name."""
    named = failures.constants(module)
    return {x.name: named[x.number, x.name][0] for x in failures.own(routine)}


def handed(module: Module, program: Program | Routine, dialect: Dialect) -> list[str]:
    """The lines of a function that only prepares the constants and calls the one that takes them."""
    results = [result.name for result in program.results] if dialect.passed else []
    text = templates.fill(
        f"{dialect.folder}/handed.jinja",
        macro=module.name.upper(),
        prefix=dialect.prefix,
        function=program.handed,
        others=[a.name for a in program.arguments if a.name != "p"] + results,
        status=bool(failures.statuses(module)[program.name]),
        not_finite_input=f"{module.name.upper()}_{NOT_FINITE_INPUT.name}",
    )
    return text.rstrip("\n").split("\n")


def _calling(module: Module, routine: Routine, dialect: Dialect) -> Callable[..., str]:
    """How a template calls another function.

    ``call("bias", "h", v="v_on")`` gives ``arm_bias(p, q, v_on, h)``.
    The first names are those of the results; arguments have their own names unless renamed. One that takes
    the constants of `prepare` calls others that do. Those that report no status are called by `checked`, if
    there is such a function.
    """
    programs = {program.name: program for program in module.programs}
    prefix = dialect.prefix
    statuses = failures.statuses(module)

    def call(name: str, *results: str, **renamed: str) -> str:
        if name not in routine.uses:
            name += PREPARED_SUFFIX
        if name not in routine.uses:
            raise ValueError(f"{routine.name} does not say that it calls {name}")
        given = [renamed.get(x.name, x.name) for x in programs[name].arguments]
        if dialect.checked and not statuses[name]:
            return f"{dialect.checked}({', '.join([prefix + name, *given, *results])})"
        return f"{prefix}{name}({', '.join([*given, *results])})"

    return call
