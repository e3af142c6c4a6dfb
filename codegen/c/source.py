"""C: ``NAME.h`` and ``NAME.c``, in the common part of C99 and C++."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from codegen import algorithms, failures, layout, naming, prose, templates
from codegen.c import (
    batch,
    cost_report,
    declare,
    frames,
    guard,
    packages,
    real,
    stack,
    straight_line,
)
from codegen.c.algorithms import CAlgorithms
from codegen.c.declare import block, comment, string
from codegen.c.frames import Definition
from codegen.options import DEFAULT
from codegen.printer import number
from linegraph.ir.program import Routine, counts_of, named_listings
from linegraph.ir.statuses import NOT_FINITE_INPUT

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from codegen.options import Options
    from linegraph.ir.program import Listing, Module, Program, Quantity


def render(module: Module, options: Options = DEFAULT) -> dict[str, str]:
    """The header and the source of a module, with the files of its package if there is one.

    Args:
        module: the functions of a model; file names begin with its name.
        options: the choices for C.

    Returns:
        The text of each file, by its path relative to the output folder.

    Raises:
        NameRefused: the prefix, or a name with this prefix, cannot be used.
        ModelError: a number cannot be represented in the chosen type.
    """
    file = module.name
    if options.prefix is not None:
        naming.validate_prefix(options.prefix)
        module = replace(module, name=options.prefix)
        naming.validate(module)
    statuses = failures.statuses(module)
    macro = module.name.upper()
    batches = batch.functions(module, statuses) if options.batch else []
    common = {
        "file": file,
        "name": module.name,
        "macro": macro,
        "parameters": [(x.name, number(layout.default(x)), _remark(x)) for x in module.parameters],
        "names": [_names(macro, listing) for listing in named_listings(module)],
        "inline": options.trig == "inline",
        "real": options.real,
        "ok": f"{macro}_{failures.OK}",
        "failures": _failures(module),
        "guards_parameters": guard.reads_parameters(module),
    }
    kind = straight_line.NumberKind(inline=options.trig == "inline", real=options.real)
    printer = CAlgorithms(module, algorithms.of(module), options.real)
    shared = printer.shared()
    functions = [
        x for program in module.programs for x in _define(module, program, statuses, kind, printer)
    ]
    wide = [x for found in batches for x in found.definitions]
    source = templates.fill(
        "c/source.c.jinja",
        functions=functions,
        batches=batches,
        codes=printer.codes(),
        shared=shared,
        finite=guard.is_needed(module),
        needs=_needs(module, [*shared, *functions], wide),
        elementwise=batch.elementwise(module, wide),
        **common,
    )
    source = real.written(source, options.real)
    known = frames.of_helpers()
    known |= {x.name: x.frame for x in (*shared, *functions, *wide)}
    known |= {f"{x.name}_batch": x.frame for x in batches}
    taken = stack.bounds(known, options.real)
    header = templates.fill(
        "c/header.h.jinja",
        head=block(layout.head(module)),
        deepest=_deepest(module, taken, batches),
        report=block(cost_report.table(module, functions, taken)) if options.report else [],
        counts=list(counts_of(module).items()),
        functions=[
            (_document(module, x, taken), declare.signature(module, x, statuses))
            for x in module.programs
        ],
        batches=[(_with_stack(x, taken), x.signature) for x in batches],
        left_out=block(batch.left_out(module, batches)) if options.batch else [],
        **common,
    )
    files = {f"{file}.h": real.written(header, options.real), f"{file}.c": source}
    return packages.packed(module, file, files, options)


def _define(
    module: Module,
    program: Program | Routine,
    statuses: dict[str, dict[int, str]],
    kind: straight_line.NumberKind,
    printer: CAlgorithms,
) -> list[Definition]:
    """The definition of a function, preceded by those of its parts."""
    core = bool(statuses[program.name]) and not program.handed
    name, head = program.name, declare.signature(module, program, statuses, core=core)
    if program.handed:
        return [_handed(module, program, head, fails=bool(statuses[name]))]
    if isinstance(program, Routine):
        made = printer.routine(program, head, name + declare.CORE * core)
    else:
        made = straight_line.define(module, program, statuses, kind)
    return [*made, guard.definition(module, program, statuses)] if core else made


def _handed(module: Module, program: Program | Routine, head: str, *, fails: bool) -> Definition:
    """A function that only prepares the constants and calls the one that takes them."""
    macro, prefix = module.name.upper(), module.name
    lines = [f"    double c[{macro}_NK];"]
    if fails:
        lines += [
            f"    if ({prefix}_parameters_not_finite(p) > 0) {{",
            f"        return {macro}_{NOT_FINITE_INPUT.name};",
            "    }",
        ]
    others = [x.name for x in program.arguments if x.name != "p"]
    others += [x.name for x in program.results]
    call = f"{prefix}_{program.handed}({', '.join(['c', *others])});"
    lines += [f"    {prefix}_prepare(p, c);", f"    {'return ' * fails}{call}"]
    frame = frames.StackFrame(
        doubles=counts_of(module)["NK"],
        parameters=len(program.arguments) + len(program.results),
        statements=frames.statements(lines),
        calls={"prepare", program.handed, "parameters_not_finite"},
    )
    return Definition(program.name, head, lines, frame)


def _deepest(module: Module, taken: Mapping[str, int], batches: Sequence[batch.Batch]) -> int:
    """The most stack that a function takes which users call."""
    names = [*(x.name for x in module.programs), *(f"{x.name}_batch" for x in batches)]
    return max((taken[name] for name in names), default=0)


def _needs(module: Module, functions: Sequence[Definition], wide: Sequence[Definition]) -> set[str]:
    """The optional parts of the source's head that some function uses."""
    called = frozenset[str]().union(*(x.frame.calls for x in (*functions, *wide)))
    marks = {
        **{own: f"{own}_of" for own in straight_line.OWN},
        **{"one": "sincos", "all": "all_sincos", "lanes_sincos": "lanes_sincos"},
    }
    found = {key for key, mark in marks.items() if mark in called}
    part = f"{module.name.upper()}_PART "
    return found | {"part"} if any(part in x.head for x in (*functions, *wide)) else found


