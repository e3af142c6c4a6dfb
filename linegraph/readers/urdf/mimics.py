"""Joints that follow others: which move, and which are fixed because their master is."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.readers.urdf.joints import ONE_FREEDOM, Mimic, UrdfJoint
from linegraph.readers.urdf.report import UrdfReport, named, nearest, shown

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


class Followers(NamedTuple):
    """Joints with ``<mimic>``, by whether they move.

    Attributes:
        moving: joints that follow a moving joint, directly or through others.
        still: constant coordinate (rad or m) of joints that follow a fixed one.
    """

    moving: Mapping[str, Mimic]
    still: Mapping[str, float]


def followers_of(joints: Sequence[UrdfJoint], report: UrdfReport) -> Followers:
    """Resolve the ``<mimic>`` of all joints.

    Args:
        joints: all joints.
        report: receives warnings and places errors.

    Raises:
        SourceError: a joint follows itself, an unknown joint, or one of several freedoms.
    """
    by_name = {joint.name: joint for joint in joints}
    mimics = {joint.name: joint.mimic for joint in joints if joint.mimic is not None}
    for name, mimic in mimics.items():
        _check_master(name, mimic, by_name, report)
    # For each joint whose chain of masters has been followed: its constant coordinate, None if it moves.
    position: dict[str, float | None] = {}
    for name in mimics:
        _follow(name, mimics, by_name, position, report)
    still = {name: value for name, value in position.items() if value is not None}
    for name in (name for name in mimics if name in still):
        mimic = mimics[name]
        text = (
            f'<mimic> follows "{shown(mimic.master)}", which cannot move: welded at {still[name]:g}'
        )
        many = "<mimic> follows a joint that cannot move: welded where that leaves it"
        report.warn(mimic.line, named("joint", name), text, many)
    moving = {name: mimic for name, mimic in mimics.items() if name not in still}
    return Followers(moving, {name: still[name] for name in mimics if name in still})


def _check_master(
    name: str, mimic: Mimic, joints: Mapping[str, UrdfJoint], report: UrdfReport
) -> None:
    who = named("joint", name)
    master = joints.get(mimic.master)
    if master is None:
        hint = nearest(mimic.master, joints)
        problem = f'<mimic> follows "{shown(mimic.master)}", and there is no such joint{hint}'
        raise report.error(mimic.line, who, problem)
    if master.name == name:
        raise report.error(mimic.line, who, "<mimic> follows itself")
    if master.kind not in (*ONE_FREEDOM, "fixed"):
        problem = f'<mimic> follows "{shown(master.name)}", which is {master.kind}: it has several freedoms'
        raise report.error(mimic.line, who, problem)


def _follow(
    name: str,
    mimics: Mapping[str, Mimic],
    joints: Mapping[str, UrdfJoint],
    position: dict[str, float | None],
    report: UrdfReport,
) -> None:
    """Follow a chain of masters to its end, then record on the way back which joints move."""
    way: dict[str, None] = {}
    while name in mimics and name not in position:
        if name in way:
            line = mimics[name].line
            raise report.error(
                line, named("joint", name), "<mimic> follows itself through a circle"
            )
        way[name] = None
        name = mimics[name].master
    value = position[name] if name in mimics else (0.0 if joints[name].kind == "fixed" else None)
    for follower in reversed(way):
        mimic = mimics[follower]
        value = None if value is None else mimic.multiplier * value + mimic.offset
        position[follower] = value
