"""Requested frames, and their identifiers in the names of emitted functions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.kinematics.frame_trees import NamedFrame, require_frame

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.model.system import System


def named_frames(system: System, frames: Iterable[str]) -> tuple[NamedFrame, ...]:
    """Bodies and ``body.frame`` with their identifiers, each once.

    Args:
        system: has the bodies and frames.
        frames: names as in the model; a single name is allowed.

    Raises:
        ModelError: there is no such frame.
        NameRefused: two frames get the same identifier.
    """
    from codegen import naming

    names = list(dict.fromkeys((frames,) if isinstance(frames, str) else frames))
    for name in names:
        require_frame(system, name)
    called = naming.identifiers(names, "frame", naming.stem)
    return tuple(NamedFrame(*pair) for pair in zip(called, names, strict=True))
