"""The standard parameters pi, in which inverse dynamics is linear: ten of each link and three of each joint.

    link.m                              mass (kg)
    link.mx, my, mz                     first moment of mass (kg m)
    link.Ixx, Ixy, Iyy, Ixz, Iyz, Izz   inertia (kg m^2)
    joint.damping                       viscous friction: damping w
    joint.friction                      dry friction: friction tanh(w / width)
    joint.armature                      inertia along the joint's velocity: armature dw/dt

A link is everything that one moving joint carries, all bodies welded together. It is named after the body
that the joint is connected to. Its moments are about that body's origin and in its axes: the inertia is not
about the mass centre. Off-diagonal entries have the sign of the inertia matrix, Ixy = -∫ x y dm. Joints are
those of one freedom with a velocity of their own: a joint that follows another adds to the other's
parameters, and one in prescribed motion has none.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.components.body_mass import body_moments
from linegraph.components.forces import Damper, Friction
from linegraph.components.parameters import names_in
from linegraph.ir.program import Quantity
from linegraph.spatial.inertia import NO_MOMENTS, joined
from linegraph.spatial.placement import Placement, compose, inverse
from linegraph.spatial.rotation import IDENTITY_MATRIX
from linegraph.spatial.vector import ZERO

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from linegraph.algebra.scalar import Scalar
    from linegraph.components.forces import Element, PointForce
    from linegraph.kinematics.links import KinematicTree
    from linegraph.kinematics.state_layout import Freedom
    from linegraph.model.system import System

MOMENTS = ("m", "mx", "my", "mz", "Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz")
"""The ten parameters of a link, in the order of Pinocchio's `toDynamicParameters`."""

JOINT_PARTS = ("damping", "friction", "armature")
"""The three parameters of a joint."""


class Home(NamedTuple):
    """The frame that a link's parameters refer to: that of the body its joint carries.

    Attributes:
        body: name of the body, which is also the link's.
        pose: the body's frame in the link's working frame.
    """

    body: str
    pose: Placement


@dataclass(frozen=True)
class Axis:
    """A joint of one freedom with a velocity of its own.

    Attributes:
        joint: its name.
        row: its rate as a linear combination of entries of v.
        width: the rate at which dry friction reaches 76 % of its limit (rad/s or m/s), a value of the
            model.
        turns: True for rotation, False for translation.
    """

    joint: str
    row: tuple[Freedom, ...]
    width: Any
    turns: bool

    def rate(self, v: Any) -> Scalar:
        """The joint's rate from v, or its second derivative from v̇."""
        total: Scalar = 0
        for freedom in self.row:
            total = total + freedom.ratio * v[freedom.index]
        return total


def homes(tree: KinematicTree) -> list[Home]:
    """For each link the body that its joint carries, and that body's frame in the link's working frame."""
    found: dict[int, Home] = {}
    for body, (link, pose) in tree.bodies.items():
        if link >= 0:
            found.setdefault(link, Home(body, pose))
    return [found[i] for i in range(len(tree.links))]


def axes(tree: KinematicTree) -> list[Axis]:
    """The joints that have parameters of their own, in declared order."""
    model = tree.system
    followers = {coupling.joint for coupling in model.couplings}
    found = []
    for joint in model.joints:
        place = tree.layout.own(joint.name)
        own = place is not None and place.velocities and joint.name not in followers
        if joint.freedoms == 1 and place is not None and own:
            row = (*place.velocities, *place.less[1])
            turns = joint.velocities()[0].unit == "rad/s"
            found.append(Axis(joint.name, row, _width(model, joint.name), turns))
    return found


def _width(model: System, joint: str) -> Any:
    """Width of a joint's first friction element, or the default width if it has none."""
    own = (e for e in model.force_elements if isinstance(e, Friction) and e.joint == joint)
    constant = (e.width for e in own if names_in(e.width) <= set(model.parameters))
    return next(constant, Friction.width)


def quantities(tree: KinematicTree) -> tuple[Quantity, ...]:
    """Names and units of the standard parameters, those of links before those of joints."""
    found = []
    for home in homes(tree):
        who = f"of {home.body}"
        texts = (
            ("kg", "mass"),
            *(("kg*m", f"first moment of mass {c}") for c in "xyz"),
            *(("kg*m^2", f"inertia {part[1:]} about its origin") for part in MOMENTS[4:]),
        )
        for part, (unit, meaning) in zip(MOMENTS, texts, strict=True):
            found.append(Quantity(f"{home.body}.{part}", unit, f"{meaning}, {who}"))
    for axis in axes(tree):
        units = ("N*m*s", "N*m", "kg*m^2") if axis.turns else ("N*s/m", "N", "kg")
        texts = tuple(
            zip(units, ("viscous friction", "dry friction", "rotor inertia"), strict=True)
        )
        for part, (unit, meaning) in zip(JOINT_PARTS, texts, strict=True):
            found.append(
                Quantity(f"{axis.joint}.{part}", unit, f"{meaning}, along joint {axis.joint}")
            )
    return tuple(found)


