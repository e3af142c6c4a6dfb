"""Forces, torques and moving places with the sizes that rounding errors are measured by (`cuts`)."""

from __future__ import annotations

from typing import Any, NamedTuple

Array = Any


Sized = tuple[float, float]
"""A number and its size: the magnitude of the terms that it is the sum of."""


class Pull(NamedTuple):
    """A force and a torque about a point, in ground axes, with their sizes.

    Attributes:
        force, torque: 3 each (N and N m).
        point: 3, reference point of the torque, from ground's origin (m).
        of_force, of_torque: sizes: the sums of the magnitudes of the terms.
    """

    force: Array
    torque: Array
    point: Array
    of_force: float
    of_torque: float

    def about(self, point: Array) -> Pull:
        """Move the reference point: ``n' = n + (p - p') x f``.

        The size of the torque grows by the lever arm times the size of the force.
        """
        import numpy as np

        arm = self.point - point
        torque = self.torque + np.cross(arm, self.force)
        reach = float(np.linalg.norm(arm))
        return Pull(
            self.force, torque, point, self.of_force, self.of_torque + reach * self.of_force
        )

    def with_(self, other: Pull) -> Pull:
        """Add another force and torque, taken about this one's reference point."""
        other = other.about(self.point)
        return Pull(
            self.force + other.force,
            self.torque + other.torque,
            self.point,
            self.of_force + other.of_force,
            self.of_torque + other.of_torque,
        )

    def turned(self) -> Pull:
        """Reverse the signs: the reaction on the other body, about the same point."""
        return self._replace(force=-self.force, torque=-self.torque)


class GroundPlace(NamedTuple):
    """A point and axes fixed in a body, in ground axes, with accelerations for the given v̇.

    Attributes:
        rotation: 3 x 3, from the place's axes to ground axes.
        origin: 3, from ground's origin (m).
        linear, angular: velocity of the origin (m/s) and angular velocity (rad/s), 3 each.
        pull, spin: acceleration of the origin (m/s^2) and angular acceleration (rad/s^2), 3 each.
        of_linear, of_angular: sizes of the velocities.
        of_pull, of_spin: sizes of the accelerations.
    """

    rotation: Array
    origin: Array
    linear: Array
    angular: Array
    pull: Array
    spin: Array
    of_linear: float
    of_angular: float
    of_pull: float
    of_spin: float
