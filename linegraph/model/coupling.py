"""Joints that follow others: gears, belts, mimic joints of URDF."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Coupling:
    """``q_joint = ratio q_master + offset`` between two joints of one freedom each.

    Attributes:
        joint: the follower, without a coordinate of its own.
        master: the joint that it follows.
        ratio: dimensionless between joints of the same kind, else rad/m or m/rad.
        offset: in the unit of the follower's coordinate (rad or m).
    """

    joint: str
    master: str
    ratio: Any = 1
    offset: Any = 0
