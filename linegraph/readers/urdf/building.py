"""From a tree of links and joints to a `Model`, with numbers folded or kept as parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.components.joints import JOINTS
from linegraph.model.body_handle import BodyHandle
from linegraph.model.builder import Model
from linegraph.model.name_register import claims_of
from linegraph.readers.urdf.mimics import Followers, followers_of
from linegraph.readers.urdf.names import ROOT
from linegraph.readers.urdf.report import UrdfReport, named
from linegraph.readers.urdf.stems import MOMENTS, OFFSETS, stems

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.readers.urdf.joints import UrdfJoint
    from linegraph.readers.urdf.links import Inertial, UrdfLink
    from linegraph.readers.urdf.structure import Tree
    from linegraph.spatial.rotation import Inertia
    from linegraph.spatial.vector import Vector

_AXES = ("xx", "xy", "xz", "yy", "yz", "zz")


class UrdfOptions(NamedTuple):
    """Options for turning a robot into a model.

    Attributes:
        floating: whether a free joint connects the root link to ground, instead of a weld.
        symbolic: whether masses, moments and offsets of joints become parameters.
        snap: as for `Model`.
    """

    floating: bool
    symbolic: bool
    snap: float


def build(name: str, tree: Tree, options: UrdfOptions, report: UrdfReport) -> Model:
    """Build the model, with bodies and joints in the order of the walk.

    Args:
        name: the model's name.
        tree: the robot.
        options: how its root is connected and whether its numbers become parameters.
        report: receives warnings and places errors.

    Raises:
        SourceError: a ``<mimic>`` is impossible, or the builder refuses something.
    """
    followers = followers_of(tree.walk, report)
    model = Model(name, snap=options.snap)
    model.source = report.source
    model.places = {f'joint "{joint.name}"': joint.line for joint in tree.walk}
    add = _Symbolic(model, tree) if options.symbolic else _Folded(model)
    with report.placed(tree.root.line, named("link", tree.root.name)):
        add.link(tree.root)
    _add_base(model, tree, options, report)
    for joint in tree.walk:
        link = tree.links[joint.child]
        with report.placed(link.line, named("link", link.name)):
            add.link(link)
        with report.placed(joint.line, named("joint", joint.name)):
            _add_joint(model, joint, add.offset(joint))
    _add_followers(model, tree, followers, report)
    _mention_dampers(tree, report)
    return model


def _add_base(model: Model, tree: Tree, options: UrdfOptions, report: UrdfReport) -> None:
    """Connect the root link to ground, before all other joints, so that its velocities come first in v."""
    joints = {joint.name: joint for joint in tree.walk}
    if options.floating:
        if ROOT in joints:
            problem = f'the joint above a floating robot is called "{ROOT}"; rename this one'
            raise report.error(joints[ROOT].line, named("joint", ROOT), problem)
        model.free(ROOT, (model.ground, tree.root.name))
        return
    # A weld has no coordinate and its name is not emitted; it only has to differ from those of all joints.
    # A file may call a joint anything, hence the loop.
    weld = "ground/base"
    while weld in joints:
        weld += "'"
    model.fixed(weld, (model.ground, tree.root.name))


def _add_joint(model: Model, joint: UrdfJoint, at: Sequence[Any]) -> None:
    """Add a frame named after the joint to the parent; the head is the frame of the child link."""
    tail = BodyHandle(model, joint.parent).frame(joint.name, at, joint.rpy)
    model.add_joint(JOINTS[joint.kind](joint.name, (tail, joint.child), joint.axis))


def _add_followers(model: Model, tree: Tree, followers: Followers, report: UrdfReport) -> None:
    for joint in tree.walk:
        with report.placed(joint.line, named("joint", joint.name)):
            if joint.name in followers.still:
                model.lock(joint.name, followers.still[joint.name])
            elif joint.name in followers.moving:
                mimic = followers.moving[joint.name]
                model.couple(joint.name, mimic.master, mimic.multiplier, mimic.offset)


def _mention_dampers(tree: Tree, report: UrdfReport) -> None:
    for joint in tree.walk:
        if joint.damped:
            text = "damping and friction are ignored"
            report.warn(joint.line, named("joint", joint.name), text)


class _Folded:
    """Adds links and offsets as numbers."""

    def __init__(self, model: Model) -> None:
        self._model = model

    def link(self, link: UrdfLink) -> None:
        """Add a body with its mass centre and its inertia about the mass centre."""
        if link.inertial is None:
            self._model.body(link.name)
            return
        given = link.inertial
        inertia = dict(zip(_AXES, given.tensor, strict=True))
        self._model.body(link.name, mass=given.mass, mass_center=given.center, inertia=inertia)

    def offset(self, joint: UrdfJoint) -> Sequence[Any]:
        """Position of the joint in the parent link (m)."""
        return joint.at


class _Symbolic:
    """Adds links and offsets as parameters whose values are the numbers of the file.

    A link's ten moments are about its own origin, since M and h are linear in these.
    """

    def __init__(self, model: Model, tree: Tree) -> None:
        self._model = model
        # A parameter must not have the name of a coordinate: they would be the same symbol.
        taken = {
            claim.name
            for joint in tree.walk
            for claim in claims_of(JOINTS[joint.kind](joint.name, ("", "")))
        }
        self._links: Mapping[str, str] = stems(tree.links, MOMENTS, taken)
        self._joints: Mapping[str, str] = stems((j.name for j in tree.walk), OFFSETS, taken)

    def link(self, link: UrdfLink) -> None:
        """Add a body whose mass, first moment and inertia about its origin are parameters."""
        if link.inertial is None:
            self._model.body(link.name)
            return
        mass, first, inertia = moments_of(link.inertial)
        meanings = [
            ("kg", "mass"),
            *(("kg m", f"first moment of mass {c}") for c in "xyz"),
            *(("kg m^2", f"inertia {entry} about the link's origin") for entry in _AXES),
        ]
        stem, who = self._links[link.name], named("link", link.name)
        m, mx, my, mz, *tensor = (
            self._model.parameter(f"{prefix}_{stem}", value, unit, f"{meaning}, {who}")
            for prefix, value, (unit, meaning) in zip(
                MOMENTS, (mass, *first, *inertia), meanings, strict=True
            )
        )
        entries = dict(zip(_AXES, tensor, strict=True))
        self._model.body(link.name, mass=m, first_moment=(mx, my, mz), inertia=entries)

    def offset(self, joint: UrdfJoint) -> Sequence[Any]:
        """Three parameters: the position of the joint in the parent link (m)."""
        stem, who = self._joints[joint.name], named("joint", joint.name)
        return [
            self._model.parameter(
                f"{c}_{stem}", value, "m", f"position {c} in the parent link, {who}"
            )
            for c, value in zip(OFFSETS, joint.at, strict=True)
        ]


def moments_of(inertial: Inertial) -> tuple[float, Vector, Inertia]:
    """Mass moments about the origin of the link's frame, in its axes.

    Returns:
        Mass (kg), first moment (kg m) and inertia (xx, xy, xz, yy, yz, zz) (kg m^2).
    """
    m, (x, y, z) = inertial.mass, inertial.center
    xx, xy, xz, yy, yz, zz = inertial.tensor
    # Parallel axis theorem; off-diagonal entries have the sign of the inertia matrix, xy = -∫ x y dm.
    about = (
        xx + m * (y * y + z * z),
        xy - m * x * y,
        xz - m * x * z,
        yy + m * (x * x + z * z),
        yz - m * y * z,
        zz + m * (x * x + y * y),
    )
    return m, (m * x, m * y, m * z), about