def link_values(tree: KinematicTree) -> list[Scalar]:
    """The ten moments of each link, summed over its bodies as given in the model.

    Returns:
        10 values for each link in the order of `MOMENTS` (kg, kg m, kg m^2), about the home's origin and in
        its axes.
    """
    resolve, model = tree.resolve, tree.system
    found = homes(tree)
    moments = [NO_MOMENTS] * len(found)
    for name, (link, pose) in tree.bodies.items():
        if link < 0:
            continue
        home = found[link]
        here = Placement(ZERO, IDENTITY_MATRIX)
        if name != home.body:
            here = compose(inverse(home.pose), pose, model.snap)
        moments[link] = joined(moments[link], body_moments(model.bodies[name], resolve, here))
    values: list[Scalar] = []
    for total in moments:
        # Stored row by row, listed column by column as in Pinocchio.
        xx, xy, xz, yy, yz, zz = total.inertia
        values += [total.mass, *total.first, xx, xy, yy, xz, yz, zz]
    return values


@dataclass(frozen=True)
class Bearings:
    """Friction of joints as parameters, and the elements that are not.

    Attributes:
        damping, friction: viscous and dry friction by joint.
        others: the remaining elements and loads, whose forces make up `rest`.
    """

    damping: dict[str, Scalar]
    friction: dict[str, Scalar]
    others: tuple[Element | PointForce, ...]


def friction_values(tree: KinematicTree, elements: Iterable[Element | PointForce]) -> Bearings:
    """Separate elements into parameters of joints and all others.

    An element is a parameter if it acts along a joint that has some, and its values are constants.

    Args:
        tree: the links and coordinates.
        elements: the elements and loads to separate.

    Returns:
        Viscous friction (N m s or N s/m) and dry friction (N m or N) by joint, and the other elements.
    """
    resolve = tree.resolve
    known = {axis.joint: axis for axis in axes(tree)}
    damping: dict[str, Scalar] = dict.fromkeys(known, 0)
    friction: dict[str, Scalar] = dict.fromkeys(known, 0)
    others: list[Element | PointForce] = []
    for element in elements:
        seat = _seat(tree, known, element)
        constant = all(names_in(value) <= set(tree.system.parameters) for value in element.values())
        if seat is None or not constant or not isinstance(element, (Damper, Friction)):
            others.append(element)
            continue
        axis, ratio = seat
        if isinstance(element, Damper):
            viscous = element.damping
        else:
            same = resolve(element.width) == resolve(axis.width) and ratio in (1, -1)
            dry = resolve(element.coulomb)
            if dry != 0 and not same:
                # Its tanh has another width than the joint's column.
                others.append(element)
                continue
            viscous = element.viscous
            friction[axis.joint] = friction[axis.joint] + dry
        damping[axis.joint] = damping[axis.joint] + ratio * ratio * resolve(viscous)
    return Bearings(damping, friction, tuple(others))


def _seat(
    tree: KinematicTree, known: Mapping[str, Axis], element: Element | PointForce
) -> tuple[Axis, Scalar] | None:
    """The joint whose parameters an element adds to, and the ratio of the two joints' rates."""
    joint = getattr(element, "joint", None)
    if joint is None:
        return None
    if joint in known:
        return known[joint], 1
    return led_by(tree, known, joint)


def led_by(
    tree: KinematicTree, known: Mapping[str, Axis], joint: str
) -> tuple[Axis, Scalar] | None:
    """The joint of `known` that another joint follows, and the ratio of the follower's rate to that joint's.

    Args:
        tree: the links and coordinates.
        known: joints with parameters, by name.
        joint: name of the joint that may be a follower.

    Returns:
        None if it follows none of them with a constant ratio.
    """
    place = tree.layout.own(joint)
    if place is None or tree.levelled or len(place.velocities) != 1:
        return None
    (freedom,) = place.velocities
    for axis in known.values():
        if [own.index for own in axis.row] == [freedom.index]:
            return axis, freedom.ratio
    return None
