"""The spherical joint: all rotations about a point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.joints.base import NO_SHIFT, Joint, Restriction
from linegraph.components.joints.composition import angles_of, hinges, reciprocal, turns
from linegraph.components.joints.look import Look
from linegraph.errors import ModelError
from linegraph.ir.program import Quantity
from linegraph.spatial.inertia import Moments, point_apart
from linegraph.spatial.motion import Motion
from linegraph.spatial.rotation import IDENTITY_MATRIX, Full, Rotation, from_quaternion
from linegraph.spatial.vector import ZERO, Matrix, Vector, skew

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar

SEQUENCES = (
    *("xyz", "xzy", "yxz", "yzx", "zxy", "zyx"),
    *("xyx", "xzx", "yxy", "yzy", "zxz", "zyz"),
)
"""The sequences of three turns that reach every orientation: Tait-Bryan angles, proper Euler angles."""


@dataclass(frozen=True)
class Spherical(Joint):
    """A ball in a socket: the head turns freely about the common origin of both frames.

    q = unit quaternion (x, y, z, w), v = angular velocity in head axes (rad/s), effort = torque in head
    axes. Or, with `angles`, q = three angles of turns each about an axis left by those before it (rad),
    v = their rates (rad/s), effort = torques about these axes.

    With the quaternion, R = R(q), d = 0, w = v, u = 0, and ``q̇ = 1/2 q (v, 0)``; q and -q are the same
    orientation. With angles, R is the product of the three turns [Diebel 2006].

    Angles have a singular orientation where the first and the third axis are in line, and M is singular
    there: three different axes at a second angle of 90 degrees, the first repeated as the third at 0 and
    180 degrees, hence at q = 0. Choose a sequence whose singular orientation the joint does not reach, or
    the quaternion, which has none.

    Attributes:
        angles: the sequence of axes, e.g. "xyz" or "zxz"; None for the quaternion.

    Example:
        >>> [c.name for c in Spherical("hip", ("pelvis", "thigh")).velocities()]
        ['hip_wx', 'hip_wy', 'hip_wz']
        >>> Spherical("hip", ("pelvis", "thigh"), angles="zxy").rest()
        (0.0, 0.0, 0.0)
    """

    angles: str | None = None
    kind = "spherical"
    look = Look("spherical", directed=False)
    freedoms = 3

    def __post_init__(self) -> None:
        """Refuse an unknown sequence of axes with a `ModelError` that lists the known ones."""
        if self.angles is not None and self.angles not in SEQUENCES:
            known = ", ".join(SEQUENCES)
            problem = f"there are no angles {self.angles!r}; sequences of turns are {known}"
            raise ModelError(f'joint "{self.name}"', problem)

    @property
    def singular(self) -> bool:
        """True with angles: where the first and the third axis are in line."""
        return self.angles is not None

    def positions(self) -> tuple[Quantity, ...]:
        """The quaternion (x, y, z, w), or the three angles (rad)."""
        if self.angles is None:
            return tuple(
                Quantity(f"{self.name}_q{c}", "1", f"quaternion {c} of {self.name}") for c in "xyzw"
            )
        return tuple(
            Quantity(f"{self.name}_angle{k}", "rad", f"angle {k} of {self.name}, about {c}")
            for k, c in enumerate(self.angles, 1)
        )

    def velocities(self) -> tuple[Quantity, ...]:
        """The angular velocity in head axes, or the rates of the angles (rad/s)."""
        if self.angles is None:
            what = f"of {self.name}, in head axes"
            return tuple(
                Quantity(f"{self.name}_w{c}", "rad/s", f"angular velocity {c} {what}")
                for c in "xyz"
            )
        return tuple(
            Quantity(f"{self.name}_angle{k}", "rad/s", f"rate {k} of {self.name}, about {c}")
            for k, c in enumerate(self.angles, 1)
        )

    def rest(self) -> tuple[float, ...]:
        """The quaternion (0, 0, 0, 1) of no turn, or three angles of 0."""
        return (0.0, 0.0, 0.0, 1.0) if self.angles is None else (0.0, 0.0, 0.0)

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """The turn of the quaternion, with unit columns and no bias, or the product of the three turns."""
        if self.angles is None:
            x, y, z, w = q
            rotation = Rotation((Full(from_quaternion(x, y, z, w)),))
            return Motion(rotation, ZERO, IDENTITY_MATRIX, (ZERO, ZERO, ZERO))
        return turns(algebra, [IDENTITY_MATRIX["xyz".index(c)] for c in self.angles], q, v)

    def sequence(self) -> tuple[tuple[Joint, Rotation], ...]:
        """Three hinges about coordinate axes, where it has angles; none for the quaternion."""
        return hinges(self, [IDENTITY_MATRIX["xyz".index(c)] for c in self.angles or ""])

    def rates(
        self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]
    ) -> tuple[Scalar, ...]:
        """Quaternion rate ``q̇ = 1/2 q (ω, 0)``, ω in head axes; with angles v itself.

        The product is Hamilton's, with w last. The rate is normal to q, so that q keeps its length.
        """
        if self.angles is not None:
            return v
        x, y, z, w = q
        a, b, c = (rate / 2 for rate in v)
        return (
            w * a + y * c - z * b,
            w * b + z * a - x * c,
            w * c + x * b - y * a,
            -(x * a + y * b + z * c),
        )

    def adjoint(self, v: tuple[Scalar, ...]) -> tuple[tuple[Scalar, ...], ...]:
        """``[ω x]``, the adjoint of SO(3) in head axes; zero with angles."""
        return super().adjoint(v) if self.angles is not None else skew((v[0], v[1], v[2]))

    def regroup(self, head: Moments) -> tuple[Moments, Moments]:
        """Hand over the mass as a point: the joint's centre belongs to both bodies."""
        return point_apart(head)

    def restricted(self, algebra: Algebra) -> tuple[Restriction, ...]:
        """Three forces: no shift of the common origin."""
        return NO_SHIFT

    def measured(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[Scalar, ...]:
        """The angles (rad), as `angles_of` gives them.

        Raises:
            ModelError: it has a quaternion, whose sign a rotation leaves open.
        """
        if self.angles is None:
            return super().measured(algebra, rotation, displacement)
        return angles_of(algebra, self.angles, rotation)

    def duals(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[tuple[Vector, Vector], ...]:
        """Torques about head axes; with angles those that do work along one angle only.

        At the singular orientation of the angles no such torques exist.
        """
        if self.angles is None:
            return super().duals(algebra, rotation, displacement)
        q = self.measured(algebra, rotation, displacement)
        columns = self.motion(algebra, q, (0, 0, 0)).angular
        return tuple((s, ZERO) for s in reciprocal(columns))
