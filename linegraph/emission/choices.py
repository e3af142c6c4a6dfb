"""What users choose of emitted files besides their name, languages and tests."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, NamedTuple, TypedDict

import codegen
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable


class EmitChoices(TypedDict, total=False):
    """The keywords of `emit`; all may be left out.

    Attributes:
        folded: write the parameters' values into the code instead of keeping them symbolic.
        functions: further functions to write, of `programs.register.ON_REQUEST`.
        only: write nothing but these of `programs.register.PROGRAMS` and what they call.
        frames: bodies, or frames of bodies as ``body.frame``, whose kinematics are to be written.
        progress: called with a short text before each stage.
        warn: called with what a reader must know of the files; default a Python warning.
        trig: where sines and cosines come from, "libm" or "inline".
        batch: whether functions of many states are written, too.
        real: the type of numbers, "double" or "float".
        prefix: of functions, types and macros, in place of the name.
        cmake: whether a CMake project comes with the files.
        arduino: whether the files are an Arduino library.
        report: whether the header says what each function costs.
    """

    folded: bool
    functions: Iterable[str]
    only: Iterable[str]
    frames: Iterable[str]
    progress: Callable[[str], None] | None
    warn: Callable[[str], None] | None
    trig: str
    batch: bool
    real: str
    prefix: str | None
    cmake: bool
    arduino: bool
    report: bool


class Chosen(NamedTuple):
    """`EmitChoices` with all that was left out.

    Attributes:
        folded, functions, only, frames, progress, warn: as in `EmitChoices`.
        options: those that concern how a language is written.
        asked: the names of options that differ from their defaults.
    """

    folded: bool
    functions: tuple[str, ...]
    only: tuple[str, ...]
    frames: tuple[str, ...]
    progress: Callable[[str], None]
    warn: Callable[[str], None]
    options: codegen.Options
    asked: frozenset[str]

    def languages(self, wanted: Iterable[str] | None) -> tuple[str, ...]:
        """The languages to write: those wanted, or all that can be written so.

        Raises:
            ModelError: one is not known, or an option concerns none of them.
        """
        heeding = [x for x in codegen.LANGUAGES if self.asked & codegen.known(x).options]
        default = heeding if self.options.arduino else codegen.LANGUAGES
        chosen = tuple(dict.fromkeys(several(wanted or default)))
        for language in chosen:
            if language not in codegen.LANGUAGES:
                known = ", ".join(codegen.LANGUAGES)
                raise ModelError(f'language "{language}"', f"is not known; known: {known}")
        if self.asked and not set(heeding) & set(chosen):
            whose, given = " or ".join(map(str.capitalize, heeding)), ", ".join(sorted(self.asked))
            problem = f"{whose} is not written: add it to the languages"
            raise ModelError(f"options of {whose} ({given})", problem)
        return chosen


def chosen(choices: EmitChoices) -> Chosen:
    """All choices.

    Raises:
        ModelError: there is no such choice.
    """
    rest: dict[str, Any] = dict(choices)
    folded = bool(rest.pop("folded", False))
    functions, only, frames = (several(rest.pop(x, ())) for x in ("functions", "only", "frames"))
    progress = rest.pop("progress", None) or (lambda text: None)
    warn = rest.pop("warn", None) or _python_warning
    options = codegen.options_of(rest)
    asked = frozenset(name for name, x in rest.items() if x != getattr(codegen.Options(), name))
    return Chosen(folded, functions, only, frames, progress, warn, options, asked)


def several(names: Iterable[str]) -> tuple[str, ...]:
    """Names; one alone is one."""
    return (names,) if isinstance(names, str) else tuple(names)


def _python_warning(text: str) -> None:
    warnings.warn(text, stacklevel=4)
