"""Python: ``NAME.py``, one module that needs NumPy alone and computes one state or many at once.

Each function is emitted as two: a public one that deals with shapes and a private one of plain
assignments. The components of a single state are Python floats there, which are several times
faster than NumPy's scalars; those of many states are arrays. The assignments are the same for both.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeGuard

from codegen import algorithms, failures, layout, prose, templates
from codegen.dependence import varying
from codegen.options import DEFAULT
from codegen.printer import Syntax, number, print_program
from codegen.python.algorithms import PythonAlgorithms
from linegraph.ir.functions import ARITY
from linegraph.ir.program import Program, Routine, counts_of, named_listings

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from codegen.options import Options
    from linegraph.ir.program import Argument, Check, Module, Quantity, Result

_WIDTH = 96


def render(module: Module, options: Options = DEFAULT) -> dict[str, str]:
    """The Python source of a module.

    Args:
        module: the functions of a model.
        options: not used.

    Returns:
        The text of the one file, by file name.
    """
    statuses = failures.statuses(module)
    notation = _notation(module)
    printer = PythonAlgorithms(module, algorithms.of(module))
    bodies = {
        program.name: _body(module, program, notation, printer) for program in module.programs
    }
    shared = printer.shared()
    own = {
        program.name: printer.own(program) if _is_routine(program) else []
        for program in module.programs
    }
    printed = "\n".join(
        "\n".join(lines)
        for lines in (*bodies.values(), *shared, *(x for found in own.values() for x in found))
    )
    alone = any(map(algorithms.is_single, module.programs))
    smooth = analytic(module)
    text = templates.fill(
        "python/module.py.jinja",
        statuses=_statuses(module),
        unary=_called(printed, 1),
        binary=_called(printed, 2),
        name=module.name,
        helpers=alone,
        codes=printer.codes(),
        shared=shared,
        guarded="_ratio(" in printed,
        larger="_larger(" in printed,
        head=_indented(layout.head(module), 0),
        counts=list(counts_of(module).items()),
        names=[
            (listing.symbol, [f"{literal(x.name)}," for x in listing.quantities])
            for listing in named_listings(module)
        ],
        parameters=[x.name for x in module.parameters],
        defaults=[f"{x.name}={number(layout.default(x))}" for x in module.parameters],
        remarks=[line for x in module.parameters for line in _remark(x)],
        functions=[
            {
                "name": program.name,
                "arguments": ", ".join(argument.name for argument in program.arguments),
                "document": _document(
                    module, program, statuses[program.name], smooth=program.name in smooth
                ),
                "wrapper": _wrapper(module, program, smooth=program.name in smooth),
                "body": bodies[program.name],
                "own": own[program.name],
                "sizes": _sizes(program),
                "given": _given(program),
                "reports": bool(statuses[program.name]) and not program.handed,
            }
            for program in module.programs
        ],
    )
    return {f"{module.name}.py": text}


_NUMPY = {
    "asin": "arcsin",
    "acos": "arccos",
    "atan": "arctan",
    "atan2": "arctan2",
    "min": "minimum",
    "max": "maximum",
}


def _called(printed: str, arity: int) -> list[tuple[str, str]]:
    """The functions of so many arguments that the module calls, and NumPy's names for them."""
    return [
        (name, _NUMPY.get(name, name))
        for name, count in ARITY.items()
        if count == arity and f"_{name}(" in printed
    ]


def _is_routine(program: Program | Routine) -> TypeGuard[Routine]:
    """Whether an algorithm is printed for a function."""
    return isinstance(program, Routine) and not program.handed


def literal(text: str) -> str:
    """A string literal of exactly this text, in double quotes where that needs no more escapes."""
    quoted = ascii(text)
    inside = quoted[1:-1]
    return quoted if '"' in inside or "\\'" in inside else f'"{inside}"'


def _escape(line: str) -> str:
    """A line of printable ASCII within a docstring, which it cannot end."""
    return line.replace("\\", "\\\\").replace('"""', '\\"\\"\\"')


def _indented(lines: Iterable[str], indent: int) -> list[str]:
    return [f"{' ' * indent}{_escape(line)}".rstrip() for line in lines]


def _remark(quantity: Quantity) -> list[str]:
    unit = f" ({quantity.unit})" if quantity.unit else ""
    return _indented(prose.paragraph(f"{quantity.name}{unit}: {quantity.about}", 4), 8)


def _document(
    module: Module, program: Program | Routine, statuses: dict[int, str], *, smooth: bool
) -> list[str]:
    """The lines of a docstring, quotes excluded."""
    about = prose.paragraph(program.about) or [f"Compute {program.name}."]
    lines = [*about, "", "Args:"]
    for argument in program.arguments:
        shape = ""
        if argument.size is not None:
            shape = _leading([layout.extent(argument)])
        lines += _item(f"{argument.name}: {argument.about}{shape}")
    lines += ["", "Returns:"]
    for result in program.results:
        shape = _leading(layout.shape(result))
        lines += _item(f"{result.name}: {result.about}{shape}")
    if program.arguments:
        lines += ["", "Raises:", *_item("ValueError: an argument has a wrong shape.")]
    if program.arguments and not smooth:
        lines += _item("TypeError: an argument is complex.")
    if statuses:
        meanings = "; ".join(f"{number_}: {about_}" for number_, about_ in statuses.items())
        lines += _item(f"StatusError: {meanings}.")
    return _indented(lines, 4)


def _leading(extents: Sequence[str]) -> str:
    return f", shape (..., {', '.join(extents)})"


def _item(text: str) -> list[str]:
    return [f"    {line}" for line in prose.paragraph(text, 4)]


