"""Extensions of a URDF that may affect the motion: they are not read, and the user is warned.

A URDF may contain elements of other tools: with a prefix (``drake:rotor_inertia``), or inside ``<gazebo>``,
``<transmission>`` and ``<ros2_control>``. Most concern sensors, control or appearance. Those named after
inertia, joints, loops, springs or dampers would change the equations.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from linegraph.readers.urdf.report import IGNORED, mechanical, named, shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linegraph.readers.urdf.document import XmlElement
    from linegraph.readers.urdf.report import UrdfReport

TOOLS = frozenset({"gazebo", "transmission", "ros2_control"})
"""Elements of other tools without a prefix, mostly without effect on the motion."""

_IN_TOOLS = frozenset(
    {
        *("motorInertia", "motor_inertia", "rotorInertia", "rotor_inertia", "armature"),
        *(
            "springStiffness",
            "spring_stiffness",
            "stiffness",
            "dampingFactor",
            "damping",
            "friction",
        ),
        *("mimic", "mimicJoint", "mass", "inertial", "gearbox_ratio", "thread_pitch"),
    }
)
"""Elements inside these that matter; their joints matter if they have a type, as in SDF."""

_RATIOS = frozenset({"mechanicalReduction", "mechanical_reduction"})
"""Elements that matter together with a rotor's inertia only; otherwise the joint moves the same."""

_ELSEWHERE = frozenset({"surface", "contact", "sensor", "visual", "collision"})
"""Elements inside these about contact, sensors and appearance."""

_ZERO = re.compile(r"[+-]?0*\.?0*(?:[eE][+-]?[0-9]+)?")
_MOST_NAMED = 4


def mention_extensions(root: XmlElement, report: UrdfReport) -> None:
    """Warn about extensions of the robot, its links and its joints that may affect the motion.

    Args:
        root: the root element.
        report: receives the warnings.
    """
    _mention(root, "robot", report)
    for part in root.children:
        if part.tag in ("link", "joint") and "name" in part.attributes:
            _mention(part, named(part.tag, part.attributes["name"]), report)


def _mention(owner: XmlElement, thing: str, report: UrdfReport) -> None:
    for child in owner.children:
        if ":" in child.tag:
            found = [child] if mechanical(child.tag) else list(_prefixed(child))
        elif child.tag in TOOLS:
            found = list(_of_tools(child))
        else:
            continue
        if any(element.tag not in _RATIOS for element in found):
            _tell(child, found, thing, report)


def _tell(child: XmlElement, found: list[XmlElement], thing: str, report: UrdfReport) -> None:
    report.dropped.append((child.line, child.tag))
    own = child.attributes.get("name") or child.attributes.get("reference")
    owner = named(child.tag, own) if thing == "robot" and own else thing
    where = "" if owner != thing or found[0] is child else f" in <{shown(child.tag)}>"
    tags = list(dict.fromkeys(element.tag for element in found))
    kinds = [f"<{shown(tag)}>" for tag in tags]
    said = {element.tag: element.text for element in found if element.text}
    values = [
        f"{kind} {shown(said.get(tag, ''))}".rstrip() for kind, tag in zip(kinds, tags, strict=True)
    ]
    text, many = (f"{_listed(parts)}{where}: {IGNORED}" for parts in (values, kinds))
    report.warn(child.line, owner, text, many)


def _listed(parts: list[str]) -> str:
    return ", ".join(parts[:_MOST_NAMED]) + ", ..." * (len(parts) > _MOST_NAMED)


def _prefixed(element: XmlElement) -> Iterator[XmlElement]:
    for child in element.children:
        if mechanical(child.tag):
            yield child
        else:
            yield from _prefixed(child)


def _of_tools(element: XmlElement) -> Iterator[XmlElement]:
    """Elements of other tools that affect the motion, without those whose value is zero."""
    for child in element.children:
        local = child.tag.rpartition(":")[2]
        if local in ("gravity", "turnGravityOff"):
            off = ("true", "1") if local == "turnGravityOff" else ("false", "0")
            found = child.text.lower() in off
        elif local == "joint":
            found = "type" in child.attributes
        else:
            zero = child.text and _ZERO.fullmatch(child.text)
            found = local in (_IN_TOOLS | _RATIOS) and not zero
        if found:
            yield child
        elif local not in _ELSEWHERE:
            yield from _of_tools(child)
