"""Bodies that turn about one direction of ground only, so that one angle determines their orientation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from linegraph.algebra.protocol import Floats
from linegraph.components.body import GROUND
from linegraph.components.joints import Fixed, Prismatic, Revolute, Spherical, Universal
from linegraph.components.parameters import names_in, resolver, sample_values
from linegraph.model.terminal_graphs import terminals_of
from linegraph.spatial.rotation import IDENTITY_MATRIX, product
from linegraph.spatial.vector import Vector, dot, times, transpose

if TYPE_CHECKING:
    from collections.abc import Set

    from linegraph.components.joints import Joint
    from linegraph.graph.forest import Step, Topology
    from linegraph.model.system import System
    from linegraph.spatial.vector import Matrix

IN_LINE = 1e-9
"""Largest deviation of a cosine from ±1 at which two axes count as parallel."""

Turns = tuple[tuple[str, int], ...]
"""An angle as a sum of joint angles with signs; one measured from ground replaces those before it."""


@dataclass(frozen=True)
class Angle:
    """How the orientation of the body beyond a joint is measured relative to ground.

    Attributes:
        body: the body.
        less: joints with signs whose angles are to be subtracted from the angle to get the joint's own; None
            for an orientation in space, measured by a quaternion.
    """

    body: str
    less: Turns | None


class _Pose(NamedTuple):
    """A body with all coordinates 0: its axes, the direction about which it turns, and its angle.

    Attributes:
        axes: body components to ground components.
        about: in ground axes; None where nothing turns it.
        turns: its angle as a sum of joint angles.
        spatial: whether it turns about more than one direction.
    """

    axes: Matrix
    about: Vector | None
    turns: Turns
    spatial: bool = False


def absolute_angles(model: System, topology: Topology, wanted: Set[str]) -> dict[str, Angle]:
    """For each joint that reaches one of the `wanted` bodies, how its orientation is measured from ground.

    The joint must turn its head about its origin. Bodies reached by a joint that shifts keep that joint's
    coordinates, and so do those reached by prescribed and coupled joints, and by joints that relations name.

    Args:
        model: the system; directions of axes are compared at the parameters' values.
        topology: the tree in translation.
        wanted: names of bodies.
    """
    return _Survey(model, wanted).along(topology)


def related(model: System) -> set[str]:
    """The joints whose coordinates or rates a relation names; they must be coordinates of the tree."""
    names = {name for relation in model.relations for name in names_in(relation.rate)}
    return {
        joint.name
        for joint in model.joints
        if any({q.name, f"der({q.name})"} & names for q in joint.positions())
    }


class _Survey:
    """Follows the axes of rotation from ground outward."""

    def __init__(self, model: System, wanted: Set[str]) -> None:
        algebra = Floats(t=0.0)
        values = sample_values(model.parameters.values(), algebra)
        self._resolve = resolver(algebra, values)
        self._joints = {joint.name: joint for joint in model.joints}
        self._held = {name for c in model.couplings for name in (c.joint, c.master)} | related(
            model
        )
        self._terminals = terminals_of(model)
        self._wanted = wanted
        self._poses = {GROUND: _Pose(IDENTITY_MATRIX, None, ())}
        self._found: dict[str, Angle] = {}

    def along(self, topology: Topology) -> dict[str, Angle]:
        for step in topology.walk:
            joint = self._joints.get(step.edge.name)
            if joint is not None and step.edge.component == joint.name:
                self._cross(joint, step)
            elif step.edge.name.endswith("/inertia"):
                self._poses[step.edge.component] = _Pose(IDENTITY_MATRIX, None, (), spatial=True)
        return self._found

    def _cross(self, joint: Joint, step: Step) -> None:
        near_body, near_frame = self._frame(step.near)
        far_body, far_frame = self._frame(step.far)
        near = self._poses[near_body]
        at = product(near.axes, near_frame)
        axes = product(at, transpose(far_frame))
        axis = times(at, tuple(self._resolve(x) for x in joint.axis))
        turning = isinstance(joint, Revolute | Universal | Spherical)
        level = far_body in self._wanted and turning and joint.drive is None
        level = level and joint.name not in self._held
        sign = self._sign(joint, near, axis) * (1 if step.forward else -1)
        if sign:
            own = ((joint.name, sign),)
            turns = own if level else (*near.turns, *own)
            less = tuple((name, sign * factor) for name, factor in near.turns)
            pose = _Pose(axes, near.about or axis, turns)
        elif isinstance(joint, Fixed | Prismatic) and not near.spatial:
            pose = _Pose(axes, near.about, near.turns)
        else:
            less, pose = None, _Pose(axes, None, (), spatial=True)
        if level:
            self._found[joint.name] = Angle(far_body, less if sign else None)
        self._poses[far_body] = pose

    def _sign(self, joint: Joint, near: _Pose, axis: Vector) -> int:
        """±1, with its sense, if a hinge turns its body about the direction of those before it; else 0."""
        if not isinstance(joint, Revolute) or near.spatial or joint.drive is not None:
            return 0
        cosine = dot(near.about, axis) if near.about is not None else 1.0
        if abs(abs(cosine) - 1.0) > IN_LINE:
            return 0
        return 1 if cosine > 0 else -1

    def _frame(self, terminal: str) -> tuple[str, Matrix]:
        body, placement = self._terminals[terminal]
        rows = tuple(tuple(self._resolve(x) for x in row) for row in placement.rotation)
        return body, rows  # type: ignore[return-value]