def _wrapper(module: Module, program: Program | Routine, *, smooth: bool) -> list[str]:
    """The lines of a public function, below its docstring."""
    lines, leads = [], []
    for argument in program.arguments:
        lead, line = _read(module, argument, smooth=smooth)
        lines.append(line)
        leads.append(lead)
    results = ", ".join(result.name for result in program.results)
    arguments = ", ".join(argument.name for argument in program.arguments)
    joined = ", ".join(_join(module, result) for result in program.results)
    return [
        *lines,
        f"    lead = _lead({', '.join(leads)})",
        f"    {results} = _{program.name}({arguments})",
        f"    return {joined}",
    ]


def _read(module: Module, argument: Argument, *, smooth: bool) -> tuple[str, str]:
    """The name of an argument's leading shape and the line that finds it and the components."""
    name, lead = argument.name, f"{argument.name}_lead"
    if argument.size is not None:
        size = layout.extent(argument)
        kept = ", smooth=True" * smooth
        return lead, f'    {lead}, {name} = _split("{name}", {name}, {size}{kept})'
    if name == "p":
        return lead, f"    {lead} = _check_parameters(p)"
    return lead, f"    {lead}, {name} = _number({name})"


def _join(module: Module, result: Result) -> str:
    extents = layout.shape(result)
    return f"_join({result.name}, lead, ({', '.join(extents)}{',' * (len(extents) == 1)}))"


def _sizes(program: Program | Routine) -> str:
    """Of a routine, which takes one state at a time, how many components each result has; else nothing."""
    if not algorithms.is_single(program):
        return ""
    return ", ".join(str(math.prod(result.shape)) for result in program.results) + ","


def _body(
    module: Module, program: Program | Routine, notation: Syntax, printer: PythonAlgorithms
) -> list[str]:
    """The lines of a private function: arguments and results are lists of components."""
    if program.handed:
        return _handed(program, fails=bool(failures.statuses(module)[program.name]))
    if isinstance(program, Routine):
        return printer.body(program)
    lines = []
    for call in program.calls:
        results = ", ".join(result.name for result in call.results)
        lines.append(f"    {results} = _{call.program}({', '.join(call.arguments)})")
    body = print_program(program, notation)
    lines += body.lines
    for result, entries in zip(program.results, body.results, strict=True):
        lines += [f"    {result.name} = [", *_filled(entries), "    ]"]
    lines.append(f"    return {', '.join(result.name for result in program.results)}")
    return lines


def _handed(program: Program | Routine, *, fails: bool) -> list[str]:
    """The lines of a function that only prepares the constants and calls the one that takes them."""
    prepared = "_as_in_c(_prepare, p)" if fails else "_prepare(p)"
    given = ", ".join([prepared, *(x.name for x in program.arguments if x.name != "p")])
    return ["    _check_given(p)"] * fails + [f"    return _{program.handed}({given})"]


def _filled(entries: Sequence[str]) -> list[str]:
    """The entries of a list, as many on a line as fit."""
    lines = []
    line = "       "
    for entry in entries:
        if len(line) + len(entry) > _WIDTH and line != "       ":
            lines.append(line)
            line = "       "
        line = f"{line} {entry},"
    return [*lines, line] if entries else lines


def _statuses(module: Module) -> list[tuple[str, int, str]]:
    """Name, number and meaning of each status, as literals; none where no function reports any."""
    found = failures.constants(module)
    if not found:
        return []
    rows = [(failures.OK, 0, "the results are returned")]
    rows += [
        (failures.name_of(module, name), number_, "; or ".join(about))
        for (number_, _), (name, about) in found.items()
    ]
    return [(literal(name), number_, literal(prose.plain(about))) for name, number_, about in rows]


def _given(program: Program | Routine) -> str:
    """The arguments that must be finite: all but the constants of `prepare`."""
    return ", ".join(x.name for x in program.arguments if x.name != algorithms.CONSTANTS)


_SMOOTH = ("sin", "cos", "tan", "atan", "sinh", "cosh", "tanh", "exp")
"""Functions that have a derivative at all real numbers: they keep imaginary parts."""


def analytic(module: Module) -> set[str]:
    """The functions whose results are differentiable, so that complex arguments make sense.

    From their arguments they calculate with sums, products, quotients and smooth functions alone, and so do
    those that they call.
    """
    programs = {x.name: x for x in module.programs if isinstance(x, Program)}
    needs = {
        name: {*failures.called(x), *([x.handed] if x.handed else [])}
        for name, x in programs.items()
        if _is_smooth(x)
    }
    while True:
        found = {name for name, others in needs.items() if others <= needs.keys()}
        if len(found) == len(needs):
            return found
        needs = {name: needs[name] for name in found}


def _is_smooth(program: Program) -> bool:
    """Whether a program applies smooth functions only to what depends on more than parameters and time."""
    live = program.live
    kinked = [x.index for x in live if x.op in ARITY and x.op not in _SMOOTH]
    return not kinked or varying(live).isdisjoint(kinked)


def _notation(module: Module) -> Syntax:
    """How Python writes expressions and checks."""
    constants = failures.constants(module)

    def check(value: str, bound: str, found: Check) -> list[str]:
        name = failures.name_of(module, constants[found.status, found.name][0])
        return [
            f"    if not _exceeds({value}, {bound}):",
            f"        raise StatusError({literal(name)})",
        ]

    return Syntax(
        before="    ",
        after="",
        member="p.",
        functions={name: f"_{name}(" for name in ARITY},
        # the dashes keep a label from being read as an instruction to a tool, such as ``type: ignore``
        comment=lambda label: f"    # -- {prose.plain(label)}",
        check=check,
        divided="_ratio(",
    )
