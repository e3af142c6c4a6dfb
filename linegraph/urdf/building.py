"""From a tree of links and joints to a `Model`; its numbers folded or kept as parameters."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from linegraph.joints import JOINTS, Moments
from linegraph.kinematics import carried
from linegraph.model import Model
from linegraph.rotation import Rotation
from linegraph.urdf.mimics import followers_of
from linegraph.urdf.report import Report, named
from linegraph.vector import ZERO, Vector

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from linegraph.urdf.joints import Joint
    from linegraph.urdf.links import Inertial, Link
    from linegraph.urdf.structure import Tree

ROOT = "root"
"""The free joint above the root link of a floating robot."""
_LONGEST = 100
_MOMENT_PREFIXES = ("m", "mx", "my", "mz", "Ixx", "Ixy", "Ixz", "Iyy", "Iyz", "Izz")
_OFFSET_PREFIXES = ("x", "y", "z")


def build(
    name: str, tree: Tree, report: Report, *, floating: bool, symbolic: bool, snap: float
) -> Model:
    """Build the model: bodies and joints in the order of the walk.

    Raises:
        SourceError: what the builder refuses, with the line of the element.
    """
    model = Model(name, snap=snap)
    names = _Names(tree) if symbolic else None
    _add_link(model, tree.root, names, report)
    _add_base(model, tree, report, floating=floating)
    for joint in tree.walk:
        _add_link(model, tree.links[joint.child], names, report)
        _add_joint(model, joint, names, report)
    _add_followers(model, tree, report)
    return model


def _add_base(model: Model, tree: Tree, report: Report, *, floating: bool) -> None:
    """Connect the root link to ground, before any other joint so that its v comes first."""
    joints = {joint.name: joint for joint in tree.walk}
    if floating:
        if ROOT in joints:
            problem = f'the joint above a floating robot is called "{ROOT}"; rename this one'
            raise report.error(joints[ROOT].line, named("joint", ROOT), problem)
        model.free(ROOT, (model.ground, tree.root.name))
        return
    # The weld has no coordinate, so its name appears nowhere in emitted code; it only must be unlike
    # the name of every joint. A file may call a joint anything, hence the search.
    weld = "ground/base"
    while weld in joints:
        weld += "_"
    model.fixed(weld, (model.ground, tree.root.name))


def _add_link(model: Model, link: Link, names: _Names | None, report: Report) -> None:
    with report.placed(link.line, named("link", link.name)):
        if link.inertial is None:
            model.body(link.name)
        elif names is None:
            given = link.inertial
            tensor = dict(zip(("xx", "xy", "xz", "yy", "yz", "zz"), given.tensor, strict=True))
            model.body(link.name, mass=given.mass, mass_center=given.center, inertia=tensor)
        else:
            _add_parametric(model, link, link.inertial, names.of_links[link.name])


def _add_parametric(model: Model, link: Link, inertial: Inertial, stem: str) -> None:
    """A body whose ten moments, about its own origin, are parameters: M and h are linear in them."""
    moments = moments_of(inertial)
    who = named("link", link.name)
    mass = model.parameter(f"m_{stem}", moments.mass, "kg", f"mass of {who}")
    first = [
        model.parameter(f"m{c}_{stem}", value, "kg m", f"first moment of mass of {who}, {c}")
        for c, value in zip("xyz", moments.first, strict=True)
    ]
    about = f"of {who} about its origin"
    tensor = {
        entry: model.parameter(f"I{entry}_{stem}", value, "kg m^2", f"inertia {entry} {about}")
        for entry, value in zip(("xx", "xy", "xz", "yy", "yz", "zz"), moments.inertia, strict=True)
    }
    model.body(link.name, mass=mass, first_moment=first, inertia=tensor)


def moments_of(inertial: Inertial) -> Moments:
    """Mass, first moment and inertia about the origin of the link's frame."""
    return carried(Moments(inertial.mass, ZERO, inertial.tensor), Rotation(), inertial.center)


def _add_joint(model: Model, joint: Joint, names: _Names | None, report: Report) -> None:
    with report.placed(joint.line, named("joint", joint.name)):
        at = joint.at if names is None else _parametric_offset(model, joint, names)
        # the child's own frame is the head: URDF puts a link's frame where its joint is
        parent = model.frame_of(joint.parent) if False else None
