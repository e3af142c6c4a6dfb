"""The base of all constraints; each type is one file beside this one.

A *constraint* is a chord whose across variable is known where its through variable is not: a rigid rod, a
point in prescribed motion, a wheel that rolls without slip (a velocity source of value 0). Each of its
*rows* is one reaction direction: a unit force and a unit torque between its ends, whose product with the
relative motion the constraint fixes. All types have the same methods in the same order:

    values   prescribed   equations   rows
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from linegraph.components.body import unit
from linegraph.components.validation import vector

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.ir.program import Quantity
    from linegraph.spatial.vector import Matrix, Vector

    Resolve = Callable[[Any], Scalar]
    """From a model value to a scalar."""


class Pose(NamedTuple):
    """An end of a chord in ground axes.

    Attributes:
        rotation: its axes as columns: components in them to components in ground axes.
        origin: its origin from that of ground (m).
    """

    rotation: Matrix
    origin: Vector


class Prescribed(NamedTuple):
    """A value that is a function of time, and its rate.

    Attributes:
        x: the value, in the unit that the constraint's `prescribed` states.
        dx: its derivative with respect to time.
    """

    x: Scalar
    dx: Scalar


class Instant(NamedTuple):
    """Where and when the rows of a constraint are evaluated.

    Attributes:
        algebra: where to calculate.
        resolve: from model values to scalars.
        tail, head: the ends, in ground axes.
        drive: the prescribed values in the order of `prescribed`; None where nothing is.
    """

    algebra: Algebra
    resolve: Resolve
    tail: Pose
    head: Pose
    drive: Sequence[Prescribed | None]


class ReactionRow(NamedTuple):
    """One reaction direction between tail and head, in ground axes.

    With u the velocity of the head's origin as seen from the tail and w the relative angular velocity, the
    constraint is ``force . u + torque . w = rate``, and its multiplier scales the force and the torque
    that act on the head.

    Attributes:
        position: the equation of position, 0 where it holds; None where only velocities are constrained.
        force, torque: on the head, the torque about the head's origin.
        rate: the prescribed value of that product; 0 where nothing is prescribed.
    """

    position: Scalar | None
    force: Vector
    torque: Vector
    rate: Scalar = 0


@dataclass(frozen=True)
class Constraint:
    """Base of all constraints.

    Attributes:
        name: also the name of its edges.
        between: the terminals (tail, head), each ``body`` or ``body.frame``.
    """

    name: str
    between: tuple[str, str]

    kind: ClassVar[str]
    timed: ClassVar[tuple[str, ...]] = ()
    """Fields that may be functions of time, or "input"."""
    needs: ClassVar[tuple[tuple[str, ...], ...]] = ()
    """Of each group of fields, a model file gives at least one."""

    @property
    def ends(self) -> tuple[str, str]:
        """The terminals (tail, head) that its edges run between."""
        return self.between

    def values(self) -> tuple[Any, ...]:
        """The model values it depends on; those left out are not among them."""
        own = [getattr(self, f.name) for f in fields(self) if f.name not in _PLACES]
        flat = [x for value in own for x in (value if isinstance(value, tuple) else (value,))]
        return tuple(x for x in flat if x is not None and not isinstance(x, bool))

    def prescribed(self) -> tuple[tuple[Any, Quantity], ...]:
        """For each field that may be a function of time: its value or None, and the quantity it is."""
        return ()

    def lengths(self) -> tuple[Any, ...]:
        """Model values of its own that are lever arms beside those of its ends (m)."""
        return ()

    def equations(self) -> tuple[tuple[Quantity, bool], ...]:
        """For each row its multiplier and whether it has an equation of position."""
        raise NotImplementedError

    def rows(self, at: Instant) -> tuple[ReactionRow, ...]:
        """The rows at a state, in the order of `equations`.

        Args:
            at: ends, scalars and prescribed values at the state.
        """
        raise NotImplementedError


_PLACES = ("name", "between")


def aligned(limit: Any, who: str) -> Any:
    """A constraint with its axis, if it has one, scaled to length 1.

    Args:
        limit: the constraint.
        who: the thing that errors name.

    Raises:
        ModelError: the axis has no length.
    """
    axis = getattr(limit, "axis", None)
    return limit if axis is None else replace(limit, axis=unit(vector(axis, who), who))