def _remark(quantity: Quantity) -> str:
    unit, about = comment(quantity.unit), comment(quantity.about)
    return f"{unit}: {about}" if unit and about else unit or about or "no unit"


def _names(macro: str, listing: Listing) -> tuple[str, str, str, list[str]]:
    """An array of names: symbol, what it holds, size and entries."""
    symbol, heading = listing.symbol, listing.heading
    if not listing.quantities:
        return symbol, f"{heading} (none: one empty string, as C has no empty arrays)", "1", ['""']
    entries = [f"{string(x.name)}," for x in listing.quantities]
    return symbol, heading, f"{macro}_{listing.count}", entries


def _failures(module: Module) -> list[str]:
    """The lines of constants for statuses, if any function returns one."""
    found = failures.constants(module)
    if not found:
        return []
    rows = [(f"{module.name.upper()}_{failures.OK}", 0, "the outputs are written")]
    rows += [(name, key[0], "; or ".join(about)) for key, (name, about) in found.items()]
    lines: list[str] = []
    for place, (name, number_, about) in enumerate(rows, 1):
        comma = "," if place < len(rows) else ""
        line = f"{name} = {number_}{comma} /* {comment(about)} */"
        if len(line) > prose.WIDTH:
            lines += ["/*", *block(prose.paragraph(about)), " */"]
            line = f"{name} = {number_}{comma}"
        lines.append(line)
    return lines


def _with_stack(found: batch.Batch, taken: Mapping[str, int]) -> list[str]:
    """The comment above a function of many states."""
    return [*found.document, *block(_stack(taken[f"{found.name}_batch"]))]


def _stack(size: int) -> list[str]:
    return [f"Takes at most {size} bytes of stack."]


def _document(module: Module, program: Program | Routine, taken: Mapping[str, int]) -> list[str]:
    """The lines of the comment above a declaration."""
    lines = [*prose.paragraph(program.about), ""]
    for argument in program.arguments:
        lines += prose.paragraph(f"@param[in] {argument.name} {argument.about}", 4)
    for result in program.results:
        extents = " x ".join(layout.shape(result))
        order = ", row-major" if len(result.shape) > 1 else ""
        lines += prose.paragraph(f"@param[out] {result.name} ({extents}{order}) {result.about}", 4)
    ok = f"{module.name.upper()}_{failures.OK}"
    found = failures.of(module, program)
    if found:
        texts = "; ".join(f"{name} ({number}): {about}" for number, about, name in found)
        lines += prose.paragraph(f"@return {ok} (0), or with all outputs untouched {texts}", 4)
    return block([*lines, *_stack(taken[program.name])])
