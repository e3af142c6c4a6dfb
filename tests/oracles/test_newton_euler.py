"""The numeric oracle agrees with pinocchio, with finite differences and with itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from numpy.typing import NDArray
from oracles import newton_euler as oracle
from systems import random_trees as trees

if TYPE_CHECKING:
    from types import ModuleType

Array = NDArray[np.float64]
Change = Callable[[trees.Tree, np.random.Generator], trees.Variant]

SEEDS = range(30)
CHANGES: dict[str, Change] = {
    "renamed": lambda tree, rng: trees.renamed(tree),
    "reordered": trees.reordered,
    "reversed_joints": trees.reversed_joints,
    "rebased": trees.rebased,
}


@dataclass(frozen=True, eq=False)
class Case:
    """A tree, a state and accelerations (nv,)."""

    tree: trees.Tree
    q: Array
    v: Array
    a: Array


def draw_case(seed: int, **options: Any) -> Case:
    """Draw a tree of 1 to 8 bodies and a state of it."""
    rng = np.random.default_rng(seed)
    tree = trees.random_tree(rng, bodies=1 + seed % 8, **options)
    q, v = trees.random_state(rng, tree)
    return Case(tree, q, v, rng.normal(size=tree.nv))


def assert_near(actual: Any, expected: Any, tolerance: float) -> None:
    """Check that two arrays agree, relative to the largest entry expected or to one."""
    scale = max(1.0, float(np.abs(expected).max(initial=0.0)))
    np.testing.assert_allclose(actual, expected, rtol=0, atol=tolerance * scale)


def differences(values: list[Array], step: float) -> tuple[Array, Array]:
    """First and second derivative from values at -2, -1, 0, 1, 2 steps, to fourth order."""
    first = np.tensordot([1.0, -8.0, 0.0, 8.0, -1.0], values, 1) / (12 * step)
    second = np.tensordot([-1.0, 16.0, -30.0, 16.0, -1.0], values, 1) / (12 * step**2)
    return first, second


class Peer:
    """A tree in the form of a pinocchio model, numbered depth first.

    The velocities of the model are `velocity_map` (model nv, tree nv) times those of the
    tree, and so are the accelerations: the map of a planar or free joint that points towards
    ground does vary, as minus the adjoint action Ad of its pose, but the derivative of Ad is
    Ad times the bracket with the velocity, which vanishes on the velocity itself.
    """

    def __init__(self, pin: ModuleType, tree: trees.Tree, q: Array) -> None:
        """Build the model at the coordinates q (nq,) of the tree."""
        self.pin, self.tree, self.q = pin, tree, q
        self.model = pin.Model()
        self.model.gravity.linear = tree.gravity
        self.bodies = {body.name: body for body in tree.bodies}
        self.links = oracle.outward_links(tree)
        self.coordinates: list[Array] = []
        self.maps: list[Array] = []
        self._descend("ground", 0, pin.SE3.Identity())
        self.velocity_map = np.vstack(self.maps)

    def mass_matrix(self) -> Array:
        """Mass matrix (nv, nv) of the tree."""
        upper = np.triu(self.pin.crba(self.model, self.model.createData(), self._state()))
        full = upper + np.triu(upper, 1).T
        projected: Array = self.velocity_map.T @ full @ self.velocity_map
        return projected

    def inverse_dynamics(self, v: Array, a: Array) -> Array:
        """Generalised forces (nv,) of the tree."""
        rates = self.velocity_map @ v, self.velocity_map @ a
        forces = self.pin.rnea(self.model, self.model.createData(), self._state(), *rates)
        projected: Array = self.velocity_map.T @ forces
        return projected

    def _state(self) -> Array:
        return np.concatenate(self.coordinates)

    def _descend(self, name: str, parent: int, placement: Any) -> None:
        """Append the bodies carried by one whose placement on model joint `parent` is given."""
        for link in self.links:
            if link.near == name:
                self._append(link, parent, placement)

    def _append(self, link: oracle.Link, parent: int, placement: Any) -> None:
        joint, pin = link.joint, self.pin
        tilt = oracle.aligned(joint.axis) if joint.kind == "planar" else np.eye(3)
        tail = pin.SE3(joint.tail_rotation @ tilt, joint.tail_at)
        head = pin.SE3(joint.head_rotation @ tilt, joint.head_at)
        near, far = (tail, head) if link.outward else (head, tail)
        if joint.kind == "fixed":
            number, on_joint = parent, placement * near * far.inverse()
        else:
            kind = self._kind(joint, link.outward)
            number = self.model.addJoint(parent, kind, placement * near, joint.name)
            on_joint = far.inverse()
            self._record(joint, link.outward)
        body = self.bodies[link.far]
        inertia = pin.Inertia(body.mass, body.mass_center, body.inertia)
        self.model.appendBodyToJoint(number, inertia, on_joint)
        self._descend(link.far, number, on_joint)

    def _kind(self, joint: trees.Joint, outward: bool) -> Any:
        axis = joint.axis if outward else -joint.axis
        if joint.kind == "revolute":
            return self.pin.JointModelRevoluteUnaligned(axis)
        if joint.kind == "prismatic":
            return self.pin.JointModelPrismaticUnaligned(axis)
        if joint.kind == "planar":
            return self.pin.JointModelPlanar()
        return self.pin.JointModelFreeFlyer()

    def _record(self, joint: trees.Joint, outward: bool) -> None:
        """Note the coordinates of the model joint and the map of its velocities."""
        coordinates, selection = self._own(joint)
        convert = {"planar": planar_state, "free": free_state}.get(joint.kind)
        state, action = convert(coordinates, outward) if convert else (coordinates, np.eye(1))
        self.coordinates.append(state)
        self.maps.append(action @ selection)

    def _own(self, joint: trees.Joint) -> tuple[Array, Array]:
        """Coordinates of a joint and the matrix (n, nv) of its velocities."""
        places, unit = self.tree.velocity_slices, np.eye(self.tree.nv)
        for law in self.tree.couplings:
            if law.joint == joint.name:
                master = self.q[self.tree.coordinate_slices[law.master]]
                return law.ratio * master + law.offset, law.ratio * unit[places[law.master]]
        return self.q[self.tree.coordinate_slices[joint.name]], unit[places[joint.name]]


def planar_state(q: Array, outward: bool) -> tuple[Array, Array]:
    """Coordinates x, y, cos, sin and velocity map (3, 3) of a planar joint or its inverse."""
    x, y, cosine, sine = q[0], q[1], np.cos(q[2]), np.sin(q[2])
    if outward:
        return np.array([x, y, cosine, sine]), np.eye(3)
    inverse = np.array([-cosine * x - sine * y, sine * x - cosine * y, cosine, -sine])
    action = np.array([[cosine, -sine, y], [sine, cosine, -x], [0.0, 0.0, 1.0]])
    return inverse, -action


def free_state(q: Array, outward: bool) -> tuple[Array, Array]:
    """Coordinates and velocity map (6, 6) of a free joint or its inverse."""
    if outward:
        return q, np.eye(6)
    rotation = oracle.rotation_of_quaternion(q[3:])
    action = np.block(
        [[rotation, oracle.skew(q[:3]) @ rotation], [np.zeros((3, 3)), rotation]],
    )
    return np.concatenate([-rotation.T @ q[:3], -q[3:6], q[6:]]), -action


@pytest.mark.parametrize("seed", SEEDS)
def test_agrees_with_pinocchio(seed: int) -> None:
    """Mass matrix, bias and inverse dynamics are those of crba and rnea."""
    pin = pytest.importorskip("pinocchio")
    case = draw_case(seed)
    state = case.tree, case.q, case.v
    peer = Peer(pin, case.tree, case.q)
    rest = np.zeros(case.tree.nv)
    assert_near(oracle.mass_matrix(*state), peer.mass_matrix(), 1e-12)
    assert_near(oracle.bias(*state), peer.inverse_dynamics(case.v, rest), 1e-12)
    forces = peer.inverse_dynamics(case.v, case.a)
    assert_near(oracle.inverse_dynamics(*state, case.a), forces, 1e-12)


@pytest.mark.parametrize("seed", SEEDS)
def test_two_routes_agree(seed: int) -> None:
    """The balance of forces gives M a + h, and forward dynamics inverts it."""
    case = draw_case(seed)
    state = case.tree, case.q, case.v
    forces = oracle.inverse_dynamics(*state, case.a)
    projected = oracle.mass_matrix(*state) @ case.a + oracle.bias(*state)
    assert_near(forces, projected, 1e-12)
    assert_near(oracle.forward_dynamics(*state, forces), case.a, 1e-10)


@pytest.mark.parametrize("seed", SEEDS)
def test_motions_match_finite_differences(seed: int) -> None:
    """Velocities and accelerations of mass centres follow from their positions in time."""
    case = draw_case(seed)
    step = 2e-3
    times = step * np.arange(-2, 3)
    states = [oracle.advance(case.tree, case.q, case.v, case.a, time) for time in times]
    path = [list(oracle.mass_centers(case.tree, *state)) for state in states]
    for samples in zip(*path, strict=True):
        check_motion(case, [motion for _, motion in samples], step)


def check_motion(case: Case, motions: list[oracle.Motion], step: float) -> None:
    """Compare the third of five motions of one frame with differences along them."""
    now = motions[2]
    velocity, acceleration = differences([motion.origin for motion in motions], step)
    assert_near(now.linear @ case.v, velocity, 1e-7)
    assert_near(now.linear @ case.a + now.linear_bias, acceleration, 1e-6)
    turning, second = differences([motion.rotation for motion in motions], step)
    spin = oracle.skew(now.angular @ case.v)
    assert_near(spin, turning @ now.rotation.T, 1e-7)
    angular = oracle.skew(now.angular @ case.a + now.angular_bias)
    assert_near(angular + spin @ spin, second @ now.rotation.T, 1e-6)


@pytest.mark.parametrize("seed", SEEDS)
def test_energy_grows_by_the_power_of_the_forces(seed: int) -> None:
    """The energy changes at the rate tau . v, and T is that of the mass matrix."""
    case = draw_case(seed)
    state = case.tree, case.q, case.v
    power = oracle.inverse_dynamics(*state, case.a) @ case.v
    assert_near(oracle.power_balance(*state, case.a) + power, power, 1e-7)
    energy = case.v @ oracle.mass_matrix(*state) @ case.v / 2
    assert_near(oracle.kinetic_energy(*state), energy, 1e-13)


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("seed", range(10))
def test_variants_are_equivalent(seed: int, change: str) -> None:
    """Another description of a mechanism has the same dynamics, in its own order."""
    case = draw_case(seed)
    variant = CHANGES[change](case.tree, np.random.default_rng(seed))
    order = variant.velocity_order
    other = variant.tree, case.q[variant.coordinate_order], case.v[order]
    state = case.tree, case.q, case.v
    mass = oracle.mass_matrix(*state)
    assert_near(oracle.mass_matrix(*other), mass[np.ix_(order, order)], 1e-12)
    assert_near(oracle.bias(*other), oracle.bias(*state)[order], 1e-12)
    shifted = oracle.potential_energy(case.tree, case.q) + variant.potential_shift
    assert_near(oracle.potential_energy(*other[:2]), shifted, 1e-12)


def test_aligned_takes_z_to_the_axis() -> None:
    """The alignment turns by the angle to the axis, about x where the axis is -z."""
    for axis in (*np.eye(3), *-np.eye(3), np.array([0.48, -0.6, 0.64])):
        rotation = oracle.aligned(axis)
        assert_near(rotation @ [0.0, 0.0, 1.0], axis, 1e-15)
        assert_near(rotation @ rotation.T, np.eye(3), 1e-15)
        assert_near(np.linalg.det(rotation), 1.0, 1e-15)
        assert_near(np.trace(rotation), 1 + 2 * axis[2], 1e-15)
    assert_near(oracle.aligned(np.array([0.0, 0.0, -1.0])), np.diag([1.0, -1.0, -1.0]), 0.0)


def test_generator_reaches_every_feature() -> None:
    """Trees hold all kinds of joint in both directions, couplings and massless bodies."""
    drawn = [draw_case(seed).tree for seed in SEEDS]
    links = [link for tree in drawn for link in oracle.outward_links(tree)]
    assert {(link.joint.kind, link.outward) for link in links} == {
        (kind, outward) for kind in trees.KINDS for outward in (True, False)
    }
    assert any(tree.couplings for tree in drawn)
    assert any(body.mass == 0 for tree in drawn for body in tree.bodies)
    assert any(tree.joints != sorted_joints(tree) for tree in drawn)


def sorted_joints(tree: trees.Tree) -> tuple[trees.Joint, ...]:
    """The joints in the order of their names."""
    return tuple(sorted(tree.joints, key=lambda joint: joint.name))


def test_generator_honours_its_options() -> None:
    """Kinds, couplings and massless bodies appear only where they are asked for."""
    kinds = ("revolute", "fixed")
    for seed in SEEDS:
        tree = draw_case(seed, kinds=kinds, couplings=False, massless=False).tree
        assert {joint.kind for joint in tree.joints} <= set(kinds)
        assert not tree.couplings
        assert all(body.mass > 0 for body in tree.bodies)


def test_generator_repeats_itself() -> None:
    """The same seed gives the same tree and state."""
    first, second = draw_case(7), draw_case(7)
    np.testing.assert_array_equal(first.q, second.q)
    mass = oracle.mass_matrix(first.tree, first.q, first.v)
    np.testing.assert_array_equal(mass, oracle.mass_matrix(second.tree, second.q, second.v))


def test_generator_gives_up_where_nothing_moves() -> None:
    """A tree without velocities is refused."""
    with pytest.raises(ValueError, match="no regular tree"):
        trees.random_tree(np.random.default_rng(0), bodies=1, kinds=("fixed",))


def test_unconnected_bodies_are_refused() -> None:
    """A joint whose ends do not lead to ground is an error."""
    tree = draw_case(1).tree
    stray = tuple(replace(joint, tail="adrift", head="astray") for joint in tree.joints)
    with pytest.raises(ValueError, match="not connected"):
        oracle.outward_links(replace(tree, joints=stray))
