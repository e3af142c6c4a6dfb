"""How a body's mass enters the equations: moments about a point, mass centre, central inertia."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from linegraph.algebra.formula import Formula
from linegraph.algebra.scalar import Scalar
from linegraph.components.parameters import Parameter
from linegraph.spatial import vector
from linegraph.spatial.inertia import Moments, carried, second_moments
from linegraph.spatial.rotation import Inertia, rotation_of
from linegraph.spatial.vector import ZERO, Vector

if TYPE_CHECKING:
    from linegraph.components.body import Body
    from linegraph.spatial.placement import Placement


Resolve = Callable[[Any], Scalar]

LEAST_MASS = 1e-37
"""In kg: less is no mass, and no number with all its digits among floats."""


def body_moments(body: Body, resolve: Resolve, pose: Placement) -> Moments:
    """A body's mass distribution about the origin of a frame in which the body stands at `pose`.

    From the mass centre in one step: by way of the body's origin, the terms that the first shift adds and the
    second removes would leave their rounding.

    Args:
        body: its mass, and its mass centre or first moment.
        resolve: from model values to scalars.
        pose: the place of the body's own frame in the other frame.

    Returns:
        Mass (kg), first moment (kg m) and second moments (kg m^2), in the axes of the other frame.
    """
    mass = resolve(body.mass)
    given = tuple(resolve(x) for x in body.inertia)
    second, about = second_moments(given), (given[0], given[3], given[5])
    rotation = rotation_of(pose.rotation)
    if body.first is not None:
        about_origin = Moments(mass, resolved(body.first, resolve), second, about)
        return carried(about_origin, rotation, pose.at)
    center = rotation.out(resolved(body.center or ZERO, resolve))
    return carried(Moments(mass, ZERO, second, about), rotation, vector.add(pose.at, center))


def mass_center(body: Body, resolve: Resolve) -> Vector:
    """A body's mass centre from its origin, in its own axes (m).

    Args:
        body: its mass, and its mass centre or first moment.
        resolve: from model values to scalars.
    """
    if body.first is None:
        return resolved(body.center or ZERO, resolve)
    mass = resolve(body.mass)
    if isinstance(body.mass, Parameter) and body.mass.value == 0:
        # a link that is given some later: until then 0/0 is to be 0
        named, least = Formula("name", (body.mass.name,)), Formula("number", (LEAST_MASS,))
        mass = resolve(Formula("max", (named, least)))
    first = resolved(body.first, resolve)
    return ZERO if mass == 0 else (first[0] / mass, first[1] / mass, first[2] / mass)


def central_inertia(body: Body, resolve: Resolve) -> Inertia:
    """A body's inertia tensor about its mass centre, in its own axes.

    Where the body states the tensor about its origin, ``I - m (c² 1 - c c^T)`` with c the mass centre.

    Args:
        body: its mass, and its mass centre or first moment.
        resolve: from model values to scalars.

    Returns:
        The entries (xx, xy, xz, yy, yz, zz) (kg m^2).
    """
    given = tuple(resolve(x) for x in body.inertia)
    if body.first is None:
        return given
    mass = resolve(body.mass)
    x, y, z = mass_center(body, resolve)
    shift = (
        *(y * y + z * z, -x * y, -x * z),
        *(x * x + z * z, -y * z, x * x + y * y),
    )
    return tuple(a - mass * b for a, b in zip(given, shift, strict=True))


def resolved(a: Vector, resolve: Resolve) -> Vector:
    """A vector of model values as scalars.

    Args:
        a: three model values.
        resolve: from model values to scalars.
    """
    return (resolve(a[0]), resolve(a[1]), resolve(a[2]))
