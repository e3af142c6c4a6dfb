"""How a language is to write a module, where there is a choice."""

from __future__ import annotations

from dataclasses import dataclass

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


DEFAULT = Options()
