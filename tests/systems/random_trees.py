"""Descriptions of rigid-body trees and a seeded generator of random ones.

A tree is a plain list of bodies and joints. Each joint has a tail frame fixed on its tail
body and a head frame fixed on its head body; its motion is that of the head frame relative
to the tail frame. Writing R (3x3, tail axes <- head axes) for the relative rotation and
d (3, tail axes) for the displacement of the head origin from the tail origin:

=========  ==============================  =============  ====================================
kind       motion                          coordinates    velocities
=========  ==============================  =============  ====================================
fixed      R = 1, d = 0                    none           none
revolute   R = Rot(axis, q), d = 0         angle          rate
prismatic  R = 1, d = axis q               distance       rate
planar     R = A Rz(t) A^T, d = A (x,y,0)  x, y, t        d' = R A (vx, vy, 0), t' = wz
free       R of the quaternion, d          x, y, z, quat  d' = R v, angular velocity R w
=========  ==============================  =============  ====================================

A is the smallest rotation that takes z to `axis` (half a turn about x when axis = -z) and
quaternions are unit quaternions in the order x, y, z, w. The velocity of a free joint is
(v, w), both in head axes. The state lists the joints in the order of `Tree.joints`, without
the fixed and the coupled ones.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from numpy.typing import NDArray
from oracles.newton_euler import mass_matrix

if TYPE_CHECKING:
    from collections.abc import Sequence

Array = NDArray[np.float64]
Order = NDArray[np.int_]
T = TypeVar("T")

GROUND = "ground"
KINDS = ("fixed", "revolute", "prismatic", "planar", "free")
SINGLE = ("revolute", "prismatic")
COORDINATES = {"fixed": 0, "revolute": 1, "prismatic": 1, "planar": 3, "free": 7}
VELOCITIES = {"fixed": 0, "revolute": 1, "prismatic": 1, "planar": 3, "free": 6}

ATTEMPTS = 1000
REGULARITY = 1e-5


@dataclass(frozen=True, eq=False)
class Body:
    """A rigid body.

    Attributes:
        name: Unique among bodies, not "ground".
        mass: Mass, zero for a massless body.
        mass_center: (3,) mass centre from the body origin, in body axes.
        inertia: (3, 3) inertia about the mass centre, in body axes.
    """

    name: str
    mass: float
    mass_center: Array
    inertia: Array


@dataclass(frozen=True, eq=False)
class Joint:
    """A joint between two bodies, or between a body and ground.

    Attributes:
        name: Unique among joints.
        kind: One of `KINDS`.
        tail: Name of the tail body or "ground".
        head: Name of the head body or "ground".
        tail_at: (3,) origin of the tail frame, in axes of the tail body.
        tail_rotation: (3, 3) rotation, tail body axes <- tail frame axes.
        head_at: (3,) origin of the head frame, in axes of the head body.
        head_rotation: (3, 3) rotation, head body axes <- head frame axes.
        axis: (3,) unit vector in tail frame axes, unused by fixed and free joints.
    """

    name: str
    kind: str
    tail: str
    head: str
    tail_at: Array
    tail_rotation: Array
    head_at: Array
    head_rotation: Array
    axis: Array


@dataclass(frozen=True)
class Coupling:
    """The law q = ratio * q_master + offset between two joints of one degree of freedom.

    Attributes:
        joint: Name of the coupled joint, whose coordinate leaves the state.
        master: Name of the joint it follows, itself not coupled.
        ratio: Ratio of the rates.
        offset: Coordinate of the joint where the master is at zero.
    """

    joint: str
    master: str
    ratio: float
    offset: float


@dataclass(frozen=True, eq=False)
class Tree:
    """A tree of bodies rooted in ground.

    Attributes:
        bodies: Bodies in any order.
        joints: One joint per body, in any order, which is also the order of the state.
        couplings: Laws between joints.
        gravity: (3,) acceleration of gravity, in ground axes.
    """

    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    couplings: tuple[Coupling, ...]
    gravity: Array

    @property
    def active(self) -> tuple[Joint, ...]:
        """Joints that own coordinates, in the order of the state."""
        coupled = {coupling.joint for coupling in self.couplings}
        return tuple(j for j in self.joints if j.kind != "fixed" and j.name not in coupled)

    @property
    def coordinate_slices(self) -> dict[str, slice]:
        """Place in q of each active joint, by name of the joint."""
        return _slices(self.active, COORDINATES)

    @property
    def velocity_slices(self) -> dict[str, slice]:
        """Place in v of each active joint, by name of the joint."""
        return _slices(self.active, VELOCITIES)

    @property
    def nq(self) -> int:
        """Number of coordinates."""
        return sum(COORDINATES[joint.kind] for joint in self.active)

    @property
    def nv(self) -> int:
        """Number of velocities."""
        return sum(VELOCITIES[joint.kind] for joint in self.active)


@dataclass(frozen=True, eq=False)
class Variant:
    """Another description of the same mechanism.

    The states are related by q' = q[coordinate_order] and v' = v[velocity_order], whence
    M' = M[velocity_order][:, velocity_order] and likewise for forces and accelerations.

    Attributes:
        tree: The other description.
        coordinate_order: (nq,) indices into the original q.
        velocity_order: (nv,) indices into the original v.
        potential_shift: Potential energy of the variant less that of the original.
    """

    tree: Tree
    coordinate_order: Order
    velocity_order: Order
    potential_shift: float = 0.0


def random_tree(
    rng: np.random.Generator,
    bodies: int = 6,
    kinds: Sequence[str] = KINDS,
    couplings: bool = True,
    massless: bool = True,
) -> Tree:
    """Draw a tree whose mass matrix is well conditioned at a random state.

    Args:
        rng: Source of all randomness.
        bodies: Number of bodies, and of joints.
        kinds: Kinds of joint to draw from; repeat a kind to see it more often.
        couplings: Whether some joints of one degree of freedom may follow others.
        massless: Whether some bodies that carry others may be massless.

    Returns:
        A tree with at least one velocity.

    Raises:
        ValueError: If no tree drawn was regular.
    """
    for _ in range(ATTEMPTS):
        tree = _draw_tree(rng, bodies, kinds, couplings, massless)
        if _is_regular(tree, rng):
            return tree
    raise ValueError(f"no regular tree of {bodies} bodies with joints {tuple(kinds)}")


def random_state(rng: np.random.Generator, tree: Tree) -> tuple[Array, Array]:
    """Draw coordinates (nq,), quaternions normalised, and velocities (nv,)."""
    parts = [_draw_coordinates(rng, joint) for joint in tree.active]
    return np.concatenate([np.zeros(0), *parts]), rng.normal(size=tree.nv)


def random_rotation(rng: np.random.Generator) -> Array:
    """Draw a (3, 3) rotation matrix."""
    basis, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return np.asarray(basis * np.linalg.det(basis), dtype=float)


def renamed(tree: Tree) -> Variant:
    """Give all bodies and joints new names, whose alphabetic order is reversed."""
    links = _new_names(sorted(body.name for body in tree.bodies), "link")
    hinges = _new_names(sorted(joint.name for joint in tree.joints), "hinge")
    links[GROUND] = GROUND
    other = Tree(
        tuple(replace(b, name=links[b.name]) for b in tree.bodies),
        tuple(
            replace(j, name=hinges[j.name], tail=links[j.tail], head=links[j.head])
            for j in tree.joints
        ),
        tuple(replace(c, joint=hinges[c.joint], master=hinges[c.master]) for c in tree.couplings),
        tree.gravity,
    )
    return _same_order(other)


def reordered(tree: Tree, rng: np.random.Generator) -> Variant:
    """Shuffle the lists of bodies, joints and couplings."""
    other = Tree(
        _shuffled(rng, tree.bodies),
        _shuffled(rng, tree.joints),
        _shuffled(rng, tree.couplings),
        tree.gravity,
    )
    return Variant(
        other,
        _order(other.active, tree.coordinate_slices, tree.nq),
        _order(other.active, tree.velocity_slices, tree.nv),
    )


def reversed_joints(tree: Tree, rng: np.random.Generator) -> Variant:
    """Swap tail and head of about half the fixed, revolute and prismatic joints."""
    swappable = ("fixed", *SINGLE)
    joints = tuple(
        _swapped(j) if j.kind in swappable and rng.random() < 0.5 else j for j in tree.joints
    )
    return _same_order(replace(tree, joints=joints))


def rebased(tree: Tree, rng: np.random.Generator) -> Variant:
    """Describe the mechanism from another ground frame.

    A point at r in the old ground frame is at `turn` r + `shift` in the new one; the ground
    attachments and gravity move along.
    """
    turn, shift = random_rotation(rng), rng.normal(size=3)
    gravity = turn @ tree.gravity
    joints = tuple(_moved_ground(joint, turn, shift) for joint in tree.joints)
    mass = sum(body.mass for body in tree.bodies)
    variant = _same_order(replace(tree, joints=joints, gravity=gravity))
    return replace(variant, potential_shift=float(-mass * gravity @ shift))


def _slices(joints: Sequence[Joint], widths: dict[str, int]) -> dict[str, slice]:
    """Consecutive slices for the joints, of the width of their kind."""
    ends = np.cumsum([0] + [widths[joint.kind] for joint in joints]).tolist()
    return {j.name: slice(a, b) for j, a, b in zip(joints, ends[:-1], ends[1:], strict=True)}


def _draw_tree(
    rng: np.random.Generator, count: int, kinds: Sequence[str], couplings: bool, massless: bool
) -> Tree:
    """Draw a tree that may have a singular mass matrix."""
    parents = _draw_parents(rng, count)
    bodies = [
        _draw_body(rng, f"body{k}", massless and k in parents and rng.random() < 0.2)
        for k in range(count)
    ]
    joints = [_draw_joint(rng, k, parent, kinds) for k, parent in enumerate(parents)]
    return Tree(
        _shuffled(rng, bodies),
        _shuffled(rng, joints),
        _draw_couplings(rng, joints) if couplings else (),
        9.81 * _draw_direction(rng),
    )


def _draw_parents(rng: np.random.Generator, count: int) -> list[int]:
    """Draw the number of the parent of each body, -1 for ground; often a chain."""
    chained = rng.choice([0.0, 0.5, 1.0])
    return [k - 1 if rng.random() < chained else int(rng.integers(-1, k)) for k in range(count)]


def _draw_body(rng: np.random.Generator, name: str, massless: bool) -> Body:
    """Draw a body; its inertia is that of a cloud of points, hence physically valid."""
    mass = 0.0 if massless else rng.uniform(0.5, 3.0)
    points = rng.normal(scale=0.4, size=(6, 3))
    points -= points.mean(axis=0)
    moments = mass / 6 * points.T @ points
    inertia = np.trace(moments) * np.eye(3) - moments
    return Body(name, mass, rng.normal(scale=0.3, size=3), inertia)


def _draw_joint(rng: np.random.Generator, number: int, parent: int, kinds: Sequence[str]) -> Joint:
    """Draw the joint of body `number`, with its head nearer ground one time in four."""
    ends = [GROUND if parent < 0 else f"body{parent}", f"body{number}"]
    tail, head = ends if rng.random() < 0.75 else ends[::-1]
    kind = str(rng.choice(list(kinds)))
    frames = (*_draw_frame(rng), *_draw_frame(rng))
    return Joint(f"joint{number}", kind, tail, head, *frames, _draw_axis(rng))


def _draw_frame(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw an origin (3,) and a rotation (3, 3), each the neutral one time in six."""
    at = np.zeros(3) if rng.random() < 1 / 6 else rng.normal(scale=0.5, size=3)
    rotation = np.eye(3) if rng.random() < 1 / 6 else random_rotation(rng)
    return at, rotation


