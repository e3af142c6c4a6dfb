"""The free joint: no restriction at all, six velocities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.joints.base import Joint, Restriction
from linegraph.components.joints.composition import compose, onto
from linegraph.components.joints.look import Look
from linegraph.components.joints.prismatic import Prismatic
from linegraph.components.joints.spherical import Spherical
from linegraph.ir.program import Quantity
from linegraph.spatial.motion import Motion
from linegraph.spatial.rotation import IDENTITY_MATRIX, Rotation
from linegraph.spatial.vector import ZERO, skew

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.spatial.vector import Matrix, Vector


@dataclass(frozen=True)
class Free(Joint):
    """Six freedoms between tail and head: a floating base.

    q = (position in the tail frame (m), unit quaternion x, y, z, w); v = (velocity of the head's origin
    (m/s), angular velocity (rad/s)), both in head axes. Or, with `angles`, q = (position, three angles) and
    v = q̇, with the singular orientations described at `Spherical`. It carries no effort.

    With the quaternion, R = R(q), d = position, w = v4..v6, u = v1..v3, and the rates of q are ``R u`` and
    ``1/2 q (w, 0)``: neither the columns nor, for a body that moves alone, M depend on q.

    Attributes:
        angles: the sequence of axes of the turns, e.g. "zyx"; None for the quaternion.

    Example:
        >>> Free("root", ("ground", "trunk")).rest()
        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
        >>> [c.name for c in Free("root", ("ground", "trunk"), angles="zyx").velocities()][2:4]
        ['root_z', 'root_angle1']
    """

    effort: bool = False
    angles: str | None = None
    kind = "free"
    look = Look("free", apart=True, loose=True, directed=False)
    freedoms = 6

    def __post_init__(self) -> None:
        """Refuse an unknown sequence of axes with a `ModelError` that lists the known ones."""
        _ = self._ball

    @property
    def _ball(self) -> Spherical:
        """Its rotation alone."""
        return Spherical(self.name, self.between, angles=self.angles)

    @property
    def singular(self) -> bool:
        """True with angles: where the first and the third axis are in line."""
        return self.angles is not None

    def positions(self) -> tuple[Quantity, ...]:
        """Position in the tail frame (m), then the quaternion or the angles (rad)."""
        place = (
            Quantity(f"{self.name}_{c}", "m", f"position {c} of {self.name}, in the tail frame")
            for c in "xyz"
        )
        return (*place, *self._ball.positions())

    def velocities(self) -> tuple[Quantity, ...]:
        """Velocity (m/s) and angular velocity (rad/s) in head axes, or the rates of position and angles."""
        stem, frame = ("v", "head axes") if self.angles is None else ("", "tail axes")
        linear = (
            Quantity(f"{self.name}_{stem}{c}", "m/s", f"velocity {c} of {self.name}, in {frame}")
            for c in "xyz"
        )
        return (*linear, *self._ball.velocities())

    def rest(self) -> tuple[float, ...]:
        """The tail's origin, and the quaternion of no turn or three angles of 0."""
        return (0.0, 0.0, 0.0, *self._ball.rest())

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """A shift, then a turn; with a quaternion the velocities are the components in head axes themselves.

        With angles the shift comes first in tail axes, and the turn makes its columns depend on q.
        """
        at, none = (q[0], q[1], q[2]), (ZERO, ZERO, ZERO)
        turn = self._ball.motion(algebra, q[3:], v[3:])
        if self.angles is None:
            return Motion(turn.rotation, at, none + IDENTITY_MATRIX, IDENTITY_MATRIX + none)
        return compose(Motion(Rotation(), at, none, IDENTITY_MATRIX), turn, v[:3], v[3:])

    def sequence(self) -> tuple[tuple[Joint, Rotation], ...]:
        """Three sliders along the tail's axes, then three hinges, where it has angles; else none."""
        if self.angles is None:
            return ()
        shifts = tuple(
            (Prismatic(f"{self.name}_{c}", self.between), onto(axis))
            for c, axis in zip("xyz", IDENTITY_MATRIX, strict=True)
        )
        return (*shifts, *self._ball.sequence())

    def rates(
        self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]
    ) -> tuple[Scalar, ...]:
        """``R u`` for the position and ``1/2 q (w, 0)`` for the quaternion; with angles v itself."""
        if self.angles is not None:
            return v
        turn = self._ball.motion(algebra, q[3:], v[3:])
        linear = turn.rotation.out((v[0], v[1], v[2]))
        return (*linear, *self._ball.rates(algebra, q[3:], v[3:]))

    def adjoint(self, v: tuple[Scalar, ...]) -> tuple[tuple[Scalar, ...], ...]:
        """The adjoint of SE(3) in head axes, in the order (u, ω); zero with angles.

        ``[ω x]`` for both parts, and ``[u x]`` from the turn to the shift.
        """
        if self.angles is not None:
            return super().adjoint(v)
        u, w = skew((v[0], v[1], v[2])), skew((v[3], v[4], v[5]))
        upper = tuple((*turning, *moving) for turning, moving in zip(w, u, strict=True))
        return (*upper, *((0, 0, 0, *row) for row in w))

    def restricted(self, algebra: Algebra) -> tuple[Restriction, ...]:
        """Empty: it restricts nothing."""
        return ()

    def measured(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[Scalar, ...]:
        """The position (m) and the angles (rad).

        Raises:
            ModelError: it has a quaternion, whose sign a rotation leaves open.
        """
        return (*displacement, *self._ball.measured(algebra, rotation, displacement))

    def duals(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[tuple[Vector, Vector], ...]:
        """Forces along and torques about head axes.

        With angles, forces along tail axes and torques that do work along one angle only.
        """
        if self.angles is None:
            return super().duals(algebra, rotation, displacement)
        along = tuple((ZERO, row) for row in rotation)
        return (*along, *self._ball.duals(algebra, rotation, displacement))
