"""Macros that stand for several components: the rotor behind a gear, the basement, a locked joint."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.algebra.formula import Formula
from linegraph.components.body import GROUND
from linegraph.components.joints import Compound, Fixed, Joint, Revolute
from linegraph.components.joints.base import BY_INPUT
from linegraph.components.joints.holding import moved
from linegraph.components.validation import finite, nearest, vector
from linegraph.errors import ModelError
from linegraph.spatial.vector import ZERO

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.model.body_handle import BodyHandle, Builder

BASEMENT = "basement"
_AXES = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
_SLIDES = tuple(("prismatic", axis, {"name": name}) for name, axis in _AXES.items())


class Macros:
    """Builder methods that add several components at once."""

    def rotor(
        self: Builder, name: str, joint: str | Joint, inertia: Any, ratio: Any = 1
    ) -> BodyHandle:
        """Add a motor's rotor behind a gear at a revolute joint; it turns `ratio` times as fast.

        The rotor is a body without mass in the joint's tail that follows the joint's coordinate. All terms of
        a body are in M and h, the gyroscopic torque of the turning rotor included, which an inertia added to
        the diagonal of M would miss.

        Args:
            name: of the rotor's body and joint.
            joint: the revolute joint, or its name.
            inertia: of the rotor about the joint's axis (kg m²); other entries are zero.
            ratio: rotor speed by joint speed, with sign.

        Raises:
            ModelError: the joint is not a revolute joint of this model.
        """
        at = joint.name if isinstance(joint, Joint) else joint
        return add_rotor(self, name, at, inertia, ratio)

    def basement(self: Builder, position: Any = None, rotation: Any = None) -> BodyHandle:
        """Add a massless body called "basement" in prescribed motion.

        Args:
            position: of its origin in ground axes (m): three expressions of t, each of which, or all at
                once, may be "input" to come from inputs with its first two derivatives; by default at rest.
            rotation: ``{"axis": direction, "angle": expression}``, or ``{"rpy": three expressions}`` for
                turns about ground's x, y, z in this order (rad), or "input" for the latter; by default none.

        Raises:
            ModelError: position or rotation have another form.
        """
        return add_basement(self, position, rotation)


def add_rotor(model: Builder, name: str, joint: str, inertia: Any, ratio: Any) -> BodyHandle:
    """Add a body with inertia about a revolute joint's axis alone, in the joint's tail, following the joint.

    Args:
        model: the builder.
        name: of the body and its joint.
        joint: name of the revolute joint.
        inertia: about the axis (kg m²).
        ratio: rotor speed by joint speed, with sign.

    Raises:
        ModelError: the joint is not a revolute joint of this model.
    """
    found = {known.name: known for known in model.joints}.get(joint)
    if not isinstance(found, Revolute):
        raise ModelError(f'rotor "{name}"', f'"{joint}" is not a revolute joint of this model')
    x, y, z = found.axis
    about = {"xx": (x, x), "xy": (x, y), "xz": (x, z), "yy": (y, y), "yz": (y, z), "zz": (z, z)}
    tensor = {key: _product(inertia, a, b) for key, (a, b) in about.items() if a != 0 and b != 0}
    handle = model.body(name, inertia=tensor)
    model.add_joint(Revolute(name, (found.between[0], name), found.axis, effort=False))
    model.couple(name, found, ratio)
    return handle


def add_basement(model: Builder, position: Any, rotation: Any) -> BodyHandle:
    """Add a massless body on a compound joint whose motion is prescribed.

    Args:
        model: the builder.
        position: three expressions of t (m), or "input", also for single ones; None for rest.
        rotation: axis and angle, or rpy, or "input" (rad); None for none.

    Raises:
        ModelError: position or rotation have another form.
    """
    place = (BY_INPUT,) * 3 if position == BY_INPUT else vector(position or ZERO, BASEMENT)
    turns, angles = _turns({"rpy": BY_INPUT} if rotation == BY_INPUT else rotation or {})
    # slides come first, so that the position is in ground axes
    parts = (*_SLIDES, *turns)
    handle = model.body(BASEMENT)
    drive = (*place, *angles)
    ends = (GROUND, BASEMENT)
    model.add_joint(Compound(BASEMENT, ends, effort=False, drive=drive, parts=parts))
    return handle


def _turns(rotation: Mapping[str, Any]) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """The parts and angles of a basement's rotation, from ground outward."""
    if not rotation:
        return (), ()
    if set(rotation) == {"axis", "angle"}:
        axis = vector(rotation["axis"], BASEMENT)
        return (("revolute", axis, {"name": "angle"}),), (rotation["angle"],)
    if set(rotation) != {"rpy"}:
        raise ModelError(BASEMENT, "rotation takes axis and angle, or rpy")
    rpy = rotation["rpy"]
    roll, pitch, yaw = (BY_INPUT,) * 3 if rpy == BY_INPUT else vector(rpy, BASEMENT)
    # roll, pitch, yaw about fixed x, y, z equal yaw, pitch, roll about moving z, y, x
    order = (("yaw", "z"), ("pitch", "y"), ("roll", "x"))
    parts = tuple(("revolute", _AXES[axis], {"name": name}) for name, axis in order)
    return parts, (yaw, pitch, roll)


def _product(inertia: Any, a: Any, b: Any) -> Any:
    """``inertia a b``, also for an inertia given as text."""
    factor = a * b
    if factor == 1:
        return inertia
    return f"({inertia})*({factor})" if isinstance(inertia, str) else inertia * factor


def locked(model: Builder, name: str, value: float) -> Fixed:
    """The fixed joint that replaces a joint of one freedom at a value, on a new frame of its tail's body.

    Args:
        model: the builder, to which the frame is added.
        name: of the joint.
        value: of its coordinate (rad or m).

    Raises:
        ModelError: no such joint, or it has no coordinate or more than one.
    """
    who = f'joint "{name}"'
    joints = {joint.name: joint for joint in model.joints}
    if name not in joints:
        raise ModelError(who, f"there is no such joint to lock; {nearest(name, joints)}")
    joint = joints[name]
    if joint.freedoms != 1:
        raise ModelError(who, f"is {joint.kind}; only joints of one freedom can be locked")
    finite((value,), who)
    tail, head = joint.between
    terminals = model.terminals()
    if tail not in terminals:
        raise ModelError(who, f'there is no body or frame "{tail}"; {nearest(tail, terminals)}')
    body, placement = terminals[tail]
    terminal = model.add_frame(body, f"{name}.locked", moved(placement, joint, value, model.snap))
    return Fixed(name, (terminal, head))


def followers_at(model: Builder, name: str, value: float) -> list[tuple[str, float]]:
    """The joints coupled to a joint that is locked, with the values at which they are locked.

    Args:
        model: the builder.
        name: of the locked joint.
        value: of its coordinate (rad or m).

    Raises:
        ModelError: a coupling's ratio or offset is a text, whose value is not known yet.
    """
    found = []
    for coupling in model.couplings:
        if coupling.master == name:
            if any(isinstance(x, (str, Formula)) for x in (coupling.ratio, coupling.offset)):
                problem = f'follows "{name}" by a text; lock it first, at a value'
                raise ModelError(f'joint "{coupling.joint}"', problem)
            found.append((coupling.joint, coupling.ratio * value + coupling.offset))
    return found
