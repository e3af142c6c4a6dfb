"""A joint held at a value of its coordinate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.algebra.protocol import Constants
from linegraph.spatial.placement import Placement, compose, inverse
from linegraph.spatial.rotation import snapped
from linegraph.spatial.vector import ZERO

if TYPE_CHECKING:
    from linegraph.components.joints import Joint


def moved(near: Placement, joint: Joint, value: Any, snap: float) -> Placement:
    """The head frame of a one-freedom joint at a fixed value of its coordinate."""
    alignment = Placement(ZERO, joint.alignment())
    motion = joint.motion(Constants(), (value,), (0,))
    turn = Placement(motion.displacement, snapped(motion.rotation.matrix(), snap))
    there = compose(compose(near, alignment, snap), turn, snap)
    return compose(there, inverse(alignment), snap)
