"""The builder's words: handles of bodies, and methods made from the registers of components."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeVar

from linegraph.components.body import orientation
from linegraph.components.joints import Joint
from linegraph.components.validation import finite, rotation_matrix, triple, vector
from linegraph.spatial.placement import Placement
from linegraph.spatial.rotation import snapped
from linegraph.spatial.vector import ZERO

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from linegraph.components.constraints import Constraint
    from linegraph.components.constraints.relation import Relation
    from linegraph.components.forces import Element
    from linegraph.model.builder import Model

Ask = ParamSpec("Ask")
Kind = TypeVar("Kind", bound=Joint)
Limit = TypeVar("Limit", bound="Constraint | Relation")


class Shown:
    """How a model looks to the one who builds it."""

    name: str
    bodies: dict[str, Any]
    joints: Any

    def __repr__(self) -> str:
        """Its name and size."""
        return f"<Model {self.name}: {len(self.bodies)} bodies, {len(self.joints)} joints>"

    def _repr_html_(self) -> str:
        from linegraph.notebook.displays import of_model

        return of_model(self)  # type: ignore[arg-type]


@dataclass(frozen=True)
class BodyHandle:
    """A body of a model under construction; stands for its own frame where a terminal is wanted."""

    model: Model
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
        """
        who = f'frame "{self.name}.{name}"'
        finite((angle,), who)
        if rotation is None:
            matrix = orientation(who, triple(rpy, who), triple(axis, who), angle)
        else:
            matrix = rotation_matrix(rotation, who)
        placement = Placement(vector(at, who), snapped(matrix, self.model.snap))
        return self.model.add_frame(self.name, name, placement)

    def __str__(self) -> str:
        """The body's own frame as a terminal."""
        return self.name


Terminal = str | BodyHandle


def adds(kind: Callable[Concatenate[str, tuple[str, str], Ask], Kind]) -> Any:
    """A builder method that adds a joint of one kind: the line in the register of words.

    As in a model file, `motion` prescribes the joint's motion; the joint itself calls it `drive`.
    """

    def add(
        self: Model,
        name: str,
        between: tuple[Terminal, Terminal],
        *args: Any,
        motion: Any = None,
        **options: Any,
    ) -> Kind:
        tail, head = between
        make: Any = kind
        joint: Kind = make(name, (str(tail), str(head)), *args, **options)
        return self.add_joint(joint if motion is None else replace(joint, drive=motion))

    add.__doc__ = kind.__doc__
    add.__name__ = str(getattr(kind, "kind", add.__name__))
    return add


def applies(kind: Callable[Concatenate[str, Ask], Element]) -> Any:
    """A builder method that adds a force element of one kind."""

    def apply(
        self: Model,
        name: str,
        between: tuple[Terminal, Terminal] | None = None,
        joint: str | Joint | None = None,
        **kw: Any,
    ) -> Element:
        ends = None if between is None else (str(between[0]), str(between[1]))
        where = joint.name if isinstance(joint, Joint) else joint
        make: Any = kind
        element: Element = make(name, between=ends, joint=where, **kw)
        return self.add_element(element)

    apply.__doc__ = kind.__doc__
    apply.__name__ = str(getattr(kind, "kind", apply.__name__))
    return apply


def constrains(kind: Callable[Concatenate[str, tuple[str, str], Ask], Limit]) -> Any:
    """A builder method that adds a constraint of one kind."""

    def constrain(
        self: Model, name: str, between: tuple[Terminal, Terminal], *args: Any, **options: Any
    ) -> Limit:
        make: Any = kind
        constraint: Limit = make(name, (str(between[0]), str(between[1])), *args, **options)
        return self.add_constraint(constraint)

    constrain.__doc__ = kind.__doc__
    constrain.__name__ = str(getattr(kind, "kind", constrain.__name__))
    return constrain
