"""How a language is to write a module, where there is a choice."""

from __future__ import annotations

from dataclasses import dataclass

from linegraph.errors import ModelError

TRIG = ("libm", "inline")
"""Whose sine and cosine C calls: the library's, or those of the emitted file itself."""


@dataclass(frozen=True)
class Options:
    """Choices that concern one language and change no value beyond rounding.

    Attributes:
        trig: one of `TRIG`; C only.
        batch: whether there are functions of many states; C only, as all functions of Python are.
    """

    trig: str = TRIG[0]
    batch: bool = False

    def __post_init__(self) -> None:
        """Raises `ModelError` for what is no choice."""
        if self.trig not in TRIG:
            raise ModelError(f'trig "{self.trig}"', f"is not known; known: {', '.join(TRIG)}")
        if not isinstance(self.batch, bool):
            raise ModelError("batch", f"is True or False, not {self.batch!r}")


DEFAULT = Options()
