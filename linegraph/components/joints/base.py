"""What every joint type answers; each type is one file beside this one.

A joint is an oriented edge from a *tail* frame to a *head* frame, in translation and in rotation. Its
across variables are the motion of the head relative to the tail; its coordinates q and velocities v are
what it leaves free of it. All types answer the same questions in the same order:

    positions   velocities   rest   resolved   alignment   motion   sequence   rates   adjoint   regroup
    restricted   measured   duals

The last three say what a joint is as a *chord*, one that closes a loop: what it forbids, and what its
coordinates are where they are none of the state.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

from linegraph.errors import ModelError
from linegraph.spatial.inertia import NO_MOMENTS, Moments
from linegraph.spatial.rotation import IDENTITY_MATRIX, Rotation

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.ir.program import Quantity
    from linegraph.spatial.motion import Motion
    from linegraph.spatial.vector import Matrix, Vector


BY_INPUT = "input"
"""What a joint's drive says to take its motion from inputs."""


class Along(NamedTuple):
    """A reaction force: the head's origin does not move along a direction of the tail.

    ``direction . d = 0``, d from the tail's origin to the head's.
    """

    direction: Vector


class Square(NamedTuple):
    """A reaction torque: a direction of the head keeps its angle with one of the tail.

    ``(tail . head - cosine) / sine = 0``; the torque is along ``head x tail``.
    """

    tail: Vector
    head: Vector
    cosine: Scalar
    sine: Scalar


class Upright(NamedTuple):
    """A reaction torque about x or y, `axis` 0 or 1: the head's z leans against the tail's not about it.

    The equation is the component of ``2 tan(lean / 2)``, which has no second root half a turn away.
    """

    axis: int


class Unturned(NamedTuple):
    """A reaction torque about `axis`, 0 to 2: the head does not turn against the tail about it.

    The equation is the component of ``2 tan(angle / 2)`` along it, of the one turn from tail to head.
    """

    axis: int


class Thread(NamedTuple):
    """A reaction along z with its torque: an advance along z for a turn about z, ``d_z = advance angle``."""

    advance: Scalar


Restriction = Along | Square | Upright | Unturned | Thread
"""One reaction direction of a joint: the equation its chord adds where it closes a loop."""

TORQUES = (Square, Upright, Unturned)

NO_SHIFT: tuple[Restriction, ...] = tuple(Along(axis) for axis in IDENTITY_MATRIX)
NO_SHIFT_ACROSS_Z = NO_SHIFT[:2]
NO_TURN: tuple[Restriction, ...] = (Unturned(0), Unturned(1), Unturned(2))
NO_TURN_ACROSS_Z: tuple[Restriction, ...] = (Upright(0), Upright(1))


