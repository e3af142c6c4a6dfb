"""Stage 6: files from a `Module`.

A language is a package here (what its lines look like), a folder of templates (the shape of its files) and
a line in the register below. Nothing here knows a body or a joint.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from codegen import naming
from codegen.language import Language
from codegen.options import DEFAULT, REAL, TRIG, Options, options_of

if TYPE_CHECKING:
    from linegraph.ir.golden_vectors import Vectors
    from linegraph.ir.program import Module

_REGISTER: dict[str, str | Language] = {
    "c": "codegen.c",
    "python": "codegen.python",
}
"""All languages by name; a package has its own as `LANGUAGE` and is imported when it is written in."""

__all__ = [
    "LANGUAGES",
    "REAL",
    "TRIG",
    "Language",
    "Options",
    "known",
    "naming",
    "options_of",
    "render",
    "render_tests",
]

LANGUAGES = tuple(_REGISTER)
"""The names of all languages, in the order in which they are declared."""


def known(name: str) -> Language:
    """The language of this name, whose package is imported if necessary.

    Raises:
        KeyError: there is no such language.
    """
    found = _REGISTER[name]
    if isinstance(found, Language):
        return found
    language: Language = import_module(found).LANGUAGE
    return language


def render(module: Module, language: str, options: Options = DEFAULT) -> dict[str, str]:
    """The source files of a module in a target language.

    Equal modules give equal text, byte for byte. All text is printable ASCII; lines end with a
    newline character alone.

    Args:
        module: the functions of a model.
        language: one of `LANGUAGES`.
        options: the choices that concern the language; others have no effect.

    Returns:
        The text of each file, by file name.

    Raises:
        NameRefused: something has a name that emitted code cannot use.
        ModelError: a constant is not a finite number.
    """
    naming.validate(module)
    return dict(known(language).render(module, options))


def render_tests(
    module: Module, vectors: Vectors, language: str, options: Options = DEFAULT
) -> dict[str, str]:
    """The program that checks the files of `render` against golden vectors.

    Args:
        module: the functions of a model.
        vectors: arguments and independently computed results.
        language: one of `LANGUAGES`.
        options: those with which the files are rendered.

    Returns:
        The text of each file, by file name; empty for a language without such a program.
    """
    tests = known(language).tests
    return dict(tests(module, vectors, options)) if tests else {}
