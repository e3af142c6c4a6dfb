"""Elements of C text: comments, strings and the heads of functions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from codegen import layout, prose

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.ir.program import Argument, Module, Program, Result, Routine

_WIDTH = 100

CORE = "_core"
"""How the name of a function ends that does the work of one that reports a status."""


def comment(text: str) -> str:
    """Any text as part of a comment, which it cannot end, continue or nest."""
    return escape(prose.plain(text))


def string(text: str) -> str:
    """A string literal of exactly the bytes of `text` in UTF-8."""
    return '"' + "".join(map(_BYTES.__getitem__, text.encode("utf-8", "backslashreplace"))) + '"'


_BYTES = [f"\\{byte:03o}" for byte in range(256)]
for _letter in map(chr, range(ord(" "), ord("~") + 1)):
    if _letter not in '"\\?':
        _BYTES[ord(_letter)] = _letter
"""Octal escapes end after three digits, whatever follows; ``?`` is escaped to exclude trigraphs."""


def block(lines: Iterable[str]) -> list[str]:
    """Lines of printable ASCII as lines within a comment."""
    return [f" * {escape(line)}".rstrip() for line in lines]


def escape(text: str) -> str:
    """Printable ASCII without what ends or nests a comment or splices lines (``??/`` does, too)."""
    text = text.replace("\\", "/").replace("?/", "? /")
    return text.replace("*/", "* /").replace("/*", "/ *")


def signature(
    module: Module,
    program: Program | Routine,
    statuses: dict[str, dict[int, str]],
    *,
    core: bool = False,
) -> str:
    """The head of a function of C, without a semicolon or brace.

    Args:
        module: the module.
        program: the function.
        statuses: for each function of the module, the meaning of each status; empty if it has none.
        core: whether it is the internal function that does the work of one that reports a status.
    """
    parts = [argument(module, x) for x in program.arguments]
    parts += [result(module, x) for x in program.results]
    returned = "int" if statuses[program.name] else "void"
    if core:
        returned = f"{module.name.upper()}_PART {returned}"
    return head(f"{returned} {module.name}_{program.name}{CORE * core}(", parts)


def head(start: str, parts: Sequence[str]) -> str:
    """The head of a function: parameters on one line if it is short enough, else one per line.

    Args:
        start: the text up to and including the opening parenthesis.
        parts: the declarations of the parameters; ``void`` is written if there are none.
    """
    line = f"{start}{', '.join(parts) or 'void'})"
    return line if len(line) < _WIDTH else start + f",\n{' ' * len(start)}".join(parts) + ")"


def argument(module: Module, given: Argument, number: str = "double") -> str:
    """The declaration of a parameter that is read.

    Args:
        module: the module; array sizes are macros with its name as prefix.
        given: an array of numbers, the parameters of the model, or the time.
        number: the type of the array's entries.
    """
    if given.size is not None:
        size = layout.extent(given, f"{module.name.upper()}_")
        return f"const {number} {given.name}[{size if given.size else 1}]"
    if given.name == "p":
        return f"const {module.name}_parameters *p"
    return f"double {given.name}"


def result(module: Module, given: Result, number: str = "double") -> str:
    """The declaration of a parameter that is written, which must not alias any other one.

    Args:
        module: the module; array sizes are macros with its name as prefix.
        given: a result; a matrix is a row-major array of one dimension.
        number: the type of the array's entries.
    """
    macro = module.name.upper()
    size = " * ".join(layout.shape(given, f"{macro}_"))
    return f"{number} {given.name}[{macro}_RESTRICT {size if all(given.shape) else 1}]"
