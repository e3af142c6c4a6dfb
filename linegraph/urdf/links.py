"""Links: the mass distribution in the link's own frame, and whether any body can have it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from linegraph.rotation import Inertia, from_rpy, rotation_of, snapped
from linegraph.urdf.parts import Part, named_part
from linegraph.vector import ZERO, Vector

if TYPE_CHECKING:
    from linegraph.urdf.document import Element
    from linegraph.urdf.report import Report

ENTRIES = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
PHYSICAL = 1e-6
"""Relative to the largest principal moment: files carry about seven digits."""

_CHILDREN = ("inertial", "visual", "collision")
_IGNORED = frozenset(
    {
        "contact",
        "self_filter",
        "collision_checking",
        "self_collision_checking",
        "kinematic",
        "gravity",
    }
    | {"surface", "sensor", "verbose", "material", "audio"}
)


class Inertial(NamedTuple):
    """A mass distribution.

    Attributes:
        mass: kg.
        center: mass centre in the link's frame (m).
        tensor: (xx, xy, xz, yy, yz, zz) about the mass centre, in the link's axes (kg m^2).
    """

    mass: float
    center: Vector
    tensor: Inertia


class Link(NamedTuple):
    """A link of the robot; without `inertial` it has no mass."""

    name: str
    line: int
    inertial: Inertial | None


def link_of(element: Element, report: Report, snap: float) -> Link:
    """Read a ``<link>``.

    Args:
        element: the element.
        report: where warnings go.
        snap: entries of the inertial frame's rotation this close to 0, 1 or 1/2 become these exactly.

    Raises:
        SourceError: something in it cannot be.
    """
    name, part = named_part(report, element)
    part.check_attributes(("name",), ("type",))
    part.check_children(_CHILDREN, _IGNORED)
    inertial = part.child("inertial")
    return Link(name, element.line, None if inertial is None else _inertial(inertial, snap))


def _inertial(part: Part, snap: float) -> Inertial:
    part.check_children(("origin", "mass", "inertia"), ())
    mass = _mass(part)
    center, rpy = origin_of(part)
    written = _tensor(part)
    rotation = rotation_of(snapped(from_rpy(*rpy), snap))
    return Inertial(mass, center, rotation.congruence(written))


def origin_of(part: Part) -> tuple[Vector, Vector]:
    """The ``<origin>`` child: position (m) and roll, pitch, yaw (rad); zeros where it is missing.

    Raises:
        SourceError: there are two, or it does not hold three numbers each.
    """
    origin = part.child("origin")
    if origin is None:
        return ZERO, ZERO
    if "quat_xyzw" in origin.element.attributes:
        raise origin.fail("<origin> quat_xyzw is not read; give the orientation as rpy")
    origin.check_attributes(("xyz", "rpy"))
    x, y, z = origin.numbers("xyz", 3, ZERO)
    roll, pitch, yaw = origin.numbers("rpy", 3, ZERO)
    return (x, y, z), (roll, pitch, yaw)


def _mass(part: Part) -> float:
    mass = part.need("mass")
    mass.check_attributes(("value",))
    value = mass.number("value")
    if value < 0:
        raise mass.fail(f"the mass is negative ({value:g}); it must be 0 or more")
    return value


def _tensor(part: Part) -> Inertia:
    inertia = part.child("inertia")
    if inertia is None:
        part.warn("<inertial> has no <inertia>; the link is taken as a point mass")
        return (0, 0, 0, 0, 0, 0)
    inertia.check_attributes(ENTRIES)
    xx, xy, xz, yy, yz, zz = (inertia.number(entry) for entry in ENTRIES)
    problem = impossible((xx, xy, xz, yy, yz, zz))
    if problem:
        many = "no body has this inertia: a principal moment is negative or exceeds the sum of the others"
        inertia.warn(f"no body has this inertia: {problem}", many)
    return (xx, xy, xz, yy, yz, zz)


def impossible(tensor: Inertia) -> str:
    """Why no distribution of mass has this inertia tensor; empty where one has.

    Principal moments are never negative, and none exceeds the sum of the other two.

    Example:
        >>> impossible((1.0, 0, 0, 1.0, 0, 3.0))
        'principal moments 1, 1, 3 kg m^2: the largest exceeds the sum of the others'
    """
    low, middle, high = principal_moments(tensor)
    largest = max(abs(low), abs(high))
    margin = PHYSICAL * largest
    # moments that are zero up to rounding are shown as zero
    shown = (0.0 if abs(moment) < 1e-12 * largest else moment for moment in (low, middle, high))
    said = f"principal moments {', '.join(f'{moment:.6g}' for moment in shown)} kg m^2"
    if low < -margin:
        return f"{said}: none can be negative"
    if high > low + middle + margin:
        return f"{said}: the largest exceeds the sum of the others"
    return ""


def principal_moments(tensor: Inertia) -> tuple[float, float, float]:
    """The eigenvalues of a symmetric tensor, rising: roots of its cubic by the cosine formula."""
    scale = max(abs(entry) for entry in tensor)
    if scale == 0:
        return (0.0, 0.0, 0.0)
    xx, xy, xz, yy, yz, zz = (entry / scale for entry in tensor)
    mean = (xx + yy + zz) / 3
    a, b, c = xx - mean, yy - mean, zz - mean
    spread = math.sqrt((a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6)
    if spread == 0:
        return (mean * scale,) * 3
    determinant = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)
    cosine = max(-1.0, min(1.0, determinant / (2 * spread**3)))
    angle = math.acos(cosine) / 3
    high = mean + 2 * spread * math.cos(angle)
    low = mean + 2 * spread * math.cos(angle + 2 * math.pi / 3)
    return (low * scale, (3 * mean - high - low) * scale, high * scale)
