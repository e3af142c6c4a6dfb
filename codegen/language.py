"""The interface between code generation and a target language."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from codegen.options import Options
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
