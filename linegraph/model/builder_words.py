"""Builder methods that are generated from the registers of components."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec

from linegraph.components.joints import Joint
from linegraph.components.validation import vector
from linegraph.display import Displayed
from linegraph.model.body_handle import BodyHandle, Builder, Kind, Limit

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.components.forces import Element, PointForce

Ask = ParamSpec("Ask")


class Shown(Displayed):
    """The appearance of a model in notebooks and on the command line."""

    name: str
    bodies: dict[str, Any]
    joints: Any

    def __repr__(self) -> str:
        """The name, with the numbers of bodies and joints."""
        return f"<Model {self.name}: {len(self.bodies)} bodies, {len(self.joints)} joints>"


Terminal = str | BodyHandle


def adds(kind: Callable[Concatenate[str, tuple[str, str], Ask], Kind]) -> Any:
    """The builder method for a type of joint; its docstring is that of the type.

    As in a model file, `motion` prescribes the joint's motion, which the joint itself calls `drive`.
    """

    def add(
        self: Builder,
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
    """The builder method for a type of force element; its docstring is that of the type."""

    def apply(
        self: Builder,
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


def pushes(kind: Callable[Concatenate[str, str, Ask], PointForce]) -> Any:
    """The builder method for a type of force on a body at a terminal; its docstring is that of the type."""

    def push(self: Builder, name: str, at: Terminal, **kw: Any) -> PointForce:
        make: Any = kind
        who = f'{make.kind} "{name}"'
        given = {key: vector(x, who) if key in make.vectors else x for key, x in kw.items()}
        force: PointForce = make(name, str(at), **given)
        return self.add_element(force)

    push.__doc__ = kind.__doc__
    push.__name__ = str(getattr(kind, "kind", push.__name__))
    return push


def constrains(kind: Callable[Concatenate[str, tuple[str, str], Ask], Limit]) -> Any:
    """The builder method for a type of constraint; its docstring is that of the type."""

    def constrain(
        self: Builder, name: str, between: tuple[Terminal, Terminal], *args: Any, **options: Any
    ) -> Limit:
        make: Any = kind
        constraint: Limit = make(name, (str(between[0]), str(between[1])), *args, **options)
        return self.add_constraint(constraint)

    constrain.__doc__ = kind.__doc__
    constrain.__name__ = str(getattr(kind, "kind", constrain.__name__))
    return constrain
