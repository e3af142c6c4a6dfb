"""The compound joint: simple joints one after the other, without bodies in between."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from itertools import accumulate
from typing import TYPE_CHECKING, Any, Self

from linegraph.components.joints.base import Joint, Restriction
from linegraph.components.joints.composition import (
    chain,
    common_axes,
    constant,
    direction,
    onto,
    reoriented,
    seen,
)
from linegraph.components.joints.cylindrical import Cylindrical
from linegraph.components.joints.helical import Helical
from linegraph.components.joints.look import Look
from linegraph.components.joints.planar import Planar
from linegraph.components.joints.prismatic import Prismatic
from linegraph.components.joints.revolute import Revolute
from linegraph.errors import ModelError
from linegraph.spatial.rotation import product
from linegraph.spatial.vector import transpose

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.ir.program import Quantity
    from linegraph.spatial.motion import Motion
    from linegraph.spatial.rotation import Rotation
    from linegraph.spatial.vector import Matrix

PARTS: dict[str, type[Joint]] = {
    kind.kind: kind for kind in (Revolute, Prismatic, Cylindrical, Helical, Planar)
}
"""The possible parts of a compound joint: joints with one axis."""


@dataclass(frozen=True)
class Compound(Joint):
    """A sequence of simple joints from tail to head; the head frame of each is the tail frame of the next.

    The same mechanism as with massless bodies between the parts. q and v are those of the parts in order,
    named as if the parts were joints called NAME_1, NAME_2, ... `compose` puts their motions together:
    R = R1 R2 ..., and the columns and biases of each part carried to the last head frame.

    Attributes:
        parts: for each part its kind (revolute, prismatic, cylindrical, helical or planar) and its axis, in
            the frames as they stand at q = 0; a third entry holds further options by name, also `name` for
            NAME_name instead of a number.

    Example:
        >>> crane = Compound(
        ...     "crane",
        ...     ("mast", "hook"),
        ...     parts=(("revolute", (0, 0, 1)), ("helical", (0, 0, 1), {"lead": 0.1})),
        ... )
        >>> [c.name for c in crane.positions()], crane.freedoms
        (['crane_1', 'crane_2'], 2)
    """

    parts: tuple[Any, ...] = ()
    kind = "compound"
    look = Look("compound", apart=True, loose=True, long=True)

    def __post_init__(self) -> None:
        """Refuse no parts, parts that cannot be, and more than six freedoms, with a `ModelError`."""
        who = f'joint "{self.name}"'
        if not self._joints:
            raise ModelError(who, "has no parts; give at least one")
        if self.freedoms > 6:
            raise ModelError(who, f"has {self.freedoms} freedoms; a body has only six")

    @cached_property
    def _joints(self) -> tuple[Joint, ...]:
        """The parts as the joints they would be by themselves."""
        return tuple(_part(self, k, part) for k, part in enumerate(self.parts, 1))

    @property
    def freedoms(self) -> int:
        """The freedoms of all parts together."""
        return sum(part.freedoms for part in self._joints)

    @property
    def singular(self) -> bool:
        """True with several parts: nothing keeps their axes independent."""
        return len(self._joints) > 1

    def positions(self) -> tuple[Quantity, ...]:
        """The coordinates of all parts in order."""
        return tuple(quantity for part in self._joints for quantity in part.positions())

    def velocities(self) -> tuple[Quantity, ...]:
        """The velocities of all parts in order."""
        return tuple(quantity for part in self._joints for quantity in part.velocities())

    def resolved(self, resolve: Callable[[Any], Scalar]) -> Self:
        """The same joint, each part with its axis and its options as scalars."""
        joints = []
        for part in self._joints:
            axis = tuple(resolve(x) for x in part.axis)
            joints.append(part.resolved(resolve)._with(axis=axis))
        return self._with(_joints=tuple(joints))

    def alignment(self) -> Matrix:
        """Z onto the last axis of rotation, and the axes before it in the plane of x and z where possible."""
        turning = [k for k, part in enumerate(self._joints) if part.kind != Prismatic.kind]
        last = turning[-1] if turning else len(self._joints) - 1
        others = [part.axis for k, part in enumerate(self._joints) if k != last]
        return common_axes([*others, self._joints[last].axis])

    def motion(self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]) -> Motion:
        """The motions of the parts, composed in the aligned axes."""
        motions = [
            reoriented(part.motion(algebra, at, rates), axes)
            for (part, at, rates), (_, axes) in zip(
                self._shares(q, v), self.sequence(), strict=True
            )
        ]
        return chain(motions, v)

    def sequence(self) -> tuple[tuple[Joint, Rotation], ...]:
        """Each part with the rotation from its own axes to the aligned ones."""
        axes = self.alignment()
        return tuple((part, _placed(part, axes)) for part in self._joints)

    def rates(
        self, algebra: Algebra, q: tuple[Scalar, ...], v: tuple[Scalar, ...]
    ) -> tuple[Scalar, ...]:
        """The rates of the coordinates of all parts in order."""
        return tuple(
            rate
            for part, at, rates in self._shares(q, v)
            for rate in part.rates(algebra, at, rates)
        )

    def adjoint(self, v: tuple[Scalar, ...]) -> tuple[tuple[Scalar, ...], ...]:
        """The adjoints of the parts, as blocks on the diagonal."""
        rows: list[tuple[Scalar, ...]] = []
        for part in self._joints:
            first = len(rows)
            beyond = len(v) - first - part.freedoms
            for row in part.adjoint(v[first : first + part.freedoms]):
                rows.append((*(0,) * first, *row, *(0,) * beyond))
        return tuple(rows)

    def restricted(self, algebra: Algebra) -> tuple[Restriction, ...]:
        """Refuse it as a chord: its free directions depend on the positions of its parts.

        Raises:
            ModelError: always.
        """
        problem = (
            "is compound and closes a loop; choose a tree that has it as a branch, or write its parts as "
            "joints with massless bodies in between"
        )
        raise ModelError(f'joint "{self.name}"', problem)

    def _shares(
        self, q: tuple[Scalar, ...], v: tuple[Scalar, ...]
    ) -> Iterator[tuple[Joint, tuple[Scalar, ...], tuple[Scalar, ...]]]:
        """Each part with its own q and v, which are equally many."""
        ends = accumulate(part.freedoms for part in self._joints)
        for part, end in zip(self._joints, ends, strict=True):
            start = end - part.freedoms
            yield part, q[start:end], v[start:end]


def _part(whole: Joint, place: int, given: Any) -> Joint:
    """One part as a joint.

    Raises:
        ModelError: another shape, an unknown kind or option, or an axis without length.
    """
    who = f'joint "{whole.name}"'
    entries = (*given, {})[:3] if isinstance(given, (tuple, list)) else ()
    if len(entries) != 3 or not isinstance(entries[2], dict):
        raise ModelError(
            who, f"a part is (kind, axis) or (kind, axis, {{option: value}}): {given!r}"
        )
    kind, axis, options = entries
    options = dict(options)
    name = f"{whole.name}_{options.pop('name', place)}"
    if kind not in PARTS:
        raise ModelError(who, f"a part cannot be {kind!r}; parts are {', '.join(PARTS)}")
    own = {f.name for f in fields(PARTS[kind])} - {f.name for f in fields(Joint)}
    for option in options:
        if option not in own:
            known = ", ".join(sorted({*own, "name"}))
            raise ModelError(who, f"part {place} has no option {option!r}; known: {known}")
    return PARTS[kind](name, whole.between, direction(axis, who), **options)


def _placed(part: Joint, axes: Matrix) -> Rotation:
    """From the axes a part's motion is written in to the common ones.

    Only a planar part knows directions other than its axis; the others are turned about it to where that
    takes the fewest operations.
    """
    if part.kind == Planar.kind:
        return constant(product(transpose(axes), part.alignment()))
    return onto(seen(part.axis, axes))
