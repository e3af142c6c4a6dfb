"""Named outputs: quantities that a model lets emitted code return."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Output:
    """A quantity that emitted code returns by name.

    Attributes:
        name: unique among outputs.
        value: an expression, or its text.
        unit: for readers; it is not checked.
        about: its meaning, for readers.
    """

    name: str
    value: Any
    unit: str = ""
    about: str = ""
