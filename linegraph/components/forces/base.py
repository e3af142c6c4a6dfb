"""The base of all force elements; each type is one file beside this one.

An *element* is an edge with a law: its through variable, a force or a torque, follows from its across
variable and that variable's rate. It acts between two points, along the line that joins them, or inside a
joint, along the joint's coordinate:

    between = (tail, head)    x is the distance of the two points (m), v its rate (m/s)
    joint = name              x is the joint's coordinate (rad or m), v its rate (rad/s or m/s)

A positive through variable pulls: points together, a coordinate back. It takes in the power ``through v``.
All types have the same methods in the same order:

    values   through   potential
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar


class Resolve(Protocol):
    """A function from a model value, and values of further names such as x and v, to a scalar.

    The value has no name of its own, so that a law may use any.
    """

    def __call__(self, value: Any, /, **names: Scalar) -> Scalar:
        """The scalar of a model value.

        Args:
            value: a number, a parameter, the text of an expression, a formula or a SymPy expression.
            names: scalars of names that the expression may use besides those of the model.
        """


@dataclass(frozen=True)
class Element:
    """Base of all elements.

    Attributes:
        name: also the name of its edge.
        between: the terminals (tail, head), each ``body`` or ``body.frame``; or
        joint: the joint it sits in.
    """

    name: str
    between: tuple[str, str] | None = None
    joint: str | None = None

    kind: ClassVar[str]
    laws: ClassVar[tuple[str, ...]] = ()
    """Fields whose expressions see x and v."""
    needs: ClassVar[tuple[tuple[str, ...], ...]] = ()
    """Of each group of fields, a model file gives at least one."""

    def values(self) -> tuple[Any, ...]:
        """The model values its law depends on; those left out are not among them."""
        own = [getattr(self, f.name) for f in fields(self) if f.name not in _PLACES]
        return tuple(value for value in own if value is not None)

    def through(self, algebra: Algebra, x: Scalar, v: Scalar, resolve: Resolve) -> Scalar:
        """The force (N) or torque (N m) at (x, v); positive pulls points together, a coordinate back.

        Args:
            algebra: where to calculate.
            x: the distance of the points (m), or the joint's coordinate (rad or m).
            v: the rate of x.
            resolve: from model values to scalars.
        """
        raise NotImplementedError

    def potential(self, algebra: Algebra, x: Scalar, resolve: Resolve) -> Scalar:
        """The energy stored at x (J), whose derivative is the force at v = 0.

        0 for elements that store none, or that have no formula for it.

        Args:
            algebra: where to calculate.
            x: the distance of the points (m), or the joint's coordinate (rad or m).
            resolve: from model values to scalars.
        """
        return 0


_PLACES = ("name", "between", "joint")
