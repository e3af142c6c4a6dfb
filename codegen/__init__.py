"""Stage 6: files from a `Module`.

One language is one file here (what its lines look like), one folder of templates (the shape of its
files) and one line in the register below. Nothing here knows a body or a joint.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from codegen import c, golden, naming, python
from codegen.options import DEFAULT, REAL, TRIG, Options, options_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.program import Module
    from linegraph.vectors import Vectors

_REGISTER: dict[str, Callable[[Module, Options], dict[str, str]]] = {
    "c": c.render,
    "python": python.render,
}

__all__ = [
    "LANGUAGES",
    "REAL",
    "TRIG",
    "Options",
    "naming",
    "options_of",
    "render",
    "render_tests",
]

LANGUAGES = tuple(_REGISTER)
"""The names of all languages, in the order in which they are declared."""


def render(module: Module, language: str, options: Options = DEFAULT) -> dict[str, str]:
    """The files of a module in one of `LANGUAGES`: file name -> text.

    Equal modules give equal text, byte for byte. All text is printable ASCII; lines end with a
    newline character alone.

    Raises:
        NameRefused: something has a name that emitted code cannot carry.
        ModelError: a constant is not a finite number.
    """
    naming.validate(module)
    return _REGISTER[language](module, options)


def render_tests(
    module: Module, vectors: Vectors, language: str, options: Options = DEFAULT
) -> dict[str, str]:
    """The program that checks those files against golden vectors: file name -> text."""
    return golden.render(module, vectors, language, options)
