"""What is wanted of a model: which functions, of which frames, with parameters as symbols or as numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linegraph.kinematics.frame_trees import NamedFrame


@dataclass(frozen=True)
class Request:
    """Which functions of a model to make.

    Attributes:
        folded: whether parameters become numbers.
        wanted: further functions besides those made by default, of `register.ON_REQUEST`.
        only: nothing but these of `register.PROGRAMS`, those `wanted`, and what they call; all if empty.
        frames: the frames whose kinematics are wanted.
        prologue: whether what parameters alone determine is hoisted into a function of its own.
    """

    folded: bool = False
    wanted: tuple[str, ...] = ()
    only: tuple[str, ...] = ()
    frames: tuple[NamedFrame, ...] = ()
    prologue: bool = True
