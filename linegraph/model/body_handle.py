"""Bodies of a model under construction, and what they and macros need of its builder."""

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
    from linegraph.components.forces import Element, Load
    from linegraph.components.joints import Joint
    from linegraph.model.coupling import Coupling


Kind = TypeVar("Kind", bound="Joint")
Force = TypeVar("Force", bound="Element | Load")
Limit = TypeVar("Limit", bound="Constraint | Relation")


class Builder(Protocol):
    """What handles, words and macros need of a model under construction; see `builder.Model`."""

    snap: float

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The joints in declared order."""

    @property
    def couplings(self) -> tuple[Coupling, ...]:
        """The coupled joints in declared order."""

    def body(self, name: str, *, inertia: Any = ...) -> BodyHandle:
        """Add a rigid body."""

    def add_frame(self, body: str, name: str, placement: Placement) -> str:
        """Add a frame to a body or to ground."""

    def add_joint(self, joint: Kind) -> Kind:
        """Add a joint made elsewhere."""

    def add_element(self, element: Force) -> Force:
        """Add a force element made elsewhere."""

    def add_constraint(self, limit: Limit) -> Limit:
        """Add a constraint made elsewhere."""

    def couple(self, joint: str | Joint, to: str | Joint, ratio: Any = 1, offset: Any = 0) -> None:
        """Let one joint follow another."""

    def terminals(self) -> dict[str, tuple[str, Placement]]:
        """Every terminal a joint may be connected to."""


@dataclass(frozen=True)
class BodyHandle:
    """A body of a model under construction; stands for its own frame where a terminal is wanted."""

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
            axis: by one turn about this direction,
            angle: by so many radians; or
            rotation: by the matrix whose columns are the frame's axes in body axes.

        Returns:
            ``"body.frame"``, to be used in `between`.

        Raises:
            ModelError: the orientation is given twice, or an angle without its axis.
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
        """The body's own frame as a terminal."""
        return self.name
