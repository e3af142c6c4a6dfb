"""The relative motion of two frames that a joint connects."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.spatial import vector
from linegraph.spatial.vector import ZERO, Vector, add, cross

if TYPE_CHECKING:
    from linegraph.spatial.rotation import Rotation


class Motion(NamedTuple):
    """The relative motion a joint allows, head relative to tail.

    With relative angular velocity w = sum_a angular[a] v_a and relative velocity of the head's origin
    u = sum_a linear[a] v_a, both in head axes, their derivatives as seen in the head frame are
    sum_a angular[a] v̇_a + angular_bias and sum_a linear[a] v̇_a + linear_bias.

    Attributes:
        rotation: head components to tail components.
        displacement: origin of the head frame from that of the tail frame, in tail axes (m).
        angular, linear: one 3-vector for each velocity coordinate, in head axes.
        angular_bias, linear_bias: the derivatives at v̇ = 0, in head axes.
    """

    rotation: Rotation
    displacement: Vector
    angular: tuple[Vector, ...]
    linear: tuple[Vector, ...]
    angular_bias: Vector = ZERO
    linear_bias: Vector = ZERO


def reverse(motion: Motion) -> Motion:
    """The motion of the tail relative to the head, for a joint whose edge points towards the root.

    With d from the head's origin to the tail's, the tail's origin moves at -(u + w x d) relative to the head.
    The biases transform in the same way: in the derivative as seen from the tail, two terms w x u cancel.

    Args:
        motion: head relative to tail, in head axes.

    Returns:
        Tail relative to head, in tail axes.
    """
    r = motion.rotation
    at = vector.negate(r.into(motion.displacement))

    def moment(s: Vector, u: Vector) -> Vector:
        return r.out(vector.negate(add(cross(s, at), u)))

    return Motion(
        r.inverse(),
        at,
        tuple(r.out(vector.negate(s)) for s in motion.angular),
        tuple(moment(s, u) for s, u in zip(motion.angular, motion.linear, strict=True)),
        r.out(vector.negate(motion.angular_bias)),
        moment(motion.angular_bias, motion.linear_bias),
    )
