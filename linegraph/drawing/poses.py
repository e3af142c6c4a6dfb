"""Positions of everything in a mechanism at a configuration, in ground axes, for the sketch."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import sqrt
from typing import TYPE_CHECKING

from linegraph.components.body import GROUND
from linegraph.components.body_mass import mass_center, resolved
from linegraph.components.forces import PointForce
from linegraph.errors import ModelError
from linegraph.kinematics.ground_frames import seated
from linegraph.kinematics.links import Seat
from linegraph.model.terminal_graphs import terminals_of
from linegraph.numeric.loop_closure import at_some_time
from linegraph.spatial.placement import Placement, compose
from linegraph.spatial.vector import Vector, transpose

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.components.joints import Joint
    from linegraph.dynamics.chords import Chords
    from linegraph.numeric.derived import Derived
    from linegraph.numeric.reference import Numeric

GROUND_LINK = -1


@dataclass(frozen=True)
class JointPose:
    """A joint at a configuration, in ground axes.

    Attributes:
        joint: the joint.
        links: indices of the links of tail and head; -1 for ground.
        tail, head: origins of its frames (m).
        axis: unit vector of its axis, or of the normal of its plane.
    """

    joint: Joint
    links: tuple[int, int]
    tail: Vector
    head: Vector
    axis: Vector


@dataclass(frozen=True)
class TiePose:
    """A force element, constraint or load at a configuration, in ground axes.

    Attributes:
        name: its name.
        kind: its type.
        links: indices of the links of its ends; -1 for ground.
        tail, head: its ends (m); the joint's frames for an element in a joint.
        joint: name of the joint it acts in; empty if none.
    """

    name: str
    kind: str
    links: tuple[int, int]
    tail: Vector
    head: Vector
    joint: str = ""


@dataclass
class Poses:
    """A mechanism at a configuration, in ground axes.

    Attributes:
        links: the bodies of each link, welded together; those of ground at -1.
        origins: origins of the bodies' own frames (m).
        centers: mass centre of each moving link with mass (m).
        joints: joints that are not fixed.
        welds: names of fixed joints.
        ties: force elements, constraints and loads.
        upward: unit vector against gravity; None without gravity.
    """

    links: dict[int, list[str]] = field(default_factory=dict)
    origins: dict[str, Vector] = field(default_factory=dict)
    centers: dict[int, Vector] = field(default_factory=dict)
    joints: list[JointPose] = field(default_factory=list)
    welds: list[str] = field(default_factory=list)
    ties: list[TiePose] = field(default_factory=list)
    upward: Vector | None = None


def poses(
    derivation: Derived,
    q: Sequence[float] | None = None,
    hold: Mapping[str, float] | None = None,
) -> Poses:
    """Positions of all bodies and joints at a configuration.

    Args:
        derivation: a derived model with bodies.
        q: coordinates (rad, m); if left out, those found from the start values that close all loops.
        hold: values of coordinates, by name, that are kept while the loops are closed.

    Raises:
        ModelError: a parameter has no value, there is no body, or `q` has the wrong length.
    """
    model = derivation.system
    if not model.bodies:
        raise ModelError(f'model "{model.name}"', "has no bodies: there is no mechanism to sketch")
    for parameter in model.parameters.values():
        if parameter.value is None:
            problem = "has no value; a sketch of the mechanism needs one"
            raise ModelError(f'parameter "{parameter.name}"', problem)
    numeric = at_some_time(derivation)
    if q is None:
        held = hold or {}
        q = derivation.placed_assembly(held).q if held else derivation.assembled.q
    count = len(numeric.tree.positions)
    if len(q) != count:
        raise ModelError("q", f"{count} coordinates are needed, got {len(q)}")
    at = list(q)
    numeric.tree.normalise(at)
    return _gathered(derivation, numeric, at)


def _gathered(derivation: Derived, numeric: Numeric, q: Sequence[float]) -> Poses:
    model, tree = derivation.system, numeric.tree
    chords = numeric.chords(q, [0.0] * len(tree.velocities))
    found = Poses(upward=_upward(tree.gravity))
    found.links[GROUND_LINK] = []
    moments: dict[int, list[float]] = {}
    for name, (link, placement) in tree.bodies.items():
        frame = seated(chords.frames, Seat(link, placement.at, placement.rotation))
        found.links.setdefault(link, [])
        if name != GROUND:
            found.links[link].append(name)
            found.origins[name] = _floats(frame.origin)
            body = model.bodies[name]
            mass = float(numeric.resolve(body.mass))
            center = _floats(frame.at(mass_center(body, numeric.resolve)).origin)
            total = moments.setdefault(link, [0.0] * 4)
            moments[link] = [a + mass * b for a, b in zip(total, (*center, 1.0), strict=True)]
    for link, (x, y, z, mass) in moments.items():
        if mass and link != GROUND_LINK:
            found.centers[link] = (x / mass, y / mass, z / mass)
    for joint in model.joints:
        end = tree.ends[joint.name]
        if joint.freedoms == 0:
            found.welds.append(joint.name)
            continue
        tail, head = chords.ends(joint.name)
        axis = transpose(tail.rotation)[2]
        links = (end.tail.link, end.head.link)
        found.joints.append(
            JointPose(joint, links, _floats(tail.origin), _floats(head.origin), _floats(axis))
        )
    found.ties = _ties(derivation, numeric, chords, {p.joint.name: p for p in found.joints})
    return found


def _ties(
    derivation: Derived, numeric: Numeric, chords: Chords, joints: Mapping[str, JointPose]
) -> list[TiePose]:
    """Positions of force elements, constraints and loads."""
    model = derivation.system
    terminals = terminals_of(model)
    ties = []

    def end(terminal: str) -> tuple[int, Vector]:
        body, placement = terminals[terminal]
        link, own = numeric.tree.bodies[body]
        a, b, c = (resolved(row, numeric.resolve) for row in placement.rotation)
        constant = Placement(resolved(placement.at, numeric.resolve), (a, b, c))
        whole = compose(own, constant, model.snap)
        return link, _floats(seated(chords.frames, Seat(link, whole.at, whole.rotation)).origin)

    for element in model.elements:
        if isinstance(element, PointForce):
            link, place = end(element.at)
            ties.append(TiePose(element.name, element.kind, (GROUND_LINK, link), place, place))
        elif element.between is not None:
            (a, tail), (b, head) = map(end, element.between)
            ties.append(TiePose(element.name, element.kind, (a, b), tail, head))
        elif element.joint is not None and element.joint in joints:
            at = joints[element.joint]
            ties.append(
                TiePose(element.name, element.kind, at.links, at.tail, at.head, element.joint)
            )
    for limit in model.constraints:
        (a, tail), (b, head) = map(end, limit.ends)
        ties.append(TiePose(limit.name, limit.kind, (a, b), tail, head))
    return ties


def _upward(gravity: Vector) -> Vector | None:
    x, y, z = (float(c) for c in gravity)
    length = sqrt(x * x + y * y + z * z)
    return (-x / length, -y / length, -z / length) if length else None


def _floats(a: Vector) -> Vector:
    return (float(a[0]), float(a[1]), float(a[2]))
