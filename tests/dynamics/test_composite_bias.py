"""The bias from composites: a pendulum by hand, single bodies by Newton and Euler, virtual work."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from oracles import newton_euler as oracle
from support.chains import LIMB, LIMB_STATE, jacobian, modelled, poses, walked
from support.drawn_trees import KINDS, drawn
from support.near import near
from support.rigid_motion import TINY, moving

import linegraph as lg
from linegraph.dynamics.applied_forces import Applied
from linegraph.dynamics.composite_bias import bias_beside_mass
from linegraph.kinematics.tree_state import TreeState
from linegraph.spatial.vector import ZERO


def idle(tree: Any) -> Applied:
    return Applied([(ZERO, ZERO)] * len(tree.links), [0] * len(tree.velocities))


def resting(state: TreeState) -> Any:
    """The bias where nothing acts but gravity."""
    return bias_beside_mass(state, idle(state.tree))


def bias(model: lg.Model, q: Any, v: Any, **known: Any) -> Any:
    return resting(TreeState(walked(model, **known), q, v))


M, L, G = 1.7, 0.6, 9.81


def cart(**slide: Any) -> lg.Model:
    """A pendulum that hangs along -y from a cart of 2 kg on a rail along x."""
    model = lg.Model("cart", gravity=(0, -G, 0))
    rail = model.body("cart", mass=2.0)
    bob = model.body("bob", mass=M, mass_center=(0, -L, 0), inertia={"zz": 0.03})
    model.prismatic("slide", between=("ground", rail), axis=(1, 0, 0), **slide)
    model.revolute("swing", between=(rail, bob))
    return model


def test_a_pendulum_on_a_cart_pulls_it_outward() -> None:
    angle, rate = 0.7, 1.9
    found = bias(cart(), [0.4, angle], [-0.8, rate])
    pull, weight = -M * L * math.sin(angle) * rate**2, M * G * L * math.sin(angle)
    near(found, [pull, weight])


def test_where_the_carts_motion_is_prescribed_its_acceleration_swings_the_pendulum() -> None:
    """The hinge takes m l (x'' cos + g sin), whatever the rate."""
    t, angle = 0.6, 0.7
    pull = -0.3 * 4 * math.sin(2 * t)
    found = bias(cart(motion="0.3*sin(2*t)"), [angle], [1.9], t=t)
    expected = M * L * (pull * math.cos(angle) + G * math.sin(angle))
    near(found, [expected])


def test_oblique_joints_and_a_fork_take_what_newton_and_euler_say_of_each_body() -> None:
    """Universal and cylindrical joints, some crossed against their edges; accelerations by differences."""
    q, v = LIMB_STATE
    expected = np.zeros(7)
    for k, part in enumerate(LIMB):
        here = moving(lambda t, k=k: poses(LIMB, q + t * v)[k])  # type: ignore[misc]
        arm = here.rotation @ part.center
        w = here.angular
        pull = here.pull + np.cross(here.spin, arm) + np.cross(w, np.cross(w, arm))
        tensor = here.rotation @ np.diag(part.inertia) @ here.rotation.T
        J = jacobian(LIMB, q, k, part.center)
        expected += part.mass * (pull - [0.3, -0.2, -9.81]) @ J[:3]
        expected += (tensor @ here.spin + np.cross(w, tensor @ w)) @ J[3:]
    near(bias(modelled(LIMB), q, v), expected, 1e-9)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kinds", KINDS)
def test_random_trees_have_the_bias_of_single_bodies(kinds: str, seed: int) -> None:
    here = drawn(seed, kinds)
    expected = oracle.bias(here.spec, here.q, here.v)
    near(resting(here.over_floats()), expected)
    # over nodes a joint is seen from its far side where its directions change on the near one
    near(here.over_dag(resting), expected)


def test_forces_and_efforts_that_act_are_taken_off() -> None:
    """A force at b4's origin and a torque, given in its working axes, by their virtual work."""
    q, v = LIMB_STATE
    tree = walked(modelled(LIMB))
    state = TreeState(tree, q, v)
    link, seat = tree.bodies["b4"]
    turn = poses(LIMB, q)[4][:3, :3] @ np.array(seat.rotation, float).T
    force, torque = np.array([2.0, -3.0, 1.0]), np.array([0.5, 0.7, -0.4])
    place = -np.array(seat.rotation, float).T @ np.array(seat.at, float)
    J = jacobian(LIMB, q, 4, place)
    efforts = np.linspace(-1, 1, 7)
    acting = idle(tree)
    acting.wrenches[link] = (tuple(force), tuple(torque))
    acting.efforts[:] = efforts.tolist()
    found = np.array(bias_beside_mass(state, acting))
    work = (turn @ force) @ J[:3] + (turn @ torque) @ J[3:]
    expected = np.array(resting(state)) - work - efforts
    near(found, expected)


def test_coupled_hinges_share_one_entry() -> None:
    """Seen from ground the second link turns by -a where the first turns by a."""
    angle, rate = 0.4, 1.3
    model = lg.Model("geared", gravity=(0, -G, 0))
    upper = model.body("upper", mass=1.0, mass_center=(0.1, 0, 0))
    lower = model.body("lower", mass=M, mass_center=(0.3, 0, 0))
    model.revolute("first", between=("ground", upper))
    model.revolute("second", between=(upper.frame("end", at=(0.5, 0, 0)), lower))
    model.couple("second", to="first", ratio=-2.0)

    def centers(a: Any) -> Any:
        return np.array(
            [[0.1 * np.cos(a), 0.1 * np.sin(a)], [0.8 * np.cos(a), (0.5 - 0.3) * np.sin(a)]]
        )

    slopes = centers(angle + 1j * TINY).imag / TINY
    # all are sums of cos a and sin a: the second derivative is minus the place
    pulls = -(rate**2) * centers(angle) + [0, G]
    expected = np.array([1.0, M]) @ np.sum(pulls * slopes, axis=1)
    near(bias(model, [angle], [rate]), [expected])
