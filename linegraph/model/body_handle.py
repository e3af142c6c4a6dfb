"""Bodies of a model under construction, and the part of the builder that they and macros use."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from linegraph.components.body import orientation
from linegraph.components.validation import finite, rotation_matrix, triple, vector
from linegraph.errors import ModelError
from linegraph.spatial.placement import Placement
from linegraph.spatial.rotation import snapped
from linegraph.spatial.vector import ZERO

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.components.constraints import Constraint
    from linegraph.components.constraints.relation import Relation
    from linegraph.components.forces import Element, PointForce
    from linegraph.components.joints import Joint
    from linegraph.model.coupling import Coupling


Kind = TypeVar("Kind", bound="Joint")
Force = TypeVar("Force", bound="Element | PointForce")
Limit = TypeVar("Limit", bound="Constraint | Relation")


class Builder(Protocol):
    """The part of `builder.Model` that handles, generated methods and macros use."""

    snap: float

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The joints in declared order."""

    @property
    def couplings(self) -> tuple[Coupling, ...]:
        """The coupled joints in declared order."""

    def body(self, name: str, *, inertia: Any = ...) -> BodyHandle:
        """Add a rigid body.

        Args:
            name: unique among bodies.
            inertia: about the mass centre, in body axes (kg m²).
        """

    def add_frame(self, body: str, name: str, placement: Placement) -> str:
        """Add a frame to a body or to ground.

        Args:
            body: name of the body, or "ground".
            name: unique on it.
            placement: the frame in the body's frame.

        Returns:
            The terminal, ``"body.frame"``.
        """

    def add_joint(self, joint: Kind) -> Kind:
        """Add a joint that has been constructed elsewhere, and return it with its axis normalised."""

    def add_element(self, element: Force) -> Force:
        """Add a force element or a load that has been constructed elsewhere."""

    def add_constraint(self, limit: Limit) -> Limit:
        """Add a constraint or a relation that has been constructed elsewhere."""

    def couple(self, joint: str | Joint, to: str | Joint, ratio: Any = 1, offset: Any = 0) -> None:
        """Let one joint follow another: ``q_joint = ratio q_to + offset``.

        Args:
            joint: the follower.
            to: the joint that it follows.
            ratio: dimensionless between joints of the same kind.
            offset: in the unit of the follower's coordinate.
        """

    def terminals(self) -> dict[str, tuple[str, Placement]]:
        """Every terminal to which a joint may be connected, with its body and its placement there."""


@dataclass(frozen=True)
class BodyHandle:
    """A body of a model under construction. Used as a terminal it means the body's own frame.

    Attributes:
        model: the model to which the body belongs.
        name: of the body.
    """

    model: Builder
    name: str

    def frame(
        self,
        name: str,
        at: Sequence[Any] = ZERO,
        rpy: Sequence[float] | None = None,
        axis: Sequence[float] | None = None,
        angle: float = 0.0,
        rotation: Any = None,
    ) -> str:
        """Add a named frame and return its terminal.

        Args:
            name: unique on this body.
            at: origin in the body's frame (m).
            rpy: orientation by turns about the body's fixed x, y, z, in radians; or
            axis: by one turn about this direction in body axes,
            angle: by so many radians; or
            rotation: by the matrix whose columns are the frame's axes in body axes.

        Returns:
            ``"body.frame"``, to be used in `between`.

        Raises:
            ModelError: the name is taken, a number is not finite, the orientation is given twice or is none,
                or there is an angle without its axis.
        """
        who = f'frame "{self.name}.{name}"'
        finite((angle,), who)
        ways = {"rpy": rpy, "axis": axis, "rotation": rotation}
        given = [way for way, value in ways.items() if value is not None]
        if len(given) > 1:
            raise ModelError(who, f"give {' or '.join(given)}, not both")
        if axis is None and angle != 0:
            raise ModelError(who, "has an angle but no axis to turn about; give both, or rpy")
        if rotation is None:
            matrix = orientation(who, triple(rpy, who), triple(axis, who), angle)
        else:
            matrix = rotation_matrix(rotation, who)
        placement = Placement(vector(at, who), snapped(matrix, self.model.snap))
        return self.model.add_frame(self.name, name, placement)

    def __str__(self) -> str:
        """The terminal that is the body's own frame."""
        return self.name
