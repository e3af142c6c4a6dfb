"""The tree that links and joints form, and the errors where they form none."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeVar

from linegraph.components.body import MASS_CENTER
from linegraph.readers.urdf.joints import UrdfJoint
from linegraph.readers.urdf.links import UrdfLink
from linegraph.readers.urdf.names import renamed
from linegraph.readers.urdf.report import UrdfReport, named, nearest, shown

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from linegraph.errors import SourceError

Named = TypeVar("Named", UrdfLink, UrdfJoint)
_LISTED = 8


class Tree(NamedTuple):
    """The robot as a tree.

    Attributes:
        root: the link that is no joint's child.
        links: links by name.
        walk: joints depth first from the root, those of one link in the order of the file.
    """

    root: UrdfLink
    links: Mapping[str, UrdfLink]
    walk: tuple[UrdfJoint, ...]


def tree_of(
    links: Sequence[UrdfLink],
    joints: Sequence[UrdfJoint],
    line: int,
    floating: bool,
    report: UrdfReport,
) -> Tree:
    """Connect links by joints.

    Args:
        links: in the order of the file.
        joints: in the order of the file.
        line: line of the robot, for errors of no single element.
        floating: whether a free joint is above the root link.
        report: receives warnings and places errors.

    Raises:
        SourceError: names clash, a joint names no link, or the links form no single tree.
    """
    if not links:
        raise report.error(line, "robot", "has no links")
    _require_unique("link", links, report)
    _require_unique("joint", joints, report)
    links, joints = renamed(links, joints, floating, report)
    by_name = {link.name: link for link in links}
    carriers = _carriers(by_name, joints, report)
    roots = [link for link in links if link.name not in carriers]
    if len(roots) > 1:
        raise _several_roots(roots, report)
    walk = _depth_first(roots[0].name, joints) if roots else ()
    if len(walk) < len(joints):
        reached = {joint.child for joint in walk}
        start = next(joint for joint in joints if joint.child not in reached)
        raise _circle(start, carriers, report)
    _check_vertices(links, joints, report)
    _check_edges(links, joints, report)
    return Tree(roots[0], by_name, walk)


def _require_unique(kind: str, found: Sequence[Named], report: UrdfReport) -> None:
    names: dict[str, Named] = {}
    for one in found:
        first = names.setdefault(one.name, one)
        if first is not one:
            problem = f"the name is taken by the {kind} on line {first.line}"
            raise report.error(one.line, named(kind, one.name), problem)


def _carriers(
    links: Mapping[str, UrdfLink], joints: Sequence[UrdfJoint], report: UrdfReport
) -> dict[str, UrdfJoint]:
    """The joint whose child each link is."""
    carriers: dict[str, UrdfJoint] = {}
    for joint in joints:
        who = named("joint", joint.name)
        for role, name, line in (
            ("parent", joint.parent, joint.parent_line),
            ("child", joint.child, joint.child_line),
        ):
            if name not in links:
                problem = f'there is no {role} link "{shown(name)}"{nearest(name, links)}'
                raise report.error(line, who, problem)
        if joint.parent == joint.child:
            raise report.error(joint.line, who, f'connects link "{shown(joint.child)}" to itself')
        other = carriers.setdefault(joint.child, joint)
        if other is not joint:
            problem = (
                f"link {_quoted(joint.child)} is already the child of "
                f"{named('joint', other.name)} (line {other.line}); a URDF is a tree"
            )
            raise report.error(joint.line, who, problem)
    return carriers


def _several_roots(roots: Sequence[UrdfLink], report: UrdfReport) -> SourceError:
    listed = [f"{_quoted(link.name)} (line {link.line})" for link in roots[:_LISTED]]
    more = "" if len(roots) <= _LISTED else f" and {len(roots) - _LISTED} more"
    problem = (
        f"no joint carries {', '.join(listed)}{more}: {len(roots)} roots; "
        "a URDF is one tree with one root, connect them by joints"
    )
    if report.dropped:
        listed = [f"<{shown(tag)}> (line {line})" for line, tag in report.dropped[:_LISTED]]
        problem += f"; what may connect them is not read: {', '.join(listed)}"
    return report.error(roots[1].line, named("link", roots[1].name), problem)


def _depth_first(root: str, joints: Sequence[UrdfJoint]) -> tuple[UrdfJoint, ...]:
    beyond: dict[str, list[UrdfJoint]] = {}
    for joint in joints:
        beyond.setdefault(joint.parent, []).append(joint)
    walk: list[UrdfJoint] = []
    # Not recursive: a chain may be longer than Python's stack allows.
    pending: list[Iterator[UrdfJoint]] = [iter(beyond.get(root, ()))]
    while pending:
        for joint in pending[-1]:
            walk.append(joint)
            pending.append(iter(beyond.get(joint.child, ())))
            break
        else:
            pending.pop()
    return tuple(walk)


def _circle(start: UrdfJoint, carriers: Mapping[str, UrdfJoint], report: UrdfReport) -> SourceError:
    """The error for joints not reached from the root: walking toward it, they form a cycle."""
    seen: dict[str, UrdfJoint] = {}
    joint = start
    while joint.name not in seen:
        seen[joint.name] = joint
        joint = carriers[joint.parent]
    names = list(seen)
    around = [seen[name] for name in names[names.index(joint.name) :]]
    first = min(around, key=lambda j: j.line)
    listed = [f"{_quoted(j.name)} (line {j.line})" for j in around[:_LISTED]]
    problem = f"closes a circle of joints: {', '.join(listed)}; a URDF is a tree with one root"
    return report.error(first.line, named("joint", first.name), problem)


def _check_vertices(
    links: Sequence[UrdfLink], joints: Sequence[UrdfJoint], report: UrdfReport
) -> None:
    """Refuse clashes of the system graph's vertices, whose names are joined by dots."""
    taken: dict[str, str] = {}

    def take(vertex: str, line: int, who: str) -> None:
        if vertex in taken:
            problem = f'the name "{shown(vertex)}" also arises from {taken[vertex]}; rename one'
            raise report.error(line, who, problem)
        taken[vertex] = f"{who} on line {line}"

    for link in links:
        who = named("link", link.name)
        take(link.name, link.line, who)
        take(f"{link.name}.{MASS_CENTER}", link.line, who)
    for joint in joints:
        take(f"{joint.parent}.{joint.name}", joint.line, named("joint", joint.name))


def _check_edges(
    links: Sequence[UrdfLink], joints: Sequence[UrdfJoint], report: UrdfReport
) -> None:
    """Refuse joints named like an edge of a body, which has a slash in its name."""
    owners = {f"{link.name}/{edge}": link for link in links for edge in ("inertia", "arm")}
    arms = {f"{joint.parent}/arm.{joint.name}" for joint in joints}
    for joint in joints:
        if joint.name in owners or joint.name in arms:
            problem = "the name is that of an edge inside a link; rename the joint"
            raise report.error(joint.line, named("joint", joint.name), problem)


def _quoted(name: str) -> str:
    return f'"{shown(name)}"'
