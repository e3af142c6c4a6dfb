"""The base of all joint types; each type is one file beside this one.

A joint is an oriented edge from a *tail* frame to a *head* frame, in translation and in rotation. Its
across variables are the motion of the head relative to the tail; its coordinates q and velocities v
describe the part of it that is free. All types have the same methods in the same order:

    positions   velocities   rest   resolved   alignment   motion   sequence   rates   adjoint   regroup
    restricted   measured   duals

The last three are about a joint that closes a loop, a *chord*: the directions that it forbids, and its
coordinates where these are not part of the state.

Formulas are written in *aligned* axes, in which the joint's axis is z: `alignment` takes them to the axes of
its frames. At q = `rest` the two frames coincide.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

from linegraph.components.joints.look import Look
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
"""The `drive` of a joint whose motion comes from inputs."""


class Along(NamedTuple):
    """A reaction force: the head's origin does not move along a direction of the tail.

    ``direction . d = 0``, with d from the tail's origin to the head's in tail axes (m). The multiplier is the
    force on the head along the direction (N).
    """

    direction: Vector


class Square(NamedTuple):
    """A reaction torque: a direction of the head keeps its angle with one of the tail.

    ``(tail . head - cosine) / sine = 0``; the torque on the head is along ``head x tail`` (N m). Division by
    the sine makes the equation an angle (rad) to first order, like those of the other torques.
    """

    tail: Vector
    head: Vector
    cosine: Scalar
    sine: Scalar


class Upright(NamedTuple):
    """A reaction torque about x or y, `axis` 0 or 1: the head's z axis does not lean about it.

    The equation is the component of ``2 tan(lean / 2)`` along the axis (rad to first order). The sine of the
    lean would do as well near its root, but has a second one half a turn away.
    """

    axis: int


class Unturned(NamedTuple):
    """A reaction torque about `axis`, 0 to 2: the head does not turn relative to the tail about it.

    The equation is the component along it of ``2 tan(angle / 2)``, of the one turn that takes the tail's axes
    to the head's (rad to first order).
    """

    axis: int


class Thread(NamedTuple):
    """A reaction along z together with its torque, of a screw: ``d_z = advance angle``.

    `advance` is the shift along z for a turn about z by one radian (m/rad). The multiplier is the force on
    the head along z (N); it comes with the torque ``-advance force`` about z.
    """

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
    look: ClassVar[Look] = Look()
    """How pictures draw it."""

    @property
    def freedoms(self) -> int:
        """The number of velocities. Most types state it as a constant, which costs no call."""
        return len(self.velocities())

    @property
    def singular(self) -> bool:
        """Whether its velocities become dependent at some q, where even a solid body leaves M singular."""
        return False

    def positions(self) -> tuple[Quantity, ...]:
        """The coordinates q in order: their names, units and meanings."""
        raise NotImplementedError

    def velocities(self) -> tuple[Quantity, ...]:
        """The velocities v in order: their names, units and meanings; `freedoms` of them."""
        raise NotImplementedError

    def rest(self) -> tuple[float, ...]:
        """The q at which head and tail frames coincide, in the order and units of `positions`."""
        return (0.0,) * len(self.positions())

    def prescribed_values(self) -> tuple[Any, ...]:
        """The model values of a prescribed motion; none where the joint is free or is driven by inputs."""
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
        """The same joint, with the model values that `motion` reads as scalars of an algebra.

        Args:
            resolve: from a model value to a scalar.
        """
        return self

    def alignment(self) -> Matrix:
        """The constant rotation from aligned axes, in which the joint's axis is z, to those of its frames.

        Its columns are the aligned axes, resolved in frame axes.
        """
        return IDENTITY_MATRIX

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """The motion of the head relative to the tail at (q, v), in aligned axes.

        Args:
            algebra: where to calculate.
            q: coordinates, in the order and units of `positions`.
            v: velocities, in the order and units of `velocities`. Only the biases depend on them.

        Returns:
            The rotation and the displacement (m, in tail axes), and for each velocity a column of the
            relative angular velocity and one of the velocity of the head's origin, in head axes.
        """
        raise NotImplementedError

    def sequence(self) -> tuple[tuple[Joint, Rotation], ...]:
        """The joints of one axis that it is a sequence of, each with its axes in the aligned ones; or none.

        With m the motion of a part, written about z, and B its axes, the motion is the product of all
        ``B m B^T``; q and v are those of the parts in order.
        """
        return ()

    def rates(
        self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]
    ) -> tuple[Scalar, ...]:
        """The derivative of the coordinates, ``q̇ = N(q) v``.

        Args:
            algebra: where to calculate.
            q: coordinates, in the order and units of `positions`.
            v: velocities, in the order and units of `velocities`.

        Returns:
            A rate for each coordinate (its unit per second); v itself where v is the derivative of q.
        """
        return v

    def adjoint(self, v: tuple[Scalar, ...]) -> tuple[tuple[Scalar, ...], ...]:
        """``ad v``: how a small displacement d along the velocities develops, ``d' = dv - (ad v) d``.

        A square matrix by rows, of `freedoms` rows. Zero where v is the derivative of q. It follows from the
        Lie brackets of the columns of N [Solà et al. 2018].

        Args:
            v: velocities, in the order and units of `velocities`.
        """
        return ((0,) * len(v),) * len(v)

    def regroup(self, head: Moments) -> tuple[Moments, Moments]:
        """Split the moments of the head body into those it keeps and those handed to the tail body.

        M and h are the same before and after, so fewer moments have to be carried to the root. The moments
        that can be handed over are those that regroup into base parameters [Gautier and Khalil 1990].

        Args:
            head: mass (kg), first (kg m) and second moments (kg m^2) about the head's origin, in aligned
                axes.

        Returns:
            The moments that the head keeps, and those that the tail gets; their sum is `head`.
        """
        return head, NO_MOMENTS

    def restricted(self, algebra: Algebra) -> tuple[Restriction, ...]:
        """The reaction directions of a chord, in aligned axes: 6 less its freedoms.

        Args:
            algebra: where to calculate.

        Raises:
            ModelError: they are not the same at all q, so the joint cannot be a chord.
        """
        raise NotImplementedError

    def measured(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[Scalar, ...]:
        """The coordinates q of a chord, from the place of its head relative to its tail.

        Args:
            algebra: where to calculate.
            rotation: head components to tail components, a 3 x 3 matrix in aligned axes.
            displacement: from the tail's origin to the head's, in aligned tail axes (m).

        Returns:
            A value for each coordinate; angles between -pi and pi.

        Raises:
            ModelError: no formula gives them.
        """
        who = f'joint "{self.name}"'
        raise ModelError(who, f"{_CHORD}its coordinates are not known; {_CHOOSE}")

    def duals(
        self, algebra: Algebra, rotation: Matrix, displacement: Vector
    ) -> tuple[tuple[Vector, Vector], ...]:
        """For each velocity of a chord, the (torque, force) of a unit effort along it, in aligned head axes.

        With (w, u) the twist of the head relative to the tail at the head's origin, ``v_a = torque_a . w +
        force_a . u``: these vectors measure the velocities, and give the wrench of an effort or a spring in
        the joint.

        Args:
            algebra: where to calculate.
            rotation: head components to tail components, a 3 x 3 matrix in aligned axes.
            displacement: from the tail's origin to the head's, in aligned tail axes (m).
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
    """The angle of a turn about z, between -pi and pi (rad).

    Args:
        algebra: where to calculate.
        rotation: the matrix of the turn; of another rotation, the angle by which its x axis is turned about
            z.
    """
    return algebra.function("atan2", rotation[1][0], rotation[0][0])
