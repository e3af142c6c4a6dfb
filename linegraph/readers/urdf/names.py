"""Renaming of links and joints whose names are not possible in the equations."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.components.body import GROUND
from linegraph.components.joints import JOINTS
from linegraph.components.validation import RESERVED
from linegraph.model.name_register import Claim, claims_of, numbered
from linegraph.readers.urdf.report import named, shown

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.readers.urdf.joints import UrdfJoint
    from linegraph.readers.urdf.links import UrdfLink
    from linegraph.readers.urdf.report import UrdfReport

ROOT = "root"
"""Name of the free joint above the root link of a floating robot."""


def renamed(
    links: Sequence[UrdfLink], joints: Sequence[UrdfJoint], floating: bool, report: UrdfReport
) -> tuple[Sequence[UrdfLink], Sequence[UrdfJoint]]:
    """Rename a link called ground, and joints whose coordinates would clash with other names.

    A joint x has the coordinate x with the rate x_dot, so no other joint can be called x_dot; a planar
    joint p has p_x, p_y and more. The later one in the file gets a suffix.

    Args:
        links: in the order of the file.
        joints: in the order of the file.
        floating: whether a free joint called root is above the root link.
        report: receives a warning for each change.

    Returns:
        Links and joints with references renamed as well.
    """
    new_links = _of_links(links, report)
    new_joints = _of_joints(joints, floating, report)
    if not new_links and not new_joints:
        return links, joints
    found = []
    for joint in joints:
        mimic = joint.mimic
        if mimic is not None:
            mimic = mimic._replace(master=new_joints.get(mimic.master, mimic.master))
        ends = (new_links.get(end, end) for end in (joint.parent, joint.child))
        parent, child = ends
        name = new_joints.get(joint.name, joint.name)
        found.append(joint._replace(name=name, parent=parent, child=child, mimic=mimic))
    return [link._replace(name=new_links.get(link.name, link.name)) for link in links], found


def _of_links(links: Sequence[UrdfLink], report: UrdfReport) -> dict[str, str]:
    names = {link.name for link in links}
    found = {}
    for link in links:
        if link.name == GROUND:
            other = f"{GROUND}_link"
            while other in names:
                other += "_"
            found[GROUND] = other
            text = f'"{GROUND}" is the inertial frame; the link becomes the body "{other}"'
            report.warn(link.line, named("link", GROUND), text)
    return found


def _of_joints(joints: Sequence[UrdfJoint], floating: bool, report: UrdfReport) -> dict[str, str]:
    names = {joint.name for joint in joints}
    owners = {claim.name: claim for claim in _claims("free", ROOT)} if floating else {}
    found: dict[str, str] = {}
    for joint in joints:
        name, reason = joint.name, _reason(joint.kind, joint.name, owners)
        if reason:
            free = (x for x in numbered(f"{joint.name}_joint") if x not in names)
            name = next(x for x in free if not _reason(joint.kind, x, owners))
            names.add(name)
            found[joint.name] = name
            text = f'{reason}; it becomes the joint "{shown(name)}"'
            report.warn(joint.line, named("joint", joint.name), text)
        owners |= {claim.name: claim for claim in _claims(joint.kind, name)}
    return found


def _reason(kind: str, name: str, owners: dict[str, Claim]) -> str:
    """Why a joint cannot have a name; empty if it can."""
    for claim in _claims(kind, name):
        if claim.name in RESERVED:
            return f'"{name}" has a meaning of its own in expressions'
        if claim.name in owners:
            return f'{claim.own} "{shown(claim.name)}" has the name of {shown(owners[claim.name].what)}'
    return ""


def _claims(kind: str, name: str) -> list[Claim]:
    return claims_of(JOINTS[kind](name, ("", "")))


__all__ = ["ROOT", "renamed"]
