"""The spring of 1-D rotation."""

from __future__ import annotations

from dataclasses import dataclass

from linegraph.components.domains import ROTATION_1D
from linegraph.components.scalar.stores import Spring1D


@dataclass(frozen=True)
class RotationalSpring(Spring1D):
    """A spring in 1-D rotation: ``dY/dt = stiffness X``, Y the torque that it is pressed together with.

    Example:
        >>> RotationalSpring("strut", ("car", "wheel"), stiffness=2e4).kind
        'rotational_spring'
    """

    kind = "rotational_spring"
    domain_name = ROTATION_1D.name
