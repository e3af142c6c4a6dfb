"""A request for functions: which, for which frames, with parameters as symbols or as numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linegraph.kinematics.frame_trees import NamedFrame


@dataclass(frozen=True)
class Request:
    """Which functions of a model to make, and in which form.

    Attributes:
        folded: whether parameters become numbers.
        wanted: functions of `register.ON_REQUEST` in addition to the default ones.
        only: if not empty, nothing but these of `register.PROGRAMS`, those `wanted`, and functions they
            call.
        frames: the frames whose kinematics are needed.
        prologue: whether subexpressions of parameters alone move into a function of their own.
    """

    folded: bool = False
    wanted: tuple[str, ...] = ()
    only: tuple[str, ...] = ()
    frames: tuple[NamedFrame, ...] = ()
    prologue: bool = True
