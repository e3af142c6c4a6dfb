"""The options of code generation."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Mapping

TRIG = ("libm", "inline")
"""The sine and cosine that C calls: those of the library or of the emitted file itself."""

REAL = ("double", "float")
"""The type of C's numbers."""


@dataclass(frozen=True)
class Options:
    """Choices that concern some languages only and change no value beyond rounding; today all are about C.

    Attributes:
        trig: one of `TRIG`.
        batch: whether there are functions of many states, as all functions of Python are.
        real: one of `REAL`.
        prefix: of functions, types and macros; None for the module's name.
        cmake: whether a project of CMake that builds, installs and exports a library comes with the files.
        arduino: whether the files are laid out as a library of Arduino's.
        report: whether the header says what each function costs.
    """

    trig: str = TRIG[0]
    batch: bool = False
    real: str = REAL[0]
    prefix: str | None = None
    cmake: bool = False
    arduino: bool = False
    report: bool = False

    def __post_init__(self) -> None:
        """Validate the values; raises `ModelError` for an unknown or contradictory choice."""
        for what, known in (("trig", TRIG), ("real", REAL)):
            value = getattr(self, what)
            if value not in known:
                raise ModelError(f'{what} "{value}"', f"is not known; known: {', '.join(known)}")
        if not isinstance(self.prefix, str | None):
            raise ModelError("prefix", f"is a text, not {self.prefix!r}")
        for what in ("batch", "cmake", "arduino", "report"):
            if not isinstance(getattr(self, what), bool):
                raise ModelError(what, f"is True or False, not {getattr(self, what)!r}")
        if self.real == "float" and (self.batch or self.trig == "inline"):
            what = (
                "functions of many states" if self.batch else "sines and cosines of the file itself"
            )
            raise ModelError('real "float"', f"has no {what}: leave one of the two out")
        if self.cmake and self.arduino:
            raise ModelError(
                "arduino", "has a layout of its own: emit for CMake into another folder"
            )


DEFAULT = Options()

NAMES = frozenset(field.name for field in fields(Options))
"""Of all options."""


def options_of(choices: Mapping[str, object]) -> Options:
    """Options by name.

    Raises:
        ModelError: there is no option of this name, or not this choice.

    Example:
        >>> options_of({"real": "float"}).real
        'float'
    """
    for name in choices:
        if name not in NAMES:
            known = ", ".join(field.name for field in fields(Options))
            raise ModelError(f'option "{name}"', f"is not known; known: {known}")
    return Options(**choices)  # type: ignore[arg-type]
