"""Names: checks that they are identifiers in every target language, and makes such from any text."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from codegen import reserved
from linegraph.errors import NameRefused
from linegraph.ir.program import counts_of, named_listings

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from linegraph.ir.program import Module, Program, Routine

LONGEST = 128
"""Identifiers are at most this long, so that they also do as file names."""

LONGEST_STEM = LONGEST - 48
"""What names begin with leaves place for what they end with."""

LONGEST_TEXT = 1000
"""C compilers need to accept string literals of 4095 bytes only."""

_IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_TEMPORARY = re.compile(r"t[0-9]+")


def identifier(text: str) -> str:
    """An identifier that every language accepts, as close to `text` as can be.

    Runs of anything but ASCII letters and digits become one ``_``; a leading digit, and a word that
    is taken, get ``x_`` before them.

    Example:
        >>> identifier("2-link arm"), identifier("class"), identifier("arm_2")
        ('x_2_link_arm', 'x_class', 'arm_2')
    """
    name = "_".join(re.findall(r"[A-Za-z0-9]+", text)) or "x"
    name = name[: LONGEST - 2].rstrip("_")
    taken = name in reserved.FILES or name in reserved.CLASS or _problem(name) is not None
    return f"x_{name}" if taken else name


def stem(text: str) -> str:
    """The start of identifiers, as close to `text` as can be: words that are taken are none in longer ones.

    Example:
        >>> stem("tool.tip"), stem("class"), stem("2nd arm")
        ('tool_tip', 'class', 'x_2nd_arm')
    """
    name = "_".join(re.findall(r"[A-Za-z0-9]+", text))[:LONGEST_STEM].rstrip("_") or "x"
    return f"x_{name}" if name[0].isdigit() else name


def identifiers(
    texts: Sequence[str], what: str, made: Callable[[str], str] = identifier
) -> tuple[str, ...]:
    """An identifier for each of some names, all different.

    Args:
        texts: the names.
        what: the kind of object that they name, for messages, such as ``joint``.
        made: makes an identifier from a name: `identifier` or `stem`.

    Raises:
        NameRefused: two names become the same identifier.
    """
    first: dict[str, str] = {}
    for text in texts:
        name = made(text)
        if name in first:
            both = f"{what} {quote(first[name])} and {what} {quote(text)}"
            raise NameRefused(f"{both}: both become {name} in emitted code; rename one of them")
        first[name] = text
    return tuple(first)


def validate(module: Module) -> None:
    """Refuse what an emitted file could not carry.

    Raises:
        NameRefused: says which name, why, and what to use instead.
    """
    if module.name in reserved.FILES:
        raise _refused("model", module.name, "files of this name would hide those of C or Python")
    _accept("model", module.name)
    if module.name.endswith("_"):
        raise _refused("model", module.name, "functions' names would have two underscores in a row")
    macros = {f"{module.name.upper()}_{end}" for end in (*counts_of(module), *reserved.HEADS)}
    for parameter in module.parameters:
        _accept("parameter", parameter.name)
        if parameter.name in macros:
            raise _refused("parameter", parameter.name, "it is a macro of the emitted files")
        if parameter.name in reserved.CLASS:
            raise _refused("parameter", parameter.name, "the emitted Python class uses it")
    _distinct("parameter", (parameter.name for parameter in module.parameters))
    _distinct("function", (program.name for program in module.programs))
    for program in module.programs:
        _validate_program(program)
    for quantity in (x for listing in named_listings(module) for x in listing.quantities):
        if len(quantity.name) > LONGEST_TEXT:
            size = f"it has {len(quantity.name)} characters, more than {LONGEST_TEXT}"
            raise NameRefused(
                f"coordinate or input {quote(quantity.name)} cannot be emitted: {size}"
            )


def validate_prefix(prefix: str) -> None:
    """Refuse a prefix with which names would be none.

    Raises:
        NameRefused: says why, and what to use instead.
    """
    _accept("prefix", prefix)
    if prefix.endswith("_"):
        raise _refused("prefix", prefix, "functions' names would have two underscores in a row")
    if prefix in reserved.FILES:
        raise _refused("prefix", prefix, "it is the name of a header of C or a module of Python")


def quote(text: str) -> str:
    """Any text, made fit to stand in a message: escaped, and cut where it is long."""
    return ascii(text) if len(text) <= 60 else f"{text[:60]!a}..."


def _validate_program(program: Program | Routine) -> None:
    arguments = [argument.name for argument in program.arguments]
    results = [result.name for result in program.results]
    locals_ = [result.name for call in program.calls for result in call.results]
    for what, name in [
        ("function", program.name),
        *(("argument", name) for name in arguments),
        *(("result", name) for name in results + locals_),
    ]:
        _accept(what, name)
        if name in reserved.CODE or _TEMPORARY.fullmatch(name):
            raise _refused(what, name, "the emitted files use it themselves")
    _distinct(f"name in the function {program.name},", arguments + results + locals_)


def _accept(what: str, name: str) -> None:
    problem = _problem(name)
    if problem is not None:
        raise _refused(what, name, problem)


def _problem(name: str) -> str | None:
    """Why `name` cannot be an identifier everywhere; None where it can."""
    if not _IDENTIFIER.fullmatch(name):
        return "it must start with a letter and have ASCII letters, digits and _ only"
    if "__" in name:
        return "C++ reserves names with two underscores in a row"
    if len(name) > LONGEST:
        return f"it has {len(name)} characters, more than {LONGEST}"
    if name in reserved.KEYWORDS:
        return "it is a keyword of C, C++ or Python"
    if name in reserved.MACROS or reserved.MACRO_FAMILIES.match(name):
        return "it is a macro of the C compiler or of <math.h>"
    return None


def _distinct(what: str, names: Iterable[str]) -> None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise _refused(what, name, "it is there twice")
        seen.add(name)


def _refused(what: str, name: str, problem: str) -> NameRefused:
    instead = identifier(name)
    advice = "" if instead == name else f"; {instead} would do"
    return NameRefused(f"{what} {quote(name)} cannot be used in emitted code: {problem}{advice}")