def _draw_direction(rng: np.random.Generator) -> Array:
    """Draw a (3,) unit vector, uniform on the sphere."""
    vector = rng.normal(size=3)
    return np.asarray(vector / np.linalg.norm(vector), dtype=float)


def _draw_axis(rng: np.random.Generator) -> Array:
    """Draw a (3,) unit vector, one time in three a coordinate axis of either sign."""
    if rng.random() < 1 / 3:
        return np.asarray(rng.choice([-1.0, 1.0]) * np.eye(3)[rng.integers(3)], dtype=float)
    return _draw_direction(rng)


def _draw_couplings(rng: np.random.Generator, joints: Sequence[Joint]) -> tuple[Coupling, ...]:
    """Draw couplings of some joints of one degree of freedom to those left uncoupled."""
    single = _shuffled(rng, [joint.name for joint in joints if joint.kind in SINGLE])
    count = int(rng.binomial(max(len(single) - 1, 0), 0.3))
    masters = list(single[count:])
    return tuple(
        Coupling(
            name,
            str(rng.choice(masters)),
            float(rng.choice([-1.0, 1.0]) * rng.uniform(0.3, 2.0)),
            rng.normal(),
        )
        for name in single[:count]
    )


def _draw_coordinates(rng: np.random.Generator, joint: Joint) -> Array:
    """Draw the coordinates of one active joint."""
    if joint.kind == "revolute":
        return rng.uniform(-np.pi, np.pi, size=1)
    q = rng.normal(size=COORDINATES[joint.kind])
    if joint.kind == "free":
        q[3:] /= np.linalg.norm(q[3:])
    return q


