"""Joints that follow others: gears, belts, mimic joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Coupling:
    """``q_joint = ratio q_master + offset`` between two joints of one freedom each."""

    joint: str
    master: str
    ratio: Any = 1
    offset: Any = 0
