"""Stage 6: files from a `Module`.

One language is one file here (what its lines look like), one folder of templates (the shape of its
files) and one line in the register below. Nothing here knows a body or a joint.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from codegen import c, golden, naming, options, python
from codegen.options import DEFAULT, REAL, TRIG, Options, options_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from linegraph.ir.golden_vectors import Vectors
    from linegraph.ir.program import Module

    Render = Callable[[Module, Options], Mapping[str, str]]
    RenderTests = Callable[[Module, Vectors, Options], Mapping[str, str]]


@dataclass(frozen=True)
class Language:
    """A language that modules are written in.

    Attributes:
        render: the files of a module: file name -> text.
        tests: the program that checks these files against golden vectors; None where there is none.
        options: the names of the `Options` that concern it.
    """

    render: Render
    tests: RenderTests | None = None
    options: frozenset[str] = frozenset()


_REGISTER: dict[str, Language | Render] = {
    "c": Language(c.render, golden.in_c, options.NAMES),
    "python": Language(python.render, golden.in_python),
}
"""All languages by name; one without golden vectors and options may be its `render` alone."""

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
    """One of `LANGUAGES`."""
    found = _REGISTER[name]
    return found if isinstance(found, Language) else Language(found)


def render(module: Module, language: str, options: Options = DEFAULT) -> dict[str, str]:
    """The files of a module in one of `LANGUAGES`: file name -> text.

    Equal modules give equal text, byte for byte. All text is printable ASCII; lines end with a
    newline character alone.

    Raises:
        NameRefused: something has a name that emitted code cannot carry.
        ModelError: a constant is not a finite number.
    """
    naming.validate(module)
    return dict(known(language).render(module, options))


def render_tests(
    module: Module, vectors: Vectors, language: str, options: Options = DEFAULT
) -> dict[str, str]:
    """The program that checks those files against golden vectors: file name -> text.

    Nothing for a language that has no such program.
    """
    tests = known(language).tests
    return dict(tests(module, vectors, options)) if tests else {}