def _is_regular(tree: Tree, rng: np.random.Generator) -> bool:
    """Whether the mass matrix, scaled to a unit diagonal, is safely positive definite."""
    if tree.nv == 0:
        return False
    mass = mass_matrix(tree, *random_state(rng, tree))
    diagonal = np.diag(mass)
    if diagonal.min() < REGULARITY:
        return False
    scaled = mass / np.sqrt(np.outer(diagonal, diagonal))
    return bool(np.linalg.eigvalsh(scaled)[0] > REGULARITY)


def _shuffled(rng: np.random.Generator, items: Sequence[T]) -> tuple[T, ...]:
    """The items in random order."""
    return tuple(items[k] for k in rng.permutation(len(items)))


def _new_names(names: Sequence[str], stem: str) -> dict[str, str]:
    """New names by old name, in the reverse of the order given."""
    return {name: f"{stem}{len(names) - k:03d}" for k, name in enumerate(names)}


def _same_order(tree: Tree) -> Variant:
    """A variant with the state of the original."""
    return Variant(tree, np.arange(tree.nq), np.arange(tree.nv))


def _order(joints: Sequence[Joint], slices: dict[str, slice], count: int) -> Order:
    """Indices (count,) that bring entries placed by `slices` into the order of `joints`."""
    places = np.arange(count)
    return np.concatenate([places[:0], *(places[slices[joint.name]] for joint in joints)])


def _swapped(joint: Joint) -> Joint:
    """The same fixed, revolute or prismatic joint, with tail and head exchanged."""
    return Joint(
        joint.name,
        joint.kind,
        joint.head,
        joint.tail,
        joint.head_at,
        joint.head_rotation,
        joint.tail_at,
        joint.tail_rotation,
        -joint.axis,
    )


def _moved_ground(joint: Joint, turn: Array, shift: Array) -> Joint:
    """The joint with its frame on ground, if any, described in the new ground frame."""
    if joint.tail == GROUND:
        at, rotation = turn @ joint.tail_at + shift, turn @ joint.tail_rotation
        return replace(joint, tail_at=at, tail_rotation=rotation)
    if joint.head == GROUND:
        at, rotation = turn @ joint.head_at + shift, turn @ joint.head_rotation
        return replace(joint, head_at=at, head_rotation=rotation)
    return joint
