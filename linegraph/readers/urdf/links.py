"""Links of a URDF: mass distribution in the link's own frame, and whether a body can have it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.components.body import impossible
from linegraph.readers.urdf.parts import XmlPart, named_part
from linegraph.spatial.rotation import Inertia, from_rpy, rotation_of, snapped
from linegraph.spatial.vector import ZERO, Vector

if TYPE_CHECKING:
    from linegraph.readers.urdf.document import XmlElement
    from linegraph.readers.urdf.report import UrdfReport

ENTRIES = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
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
    """Mass, mass centre and inertia of a link.

    Attributes:
        mass: kg.
        center: mass centre in the link's frame (m).
        tensor: (xx, xy, xz, yy, yz, zz) about the mass centre, in the link's axes (kg m^2).
    """

    mass: float
    center: Vector
    tensor: Inertia


class UrdfLink(NamedTuple):
    """A link of the robot.

    Attributes:
        name: its name.
        line: line of the element.
        inertial: mass and inertia; None for a link without mass.
    """

    name: str
    line: int
    inertial: Inertial | None


def link_of(element: XmlElement, report: UrdfReport, snap: float) -> UrdfLink:
    """Read a ``<link>``.

    Args:
        element: the element.
        report: receives warnings and places errors.
        snap: entries of the inertial frame's rotation this close to 0, 1 or 1/2 become these exactly.

    Raises:
        SourceError: an attribute or child element is missing or invalid.
    """
    name, part = named_part(report, element)
    part.check_attributes(("name",), ("type",))
    part.check_children(_CHILDREN, _IGNORED)
    inertial = part.child("inertial")
    return UrdfLink(name, element.line, None if inertial is None else _inertial(inertial, snap))


def _inertial(part: XmlPart, snap: float) -> Inertial:
    part.check_children(("origin", "mass", "inertia"), ())
    mass = _mass(part)
    center, rpy = origin_of(part)
    written = _tensor(part)
    rotation = rotation_of(snapped(from_rpy(*rpy), snap))
    # R I Rᵀ: the file gives the inertia in the axes of <origin>, the model needs it in those of the link.
    return Inertial(mass, center, rotation.congruence(written))


def origin_of(part: XmlPart) -> tuple[Vector, Vector]:
    """The ``<origin>`` child: position (m) and roll, pitch, yaw (rad); zeros where it is missing.

    Raises:
        SourceError: there are two, or an attribute does not contain three numbers.
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


def _mass(part: XmlPart) -> float:
    mass = part.need("mass")
    mass.check_attributes(("value",))
    value = mass.number("value")
    if value < 0:
        raise mass.fail(f"the mass is negative ({value:g}); it must be 0 or more")
    return value


def _tensor(part: XmlPart) -> Inertia:
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
