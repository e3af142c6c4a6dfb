"""C: ``NAME.h`` and ``NAME.c``, in the common part of C99 and C++."""

from __future__ import annotations

from typing import TYPE_CHECKING

from codegen import layout, prose, routines, templates
from codegen.printer import Notation, number, print_program
from linegraph.functions import ARITY
from linegraph.program import Routine

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.program import Argument, Call, Check, Listing, Module, Program, Quantity

_WIDTH = 100


def render(module: Module) -> dict[str, str]:
    """The header and the source of a module."""
    statuses = layout.statuses(module)
    macro = module.name.upper()
    common = {
        "name": module.name,
        "macro": macro,
        "parameters": [(x.name, number(layout.default(x)), _remark(x)) for x in module.parameters],
        "names": [_names(macro, listing) for listing in layout.named(module)],
    }
    header = templates.fill(
        "c/header.h.jinja",
        head=_block(layout.head(module)),
        counts=list(layout.counts(module).items()),
        functions=[
            (_document(module, x, statuses[x.name]), _signature(module, x, statuses))
            for x in module.programs
        ],
        **common,
    )
    functions = [
        (_signature(module, x, statuses), _body(module, x, statuses)) for x in module.programs
    ]
    sign = any(_FUNCTIONS["sign"] in line for _, body in functions for line in body)
    helpers = routines.helpers(module)
    source = templates.fill(
        "c/source.c.jinja",
        functions=functions,
        sign=sign,
        helpers=helpers,
        w_at=routines.independent(module),
        quaternions=routines.quaternions(module),
        **common,
    )
    return {f"{module.name}.h": header, f"{module.name}.c": source}


def comment(text: str) -> str:
    """Any text as part of a comment, which it cannot end, continue or nest."""
    return _escape(prose.plain(text))


def string(text: str) -> str:
    """A string literal of exactly the bytes of `text` in UTF-8."""
    return '"' + "".join(map(_BYTES.__getitem__, text.encode("utf-8", "backslashreplace"))) + '"'


_BYTES = [f"\\{byte:03o}" for byte in range(256)]
for _letter in map(chr, range(ord(" "), ord("~") + 1)):
    if _letter not in '"\\?':
        _BYTES[ord(_letter)] = _letter
"""Octal escapes end after three digits, whatever follows; ``?`` is escaped to exclude trigraphs."""


def _block(lines: Iterable[str]) -> list[str]:
    """Lines of printable ASCII as lines within a comment."""
    return [f" * {_escape(line)}".rstrip() for line in lines]


def _escape(text: str) -> str:
    """Printable ASCII without what ends or nests a comment or splices lines (``??/`` does, too)."""
    text = text.replace("\\", "/").replace("?/", "? /")
    return text.replace("*/", "* /").replace("/*", "/ *")


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


def _document(module: Module, program: Program | Routine, statuses: dict[int, str]) -> list[str]:
    """The lines of the comment above a declaration."""
    lines = [*prose.paragraph(program.about), ""]
    for argument in program.arguments:
        lines += prose.paragraph(f"@param[in] {argument.name} {argument.about}", 4)
    for result in program.results:
        extents = " x ".join(layout.shape(module, result))
        order = ", row-major" if len(result.shape) > 1 else ""
        lines += prose.paragraph(f"@param[out] {result.name} ({extents}{order}) {result.about}", 4)
    if statuses:
        failures = "; ".join(f"{status}: {about}" for status, about in sorted(statuses.items()))
        lines += prose.paragraph(f"@return 0, or with all outputs untouched {failures}", 4)
    elif program.status:
        lines += prose.paragraph("@return 0: it cannot fail")
    return _block(lines)


def _signature(
    module: Module, program: Program | Routine, statuses: dict[str, dict[int, str]]
) -> str:
    prefix = f"{module.name.upper()}_"
    parts = [_argument(module, argument, prefix) for argument in program.arguments]
    for result in program.results:
        size = " * ".join(layout.shape(module, result, prefix))
        parts.append(f"double {result.name}[{size if all(result.shape) else 1}]")
    returned = "int" if program.status or statuses[program.name] else "void"
    head = f"{returned} {module.name}_{program.name}("
    line = f"{head}{', '.join(parts)})"
    return line if len(line) < _WIDTH else head + f",\n{' ' * len(head)}".join(parts) + ")"


def _argument(module: Module, argument: Argument, prefix: str) -> str:
    if argument.size is not None:
        size = layout.extent(module, argument.name, argument.size, prefix)
        return f"const double {argument.name}[{size if argument.size else 1}]"
    if argument.name == "p":
        return f"const {module.name}_parameters *p"
    return f"double {argument.name}"


def _body(
    module: Module, program: Program | Routine, statuses: dict[str, dict[int, str]]
) -> list[str]:
    """The lines between the braces of a definition."""
    if program.handed:
        return routines.handed(module, program, "c", f"{module.name}_")
    if isinstance(program, Routine):
        return routines.body(module, program, "c", f"{module.name}_")
    body = print_program(program, _NOTATION)
    lines = [
        f"    double {local.name}[{local.size or 1}];"
        for call in program.calls
        for local in call.results
    ]
    fails = [bool(statuses[call.program]) for call in program.calls]
    if any(fails):
        lines.append("    int status;")
    used = body.used.union(*(call.arguments for call in program.calls))
    lines += [f"    (void){x.name};" for x in program.arguments if x.name not in used]
    lines += [f"    (void){x.name};" for x in program.results if not x.entries]
    for call, may_fail in zip(program.calls, fails, strict=True):
        lines += _call(module, call, may_fail)
    lines += body.lines
    for result, entries in zip(program.results, body.results, strict=True):
        lines += [f"    {result.name}[{i}] = {entry};" for i, entry in enumerate(entries)]
    if program.status or statuses[program.name]:
        lines.append("    return 0;")
    return lines


def _call(module: Module, call: Call, may_fail: bool) -> list[str]:
    names = ", ".join((*call.arguments, *(local.name for local in call.results)))
    line = f"{module.name}_{call.program}({names});"
    if not may_fail:
        return [f"    {line}"]
    return [f"    status = {line}", "    if (status != 0) {", "        return status;", "    }"]


def _check(value: str, bound: str, check: Check) -> list[str]:
    """Written so that NaN fails, too."""
    return [
        f"    if (!({value} > {bound})) {{ /* {comment(check.about)} */",
        f"        return {check.status};",
        "    }",
    ]


_RENAMED = {"abs": "fabs", "min": "fmin", "max": "fmax", "sign": "sign_of"}
_FUNCTIONS = {name: f"{_RENAMED.get(name, name)}(" for name in ARITY}

_NOTATION = Notation(
    before="    const double ",
    after=";",
    member="p->",
    functions=_FUNCTIONS,
    comment=lambda label: f"    /* {comment(label)} */",
    check=_check,
)
