"""Named outputs: what a model asks emitted code to return."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Output:
    """A quantity that emitted code returns by name.

    Attributes:
        value: an expression, or its text.
    """

    name: str
    value: Any
    unit: str = ""
    about: str = ""
