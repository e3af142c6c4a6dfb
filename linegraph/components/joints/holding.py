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
    """The place of the head frame of a joint that is held at a value of its coordinate.

    Args:
        near: the tail frame, in the body that the head becomes part of.
        joint: a joint with one freedom.
        value: its coordinate, a number (rad or m).
        snap: entries of rotations closer than this to 0, 1 and the like become exactly that.

    Returns:
        The head frame in the same body.
    """
    alignment = Placement(ZERO, joint.alignment())
    motion = joint.motion(Constants(), (value,), (0,))
    turn = Placement(motion.displacement, snapped(motion.rotation.matrix(), snap))
    there = compose(compose(near, alignment, snap), turn, snap)
    return compose(there, inverse(alignment), snap)
