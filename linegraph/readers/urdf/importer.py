"""Entry points: a URDF file or its text becomes a `Model`."""

from __future__ import annotations

import hashlib
import os
from pathlib import PurePath

from linegraph.model.builder import SNAP, Model
from linegraph.readers.urdf.building import UrdfOptions, build
from linegraph.readers.urdf.document import XmlElement, parse_xml, read_bytes
from linegraph.readers.urdf.extensions import TOOLS, mention_extensions
from linegraph.readers.urdf.joints import joint_of
from linegraph.readers.urdf.links import link_of
from linegraph.readers.urdf.parts import XmlPart, named_part
from linegraph.readers.urdf.report import UrdfReport, shown
from linegraph.readers.urdf.structure import tree_of

_CHILDREN = ("link", "joint")
_IGNORED = frozenset({"material", "sensor", "group", "version", *TOOLS})
_OTHERS = {
    "sdf": "an SDF file, not a URDF",
    "mujoco": "an MJCF (MuJoCo) file, not a URDF",
    "mujocoinclude": "a fragment of an MJCF (MuJoCo) file, not a URDF",
    "html": "an HTML page, not a URDF",
    "svg": "an SVG drawing, not a URDF",
    "COLLADA": "a COLLADA mesh, not a URDF",
    "launch": "a ROS launch file, not a URDF",
}
_RUN_XACRO = "run xacro first and give its output"


def read(
    path: str | os.PathLike[str], *, base: str = "fixed", symbolic: bool = False, snap: float = SNAP
) -> Model:
    """Read a URDF file.

    Every joint that is neither fixed nor a ``<mimic>`` gives coordinates under its own name, in the order
    of a depth-first walk from the root link, children in the order of the file. Gravity is (0, 0, -9.81)
    m/s^2 in the axes of the root link at rest. Visuals, collisions, limits and other elements without
    effect on the equations of motion are skipped; no other file is opened.

    Args:
        path: the file.
        base: ``fixed`` welds the root link to ground; ``floating`` connects it by a free joint ``root``.
        symbolic: whether mass, first moment and inertia of every link and the position of every joint
            become parameters whose values are the numbers of the file.
        snap: entries of rotation matrices this close to 0, 1 or 1/2 become these exactly.

    Returns:
        The model; warnings about the file are in its `warnings`.

    Raises:
        SourceError: the file cannot be read or describes no robot; with the line at fault.
        ValueError: `base` is another string.
    """
    return parse(read_bytes(path), os.fsdecode(path), base=base, symbolic=symbolic, snap=snap)


def parse(
    text: bytes, source: str, *, base: str = "fixed", symbolic: bool = False, snap: float = SNAP
) -> Model:
    """Read the text of a URDF.

    Args:
        text: the XML document.
        source: name of the file, for messages; its stem names a robot without name.
        base: ``fixed`` or ``floating``, as for `read`.
        symbolic: whether numbers become parameters, as for `read`.
        snap: rounding of rotation matrices, as for `read`.

    Returns:
        The model; warnings about the text are in its `warnings`.

    Raises:
        SourceError: the text describes no robot; with the line at fault.
        ValueError: `base` is another string.

    Example:
        >>> model = parse(b'''<robot name="pendulum">
        ...   <link name="stand"/>
        ...   <link name="bob"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
        ...     <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
        ...   <joint name="hinge" type="continuous"><parent link="stand"/><child link="bob"/></joint>
        ... </robot>''', "pendulum.urdf")
        >>> [joint.name for joint in model.joints if joint.freedoms]
        ['hinge']
    """
    if base not in ("fixed", "floating"):
        raise ValueError(f'base must be "fixed" or "floating", not {base!r}')
    report = UrdfReport(source)
    root = parse_xml(text, report)
    _require_urdf(root, source, report)
    robot = XmlPart(report, "robot", root)
    robot.check_attributes(("name",), ("version",))
    robot.check_children(_CHILDREN, _IGNORED)
    mention_extensions(root, report)
    name = _name_of(root, source, report)
    links = [link_of(e, report, snap) for e in root.children if e.tag == "link"]
    joints = [joint_of(e, report, snap) for e in root.children if e.tag == "joint"]
    tree = tree_of(links, joints, root.line, base == "floating", report)
    model = build(name, tree, UrdfOptions(base == "floating", symbolic, snap), report)
    model.about = f"Derived from a URDF with SHA-256 {hashlib.sha256(text).hexdigest()}."
    model.warnings += report.warnings
    return model


def _require_urdf(root: XmlElement, source: str, report: UrdfReport) -> None:
    if root.tag != "robot":
        known = _OTHERS.get(root.tag)
        said = (
            f"looks like {known}"
            if known
            else f"is no URDF: its root element is <{shown(root.tag)}>"
        )
        raise report.error(root.line, "", f"{said}; a URDF's root element is <robot>")
    left = _xacro_element(root)
    if left is not None:
        raise report.error(left.line, "", f"<{shown(left.tag)}> is left of xacro; {_RUN_XACRO}")
    if source.endswith(".xacro"):
        raise report.error(None, "", f"is a xacro file; {_RUN_XACRO}")


def _xacro_element(element: XmlElement) -> XmlElement | None:
    if element.tag.startswith("xacro:"):
        return element
    found = (_xacro_element(child) for child in element.children if child.tag not in TOOLS)
    return next((one for one in found if one is not None), None)


def _name_of(root: XmlElement, source: str, report: UrdfReport) -> str:
    """Name of the robot, or that of the file if the robot has none."""
    if root.attributes.get("name", "").strip():
        return named_part(report, root)[0]
    stem = PurePath(source).stem.strip()
    name = stem if stem and stem.isprintable() else "robot"
    report.warn(root.line, "robot", f'has no name; taken as "{shown(name)}"')
    return name
