"""Rolling without slip: a wheel, a disc or a ball on a plane."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.constraints.base import Constraint, Pose, ReactionRow
from linegraph.errors import ModelError
from linegraph.ir.program import Quantity
from linegraph.spatial.vector import Vector, add, cross, dot, negate, scale, subtract, times

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.constraints.base import Instant


@dataclass(frozen=True)
class Rolling(Constraint):
    """A wheel on a plane: it touches, and where it touches it does not slip.

    The tail is the plane, its z the normal n; the head is the wheel's centre. With s the wheel's axis the
    rim's lowest point is at ``radius e - crown n`` from the centre, ``e = -(n - (n.s) s) / |n - (n.s) s|``.

        touching     n . d - radius |n - (n.s) s| - crown = 0
        no slip      the velocity of the wheel's material there is that of the plane's

    d runs from the plane's origin to the centre. Three multipliers act on the wheel (N): the normal force,
    the forces along the track (the direction s x n) and across it. A wheel that lies flat, s along n, has no
    lowest point.

    Attributes:
        axis: of the wheel, in the head's axes; left out for a ball.
        radius: of the rim, or of the ball (m).
        crown: radius of the rim's rounding, a torus (m); 0 for a thin disc.

    Example:
        >>> wheel = Rolling("rear", ("ground", "wheel"), axis=(0, 1, 0), radius=0.3)
        >>> [holonomic for _, holonomic in wheel.equations()]
        [True, False, False]
    """

    axis: Vector | None = None
    radius: Any = 0
    crown: Any = 0
    kind = "rolling"
    needs = (("radius",),)

    def __post_init__(self) -> None:
        """Refuse a wheel of no size, or of a negative one, with a `ModelError`."""
        for name, size in (("radius", self.radius), ("crown", self.crown)):
            if isinstance(size, (int, float)) and size < 0:
                raise ModelError(f'rolling "{self.name}"', f"its {name} is negative ({size})")
        if self.radius == 0 and self.crown == 0:
            raise ModelError(f'rolling "{self.name}"', "has no radius")

    def lengths(self) -> tuple[Any, ...]:
        """Radius and crown, the lever arms of its forces about the centre (m)."""
        return (self.radius, self.crown)

    def equations(self) -> tuple[tuple[Quantity, bool], ...]:
        """Normal force with an equation of position, and forces along and across the track without (N)."""
        return tuple(
            (
                Quantity(
                    f"{self.name}_{end}", "N", f"{about} of rolling {self.name}, on the wheel"
                ),
                touching,
            )
            for end, about, touching in (
                ("normal", "normal force", True),
                ("along", "force along the track", False),
                ("across", "force across the track", False),
            )
        )

    def rows(self, at: Instant) -> tuple[ReactionRow, ...]:
        """Unit forces at the point of contact, their torques taken about the centre, in ground axes."""
        normal, along, across = _columns(at.tail)
        radius, crown = at.resolve(self.radius), at.resolve(self.crown)
        line = subtract(at.head.origin, at.tail.origin)
        if self.axis is None:
            contact = scale(-radius, normal)
            height: Scalar = radius
        else:
            x, y, z = self.axis
            axis = times(at.head.rotation, (at.resolve(x), at.resolve(y), at.resolve(z)))
            tilt = dot(normal, axis)
            level = at.algebra.sqrt(1 - tilt * tilt)
            upward = scale(1 / level, subtract(normal, scale(tilt, axis)))
            contact = negate(add(scale(radius, upward), scale(crown, normal)))
            height = radius * level + crown
            along = scale(1 / level, cross(axis, normal))
            across = cross(normal, along)
        touching = dot(normal, line) - height
        return (
            ReactionRow(touching, normal, cross(contact, normal)),
            ReactionRow(None, along, cross(contact, along)),
            ReactionRow(None, across, cross(contact, across)),
        )


def _columns(tail: Pose) -> tuple[Vector, Vector, Vector]:
    """The plane's normal and the two directions in it."""
    along, across, normal = (
        times(tail.rotation, axis) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    )
    return normal, along, across
