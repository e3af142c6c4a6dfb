"""Functions of many states: several side by side, one in each lane of vector registers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from codegen import layout, prose
from codegen.c import declare, straight_line
from codegen.c.frames import StackFrame
from codegen.c.straight_line import NumberKind
from codegen.dependence import SHARED
from linegraph.ir.functions import ARITY
from linegraph.ir.program import PREPARED_SUFFIX, Program

if TYPE_CHECKING:
    from collections.abc import Sequence

    from codegen.c.frames import Definition
    from linegraph.ir.program import Argument, Module, Result, Routine

NAMES = (
    "mass_matrix",
    "bias",
    "equations",
    "inverse_dynamics",
    "forward_dynamics",
    "regressor",
)
"""The functions that users call for many states; those that may fail are named in the header as left out."""


@dataclass(frozen=True)
class Rows:
    """An array with a row for each state: its name, the length of a row, the same by name."""

    name: str
    size: int
    extent: str


@dataclass(frozen=True)
class Batch:
    """A function of many states.

    Attributes:
        name: the function of one state.
        document: the lines of the comment above the declaration.
        signature: the head of the function.
        definitions: the function of as many states as there are lanes, after its parts.
        given: what is read, a row for each state.
        found: what is written, a row for each state.
        one: the names with which both functions are called, those of `given` and `found` included.
    """

    name: str
    document: list[str]
    signature: str
    definitions: list[Definition]
    given: list[Rows]
    found: list[Rows]
    one: list[str]

    @property
    def frame(self) -> StackFrame:
        """The stack frame of the function of many states."""
        return StackFrame(
            registers=sum(max(rows.size, 1) for rows in (*self.given, *self.found)),
            ints=1,
            parameters=1 + len(self.one),
            wide=True,
            calls={self.name, f"{self.name}_lanes", "gather", "scatter"},
        )

    @property
    def wide(self) -> str:
        """The arguments with which the function on vector registers is called."""
        rows = {x.name for x in (*self.given, *self.found)}
        return ", ".join(f"wide_{x}" if x in rows else x for x in self.one)


def functions(module: Module, statuses: dict[str, dict[int, str]]) -> list[Batch]:
    """The functions of many states: those of `NAMES` that report no status and call no other function.

    Args:
        module: the module.
        statuses: for each function of the module, the meaning of each status; empty if it has none.
    """
    return [
        _made(module, program, statuses)
        for program in module.programs
        if isinstance(program, Program) and _wanted(program) and _plain(program, statuses)
    ]


def left_out(module: Module, batches: Sequence[Batch]) -> list[str]:
    """The lines of the header that list the functions of `NAMES` without a version for many states.

    Args:
        module: the module.
        batches: its functions of many states.

    Returns:
        Wrapped lines of plain text; none if nothing is missing.
    """
    made = {batch.name for batch in batches}
    names = [x.name for x in module.programs if _wanted(x) and x.name not in made]
    if not names:
        return []
    reason = "since they report a status or call what does"
    return prose.paragraph(f"Not for many states at once, {reason}: {', '.join(names)}.")


def elementwise(module: Module, wide: Sequence[Definition]) -> list[tuple[str, str, int]]:
    """The elementary functions, other than sine and cosine, that are evaluated lane by lane.

    Args:
        module: the module.
        wide: its functions that work on vector registers.

    Returns:
        For each elementary function: its name in `ARITY`, its name in C and its number of arguments.
    """
    called = frozenset[str]().union(*(definition.frame.calls for definition in wide))
    return [
        (name, straight_line.function(module, name), arity)
        for name, arity in ARITY.items()
        if f"lanes_{name}" in called
    ]


def _wanted(program: Program | Routine) -> bool:
    """Whether a function, or its twin that reads prepared constants, is called for many states."""
    return program.name.removesuffix(PREPARED_SUFFIX) in NAMES


def _plain(program: Program, statuses: dict[str, dict[int, str]]) -> bool:
    return not (program.status or statuses[program.name] or program.calls)


def _made(module: Module, program: Program, statuses: dict[str, dict[int, str]]) -> Batch:
    macro = module.name.upper()
    given = [
        Rows(x.name, x.size, layout.extent(x, f"{macro}_"))
        for x in program.arguments
        if x.size is not None and x.name not in SHARED
    ]
    found = [_rows(module, x) for x in program.results]
    parts = ["int n", *(_argument(module, x) for x in program.arguments)]
    parts += [f"double {x.name}[{macro}_RESTRICT]" for x in program.results]
    return Batch(
        program.name,
        _document(module, program),
        declare.head(f"void {module.name}_{program.name}_batch(", parts),
        straight_line.define(
            module, program, statuses, NumberKind(f"{module.name}_lanes", True, True)
        ),
        given,
        found,
        [*(x.name for x in program.arguments), *(x.name for x in program.results)],
    )


def _rows(module: Module, result: Result) -> Rows:
    size = 1
    for extent in result.shape:
        size *= extent
    product = " * ".join(layout.shape(result, f"{module.name.upper()}_"))
    return Rows(result.name, size, f"({product})" if " * " in product else product)


def _argument(module: Module, argument: Argument) -> str:
    if argument.size is None or argument.name in SHARED:
        return declare.argument(module, argument)
    return f"const double {argument.name}[]"


def _document(module: Module, program: Program | Routine) -> list[str]:
    """The lines of the comment above a declaration."""
    about = f"{program.name} of n states at once; every array has n rows, each laid out as for one state."
    shared = [x.name for x in program.arguments if x.name in SHARED]
    if shared:
        about += f" {' and '.join(shared)} {'are' if len(shared) > 1 else 'is'} the same for all."
    lines = [*prose.paragraph(about), ""]
    lines += prose.paragraph("@param[in] n how many states; none if it is not positive", 4)
    for argument in program.arguments:
        rows = ""
        if argument.size is not None and argument.name not in SHARED:
            rows = f" (n x {layout.extent(argument)})"
        lines += prose.paragraph(f"@param[in] {argument.name}{rows} {argument.about}", 4)
    for result in program.results:
        extents = " x ".join(("n", *layout.shape(result)))
        lines += prose.paragraph(f"@param[out] {result.name} ({extents}) {result.about}", 4)
    return declare.block(lines)
