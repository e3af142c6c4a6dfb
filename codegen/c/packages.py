"""Emitted C as others take it up: a project of CMake, a library of Arduino's."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from codegen import failures, layout, naming, prose, reserved, templates
from codegen.c import declare
from linegraph.errors import ModelError, NameRefused
from linegraph.ir.program import PREPARED_SUFFIX, counts_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from codegen.options import Options
    from linegraph.ir.program import Module, Program, Routine

_TARGETS = frozenset(
    (
        *(
            "all",
            "ALL_BUILD",
            "clean",
            "edit_cache",
            "help",
            "install",
            "list_install_components",
            "m",
        ),
        *(
            "package",
            "package_source",
            "rebuild_cache",
            "RUN_TESTS",
            "test",
            "ZERO_CHECK",
            "INSTALL",
        ),
        "PACKAGE",
    )
)
"""Reserved names of CMake targets, and the name of the mathematics library."""

_KEYWORD = re.compile(r"[A-Z_]+")
"""How keywords of CMake's commands are written: EXPORT, TARGETS, FILE, STATIC and many more."""

_SHOWN = ("forward_dynamics", "equations", "mass_matrix")
"""The functions that the Arduino example may call; it calls the first that is emitted."""

VERSION = "1.0.0"
"""The version of emitted libraries; it is fixed, so that the same model gives the same files."""

LONGEST = 63
"""Names of Arduino's libraries are at most this long."""


def packed(module: Module, file: str, files: Mapping[str, str], options: Options) -> dict[str, str]:
    """The files of C, with what makes a project or a library of them: path -> text.

    Args:
        module: whose functions, named as their prefix is.
        file: what header and source are called.
        files: header and source.
        options: which of the two is wanted, if any.

    Raises:
        ModelError: the name cannot be that of a target or library.
        NameRefused: the name of a parameter is none where Arduino.h is included.
    """
    if options.cmake:
        return {**files, "CMakeLists.txt": _project(file)}
    if options.arduino:
        return _library(module, file, files, options)
    return dict(files)


def _project(file: str) -> str:
    if file in _TARGETS:
        raise ModelError(f'name "{file}"', "is a target of CMake's own; choose another name")
    if _KEYWORD.fullmatch(file):
        problem = "has capitals alone, as keywords of CMake's have; choose one with small letters"
        raise ModelError(f'name "{file}"', problem)
    return templates.fill(
        "c/packages/CMakeLists.txt.jinja", file=file, macro=file.upper(), version=VERSION
    )


def _library(
    module: Module, file: str, files: Mapping[str, str], options: Options
) -> dict[str, str]:
    if len(file) > LONGEST:
        problem = f"is longer than {LONGEST} characters, the most a library of Arduino's has"
        raise ModelError(f'name "{file}"', f"{problem}; choose another name")
    if file.casefold() in reserved.CORES:
        problem = "would hide a header of Arduino's, capitals or not; choose another name"
        raise ModelError(f'name "{file}"', problem)
    for parameter in module.parameters:
        if reserved.BOARDS.fullmatch(parameter.name):
            what = f"parameter {naming.quote(parameter.name)} cannot be used with Arduino"
            instead = f"rename it; x_{parameter.name} would do"
            raise NameRefused(f"{what}: Arduino.h has macros of such names; {instead}")
    about = " ".join(declare.comment(text) for text in module.about[:1])
    constants = [f"{module.name.upper()}_{x}" for x in counts_of(module)]
    constants += [name for name, _ in failures.constants(module).values()]
    texts = {
        "library.properties": templates.fill(
            "c/packages/library.properties.jinja",
            file=file,
            about=about,
            author="linegraph",
            version=VERSION,
        ),
        "keywords.txt": templates.fill(
            "c/packages/keywords.txt.jinja",
            types=[f"{module.name}_parameters"] if module.parameters else [],
            functions=[f"{module.name}_{program.name}" for program in module.programs],
            constants=constants,
        ),
        f"examples/{file}/{file}.ino": _example(module, file, options.real),
    }
    sources = {f"src/{name}": text for name, text in files.items()}
    return {f"{file}/{path}": text for path, text in (sources | texts).items()}


def _example(module: Module, file: str, real: str) -> str:
    """A sketch that calls one function."""
    program = _shown(module)
    name = f"{module.name}_{program.name}"
    fails = bool(failures.statuses(module)[program.name])
    macro = f"{module.name.upper()}_"
    declarations, given = [], []
    for argument in program.arguments:
        if argument.name == "p":
            given.append(f"&{module.name}_default_parameters")
        elif argument.size is None:
            declarations.append(f"static {real} {argument.name} = 0;")
            given.append(argument.name)
        else:
            size = layout.extent(argument, macro)
            begin = "{0}" if argument.name != "q" else f"{{{', '.join(_rest(module)) or '0'}}}"
            text = f"static {real} {argument.name}[{size if argument.size else 1}] = {begin};"
            declarations.append(f"{text} // {declare.comment(prose.plain(argument.about))}")
            given.append(argument.name)
    outputs = []
    for result in program.results:
        size = " * ".join(layout.shape(result, macro))
        size = size if all(result.shape) else "1"
        declarations.append(f"static {real} {result.name}[{size}];")
        outputs.append((result.name, size))
        given.append(result.name)
    call = f"called({', '.join(given)});"
    return templates.fill(
        "c/packages/example.ino.jinja",
        file=file,
        function=name,
        declarations=declarations,
        prepared=[],
        call=f"const int status = {call}" if fails else call,
        status=fails,
        ok=f"{macro}{failures.OK}",
        outputs=outputs,
    )


def _shown(module: Module) -> Program | Routine:
    """What the sketch calls: of `_SHOWN`, else the first that computes from the parameters themselves."""
    programs = {program.name: program for program in module.programs}
    own = [x for x in programs if x != "prepare" and not x.endswith(PREPARED_SUFFIX)]
    return programs[next(name for name in (*_SHOWN, *own, *programs) if name in programs)]


def _rest(module: Module) -> list[str]:
    """Coordinates to begin with: zero, and quaternions that turn nothing.

    A quaternion is four numbers without unit, one after the other, that are called alike up to x, y, z, w.
    """
    begin = ["0"] * len(module.positions)
    for k in range(3, len(begin)):
        four = module.positions[k - 3 : k + 1]
        stem = four[0].name.removesuffix("qx")
        if [(x.name, x.unit) for x in four] == [(f"{stem}q{c}", "1") for c in "xyzw"]:
            begin[k] = "1"
    return begin
