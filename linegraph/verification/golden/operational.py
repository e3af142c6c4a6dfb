"""Operational space of a frame, from its Jacobian and the equations of motion, by NumPy [Khatib 1987].

With constraints, all in independent velocities: J T for J, Mr and hr for M and h, and v = T w + rest.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from linegraph.verification.golden.point import Point
    from linegraph.verification.golden.walk import Valued

    Array = Any


class _ReferenceDynamics(NamedTuple):
    """M and h in coordinates without constraints, J there, and the rate J̇ v of the frame's velocity.

    Each is an array and its sizes.
    """

    mass: Valued
    bias: Valued
    jacobian: Valued
    rate: Valued


@dataclass(frozen=True)
class Operational:
    """Equations of motion of a frame: ``Λ ẍ + μ = F`` for a wrench F on it.

    Attributes:
        point: the state and the reference quantities at it.
        frame: name of the frame.
        rows: 6, or 3 for the motion of its origin only.
    """

    point: Point
    frame: str
    rows: int

    @cached_property
    def _dynamics(self) -> _ReferenceDynamics:
        np, point = self.point.walk.np, self.point
        jacobian, rate = (
            (value[: self.rows], size[: self.rows])
            for value, size in (
                point.kinematics.jacobian(self.frame),
                point.kinematics.jacobian_dot_v(self.frame),
            )
        )
        if not point.walk.tree.closed:
            return _ReferenceDynamics(point.bodies.mass_matrix, point.bodies.bias, jacobian, rate)
        (T, of_T), (rest, of_rest) = point.reduction
        (J, of_J), (dot, of_dot) = jacobian, rate
        projected = J @ T, of_J @ of_T
        whole = dot + J @ rest, of_dot + np.abs(J) @ of_rest
        return _ReferenceDynamics(*point.reduced, projected, whole)

    @cached_property
    def _inverse(self) -> Array:
        """M⁻¹, computed with velocities scaled to unit inertia."""
        np, (M, of_M) = self.point.walk.np, self._dynamics.mass
        scale = self.point.scale(of_M, of_M[:0])[0]
        # Scaled to unit inertia, so that units do not decide which entries are rounding.
        return np.linalg.inv(M * scale * scale[:, None]) * scale * scale[:, None]

    @cached_property
    def _mobility(self) -> Valued:
        """``J M⁻¹ Jᵀ``; each size is the geometric mean of two diagonal entries, which no entry exceeds."""
        np, J = self.point.walk.np, self._dynamics.jacobian[0]
        found = J @ self._inverse @ J.T
        return found, np.outer(*2 * [np.sqrt(np.diag(found))])

    @cached_property
    def inertia(self) -> Valued:
        """Operational space inertia Λ = (J M⁻¹ Jᵀ)⁻¹, rows x rows, in ground axes."""
        np, (mobility, size) = self.point.walk.np, self._mobility
        found = np.linalg.inv(mobility)
        return found, np.abs(found) @ size @ np.abs(found)

    @cached_property
    def bias(self) -> Valued:
        """Operational space bias μ = Λ (J M⁻¹ h - J̇ v), rows, in ground axes."""
        np, known = self.point.walk.np, self._dynamics
        J, (h, of_h), (rate, of_rate) = known.jacobian[0], known.bias, known.rate
        inertia, of_inertia = self.inertia
        pull = J @ self._inverse @ h - rate
        most = np.linalg.norm(of_h * np.sqrt(np.diag(self._inverse)))
        parts = np.sqrt(np.diag(self._mobility[0])) * most + of_rate
        return inertia @ pull, np.abs(inertia) @ parts + of_inertia @ np.abs(pull)

    @cached_property
    def inverse(self) -> Valued:
        """Dynamically consistent inverse J̄ = M⁻¹ Jᵀ Λ, n x rows; premultiplied by T under constraints."""
        np, inertia = self.point.walk.np, self.inertia[0]
        T = np.eye(len(self._inverse))
        if self.point.walk.tree.closed:
            T = self.point.reduction[0][0]
        inverse, (mobility, _) = T @ self._inverse @ T.T, self._mobility
        found = T @ self._inverse @ self._dynamics.jacobian[0].T @ inertia
        size = np.sqrt(np.outer(np.diag(inverse), np.diag(mobility)))
        return found, size @ np.abs(inertia)
