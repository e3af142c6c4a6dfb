"""Joints of a URDF: kind, placement, axis and the joint they follow."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.readers.urdf.links import origin_of
from linegraph.readers.urdf.parts import XmlPart, length, named_part
from linegraph.readers.urdf.report import nearest, shown

if TYPE_CHECKING:
    from linegraph.readers.urdf.document import XmlElement
    from linegraph.readers.urdf.report import UrdfReport
    from linegraph.spatial.vector import Vector

KINDS = {
    "revolute": "revolute",
    "continuous": "revolute",
    "prismatic": "prismatic",
    "planar": "planar",
    "floating": "free",
    "fixed": "fixed",
}
"""Joint types of URDF with the names of the corresponding joint types here."""
ONE_FREEDOM = frozenset({"revolute", "prismatic"})

_CHILDREN = ("parent", "child", "origin", "axis", "mimic", "dynamics", "limit")
_IGNORED = frozenset({"safety_controller", "calibration", "hardwareInterface", "physics"})
_DAMPERS = ("damping", "friction")
# Used by one vendor.
_OTHER_DYNAMICS = frozenset(
    {"D", "K", "mu_coulomb", "mu_viscous", "spring_reference", "spring_stiffness"}
)
_DEFAULT_AXIS = (1.0, 0.0, 0.0)
_OFF_UNIT = 1e-3


class Mimic(NamedTuple):
    """A coupling of coordinates: ``q = multiplier q_master + offset``.

    Attributes:
        master: name of the joint that is followed.
        multiplier: ratio of the coordinates (rad and m).
        offset: rad or m.
        line: line of the element.
    """

    master: str
    multiplier: float
    offset: float
    line: int


class UrdfJoint(NamedTuple):
    """A joint of the robot.

    Attributes:
        name: its name.
        line: line of the element.
        kind: a value of `KINDS`.
        parent, child: names of links.
        at, rpy: the joint frame in the parent link's frame (m, rad).
        axis: unit vector in the joint frame.
        mimic: the coupling to another joint, if any.
        damped: whether the file gives damping or friction.
        parent_line, child_line: lines of the elements that name the links.
    """

    name: str
    line: int
    kind: str
    parent: str
    child: str
    at: Vector
    rpy: Vector
    axis: Vector
    mimic: Mimic | None
    damped: bool
    parent_line: int
    child_line: int


def joint_of(element: XmlElement, report: UrdfReport, snap: float) -> UrdfJoint:
    """Read a ``<joint>``.

    Args:
        element: the element.
        report: receives warnings and places errors.
        snap: components of the axis this close to 0 become 0.

    Raises:
        SourceError: an attribute or child element is missing or invalid.
    """
    name, part = named_part(report, element)
    part.check_attributes(("name", "type"), ("dont_collapse",))
    part.check_children(_CHILDREN, _IGNORED)
    kind = _kind(part)
    parent, child = _link_named(part, "parent"), _link_named(part, "child")
    at, rpy = origin_of(part)
    return UrdfJoint(
        name, element.line, kind, parent.word("link"), child.word("link"), at, rpy,
        _axis(part, kind, snap), _mimic(part, kind), _damped(part),
        parent.element.line, child.element.line,
    )  # fmt: skip


def _kind(part: XmlPart) -> str:
    word = part.word("type")
    if word not in KINDS:
        hint = nearest(word, KINDS) or f"; types are {', '.join(KINDS)}"
        raise part.fail(f'type="{shown(word)}" is not known{hint}')
    return KINDS[word]


def _link_named(part: XmlPart, tag: str) -> XmlPart:
    """The ``<parent>`` or ``<child>`` element, each of which names a link."""
    found = part.need(tag)
    found.check_attributes(("link",))
    return found


def _axis(part: XmlPart, kind: str, snap: float) -> Vector:
    axis = part.child("axis")
    if kind in ("fixed", "free"):
        return (0, 0, 1)
    if axis is None:
        return _DEFAULT_AXIS
    axis.check_attributes(("xyz",))
    x, y, z = axis.numbers("xyz", 3)
    norm = length((x, y, z))
    if norm == 0:
        raise axis.fail('<axis> xyz="0 0 0" has no direction; give one such as "0 0 1"')
    if abs(norm - 1) > _OFF_UNIT:
        many = "<axis> is no unit vector; it is scaled to length 1"
        axis.warn(f"<axis> has length {norm:.6g}; it is scaled to 1", many)
    return _direction((x / norm, y / norm, z / norm), snap)


def _direction(unit: Vector, snap: float) -> Vector:
    """A unit vector without the rounding that conversion from degrees leaves next to coordinate axes."""
    clean = tuple(0.0 if abs(c) <= snap else c for c in unit)
    if sum(c != 0 for c in clean) == 1:
        clean = tuple(float(round(c)) for c in clean)
    return clean  # type: ignore[return-value]


def _mimic(part: XmlPart, kind: str) -> Mimic | None:
    mimic = part.child("mimic")
    if mimic is None:
        return None
    mimic.check_attributes(("joint", "multiplier", "offset"))
    if kind == "fixed":  # some vendors fix the fingers of a hand and keep their <mimic>
        mimic.warn("<mimic> of a fixed joint is ignored")
        return None
    if kind not in ONE_FREEDOM:
        raise mimic.fail(f"<mimic> is for joints of one freedom; this one is {kind}")
    master = mimic.word("joint")
    values = mimic.number("multiplier", 1.0), mimic.number("offset", 0.0)
    return Mimic(master, *values, mimic.element.line)


def _damped(part: XmlPart) -> bool:
    dynamics = part.child("dynamics")
    if dynamics is None:
        return False
    dynamics.check_attributes(_DAMPERS, _OTHER_DYNAMICS)
    return any(dynamics.number(name, 0.0) != 0 for name in _DAMPERS)