@dataclass(frozen=True)
class Joint:
    """Base of all joint types.

    Attributes:
        name: also the name of its edge and, with one freedom, of its coordinate.
        between: the terminals (tail, head) as ``body`` or ``body.frame``.
        axis: the direction it is about, along or normal to; unit length, in the joint's frames.
        effort: whether a force or torque along each velocity coordinate is an input.
        drive: the prescribed motion, a function of t for each coordinate, or "input" for values with
            their first two derivatives; None where the joint moves freely.
        start: the coordinates at which the search for a position begins that closes all loops; None for
            those of `rest`.
    """

    name: str
    between: tuple[str, str]
    axis: Vector = (0, 0, 1)
    effort: bool = True
    drive: Any = None
    start: Any = None

    kind: ClassVar[str]
    turns: ClassVar[bool] = False
    """Whether all it does is turn about z, so that turning its frames about z only shifts its angle."""
    slides: ClassVar[tuple[int, ...]] = ()
    """The axes along which its two frames may be shifted together: its motion stays the same."""

    @property
    def freedoms(self) -> int:
        """The number of velocities; most types know it without being asked."""
        return len(self.velocities())

    @property
    def singular(self) -> bool:
        """Whether its velocities become dependent at some q, so that even a solid body leaves M singular."""
        return False

    def positions(self) -> tuple[Quantity, ...]:
        """The coordinates q: names, units, meaning."""
        raise NotImplementedError

    def velocities(self) -> tuple[Quantity, ...]:
        """The velocity coordinates v."""
        raise NotImplementedError

    def rest(self) -> tuple[float, ...]:
        """The q at which head and tail frames coincide."""
        return (0.0,) * len(self.positions())

    def prescribed_values(self) -> tuple[Any, ...]:
        """The model values of a prescribed motion; none where it is free or comes from inputs."""
        given = tuple(self.drive) if isinstance(self.drive, (tuple, list)) else (self.drive,)
        return () if given in ((None,), (BY_INPUT,)) else given

    def require_start(self) -> None:
        """Refuse start values that are no coordinates.

        Raises:
            ModelError: another number of them than of coordinates, or a quaternion without length.
        """
        if self.start is None:
            return
        given = self.start if isinstance(self.start, (tuple, list)) else (self.start,)
        names = [quantity.name for quantity in self.positions()]
        who = f'joint "{self.name}"'
        if len(given) != len(names):
            problem = (
                f"start has {len(given)} values for {len(names)} coordinates: {', '.join(names)}"
            )
            raise ModelError(who, problem)
        if len(names) > self.freedoms and all(x == 0 for x in given[-4:]):
            raise ModelError(who, "start has a quaternion of length zero; no turn is (0, 0, 0, 1)")

    def resolved(self, resolve: Callable[[Any], Scalar]) -> Self:
        """The same joint with the model values `motion` reads as scalars of an algebra."""
        return self

    def alignment(self) -> Matrix:
        """Rotation from joint axes, in which `motion` is written with the axis as z, to frame axes."""
        return IDENTITY_MATRIX

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """The relative motion at (q, v), in aligned axes."""
        raise NotImplementedError

    def sequence(self) -> tuple[tuple[Joint, Rotation], ...]:
        """The joints of one axis it is a sequence of, if it is: each with its axes in the aligned ones.

        With m the motion of a part, written about z, and B its axes, the motion is the product of all
        ``B m B^T``; q and v are those of the parts in order.
        """
        return ()

    def rates(
        self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]
    ) -> tuple[Scalar, ...]:
        """``q̇ = N(q) v``."""
        return v

    def adjoint(self, v: tuple[Scalar, ...]) -> tuple[tuple[Scalar, ...], ...]:
        """``ad v``: how a small displacement d along the velocities goes on, ``d' = dv - (ad v) d``.

        Zero where v is the derivative of q. Source: Lie brackets of the columns of N; Sola, Deray & Atchuthan
        2018, "A micro Lie theory for state estimation in robotics".
        """
        return ((0,) * len(v),) * len(v)

    def regroup(self, head: Moments) -> tuple[Moments, Moments]:
        """Split the head body's moments into (kept, handed to the tail body) with the same M and h."""
        return head, NO_MOMENTS

    def restricted(self, algebra: Algebra) -> tuple[Restriction, ...]:
        """Its reaction directions in aligned axes: 6 less its freedoms.

        Raises:
            ModelError: they are not the same at all q, so that it cannot be a chord.
        """
        raise NotImplementedError

    def measured(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[Scalar, ...]:
        """The coordinates q at a relative place, in aligned axes; angles between -pi and pi.

        Raises:
            ModelError: no formula gives them.
        """
        who = f'joint "{self.name}"'
        raise ModelError(who, f"{_CHORD}its coordinates are not known; {_CHOOSE}")

    def duals(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[tuple[Vector, Vector], ...]:
        """For each velocity the (torque, force) of a unit effort along it, in aligned head axes.

        With (w, u) the relative twist, ``v_a = torque_a . w + force_a . u``.
        """
        motion = self.motion(algebra, self.rest(), (0,) * self.freedoms)
        return tuple(zip(motion.angular, motion.linear, strict=True))

    def _with(self, **values: Any) -> Self:
        """A copy with other values of some fields, which are not checked again."""
        twin = copy(self)
        for name, value in values.items():
            object.__setattr__(twin, name, value)
        return twin


_CHORD = "closes a loop, where "
_CHOOSE = "choose a tree that has it as a branch"


def angle_about_z(algebra: Algebra, rotation: Matrix) -> Scalar:
    """The angle of a turn about z."""
    return algebra.function("atan2", rotation[1][0], rotation[0][0])
